"""What the machine wants done about a component is done, unless that would be undone, or is not needed yet."""

from __future__ import annotations

import pytest

from selfconf.configurator import ApplyTo, Phase, ReleaseFrom
from selfconf.deployment import TaskRunner
from selfconf.deployment.notices import AT_LEISURE
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from tests.lab import Lab, iri

TRACKER = iri("person-tracker")


@pytest.fixture
def agent(lab: Lab) -> TaskRunner:
    """A configurator whose task runs."""
    agent = lab.agent()
    assert lab.running(agent)
    return agent


@pytest.mark.parametrize(("unsure", "rests", "applied"), [(False, False, 1), (True, False, 0), (True, True, 1)])
def test_nothing_is_let_act_by_one_that_does_not_know_what_has_become_of_its_components(
    agent: TaskRunner, monkeypatch: pytest.MonkeyPatch, unsure: bool, rests: bool, applied: int
) -> None:
    calls = list[ApplyTo]()
    monkeypatch.setattr(agent._components.calls, "apply", calls.append)
    agent._components.reachability.unsure = unsure
    agent._components.carry_out(ApplyTo(TRACKER, agent.state.epoch, {}, {}, {}, rests=rests))
    assert len(calls) == applied


@pytest.mark.parametrize(("phase", "seconds"), [(Phase.RUNNING, 0.0), (Phase.COMPOSING, AT_LEISURE)])
def test_a_release_comes_after_what_a_repair_waits_for(
    agent: TaskRunner, lab: Lab, monkeypatch: pytest.MonkeyPatch, phase: Phase, seconds: float
) -> None:
    released = list[float]()
    monkeypatch.setattr(agent._components.calls, "release", lambda effect: released.append(agent.bus.now()))
    agent.state = replace(agent.state, phase=phase)
    began = agent.bus.now()
    agent._components.carry_out(ReleaseFrom(TRACKER, agent.state.epoch))
    lab.until(lambda: bool(released))
    assert released[0] - began == pytest.approx(seconds, abs=AT_LEISURE / 10)


def test_once_all_is_over_nothing_is_heard_of_components(
    agent: TaskRunner, lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    heard = list[IRI]()
    monkeypatch.setattr(agent._components._messages, "_heed", lambda failed: heard.append(failed.component))
    lab.runtimes["tracker"].fail("the person has gone")
    lab.let_pass(0.1)
    assert heard == [TRACKER]
    agent._components.close()
    lab.runtimes["control"].fail("it is lost")
    lab.let_pass(0.1)
    assert heard == [TRACKER]
