"""How components come to live: dormant ones, sites that end, components that end before they act."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Request, Urgency
from selfconf.configurator import WakeUp
from selfconf.configurator.state import Phase
from selfconf.deployment.components.waking import SITE_BACK, WAKE_ATTEMPTS, WAKING, Waking
from selfconf.deployment.runner import TaskRunner
from selfconf.model.configuration import Configuration
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Cause, Fail, Wake
from tests.deployment.simulated import home, living_room
from tests.deployment.tasks import TASK
from tests.lab import Lab, iri


def test_a_component_that_is_advertised_but_does_not_run_is_passed_over(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("home", *TASK, "odometry", "tracker")
    for name in TASK | {"odometry"}:
        lab.component(name)
    agent = lab.agent()
    assert lab.running(agent)
    assert lab.active() == TASK | {"odometry"}
    assert agent.state.lost[iri("person-tracker")].detail == "it is advertised, but it does not run"
    assert agent.status().owed == ()  # what never ran is not out of control


def test_a_component_is_not_lost_that_comes_to_live_just_as_it_is_given_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Its life is heard of before the loss is noted, so that nothing would disprove that any more."""
    lab = Lab(tmp_path)
    lab.site("home", *TASK, "odometry", "tracker")
    for name in TASK | {"odometry"}:
        lab.component(name)
    agent = lab.agent()
    monkeypatch.setattr(agent.bus, "wake_up", lambda action: agent.bus.later(0.05, action))
    fail = Waking._fail

    def fail_as_it_comes(self: Waking, effect: WakeUp, detail: str) -> None:
        lab.component("tracker")
        fail(self, effect, detail)

    monkeypatch.setattr(Waking, "_fail", fail_as_it_comes)
    assert lab.running(agent)
    assert not agent.state.lost
    assert lab.active() == TASK | {"tracker"}


def test_a_component_that_has_ended_unseen_is_started_again_by_a_site_that_can(tmp_path: Path) -> None:
    """It ended, with its site, while the configurator was cut off; another site can start it, and nothing else will."""
    lab = Lab(tmp_path)
    lab.site("astrid", *TASK)
    for name in (*TASK, "tracker"):
        lab.component(name)
    first = living_room(lab, "1", lambda node: None)
    living_room(lab, "2", lambda node: lab.component("tracker"), "attic")
    agent = lab.agent()
    assert lab.running(agent)
    lab.isolate(agent)
    lab.crash("tracker")
    first.close()
    lab.let_pass(0.3)
    lab.rejoin(agent)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING and lab.active() == TASK | {"tracker"}, 10.0)


def test_a_site_is_asked_once_for_what_it_starts_however_often_the_deployment_begins_anew(tmp_path: Path) -> None:
    """What follows the lost component is disconnected meanwhile, and actuators come to rest."""
    lab, asked = Lab(tmp_path), list[float]()
    lab.site("astrid", *TASK, "odometry")
    for name in (*TASK, "odometry"):
        lab.component(name)
    agent = lab.agent()
    assert lab.running(agent)

    def begin(node: MemoryBus) -> None:
        asked.append(lab.network.time)
        node.later(4.0, lambda: lab.component("tracker"))

    living_room(lab, "1", begin)
    lab.let_pass(1.0)
    lab.components["odometry"].fail("it has slipped")
    lab.let_pass(2.0)
    assert agent.state.phase is Phase.RESERVING
    assert lab.running(agent)
    assert len(asked) == len(lab.acts("waking")) == 1
    assert lab.active() == TASK | {"tracker"}


def test_a_start_that_is_asked_for_again_is_reported_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """So it is where the end of a life is seen twice, as by the network and by its site."""
    lab, asked, wake = Lab(tmp_path), list[float](), Waking.wake
    lab.site("astrid", *TASK)
    for name in TASK:
        lab.component(name)

    def twice(self: Waking, effect: WakeUp) -> None:
        wake(self, effect)
        wake(self, effect)

    def begin(node: MemoryBus) -> None:
        asked.append(lab.network.time)
        if len(asked) == 1:
            node.later(1.0, lambda: lab.component("tracker"))

    monkeypatch.setattr(Waking, "wake", twice)
    living_room(lab, "1", begin)
    assert lab.running(lab.agent())
    assert len(asked) == 2
    assert len(lab.acts("waking")) == 1


@pytest.mark.parametrize("unheard", range(WAKE_ATTEMPTS + 1))
def test_a_site_is_asked_again_where_it_has_not_answered(tmp_path: Path, unheard: int) -> None:
    lab = home(tmp_path, "odometry")
    living_room(lab, "1", lambda _: lab.component("tracker"), unheard=unheard)
    assert lab.running(lab.agent())
    given_up = unheard == WAKE_ATTEMPTS
    assert lab.active() == TASK | {"odometry" if given_up else "tracker"}
    assert [event.detail for event in lab.acts("unreachable")] == ["its site does not answer"] * given_up


def test_a_site_hears_which_life_a_task_has_lost_when_it_is_asked_to_start_the_component_again(tmp_path: Path) -> None:
    lab = home(tmp_path)
    living_room(lab, "1", lambda _: lab.component("tracker"))
    asked: list[Wake] = []

    def listen(request: Request) -> None:
        asked.append(decode(request.payload, Wake))
        request.finish()

    lab.network.node().serve(lab.keys.wake("living-room"), listen)
    agent = lab.agent()
    assert lab.running(agent)
    life, tracker = lab.runtimes["tracker"].life, iri("person-tracker")
    lab.crash("tracker")
    assert lab.until(lambda: len(asked) == 2)
    assert asked == [Wake(tracker), Wake(tracker, life)]


