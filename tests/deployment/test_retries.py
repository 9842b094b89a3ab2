"""When lost components are tried again that may be able by now."""

from __future__ import annotations

import itertools

import pytest

from selfconf.configurator.state import Phase
from selfconf.deployment.retries import LONGEST_PAUSE, TRY_AGAIN
from selfconf.sdk.component import Refused
from tests.deployment.simulated import slow_code
from tests.deployment.tasks import TASK
from tests.lab import Lab, iri


def test_patience_goes_on_when_a_component_that_another_configurator_held_is_free(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    second = lab.agent(patient=True)
    lab.let_pass(3 * TRY_AGAIN)
    assert second.state.phase is Phase.REFUSED
    assert {detail for waiting in lab.acts("waiting") for detail in waiting.lost.values()} == {
        f"refused, the task navigate (priority 0, configurator {first.name}) holds it"
    }
    first.stop()
    assert lab.running(second)
    assert lab.active() == TASK | {"tracker"}
    hold = lab.runtimes["drive"].activation.first
    assert hold is not None
    assert hold.claim.supervisor == second.supervisor


def test_patience_goes_on_when_the_configurator_that_held_a_component_is_killed(lab: Lab) -> None:
    first = lab.agent()
    lab.running(first)
    second = lab.agent(patient=True)
    lab.let_pass(2 * TRY_AGAIN)
    lab.crash(first)
    assert lab.running(second)
    assert lab.active() == TASK | {"tracker"}


def test_patience_tries_every_lost_component_that_lives_again_at_intervals_that_double(lab: Lab) -> None:
    drive = lab.components["drive"]
    drive.refusal = Refused("the battery is empty")
    tried: list[float] = []
    started = drive.started

    def note() -> None:
        tried.append(lab.network.time)
        started()

    drive.started = note  # type: ignore[method-assign]  # it notes when
    agent = lab.agent(patient=True)
    lab.let_pass(5 * LONGEST_PAUSE)
    assert agent.state.phase is Phase.REFUSED
    pauses = [round(after - before) for before, after in itertools.pairwise(tried)]
    doubling = [TRY_AGAIN * 2**number for number in range(4)]
    assert pauses == [*doubling, *[LONGEST_PAUSE] * (len(pauses) - len(doubling))]
    assert len(pauses) > len(doubling)
    drive.refusal = None
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, LONGEST_PAUSE + 1.0)


def test_the_pause_of_a_patient_task_is_short_again_after_it_has_run(lab: Lab) -> None:
    agent = lab.agent(patient=True)
    lab.running(agent)
    for _ in range(2):
        lab.crash("drive")
        lab.let_pass(4 * TRY_AGAIN)
        lab.component("drive")
        assert lab.running(agent)
    drive = lab.components["drive"]
    drive.refusal = Refused("the battery is empty")
    drive.fail("the battery is empty")
    lab.let_pass(1.0)
    assert agent.state.phase is Phase.REFUSED
    drive.refusal = None
    lab.let_pass(TRY_AGAIN + 1.0)
    assert agent.state.phase is Phase.RUNNING


def test_a_task_that_changes_for_the_better_returns_to_what_has_failed_once_it_can_go_on(lab: Lab) -> None:
    agent = lab.agent(upgrade=0.5)
    assert lab.running(agent)
    drive, tracker = lab.components["drive"], lab.components["tracker"]
    starts = drive.said.count(("started",))
    tracker.fail("she is out of sight")
    lab.let_pass(TRY_AGAIN - 1.0)
    assert lab.active() == TASK | {"odometry"}
    assert lab.until(lambda: lab.active() == TASK | {"tracker"}, 5.0)
    assert agent.state.phase is Phase.RUNNING
    assert drive.said.count(("started",)) == starts, "what the failed one feeds has run on"


@pytest.mark.parametrize("stranger", [False, True])
def test_what_fails_again_and_again_is_tried_at_intervals_that_double_and_stops_nothing(
    lab: Lab, stranger: bool
) -> None:
    """Also where a stranger comes and goes: what appears says nothing of whether what has failed can go on."""
    agent = lab.agent(upgrade=0.5)
    assert lab.running(agent)
    drive, tracker = lab.components["drive"], lab.components["tracker"]
    tried: list[float] = []

    def started() -> None:
        tried.append(lab.network.time)
        tracker.fail("she is out of sight")

    tracker.started = started  # type: ignore[method-assign]  # it fails whenever it begins
    starts = drive.said.count(("started",))
    tracker.fail("she is out of sight")
    for number in range(15):
        leave = lab.network.node().announce(lab.keys.life(iri("stranger"), str(number))) if stranger else None
        lab.let_pass(LONGEST_PAUSE / 3)
        if leave is not None:
            leave()
    pauses = [after - before for before, after in itertools.pairwise(tried)]
    doubling = [TRY_AGAIN * 2**number for number in range(1, 4)]
    expected = [*doubling, *[LONGEST_PAUSE] * (len(pauses) - len(doubling))]
    assert pauses == pytest.approx([pause + 1.0 for pause in expected], abs=0.6), "once it has been there for a while"
    assert len(pauses) > len(doubling)
    assert lab.active() == TASK | {"odometry"}
    assert drive.said.count(("started",)) == starts


def test_what_has_failed_and_takes_its_time_to_come_to_rest_is_tried_again_once_it_has(lab: Lab) -> None:
    thread = slow_code(lab, "tracker")
    agent = lab.agent(upgrade=0.5)
    assert lab.running(agent)
    tracker = lab.components["tracker"]
    tracker.stopped = lambda: thread.spend(1.5)  # type: ignore[method-assign]  # longer than until the task looks again
    tracker.fail("she is out of sight")
    assert lab.until(lambda: lab.active() == TASK | {"odometry"})
    assert lab.until(lambda: lab.active() == TASK | {"tracker"}, 2 * TRY_AGAIN)


def test_what_fails_after_it_has_recovered_for_long_is_tried_again_as_soon_as_the_first_time(lab: Lab) -> None:
    agent = lab.agent(upgrade=0.5)
    assert lab.running(agent)
    for _ in range(4):
        lab.components["tracker"].fail("she is out of sight")
        assert lab.until(lambda: lab.active() == TASK | {"odometry"})
        assert lab.until(lambda: lab.active() == TASK | {"tracker"}, TRY_AGAIN + 4.0)
        lab.let_pass(1.5 * LONGEST_PAUSE)


def test_a_task_that_keeps_what_runs_tries_nothing_again_that_has_failed(lab: Lab) -> None:
    agent = lab.agent()
    assert lab.running(agent)
    lab.components["tracker"].fail("she is out of sight")
    lab.let_pass(2 * LONGEST_PAUSE)
    assert lab.active() == TASK | {"odometry"}


def test_a_site_that_never_answers_does_not_put_off_another_chance(lab: Lab) -> None:
    lab.network.node().announce(lab.keys.site_life("silent", "1"))
    agent = lab.agent(patient=True)
    assert lab.running(agent)
    lab.components["drive"].fail("jammed")
    assert lab.until(lambda: agent.state.phase is Phase.REFUSED)
    assert lab.until(lambda: agent.state.phase is Phase.RUNNING, 3 * TRY_AGAIN)
