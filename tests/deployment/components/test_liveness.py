"""Lives that end, seem to end, and begin again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.configurator.events import Appeared, Event, Failed
from selfconf.configurator.state import Phase
from selfconf.deployment.components import liveness
from selfconf.discovery import ecology_view
from selfconf.protocol.messages import CallAnswer, Cause, Verdict
from selfconf.sdk.runtime.supervision import GRACE
from tests.deployment.simulated import home, living_room, slow_code
from tests.deployment.tasks import TASK
from tests.lab import Lab, Recorder, iri

pytestmark = pytest.mark.usefixtures("followed")


def test_a_component_that_crashes_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash("tracker")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"odometry"}
    assert lab.acts("lost")[0].cause == "crash"


def test_a_component_that_dies_during_deployment_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.DEPLOYING)
    lab.crash("tracker")
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}


def test_a_component_that_dies_while_it_is_activated_has_crashed(lab: Lab) -> None:
    class Fragile(Recorder):
        def started(self) -> None:
            lab.crash("tracker")

    lab.crash("tracker")
    lab.component("tracker", Fragile())
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}
    assert agent.state.lost[iri("person-tracker")].cause is Cause.CRASH
    assert [account.cause for account in lab.acts("lost")] == ["crash"]


def test_a_new_life_of_a_lost_component_may_be_chosen_again(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash("tracker")
    lab.let_pass(1.0)
    lab.component("tracker")
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"odometry"}  # what runs is not changed for it
    lab.components["odometry"].fail("wheels slip")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}


def test_a_lost_component_whose_life_ends_may_be_started_and_chosen_again(tmp_path: Path) -> None:
    """It had failed; its process ends while another takes its place, and its site can start it."""
    lab = home(tmp_path, "odometry")
    living_room(lab, "1", lambda node: lab.component("tracker"))
    lab.component("tracker")
    agent = lab.agent()
    assert lab.running(agent)
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    lab.crash("tracker")
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"odometry"}
    lab.components["odometry"].fail("wheels slip")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}


def test_a_lost_component_that_lives_on_is_not_chosen_again_though_its_site_could_start_it(tmp_path: Path) -> None:
    lab = home(tmp_path, "odometry")
    living_room(lab, "1", lambda node: lab.component("tracker"))
    lab.component("tracker")
    agent = lab.agent()
    assert lab.running(agent)
    for name in ("tracker", "odometry"):
        lab.components[name].fail("lost")
        lab.let_pass(1.0)
    assert agent.state.phase is Phase.REFUSED


def test_a_component_that_is_restarted_while_it_acts_is_activated_and_set_anew(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash("control")
    assert lab.until(lambda: agent.state.phase is Phase.REFUSED)
    lab.ended.clear()
    lab.component("control")
    again = lab.agent()
    assert lab.running(again)
    assert lab.components["control"].said == [("goal", "(AT BEDROOM)"), ("started",)]


@pytest.mark.parametrize("seconds", [0.3, 1.5, 2.5])
def test_components_that_are_out_of_sight_for_a_moment_do_not_end_a_task_that_does_not_wait(
    lab: Lab, seconds: float
) -> None:
    agent = lab.agent()
    lab.running(agent)
    everybody = sorted(TASK | {"tracker", "odometry"})
    for name in everybody:
        lab.isolate(name)
    lab.let_pass(seconds)
    assert {loss.component for loss in lab.acts("lost")} >= {iri("thinking-cap"), iri("wheels")}
    for name in everybody:
        lab.rejoin(name)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, 2.0)
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"tracker"}


def test_a_component_that_was_cut_off_for_a_moment_does_not_go_on_in_the_old_configuration(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate("tracker")
    lab.let_pass(GRACE / 2)
    assert lab.active() == TASK | {"odometry", "tracker"}
    lab.rejoin("tracker")
    lab.let_pass(0.1)
    assert lab.active() == TASK | {"odometry"}
    lab.let_pass(10.0)
    assert lab.active() == TASK | {"odometry"}
    lab.components["odometry"].fail("wheels slip")
    lab.let_pass(1.0)
    assert lab.active() == TASK | {"tracker"}
    assert agent.state.phase is Phase.RUNNING


def test_a_component_that_fails_while_it_is_cut_off_for_a_moment_is_replaced(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.isolate("tracker")
    lab.components["tracker"].fail("unheard")
    lab.let_pass(0.01)
    lab.rejoin("tracker")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"odometry"}


@pytest.mark.parametrize("seconds", [0.1, 5.0])
def test_a_component_that_was_silent_as_it_was_cut_off_with_its_site_may_be_chosen_again(
    lab: Lab, seconds: float
) -> None:
    agent = lab.agent()
    lab.running(agent)
    configurator, behind_the_router = lab.network.nodes[-1], (lab.node_of("tracker"), lab.network.nodes[0])
    agent._step(Failed(iri("person-tracker"), "", Cause.SILENCE, "no signal"))
    for node in behind_the_router:
        lab.network.cut(configurator, node)
    lab.let_pass(seconds)
    assert agent.state.phase is Phase.RUNNING
    for node in behind_the_router:
        lab.network.reconnect(configurator, node)
    lab.let_pass(5.0)
    assert iri("person-tracker") not in agent.state.lost
    lab.components["odometry"].fail("wheels slip")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.RUNNING
    assert lab.active() == TASK | {"tracker"}


@pytest.mark.parametrize("name", ["drive", "tracker"])
def test_a_component_that_is_cut_off_for_a_moment_before_it_acts_has_not_failed(lab: Lab, name: str) -> None:
    """It is held, as the drive is while the tracker starts, or starts itself."""
    slow_code(lab, "tracker")
    lab.components["tracker"].slow = 5.0
    agent = lab.agent()
    assert lab.until(lambda: agent.state.phase is Phase.DEPLOYING)
    lab.let_pass(1.0)
    configurator, behind_the_router = lab.network.nodes[-1], (lab.node_of(name), lab.network.nodes[0])
    for node in behind_the_router:
        lab.network.cut(configurator, node)
    lab.let_pass(0.1)
    for node in behind_the_router:
        lab.network.reconnect(configurator, node)
    assert lab.running(agent)
    assert not agent.state.lost
    assert lab.active() == TASK | {"tracker"}


@pytest.mark.parametrize("late", [False, True])
def test_an_answer_of_before_a_component_was_applied_to_anew_is_not_that_of_one_that_has_failed(
    lab: Lab, late: bool
) -> None:
    """It was asked whether it lives on while it did not act yet, and the network has delayed its answer."""
    agent, tracker = lab.agent(), iri("person-tracker")
    assert lab.running(agent)
    life = lab.runtimes["tracker"].life
    answer = CallAnswer(Verdict.DONE, tracker, life, supervisor=agent.supervisor, task=agent.identity.task)
    agent._components.liveness._seen(tracker, life, agent.state.epoch - late, answer)
    lab.let_pass(0.1)
    assert (tracker in agent.state.lost) is not late


def test_a_component_that_crashes_is_lost_after_one_question_to_the_network(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    lab.crash("tracker")
    round_trip = 2 * lab.network.faults.most_delay
    assert lab.until(lambda: bool(agent.state.lost), 4 * round_trip)


def test_a_component_that_crashes_in_an_ecology_whose_sites_are_gone_is_lost_all_the_same(lab: Lab) -> None:
    agent = lab.agent()
    lab.running(agent)
    for site in lab.network.nodes[:2]:
        site.close()
    lab.let_pass(1.0)
    lab.crash("tracker")
    lab.let_pass(1.0)
    assert iri("person-tracker") in agent.state.lost


def test_many_that_end_at_once_are_asked_about_once(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    agent = lab.agent()
    lab.running(agent)
    asked: list[str] = []
    roll_call = MemoryBus.roll_call

    def counted(bus: MemoryBus, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        asked.append(key)
        roll_call(bus, key, seconds, done)

    monkeypatch.setattr(MemoryBus, "roll_call", counted)
    for name in ("tracker", "sonar", "pippi"):
        lab.crash(name)
    lab.let_pass(0.01)
    assert set(agent.state.lost) >= {iri("person-tracker"), iri("sonar-array")}
    assert asked[:2] == [lab.keys.any_site_life()] * len(asked[:2])
    assert asked.count(lab.keys.any_site_life()) <= 2 + 1  # a discovery calls the sites as well


def test_lives_that_nobody_waits_for_are_fed_together_when_a_lost_link_is_back(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ecology_view, "MANY_LIVES", 0)
    lamps = lab.network.node()
    undos = [lamps.announce(lab.keys.life(iri(f"lamp{number}"), "1")) for number in range(50)]
    agent = lab.agent()
    lab.running(agent)
    fed: list[Event] = []
    monkeypatch.setattr(agent._components.liveness, "_step", fed.append)
    node = agent.bus
    assert isinstance(node, MemoryBus)
    lab.network.cut(lamps, node)
    lab.let_pass(1.0)
    lab.network.reconnect(lamps, node)
    lab.let_pass(1.0)
    assert fed == [Appeared({})]
    assert len(undos) == 50


def test_a_life_that_begins_or_ends_costs_one_look_up_however_many_components_there_are(
    lab: Lab, monkeypatch: pytest.MonkeyPatch
) -> None:
    agent = lab.agent()
    lab.running(agent)
    hashed: list[str] = []
    monkeypatch.setattr(liveness, "component_chunk", hashed.append)
    for number in range(20):
        lab.network.node().announce(f"selfconf/lab/c/00/stranger{number}/live/1")
    lab.let_pass(1.0)
    assert hashed == []
