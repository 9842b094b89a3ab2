"""Configurators that are cut off or suspended, and hubs that are opened anew."""

from __future__ import annotations

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.memory.network import LEASE
from selfconf.bus.port import Urgency
from selfconf.configurator.state import Phase, Policy
from selfconf.deployment.components.reachability import MOST_REOPENINGS, SETTLING
from selfconf.protocol.messages import CallAnswer, Verdict
from selfconf.sdk.runtime.supervision import GRACE
from tests.deployment.components.sight import out_of_sight
from tests.deployment.tasks import TASK
from tests.lab import Lab, iri

pytestmark = pytest.mark.usefixtures("followed")


def test_a_configurator_that_was_suspended_applies_anew_to_components_that_have_turned_themselves_off(lab: Lab) -> None:
    """It sees all lives end and begin at one moment; meanwhile the components have not seen their supervisor."""
    agent = lab.agent(policy=Policy.DISMANTLE)
    lab.running(agent)
    epoch = agent.state.epoch
    lab.isolate(agent)
    for name in TASK | {"tracker"}:
        lab.runtimes[name]._orphaned(agent.supervisor)
    lab.rejoin(agent)
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert agent.state.epoch > epoch
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["control"].said[-2:] == [("goal", "(AT BEDROOM)"), ("started",)]
    assert not lab.acts("lost")
    assert len(lab.acts("connected")) == 1


@pytest.mark.parametrize("repairs", [False, True])
def test_a_configurator_that_was_suspended_starts_nothing_before_what_feeds_it(lab: Lab, repairs: bool) -> None:
    """Meanwhile all components have let go of its task, which it does not know as it goes on."""
    agent = lab.agent()
    lab.running(agent)
    node = agent.bus
    assert isinstance(node, MemoryBus)
    if repairs:
        lab.components["tracker"].fail("lost")
        assert lab.until(lambda: agent.state.phase is Phase.DEPLOYING)
    lab.network.pause(node)
    lab.let_pass(LEASE + GRACE + 0.5)
    assert lab.active() == set()
    lab.network.resume(node)
    sources, sinks = TASK - {"control", "drive"}, {"control", "drive"}
    assert not lab.until(lambda: bool(lab.active() & sinks) and not lab.active() >= sources, SETTLING + 1.0)
    assert lab.active() == TASK | {"odometry" if repairs else "tracker"}


def test_a_configurator_that_was_suspended_yields_to_the_one_that_has_taken_over(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    lab.isolate(first)
    lab.let_pass(GRACE + 0.1)
    second = lab.agent()
    lab.isolate(first)  # from the second one as well
    assert lab.running(second)
    lab.rejoin(first)
    assert lab.until(lambda: first.state.phase is Phase.REFUSED)
    assert lab.active() == TASK | {"tracker"}
    assert {holder_of(lab, name) for name in TASK | {"tracker"}} == {second.supervisor}


def holder_of(lab: Lab, name: str) -> str:
    """The liveliness key of the configurator that holds a component."""
    hold = lab.runtimes[name].activation.first
    return "" if hold is None else hold.claim.supervisor


@pytest.mark.parametrize("seconds", [0.3, GRACE + 0.5, 30.0])
def test_a_configurator_that_was_cut_off_brings_its_configuration_up_again(lab: Lab, seconds: float) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate(agent)
    lab.let_pass(seconds)
    assert lab.active() == (TASK | {"tracker"} if seconds < GRACE else set())
    lab.rejoin(agent)
    lab.let_pass(SETTLING + 1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}
    assert lab.components["control"].said[-1] in (("goal", "(AT BEDROOM)"), ("started",))
    assert not lab.acts("lost")


def test_a_component_that_died_while_the_configurator_was_cut_off_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate(agent)
    lab.let_pass(0.3)
    lab.crash("tracker")
    lab.let_pass(0.3)
    lab.rejoin(agent)
    lab.let_pass(SETTLING + 1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"odometry"}


def test_components_that_have_come_to_rest_out_of_sight_are_no_news_to_a_task_that_is_taken_down(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    agent.stop()
    assert agent.state.phase is Phase.DISMANTLING
    for component in list(agent.state.held):
        agent._components.liveness._seen(component, "1", agent.state.epoch, CallAnswer(Verdict.DONE, component, "1"))
    assert lab.until(lambda: bool(lab.ended))
    assert not lab.acts("connected")


def test_a_configurator_that_is_cut_off_can_be_stopped(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate(agent)
    lab.let_pass(0.1)
    agent.stop()
    assert lab.until(lambda: bool(lab.ended), 10.0)
    lab.let_pass(GRACE + 0.1)
    assert lab.active() == set()
    lab.rejoin(agent)
    lab.let_pass(2 * SETTLING)
    assert not lab.acts("connected")


def test_where_a_hub_is_opened_anew_no_end_is_believed_but_not_for_ever(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    node = lab.network.node()

    def say(site: str, number: int) -> None:
        warning = node.publisher(lab.keys.reopens(site), Urgency.EVENT)
        for _ in range(number):
            warning.put(b"")
            lab.let_pass(0.5)

    say("astrid", 10 * MOST_REOPENINGS)
    node.publisher(lab.keys.reopens("living-room"), Urgency.EVENT).put(b"")
    lab.let_pass(0.02)
    out_of_sight(lab, "tracker", "sonar", seconds=0.5)
    lab.let_pass(5.0)
    assert lab.acts("lost") == [], "what another site says is no matter"
    assert lab.active() == TASK | {"tracker"}
    say("living-room", 10 * MOST_REOPENINGS)
    lab.crash("tracker")
    assert lab.until(lambda: iri("person-tracker") in agent.state.lost, 5.0), (
        "whoever says it without an end is not heard"
    )


@pytest.mark.parametrize(("site", "believed"), [("living-room", True), ("nowhere", False)])
def test_of_the_hub_of_a_site_that_does_not_live_nothing_is_believed(lab: Lab, site: str, believed: bool) -> None:
    lab.running(lab.agent())
    lab.network.node().publisher(lab.keys.reopens(site), Urgency.EVENT).put(b"")
    lab.let_pass(0.5)
    assert bool(lab.acts("cut off")) == believed


def test_a_hub_that_is_opened_anew_again_and_again_is_believed_as_the_link_is_lost_each_time(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent()
    lab.running(agent)
    turns = 0
    monkeypatch.setattr(MemoryBus, "link", property(lambda _: f"the hub {turns}"))
    warning = lab.network.node().publisher(lab.keys.reopens("living-room"), Urgency.EVENT)
    for _ in range(3 * MOST_REOPENINGS):
        warning.put(b"")
        lab.let_pass(0.02)
        out_of_sight(lab, "tracker", "sonar", seconds=0.2)
        turns += 1
        lab.let_pass(2.0)
    assert lab.acts("lost") == []
