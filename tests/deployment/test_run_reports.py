"""What happens in a run is reported in its order, when there is nothing more urgent to do."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.deployment.run_reports import AT_LEISURE
from selfconf.model.refusal import Refusal
from selfconf.model.run_event import FailWatched, TaskWaiting
from selfconf.render.run_events import event_body
from tests.lab import Lab, iri


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
