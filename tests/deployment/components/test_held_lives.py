"""Lives that have obeyed a task: what is released though it cannot be heard, and who is out of control."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Urgency
from selfconf.configurator import Phase
from selfconf.deployment.components.releases import GONE
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import CallAnswer, Cause, Fail, Release, Verdict
from tests.deployment.simulated import living_room, slow_code
from tests.deployment.tasks import TASK
from tests.lab import Lab, iri


def test_a_component_that_hears_but_is_not_heard_is_released_though_it_seems_to_be_dead(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    assert isinstance(agent.bus, MemoryBus)
    lab.network.mute(lab.node_of("tracker"), agent.bus)
    assert lab.until(lambda: lab.active() == TASK | {"odometry"}, 1.0)
    lab.let_pass(2 * GONE)
    assert agent.status().owed == ()  # it is not known to have obeyed, but nobody has to see to it


@pytest.mark.parametrize("told_first", [True, False], ids=["the site is heard first", "the end is seen first"])
def test_a_component_whose_site_has_seen_it_end_is_not_out_of_control(lab: Lab, told_first: bool) -> None:
    agent, tracker = lab.agent(), iri("person-tracker")
    assert lab.running(agent)
    publisher = lab.network.node().publisher(lab.keys.fail(tracker), Urgency.EVENT)
    crash = encode(Fail(tracker, "", 0, Cause.CRASH, "its process has ended with code -9"))
    if told_first:
        publisher.put(crash)
        lab.crash("tracker")
    else:
        lab.crash("tracker")
        assert lab.until(lambda: agent.status().owed == (tracker,), 1.0)
        publisher.put(crash)
    lab.let_pass(0.1)
    assert agent.status().owed == ()
    assert tracker in agent.state.owed  # should it be heard of again, it is released


def test_a_component_that_lives_may_be_out_of_control_though_a_process_of_it_has_ended(lab: Lab) -> None:
    """A component that a person has started lives on when the process ends that its site has started as well."""
    thread, drive = slow_code(lab, "drive"), iri("astrid-drive")
    agent = lab.agent()
    assert lab.running(agent)
    thread.spend(60.0)
    publisher = lab.network.node().publisher(lab.keys.fail(drive), Urgency.EVENT)
    publisher.put(encode(Fail(drive, lab.runtimes["drive"].life, 0, Cause.FAIL)))
    publisher.put(encode(Fail(drive, "", 0, Cause.CRASH, "its process has ended with code 2")))
    assert lab.until(lambda: agent.status().owed == (drive,), 1.0)
    assert lab.until(lambda: agent.state.phase is Phase.REFUSED)
    lab.let_pass(2 * GONE)
    assert agent.status().owed == (drive,)


def test_a_component_that_its_site_does_not_start_again_is_not_out_of_control(tmp_path: Path) -> None:
    lab = Lab(tmp_path)
    lab.site("astrid", *TASK)
    for name in (*TASK, "tracker"):
        lab.component(name)
    living_room(lab, "1", lambda node: None, refusal="it has crashed too often")
    agent, tracker = lab.agent(), iri("person-tracker")
    assert lab.running(agent)
    lab.crash("tracker")
    assert lab.until(lambda: bool(lab.ended), 1.0)
    assert agent.state.lost[tracker].detail == "it has crashed too often"
    assert lab.acts("refused")[0].owed == ()
    assert tracker in agent.state.owed


def test_a_late_answer_to_a_release_does_not_count_for_a_component_that_is_held_again(lab: Lab) -> None:
    agent, tracker = lab.agent(), iri("person-tracker")
    assert lab.running(agent)
    life, components, epoch = lab.runtimes["tracker"].life, agent._components, agent.state.epoch
    for since, is_held in ((1, True), (0, False)):
        release = Release(epoch - since, agent.supervisor, agent.identity.task, life)
        components.calls._calling.answered(tracker, release, CallAnswer(Verdict.DONE, tracker, life))
        assert components.lives.has_obeyed(tracker, life) is is_held


def test_a_component_that_goes_on_after_it_was_frozen_for_long_is_released(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    lab.network.pause(lab.node_of("tracker"))
    assert lab.until(lambda: agent.status().owed == (iri("person-tracker"),), 2.0)
    lab.let_pass(2 * GONE)
    assert agent.status().owed == ()
    assert lab.active() == {*TASK, "odometry", "tracker"}
    lab.network.resume(lab.node_of("tracker"))
    assert lab.until(lambda: lab.active() == TASK | {"odometry"}, 0.5)
    assert lab.until(lambda: not agent.state.owed, 0.1)


def test_a_component_that_was_frozen_is_released_whatever_another_life_of_it_has_answered(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    frozen, runtime = lab.node_of("tracker"), lab.runtimes["tracker"]
    lab.network.pause(frozen)
    lab.let_pass(2 * GONE)
    lab.component("tracker")
    assert lab.until(lambda: not agent.state.owed, 0.5)  # the other life owes nothing, and has said so
    lab.crash("tracker")
    assert runtime.active
    lab.network.resume(frozen)
    assert lab.until(lambda: not runtime.active, 0.5)


def test_a_late_answer_of_a_life_that_has_ended_is_not_taken_for_the_life_that_is_held(lab: Lab) -> None:
    """Else the component would be asked to act in the life that has ended, for which the configurator waits no more."""
    agent, tracker = lab.agent(), iri("person-tracker")
    assert lab.running(agent)
    lives = agent._components.lives
    held = lives.life(tracker)
    lives.obeyed(tracker, "an earlier one", 1, late=True)
    assert lives.life(tracker) == held
    lab.crash("tracker")
    assert lab.until(lambda: not lives.lives_on(tracker), 1.0)
    lives.leave_behind_if_ended(tracker)
    lives.obeyed(tracker, "an earlier one", 1, late=True)
    assert lives.life(tracker) is None


def test_a_life_has_obeyed_since_an_epoch_if_it_itself_has_obeyed_a_newer_call(lab: Lab) -> None:
    agent, tracker = lab.agent(), iri("person-tracker")
    lives, life = agent._components.lives, lab.runtimes["tracker"].life
    assert not lives.has_obeyed_since(tracker, life, 0)
    lives.obeyed(tracker, life, 5, late=False)
    lives.obeyed(tracker, life, 3, late=True)  # it was answered late
    assert lives.has_obeyed_since(tracker, life, 4)
    assert not lives.has_obeyed_since(tracker, life, 5)
    lives.obeyed(tracker, "another", 6, late=False)
    assert not lives.has_obeyed_since(tracker, life, 4)
    assert lives.has_obeyed_since(tracker, "another", 5)
