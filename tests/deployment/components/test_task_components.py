"""What the machine wants done about a component is done, unless that would be undone, or is not needed yet."""

from __future__ import annotations

import pytest

from selfconf.bus.port import Urgency
from selfconf.configurator import ApplyTo, Phase, ReleaseFrom
from selfconf.deployment import TaskRunner
from selfconf.deployment.components.releases import GONE
from selfconf.deployment.notices import AT_LEISURE
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Cause, Fail
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


@pytest.mark.parametrize(
    ("seconds", "told", "cut_off", "owed"),
    [
        pytest.param(GONE, False, False, (), id="without a word"),
        pytest.param(0.2, True, False, (), id="its site tells that its process has ended"),
        pytest.param(0.0, False, True, (TRACKER,), id="out of reach"),
    ],
)
def test_what_goes_just_as_its_task_ends_is_out_of_control_only_where_nothing_can_be_heard_of_it(
    agent: TaskRunner, lab: Lab, seconds: float, told: bool, cut_off: bool, owed: tuple[IRI, ...]
) -> None:
    """As on a machine that shuts down, which ends all of its programs at once."""
    life, began = lab.runtimes["tracker"].life, agent.bus.now()
    lab.crash("tracker")
    agent.stop()
    lab.let_pass(0.1)
    assert "tracker" not in lab.active()
    if cut_off:
        lab.isolate(agent)
    if told:
        site = lab.network.node().publisher(lab.keys.fail(TRACKER), Urgency.EVENT)
        site.put(encode(Fail(TRACKER, life, 0, Cause.CRASH, "its process has ended with its site")))
    assert lab.until(lambda: bool(lab.ended))
    (stopped,) = lab.acts("stopped")
    assert stopped.owed == owed
    assert agent.bus.now() - began == pytest.approx(seconds, abs=0.3)
