"""What a task has found out about the other tasks of its ecology."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from selfconf.bus.port import Bus, Replies
from selfconf.configurator.state import Phase
from selfconf.deployment import task_discovery
from selfconf.deployment.holders import ask_holders
from selfconf.deployment.improvement import LET_GO_OF
from selfconf.deployment.runner import RETURN, TaskRunner
from selfconf.protocol.keys import Keys
from selfconf.render.run_events import event_body
from tests.deployment.tasks import DRIVEN, SPARE, TASK, contended
from tests.lab import Lab, iri


@pytest.mark.parametrize(("patient", "act"), [(False, "refused"), (True, "waiting")])
def test_a_refusal_says_of_all_that_is_held_by_whom_and_since_when(tmp_path: Path, patient: bool, act: str) -> None:
    lab, holding = contended(tmp_path)
    lab.agent(DRIVEN, (), patient=patient, name="third")
    lab.let_pass(1.0)
    (event,) = lab.acts(act)
    assert [str(reason) for reason in event.refusal.reasons] == [
        "no component that is free is eligible for the role drive"
    ]
    held = {component: (holder.name, holder.beginning) for component, holder in event.refusal.held}
    assert held == {
        iri(name): (f"holds-{name}", one.identity.beginning) for name, one in zip(SPARE, holding, strict=True)
    }
    assert [one["task"] for one in event_body(event)["refusal"]["held"]] == ["holds-left", "holds-right"]


def test_other_tasks_are_not_asked_again_for_what_they_have_just_answered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lab, holding = contended(tmp_path)
    asked, answers = list[str](), list[Replies]()
    lab.network.node().ask(lab.keys.configurator_call("*", "status"), b"", 1.0, answers.append)
    assert lab.until(lambda: bool(answers))

    def ask(bus: Bus, keys: Keys, own: str, *rest: Any) -> None:
        asked.append(own)
        ask_holders(bus, keys, own, *rest)

    monkeypatch.setattr(task_discovery, "ask_holders", ask)
    begin = TaskRunner.start
    monkeypatch.setattr(TaskRunner, "start", lambda runner: begin(runner, statuses=answers[0]))
    agent = lab.agent(DRIVEN, (), name="third")
    assert lab.until(lambda: agent.state.phase is not Phase.DISCOVERING)
    assert {one.configurator for one in agent.state.taken.values()} == {one.name for one in holding}
    assert asked == []
    assert lab.until(lambda: bool(lab.acts("refused")))
    assert asked == [agent.name] * (len(lab.acts("query")) - 1 - len(holding)), "what was answered once counts once"


def test_a_task_that_looks_again_and_again_for_something_better_tells_once_what_the_ecology_has(tmp_path: Path) -> None:
    advertised = SPARE | {"third": SPARE["right"].replace(":right", ":third")}
    lab = Lab(tmp_path, advertised=advertised)
    lab.site("shared", *SPARE)
    for name in SPARE:
        lab.component(name)
    assert lab.running(lab.agent(DRIVEN, (), name="other"))
    agent = lab.agent(DRIVEN, (), upgrade=1.0)
    assert lab.running(agent)
    before = len(lab.events)
    lab.let_pass(10 * LET_GO_OF)
    assert agent.state.taken
    assert lab.events[before:] == []
    lab.site("another", "third")
    lab.let_pass(10 * LET_GO_OF)
    assert [event.act for event in lab.events[before:]] == ["query", "discovered"]
    assert lab.events[-1].sites == ("another", "shared")  # type: ignore[attr-defined]


def test_a_task_goes_on_with_what_lives_where_no_site_advertises_it_any_more(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    site = lab.site("astrid", *TASK, "tracker")
    for name in TASK | {"tracker"}:
        lab.component(name)
    agent = lab.agent()
    assert lab.running(agent)
    lab.isolate(agent)
    lab.let_pass(0.5)
    lab.rejoin(agent)
    lab.isolate(site)
    lab.let_pass(9.0)
    assert agent.state.unseen
    assert agent.state.phase is Phase.RUNNING
    lab.rejoin(site)
    lab.let_pass(3.0)
    assert lab.active() == TASK | {"tracker"}
    assert not any(("stopped",) in recorder.said for recorder in lab.components.values())
    assert lab.acts("lost") == []


@pytest.mark.parametrize("away", [2.0, 9.0])
def test_a_task_that_has_lost_something_waits_a_while_for_a_site_that_advertises_the_rest(
    tmp_path: Path, away: float
) -> None:
    """A hub that was opened anew may let nothing through for a moment."""
    lab = Lab(tmp_path)
    site = lab.site("astrid", *TASK)
    lab.site("living-room", "tracker", "odometry")
    for name in TASK | {"tracker", "odometry"}:
        lab.component(name)
    agent = lab.agent()
    assert lab.running(agent)
    lab.isolate(agent)
    lab.let_pass(0.5)
    lab.rejoin(agent)
    lab.isolate(site)
    lab.components["tracker"].fail("lost")
    lab.let_pass(away)
    assert agent.state.ended is (away > RETURN)
    lab.rejoin(site)
    lab.let_pass(3.0)
    assert lab.active() == (TASK | {"odometry"} if away < RETURN else set())


def test_a_task_that_looks_for_something_better_keeps_what_runs_while_its_site_is_not_heard(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", *TASK)
    living_room = lab.site("living-room", "tracker")
    for name in TASK | {"tracker", "odometry"}:
        lab.component(name)
    assert lab.running(lab.agent(upgrade=0.5))
    lab.isolate(living_room)
    lab.site("hall", "odometry")
    lab.let_pass(10.0)
    assert lab.active() == TASK | {"tracker"}
    (tmp_path / "living-room" / "tracker.ttl").unlink()
    lab.rejoin(living_room)
    assert lab.until(lambda: lab.active() == TASK | {"odometry"}), "the site says that it is advertised no more"
