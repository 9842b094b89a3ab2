"""The activation of a component: its table, the guards before it, and who may call."""

from __future__ import annotations

import itertools
from dataclasses import replace

import pytest

from selfconf.protocol.activation import (
    MOST_ENDED,
    Activation,
    ActivationPhase,
    ActivationStep,
    Hold,
    drop,
    fail,
    held_under,
    obey,
)
from selfconf.protocol.messages import Apply, Release, Reserve, Verdict
from selfconf.protocol.task_queue import TaskQueue
from tests.protocol.activations import (
    ACTIVE,
    FAILED,
    GOAL,
    IDLE,
    INPUTS,
    OTHER,
    A,
    B,
    Call,
    activation_in,
    call_of,
    supervisor,
)

TABLE = [
    (IDLE, False, Reserve, IDLE, Verdict.DONE, ActivationStep.NONE),
    (IDLE, False, Apply, ACTIVE, Verdict.DONE, ActivationStep.START),
    (IDLE, False, Release, IDLE, Verdict.DONE, ActivationStep.NONE),
    (IDLE, True, Reserve, IDLE, Verdict.DONE, ActivationStep.NONE),
    (IDLE, True, Apply, ACTIVE, Verdict.DONE, ActivationStep.START),
    (IDLE, True, Release, IDLE, Verdict.DONE, ActivationStep.NONE),
    (ACTIVE, True, Reserve, ACTIVE, Verdict.DONE, ActivationStep.NONE),
    (ACTIVE, True, Apply, ACTIVE, Verdict.DONE, ActivationStep.NONE),
    (ACTIVE, True, Release, IDLE, Verdict.DONE, ActivationStep.STOP),
    (FAILED, True, Reserve, FAILED, Verdict.DONE, ActivationStep.NONE),
    (FAILED, True, Apply, ACTIVE, Verdict.DONE, ActivationStep.RESTART),
    (FAILED, True, Release, IDLE, Verdict.DONE, ActivationStep.STOP),
]


# The table.


@pytest.mark.parametrize(("phase", "held", "call", "after", "verdict", "step"), TABLE)
def test_every_phase_answers_every_call(
    phase: ActivationPhase,
    held: bool,
    call: type[Call],
    after: ActivationPhase,
    verdict: Verdict,
    step: ActivationStep,
) -> None:
    repeated = (phase, call) == (FAILED, Apply)
    for epoch in (6,) if repeated else (5, 6):
        activation, said, told = obey(activation_in(phase, held), call_of(call, epoch=epoch))
        assert (activation.phase, said, told, activation.epoch_of(A)) == (after, verdict, step, epoch)
        assert [hold.claim.task for hold in activation.holds] == ([] if call is Release else [A])


def test_the_table_is_complete() -> None:
    possible = {(IDLE, False), (IDLE, True), (ACTIVE, True), (FAILED, True)}
    assert {(phase, held, call) for phase, held, call, *_ in TABLE} == {
        (phase, held, call) for (phase, held), call in itertools.product(possible, (Reserve, Apply, Release))
    }


@pytest.mark.parametrize(
    ("phase", "after", "step"),
    [
        (IDLE, IDLE, ActivationStep.NONE),
        (ACTIVE, FAILED, ActivationStep.RAISE_FAIL),
        (FAILED, FAILED, ActivationStep.NONE),
    ],
)
def test_fail_is_raised_once_and_only_by_an_active_component(
    phase: ActivationPhase, after: ActivationPhase, step: ActivationStep
) -> None:
    activation, told = fail(activation_in(phase))
    assert (activation.phase, told) == (after, step)


@pytest.mark.parametrize("phase", ActivationPhase)
def test_an_orphan_turns_itself_off_and_is_free_for_others(phase: ActivationPhase) -> None:
    before = activation_in(phase)
    activation, told = drop(before, held_under(before, supervisor(A)))
    assert (activation.phase, activation.holds, activation.epoch_of(A)) == (IDLE, (), 5)
    assert told is (ActivationStep.NONE if phase is IDLE else ActivationStep.STOP)
    assert obey(activation, call_of(Apply, B, 1))[1] is Verdict.DONE


@pytest.mark.parametrize("phase", ActivationPhase)
def test_a_supervisor_of_no_hold_leaves_no_orphan(phase: ActivationPhase) -> None:
    before = activation_in(phase)
    assert drop(before, held_under(before, supervisor(B))) == (before, ActivationStep.NONE)


def test_a_reserved_component_does_not_act() -> None:
    activation, verdict, step = obey(Activation(), call_of(Reserve))
    assert (verdict, step, activation.phase) == (Verdict.DONE, ActivationStep.NONE, IDLE)
    assert activation.hold(A) == Hold(call_of(Reserve), False)  # type: ignore[arg-type]  # it is one