def test_a_site_hears_in_which_life_a_component_was_lost_that_ended_only_afterwards(tmp_path: Path) -> None:
    """So it counts as a crash, and what fails and ends each time is not started without a limit."""
    lab, asked = home(tmp_path, "odometry"), list[Wake]()

    def listen(request: Request) -> None:
        asked.append(decode(request.payload, Wake))
        request.finish()

    living_room(lab, "1", lambda _: lab.component("tracker"))
    lab.network.node().serve(lab.keys.wake("living-room"), listen)
    lab.component("tracker")
    assert lab.running(lab.agent())
    life = lab.runtimes["tracker"].life
    lab.components["tracker"].fail("lost")
    lab.let_pass(1.0)
    lab.crash("tracker")
    lab.let_pass(1.0)
    lab.components["odometry"].fail("it slips")
    assert lab.until(lambda: lab.active() == TASK | {"tracker"})
    lab.let_pass(1.0)
    assert asked == [Wake(iri("person-tracker"), life)]
    assert [event.component for event in lab.acts("lost")] == [iri("person-tracker"), iri("absolute-odometry")]


def test_a_site_hears_of_a_life_that_it_has_started_and_that_ended_before_it_obeyed_anything(tmp_path: Path) -> None:
    lab, lives, asked = Lab(tmp_path), list[str](), list[Wake]()
    lab.site("astrid", *TASK)
    for name in TASK:
        lab.component(name)

    def begin(node: object) -> None:
        lab.component("tracker")
        runtime = lab.runtimes["tracker"]
        lives.append(runtime.life)
        runtime.calls.close()
        runtime.bus.later(0.05, lambda: lab.crash("tracker"))

    def listen(request: Request) -> None:
        asked.append(decode(request.payload, Wake))
        request.finish()

    living_room(lab, "1", begin)
    lab.network.node().serve(lab.keys.wake("living-room"), listen)
    lab.agent()
    assert lab.until(lambda: len(asked) == 3)
    assert [wake.after for wake in asked] == ["", *lives[:2]]


def asked_of_a_site_that_ends(folder: Path) -> tuple[Lab, TaskRunner]:
    """A site ends that has been asked to start the tracker; and the configurator that has asked."""
    lab = home(folder, "odometry")
    asked: list[MemoryBus] = []
    site = living_room(lab, "1", asked.append)
    agent = lab.agent()
    assert lab.until(lambda: asked)
    site.close()
    return lab, agent


def test_a_dormant_component_whose_process_ends_at_once_is_not_given_up_a_second_time(tmp_path: Path) -> None:
    lab = home(tmp_path, "odometry")
    tracker = iri("person-tracker")
    crash = encode(Fail(tracker, "", 0, Cause.CRASH, "code 1"))
    living_room(lab, "1", lambda node: node.publisher(lab.keys.fail(tracker), Urgency.EVENT).put(crash))
    agent = lab.agent()
    assert lab.running(agent)
    assert agent.state.lost[tracker].detail == "code 1"
    lab.let_pass(2 * WAKING)
    assert lab.acts("unreachable") == []


def test_what_a_site_was_starting_it_is_asked_to_start_again_in_its_next_life(tmp_path: Path) -> None:
    lab, agent = asked_of_a_site_that_ends(tmp_path)
    lab.let_pass(SITE_BACK / 2)
    living_room(lab, "2", lambda _: lab.component("tracker"))
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, SITE_BACK)
    lab.let_pass(2 * SITE_BACK)
    assert lab.active() == TASK | {"tracker"}


def test_what_a_site_was_starting_is_given_up_if_the_site_does_not_come_back(tmp_path: Path) -> None:
    lab, agent = asked_of_a_site_that_ends(tmp_path)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, SITE_BACK + 1.0)
    assert lab.active() == TASK | {"odometry"}
    assert [event.detail for event in lab.acts("unreachable")] == ["its site has ended"]


def test_a_task_is_not_refused_where_a_component_and_its_site_are_out_of_sight_for_a_moment(tmp_path: Path) -> None:
    """As where the link between two hosts is lost."""
    lab = home(tmp_path)
    site = living_room(lab, "1", lambda _: lab.component("tracker"))
    agent = lab.agent()
    assert lab.running(agent)
    there = (site, lab.node_of("tracker"))
    for node in there:
        lab.network.cut(node, agent.bus)
    lab.let_pass(0.5)
    assert "its site does not answer" in [event.detail for event in lab.acts("unreachable")]
    for node in there:
        lab.network.reconnect(node, agent.bus)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING and lab.active() == TASK | {"tracker"}, 3.0)


def test_that_nothing_is_found_without_what_a_site_starts_again_is_not_reported(tmp_path: Path) -> None:
    lab = home(tmp_path)
    living_room(lab, "1", lambda _: lab.component("tracker"))
    agent = lab.agent()
    assert lab.running(agent)
    lab.crash("tracker")
    assert lab.until(lambda: agent.state.phase is not Phase.RUNNING)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING)
    lab.let_pass(0.1)
    assert len(lab.acts("running")) == 2
    assert all(isinstance(event.outcome, Configuration) for event in lab.acts("composed"))
