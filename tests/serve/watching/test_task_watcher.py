"""The tasks that a watcher follows: which are remembered, and how many."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from selfconf.bus.port import Bus, Replies, Request, Sample, Urgency
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Notice, Status, TaskRecord
from selfconf.serve.watching import task_watcher
from selfconf.serve.watching.task_watcher import LOOK_ANEW, TaskWatcher
from tests.lab import Lab, iri


class Tasks:
    """What a watcher of tasks tells."""

    def __init__(self, lab: Lab) -> None:
        self.events: list[Any] = []
        self.watcher = TaskWatcher(lab.network.node(), lab.keys, self.events.append, lambda: None)
        self.watcher.follow()

    def phases(self) -> list[str]:
        return [body["phase"] for _, body in self.watcher.bodies()]


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    lab = Lab(tmp_path)
    lab.navigation()
    return lab


def test_a_task_that_is_over_is_remembered_for_a_while(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(task_watcher, "ENDED_TASKS", 2)
    tasks = Tasks(lab)
    for _ in range(3):
        agent = lab.agent()
        lab.running(agent)
        agent.stop()
        lab.let_pass(2.0)
    assert tasks.phases() == ["stopped", "stopped"]


def test_a_configurator_that_is_cut_down_is_gone(lab: Lab) -> None:
    tasks = Tasks(lab)
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(1.0)
    ((graph,),) = (graphs.items() for graphs in tasks.watcher.take_graphs())
    lab.crash(agent)
    lab.let_pass(3.0)
    assert tasks.phases() == ["gone"]
    assert tasks.watcher.take_graphs() == [{graph[0]: b""}]
    late = Sample(lab.keys.configuration(agent.name), agent._record.turtle().encode())
    tasks.watcher._take_deployed(Replies((late,)))
    assert tasks.watcher.take_graphs() == [{}]


def test_a_configurator_whose_life_ends_before_its_last_notice_comes_has_stopped(lab: Lab) -> None:
    tasks, life = Tasks(lab), lab.keys.configurator_life("c1", "1")
    tasks.watcher._configurator_changed(life, True)
    tasks.watcher._configurator_changed(life, False)
    tasks.watcher._hear(tasks.watcher._task("c1"), Notice("c1", 1, "tidy~1", {"act": "stopped", "time": 1.0}))
    assert tasks.phases() == ["stopped"]
    tasks.watcher._configurator_changed(life, True)
    lab.let_pass(1.0)
    assert tasks.watcher._tasks["c1"].alive, "it has come back before its end was believed"


def tell(lab: Lab, node: Bus, *events: tuple[int, str]) -> None:
    """Put notices of the configurator c1, by their numbers and acts."""
    publisher = node.publisher(lab.keys.notices("c1"), Urgency.SIGNAL)
    for sequence, act in events:
        publisher.put(encode(Notice("c1", sequence, "tidy~c1", {"act": act, "time": 1.0, "message": act})))


def test_what_comes_after_a_notice_that_was_lost_counts_also_if_nobody_can_say_that_any_more(lab: Lab) -> None:
    tasks = Tasks(lab)
    node = lab.network.node()
    node.announce(lab.keys.configurator_life("c1", "1"))
    lab.let_pass(1.0)
    tell(lab, node, (1, "composed"), (3, "running"), (5, "released"), (4, "running"), (6, "stopped"))
    node.close()
    lab.let_pass(3.0)
    assert [event["act"] for event in tasks.events] == ["composed", "running", "running", "released", "stopped"]
    assert tasks.phases() == ["stopped"]


def test_of_what_comes_too_early_some_is_kept_and_no_more(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(task_watcher, "EARLY", 2)
    tasks = Tasks(lab)
    tell(lab, lab.network.node(), (2, "composed"), (3, "waking"), (4, "running"), (5, "lost"))
    lab.let_pass(3.0)
    assert [event["act"] for event in tasks.events] == ["running", "lost"]


def test_what_is_answered_for_a_configurator_that_has_ended_and_was_forgotten_does_not_bring_it_back(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(task_watcher, "ENDED_TASKS", 0)
    tasks, answers = Tasks(lab), list[tuple[Any, Replies]]()
    asked = tasks.watcher.bus.ask

    def ask(key: str, payload: bytes, seconds: float, done: Any) -> None:
        asked(key, payload, seconds, lambda replies: answers.append((done, replies)))

    monkeypatch.setattr(tasks.watcher.bus, "ask", ask)
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(LOOK_ANEW + 1.0)
    lab.crash(agent)
    lab.let_pass(3.0)
    assert tasks.phases() == []
    for done, replies in answers:  # as where another configurator hangs: all wait until its time is over
        done(replies)
    assert tasks.phases() == []


def test_a_configurator_that_comes_back_at_once_was_never_gone(lab: Lab) -> None:
    tasks = Tasks(lab)
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(1.0)
    for alive in (False, True):
        tasks.watcher._configurator_changed(lab.keys.configurator_life(agent.name, "1"), alive)
    lab.let_pass(1.0)
    assert tasks.phases() == ["running"]


def test_a_configurator_that_comes_back_later_is_not_forgotten_with_those_that_have_ended(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(task_watcher, "ENDED_TASKS", 2)
    tasks = Tasks(lab)
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(1.0)
    told = tasks.watcher.take_graphs()
    for alive in (False, True):  # as where this node was cut off for a while
        tasks.watcher._configurator_changed(lab.keys.configurator_life(agent.name, "1"), alive)
        lab.let_pass(1.0)
    ended, anew = tasks.watcher.take_graphs()
    assert [graphs.keys() for graphs in (ended, anew)] == [graphs.keys() for graphs in told * 2]
    assert [any(graphs.values()) for graphs in (ended, anew)] == [False, True], "what it has deployed counts anew"
    for name in ("c1", "c2"):
        for alive in (True, False):
            tasks.watcher._configurator_changed(lab.keys.configurator_life(name, "1"), alive)
        lab.let_pass(1.0)
    assert sorted(tasks.phases()) == ["gone", "gone", "running"]


def test_a_configuration_that_is_replaced_before_it_is_handed_on_is_handed_on_before_the_other(lab: Lab) -> None:
    tasks = Tasks(lab)
    agent = lab.agent()
    lab.running(agent)
    lab.let_pass(1.0)
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    first, second = tasks.watcher.take_graphs()
    assert first.keys() == second.keys()
    assert [iri("absolute-odometry").encode() in next(iter(graphs.values())) for graphs in (first, second)] == [
        False,
        True,
    ]


def test_a_configuration_that_is_replaced_before_anybody_can_ask_for_it_is_handed_on(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(TaskWatcher, "_ask", lambda *_: None)
    tasks = Tasks(lab)
    agent = lab.agent()
    lab.running(agent)
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    told = [next(iter(graphs.values())) for graphs in tasks.watcher.take_graphs()]
    assert [iri("absolute-odometry").encode() in graph for graph in told] == [False, True]


def test_a_configuration_that_is_told_late_takes_the_place_of_no_later_one(lab: Lab) -> None:
    tasks = Tasks(lab)
    agent = lab.agent()
    lab.running(agent)
    first = agent._record.turtle().encode()
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    tasks.watcher.take_graphs()
    tasks.watcher._take_deployed(Replies((Sample(lab.keys.configuration(agent.name), first),)))
    assert tasks.watcher.take_graphs() == [{}]
    ((_, body),) = tasks.watcher.bodies()
    assert iri("absolute-odometry") in str(body["configuration"])


def test_of_a_task_that_has_waited_before_the_watcher_came_and_runs_now_the_configuration_is_known(lab: Lab) -> None:
    """It asks for the events of before and for the configuration of now at once, and may hear of the latter first."""
    agent = lab.agent(patient=True)
    lab.running(agent)
    lab.crash("drive")
    lab.let_pass(4.0)
    lab.component("drive")
    lab.let_pass(6.0)
    tasks = Tasks(lab)
    lab.let_pass(3.0)
    assert {"waiting", "running"} <= {event["act"] for event in tasks.events}
    ((_, body),) = tasks.watcher.bodies()
    assert iri("drive") in str(body["configuration"])
    assert iri("drive").encode() in next(iter(tasks.watcher.take_graphs()[-1].values()))


def test_what_a_configurator_tells_of_its_task_is_handed_on_once_the_identity_is_known(lab: Lab) -> None:
    watcher = Tasks(lab).watcher
    record, key = TaskRecord("tidy~1", 1), lab.keys.configurator_call("c1", "task")
    watcher._task("c1")
    watcher._new_records = {"c1": record, "gone": record}
    assert watcher.take_records() == {}
    status = Status("c1", "idle", iri("tidy"), 0, 0.0, task="tidy~1")
    watcher._take_statuses(Replies((Sample(key.replace("task", "status"), encode(status)),)))
    assert watcher.take_records() == {"tidy~1": record}
    assert watcher.take_records() == {}


def test_what_later_configurators_tell_of_their_tasks_is_known_however_many_have_ended(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(task_watcher, "ENDED_TASKS", 0)
    monkeypatch.setattr(task_watcher, "TOLD_TASKS", 1)
    tasks = Tasks(lab)
    for name in ("c1", "c2"):
        node, key = lab.network.node(), lab.keys.configurator_call(name, "task")
        node.serve(key, answering_with(key, TaskRecord(f"{name}~1", 1)))
        node.announce(lab.keys.configurator_life(name, "1"))
        lab.let_pass(1.0)
        assert name in tasks.watcher._new_records
        node.close()
        lab.let_pass(1.0)


def answering_with(key: str, record: TaskRecord) -> Callable[[Request], None]:
    """Answers each question with that."""

    def answer(request: Request) -> None:
        request.reply(key, encode(record))
        request.finish()

    return answer


def test_a_task_that_the_sites_keep_and_none_runs_is_shown_as_kept(lab: Lab) -> None:
    tasks = Tasks(lab)
    notice = lab.network.node().publisher(lab.keys.task("tidy~1"), Urgency.EVENT)
    notice.put(encode(TaskRecord("tidy~1", 1, priority=3, wanted=iri("tidy"))))
    lab.let_pass(1.0)
    ((identity, body),) = tasks.watcher.bodies()
    assert (identity, body["name"], body["phase"], body["priority"]) == ("tidy~1", "tidy", "kept", 3)
    notice.put(encode(TaskRecord("tidy~1", 2, ended=True)))
    lab.let_pass(1.0)
    assert tasks.phases() == []


def test_a_stranger_that_tells_of_tasks_without_end_is_heard_only_so_far(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(task_watcher, "MOST_TASKS", 5)
    tasks = Tasks(lab)
    stranger = lab.network.node()
    for number in range(20):
        publisher = stranger.publisher(lab.keys.notices(f"c{number}"), Urgency.SIGNAL)
        publisher.put(encode(Notice(f"c{number}", 1, f"t~{number}", {"act": "stopped", "time": 1.0})))
    lab.let_pass(1.0)
    assert len(tasks.phases()) == 5


def test_what_is_told_on_the_key_of_another_is_passed_over(lab: Lab) -> None:
    tasks = Tasks(lab)
    publisher = lab.network.node().publisher(lab.keys.notices("c1"), Urgency.SIGNAL)
    for payload in (b"nonsense", encode(Notice("c2", 1, "t~1", {"act": "stopped"}))):
        publisher.put(payload)
    lab.let_pass(1.0)
    assert (tasks.events, tasks.phases()) == ([], [])
    tasks.watcher._task("c2")
    answer = Sample(lab.keys.notices("c1"), encode(Notice("c2", 1, "t~1", {"act": "stopped"})))
    tasks.watcher._hear_all(Replies((answer,)))
    assert tasks.events == []