def test_a_component_that_acts_goes_on_when_it_is_reserved_but_follows_only_what_is_reserved_with_it() -> None:
    both = {"position": (*INPUTS["position"], *OTHER["position"])}
    activation, _, _ = obey(Activation(), call_of(Apply, inputs=both, values=GOAL))
    activation, verdict, step = obey(activation, call_of(Reserve, epoch=6, inputs=OTHER))
    assert (verdict, step) == (Verdict.DONE, ActivationStep.NONE)
    assert activation.hold(A) == Hold(call_of(Apply, epoch=6, inputs=OTHER, values=GOAL), True)  # type: ignore[arg-type]  # it is one
    activation, _, _ = obey(activation, call_of(Reserve, epoch=7, inputs=INPUTS))
    assert activation.holds[0].wants == ({"position": ()}, GOAL)
    activation, _, step = obey(activation, call_of(Apply, epoch=7, inputs=INPUTS))
    assert step is ActivationStep.NONE
    assert activation.holds[0].wants == (INPUTS, {})


def test_a_reserve_that_comes_after_the_apply_of_its_epoch_changes_nothing() -> None:
    activation, _, _ = obey(Activation(), call_of(Apply, inputs=INPUTS, values=GOAL))
    assert obey(activation, call_of(Reserve, inputs=OTHER))[0].holds[0].wants == (INPUTS, GOAL)


# Epochs.


@pytest.mark.parametrize("phase", ActivationPhase)
@pytest.mark.parametrize("call", [Reserve, Apply, Release])
def test_a_call_of_an_older_epoch_changes_nothing(phase: ActivationPhase, call: type[Call]) -> None:
    before = activation_in(phase)
    for run in (1, 2):
        assert obey(before, call_of(call, epoch=4, run=run)) == (before, Verdict.STALE, ActivationStep.NONE)


@pytest.mark.parametrize("call", [Reserve, Apply])
def test_epochs_order_the_calls_of_one_task_not_of_two_for_their_clocks_may_differ(call: type[Call]) -> None:
    free, _, _ = obey(activation_in(ACTIVE, epoch=5000), call_of(Release, epoch=5001))
    assert obey(free, call_of(call, B, 1))[1] is Verdict.DONE
    assert obey(free, call_of(call, A, 5000))[1] is Verdict.STALE
    assert obey(activation_in(ACTIVE, epoch=5000), call_of(call, B, 1))[1] is Verdict.BUSY


@pytest.mark.parametrize("late", [Reserve, Apply])
def test_an_old_call_that_comes_after_its_release_does_not_take_hold_of_the_component(late: type[Call]) -> None:
    activation = Activation()
    for call in (call_of(late, epoch=1), call_of(Release, epoch=2)):
        activation, verdict, _ = obey(activation, call)
        assert verdict is Verdict.DONE
    assert obey(activation, call_of(late, epoch=1))[1] is Verdict.STALE


def test_a_release_is_remembered_although_the_call_before_it_has_not_come_yet() -> None:
    activation, _, _ = obey(Activation(), call_of(Release, epoch=6))
    assert obey(activation, call_of(Apply, epoch=5))[1] is Verdict.STALE


def test_the_epoch_of_a_task_whose_supervisor_was_gone_is_remembered_when_another_takes_its_place() -> None:
    gone = frozenset({supervisor(A)})
    activation, verdict, _ = obey(activation_in(ACTIVE), call_of(Apply, B, 1), gone=gone)
    assert verdict is Verdict.DONE
    activation, _, _ = obey(activation, call_of(Release, B, 2))
    assert obey(activation, call_of(Apply, A, 4))[1] is Verdict.STALE


def test_only_so_many_tasks_that_have_ended_are_remembered() -> None:
    activation = Activation()
    for number in range(MOST_ENDED + 10):
        activation, _, _ = obey(activation, call_of(Release, f"{number}~1"))
    assert len(activation.ended) == MOST_ENDED
    assert activation.epoch_of(f"{MOST_ENDED + 9}~1") == 5


# Failure.


def test_an_apply_that_is_repeated_does_not_hide_a_failure() -> None:
    failed = activation_in(FAILED)
    assert obey(failed, call_of(Apply)) == (failed, Verdict.REFUSED, ActivationStep.NONE)


def test_a_reserve_that_is_repeated_does_not_hide_a_failure() -> None:
    failed, verdict, _ = obey(activation_in(FAILED), call_of(Reserve))
    assert verdict is Verdict.DONE
    assert obey(failed, call_of(Apply))[1] is Verdict.REFUSED


