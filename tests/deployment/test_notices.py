"""What a configurator tells those who look on, and that nothing of the run depends on them."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace

import pytest

from selfconf.bus.port import Bus, Replies, Sample
from selfconf.deployment.notices import AT_LEISURE, LATEST, RunNotices
from selfconf.model.configuration import Configuration, ParameterSetting
from selfconf.model.refusal import Refusal
from selfconf.model.run_event import AnswerRejected, FailWatched, TaskRunning, TaskStopped, TaskWaiting
from selfconf.model.term import Literal
from selfconf.protocol.codec import LARGEST, decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Notice
from selfconf.render.run_events import event_body
from tests.lab import Lab, iri


def latest(lab: Lab, key: str) -> list[Notice]:
    """The events that a configurator has kept."""
    replies: list[Replies] = []
    lab.network.node().ask(key, b"", 1.0, replies.append)
    assert lab.until(lambda: bool(replies))
    return [decode(sample.payload, Notice) for sample in replies[0].samples]


def test_an_observer_hears_what_fails_and_what_takes_over(lab: Lab) -> None:
    heard: list[Notice] = []
    lab.network.node().subscribe(lab.keys.notices(), lambda sample: heard.append(decode(sample.payload, Notice)))
    agent = lab.agent()
    lab.running(agent)
    lab.components["tracker"].fail("lost Astrid")
    lab.let_pass(1.0)
    (lost,) = [notice.event for notice in heard if notice.event["act"] == "lost"]
    assert (lost["component"], lost["cause"]) == (iri("person-tracker"), "fail")
    first, second = (notice.event for notice in heard if notice.event["act"] == "running")
    assert iri("person-tracker") in json.dumps(first["configuration"])
    assert iri("absolute-odometry") in json.dumps(second["configuration"])
    assert [notice.sequence for notice in heard] == list(range(1, len(heard) + 1))
    assert {(notice.configurator, notice.task) for notice in heard} == {(agent.name, agent.identity.task)}


def test_how_a_run_has_ended_is_heard_though_the_network_drops_what_it_may(lab: Lab) -> None:
    heard: list[Notice] = []
    lab.network.node().subscribe(lab.keys.notices(), lambda sample: heard.append(decode(sample.payload, Notice)))
    told = RunNotices(lab.network.node(), lab.keys, "c1", "tidy~c1")
    lab.let_pass(0.1)
    lab.network.faults = replace(lab.network.faults, loss=1.0)
    for event in (AnswerRejected("dropped"), TaskStopped()):
        told.put(event)
    told.close()
    lab.let_pass(0.1)
    assert [(notice.sequence, notice.event["act"]) for notice in heard] == [(2, "stopped")]


def test_what_is_put_after_the_end_is_told_to_no_one(lab: Lab) -> None:
    """On a site that hands its task over, a component may answer a call after that."""
    heard: list[Notice] = []
    lab.network.node().subscribe(lab.keys.notices(), lambda sample: heard.append(decode(sample.payload, Notice)))
    told = RunNotices(lab.network.node(), lab.keys, "c1", "tidy~c1")
    lab.let_pass(0.1)
    told.put(TaskStopped())
    told.close()
    told.put(AnswerRejected("after the end"))
    lab.let_pass(0.1)
    assert [notice.event["act"] for notice in heard] == ["stopped"]


def test_who_comes_late_is_told_the_latest_events(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    told = latest(lab, lab.keys.notices())
    assert [notice.event["act"] for notice in told] == [event.act for event in lab.events]


def test_the_oldest_events_are_forgotten(lab: Lab) -> None:
    node, keys = lab.network.node(), Keys("lab")
    told = RunNotices(node, keys, "c1", "tidy~c1")
    for number in range(LATEST + 5):
        told.put(AnswerRejected(str(number)))
    found = latest(lab, keys.notices("c1"))
    assert [notice.event["detail"] for notice in found] == [str(number) for number in range(5, LATEST + 5)]
    told.close()
    assert latest(lab, keys.notices("c1")) == []


def test_nothing_is_written_while_nobody_listens(lab: Lab) -> None:
    written: list[Sample] = []
    node: Bus = lab.network.node()
    told = RunNotices(node, Keys("lab"), "c1", "tidy~c1")
    told.put(AnswerRejected("unheard"))
    undo = lab.network.node().subscribe(Keys("lab").notices(), written.append)
    lab.let_pass(0.1)
    told.put(AnswerRejected("heard"))
    lab.let_pass(0.1)
    undo()
    lab.let_pass(0.1)
    told.put(AnswerRejected("unheard again"))
    lab.let_pass(0.1)
    assert [decode(sample.payload, Notice).event["detail"] for sample in written] == ["heard"]


def test_an_event_that_is_explained_is_told_once_more_by_its_number(lab: Lab) -> None:
    heard: list[Notice] = []
    lab.network.node().subscribe(lab.keys.notices(), lambda sample: heard.append(decode(sample.payload, Notice)))
    told = RunNotices(lab.network.node(), lab.keys, "c1", "tidy~c1")
    lab.let_pass(0.1)
    waits, twin = TaskWaiting(Refusal(iri("navigate"), ())), TaskWaiting(Refusal(iri("navigate"), ()))
    for event in (waits, AnswerRejected("after it")):
        told.put(event)
    told.amend(twin, TaskStopped())
    told.amend(waits, replace(waits, refusal=Refusal(iri("navigate"), (), hint="try another")))
    lab.let_pass(0.1)
    assert [(notice.sequence, notice.event["act"]) for notice in heard] == [
        (1, "waiting"),
        (2, "complaint"),
        (1, "waiting"),
    ]
    explained = [{"code": "reasoning", "message": "try another"}]
    assert [notice.event["refusal"]["repairs"] for notice in heard[::2]] == [[], explained]
    kept = latest(lab, lab.keys.notices("c1"))
    assert [notice.event["act"] for notice in kept] == ["waiting", "complaint"]
    assert kept[0].event["refusal"]["repairs"] == explained
    told.close()
    told.amend(waits, waits)  # the explanation comes too late


def test_a_run_that_waits_hands_its_refusal_out_to_be_explained(lab: Lab) -> None:
    asked: list[Refusal] = []

    def explain(refusal: Refusal, found: Callable[[Refusal], None]) -> None:
        asked.append(refusal)
        found(replace(refusal, hint="try another"))

    lab.crash("drive")
    agent = lab.agent(patient=True, explain=explain)
    assert lab.until(lambda: bool(asked), 10.0)
    lab.let_pass(0.1)
    (waits,) = [
        notice.event for notice in latest(lab, lab.keys.notices(agent.name)) if notice.event["act"] == "waiting"
    ]
    assert waits["refusal"]["repairs"] == [{"code": "reasoning", "message": "try another"}]
    assert asked[0].hint is None


def test_an_event_that_is_too_large_is_told_in_a_sentence(lab: Lab) -> None:
    setting = ParameterSetting(iri("thinking-cap"), "goal", Literal("x" * LARGEST))
    told = RunNotices(lab.network.node(), Keys("lab"), "c1", "tidy~c1")
    told.put(TaskRunning(Configuration(iri("navigate"), (), settings=(setting,)), 7, time=3.0))
    (notice,) = latest(lab, Keys("lab").notices("c1"))
    assert notice.event == {"act": "running", "time": 3.0, "message": "running"}


def test_what_it_does_is_reported_in_the_order_of_the_four_acts(lab: Lab) -> None:
    lab.running(lab.agent())
    lab.let_pass(0.1)
    acts = [account.act for account in lab.events]
    firsts = [
        acts.index(act) for act in ("query", "discovered", "composed", "watching", "activating", "set", "running")
    ]
    assert firsts == sorted(firsts)
    assert max(i for i, act in enumerate(acts) if act == "watching") < acts.index("activating")
    connected = {(str(a.source), str(a.output)) for a in lab.acts("connecting")}
    assert (str(iri("person-tracker")), "pose") in connected
    assert all(event_body(event) for event in lab.events)


def test_an_event_is_told_a_moment_later_with_the_time_at_which_it_was_noted(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    noted, before = agent.clock(), len(lab.acts("watching"))
    agent.reports.note(FailWatched(iri("cellar-lamp")))
    assert len(lab.acts("watching")) == before
    lab.let_pass(2 * AT_LEISURE)
    *_, told = lab.acts("watching")
    assert (told.component, told.time) == (iri("cellar-lamp"), noted)


def test_what_is_to_be_told_now_is_not_told_again_later(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    before = len(lab.acts("watching"))
    agent.reports.note(FailWatched(iri("cellar-lamp")))
    for _ in range(2):
        agent.reports.tell()
        assert len(lab.acts("watching")) == before + 1
    lab.let_pass(1.0)
    assert len(lab.acts("watching")) == before + 1


def test_the_refusal_of_a_task_that_waits_is_explained_when_it_is_told(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent(bound=(("robot", ":Nobody"), ("goal", "(AT BEDROOM)")), patient=True)
    asked: list[Refusal] = []
    request = replace(agent.request, explain=lambda refusal, done: (asked.append(refusal), done(refusal)))
    monkeypatch.setattr(agent.reports, "_request", request)
    amended: list[TaskWaiting] = []
    monkeypatch.setattr(agent._notices, "amend", lambda event, more: amended.append(more))
    assert lab.until(lambda: bool(amended))
    assert [one.refusal for one in amended] == asked == [agent.state.refusal]