def test_a_component_that_has_failed_can_be_reserved_and_started_again_with_a_newer_epoch() -> None:
    failed, _, _ = obey(activation_in(FAILED), call_of(Reserve, epoch=6))
    again, verdict, step = obey(failed, call_of(Apply, epoch=6))
    assert (verdict, step, again.phase) == (Verdict.DONE, ActivationStep.RESTART, ACTIVE)


# Who may call.


@pytest.mark.parametrize("phase", ActivationPhase)
@pytest.mark.parametrize("call", [Reserve, Apply])
def test_a_component_is_held_by_one_task(phase: ActivationPhase, call: type[Call]) -> None:
    before = activation_in(phase)
    after, verdict, step = obey(before, call_of(call, B, 9))
    assert (verdict, step) == (Verdict.BUSY, ActivationStep.NONE)
    assert after == replace(before, queue=TaskQueue((call_of(call, B, 9),)))


@pytest.mark.parametrize("phase", ActivationPhase)
@pytest.mark.parametrize("call", [Reserve, Apply, Release])
def test_of_two_configurators_of_one_task_the_second_is_busy_unless_the_first_is_gone(
    phase: ActivationPhase, call: type[Call]
) -> None:
    before, second = activation_in(phase), call_of(call, epoch=9, run=2)
    assert obey(before, second) == (before, Verdict.BUSY, ActivationStep.NONE)
    after, verdict, step = obey(before, second, gone=frozenset({supervisor(A)}))
    assert verdict is Verdict.DONE
    assert step is not ActivationStep.START or phase is IDLE
    assert [hold.claim.supervisor for hold in after.holds] == ([] if call is Release else [supervisor(A, 2)])


def test_another_configurator_of_the_same_task_goes_on_with_it_without_a_stop() -> None:
    after, verdict, step = obey(activation_in(ACTIVE), call_of(Apply, epoch=9, run=2), gone=frozenset({supervisor(A)}))
    assert (verdict, step, after.phase) == (Verdict.DONE, ActivationStep.NONE, ACTIVE)
    assert drop(after, held_under(after, supervisor(A))) == (after, ActivationStep.NONE)


def test_a_release_of_a_task_that_does_not_hold_the_component_changes_nothing_for_the_one_that_does() -> None:
    after, verdict, step = obey(activation_in(ACTIVE), call_of(Release, B, 9))
    assert (verdict, step, after.phase) == (Verdict.DONE, ActivationStep.NONE, ACTIVE)
    assert after.holds == activation_in(ACTIVE).holds


@pytest.mark.parametrize("phase", ActivationPhase)
def test_of_two_configurators_of_one_task_the_second_goes_on_with_what_acts_if_the_first_was_not_seen_yet(
    phase: ActivationPhase,
) -> None:
    before = activation_in(phase)
    _, verdict, _ = obey(before, call_of(Apply, epoch=9, run=2), unseen=frozenset({supervisor(A)}))
    assert verdict is (Verdict.BUSY if phase is IDLE else Verdict.DONE)
    after, verdict, _ = obey(before, call_of(Reserve, B), unseen=frozenset({supervisor(A)}))
    assert (verdict, after.holds) == (Verdict.BUSY, before.holds), "to other tasks it may be there"


def test_a_supervisor_that_is_gone_stands_in_no_other_tasks_way() -> None:
    gone = frozenset({supervisor(A)})
    reserved, verdict, step = obey(activation_in(ACTIVE), call_of(Reserve, B), gone=gone)
    assert (verdict, step, reserved.phase) == (Verdict.DONE, ActivationStep.NONE, ACTIVE)
    applied, verdict, _ = obey(reserved, call_of(Apply, B), gone=gone)
    assert verdict is Verdict.DONE
    assert [hold.claim.task for hold in applied.holds] == [B]
    rested, step = drop(reserved, held_under(reserved, supervisor(A)))
    assert (step, rested.phase, [hold.claim.task for hold in rested.holds]) == (ActivationStep.STOP, IDLE, [B])


def test_an_actuator_is_applied_to_only_by_a_task_that_holds_it() -> None:
    assert obey(Activation(), call_of(Apply), reserved_first=True) == (
        Activation(),
        Verdict.NOT_HELD,
        ActivationStep.NONE,
    )
    reserved, _, _ = obey(Activation(), call_of(Reserve), reserved_first=True)
    assert obey(reserved, call_of(Apply), reserved_first=True)[1:] == (Verdict.DONE, ActivationStep.START)
    let_go, _ = drop(reserved, [A])
    assert obey(let_go, call_of(Apply), reserved_first=True)[1:] == (Verdict.NOT_HELD, ActivationStep.NONE)
