"""The activation of a component: its table, the guards before it, and the order in which tasks are served."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.model.term import IRI, Literal, Term
from selfconf.protocol.activation import (
    MOST_ENDED,
    MOST_WAITING,
    Activation,
    ActivationPhase,
    ActivationStep,
    Hold,
    drop,
    fail,
    granted,
    held_under,
    in_the_way,
    obey,
    offer,
    outranked,
    served,
    withdraw,
)
from selfconf.protocol.messages import Apply, Release, Reserve, Verdict, Wire

Call = Reserve | Apply | Release
IDLE, ACTIVE, FAILED = ActivationPhase
A, B, C = "a~1", "b~1", "c~1"
"""Three tasks."""
INPUTS = {"position": (Wire(IRI("urn:c:tracker"), "pose"),)}
OTHER = {"position": (Wire(IRI("urn:c:odometry"), "pose"),)}
THIRD = {"position": (Wire(IRI("urn:c:compass"), "pose"),)}
GOAL: Mapping[str, Term] = {"goal": Literal("x")}

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


def supervisor(task: str, run: int = 1) -> str:
    """The liveliness key of a configurator of a task."""
    return f"selfconf/e/conf/{task[0]}/live/{run}"


def call_of(kind: type[Call], task: str = A, epoch: int = 5, run: int = 1, **more: object) -> Call:
    """A call of a task, by the configurator that supervises it."""
    return kind(epoch, supervisor(task, run), task, **more)  # type: ignore[arg-type]  # each test gives what fits


def activation_in(phase: ActivationPhase, held: bool = True, epoch: int = 5) -> Activation:
    """An activation in a phase, as it can come about, held by the task A or by none."""
    activation = Activation()
    if held:
        activation, _, _ = obey(activation, call_of(Reserve, epoch=epoch))
    if phase is not IDLE:
        activation, _, _ = obey(activation, call_of(Apply, epoch=epoch))
    if phase is FAILED:
        activation, _ = fail(activation)
    assert activation.phase is phase
    return activation


def waiting_for(activation: Activation) -> list[str]:
    """The tasks that wait, in order."""
    return [claim.task for claim in activation.waiting]


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
    assert after == replace(before, waiting=(call_of(call, B, 9),))


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
    assert obey(Activation(), call_of(Apply), actuator=True) == (
        Activation(),
        Verdict.NOT_HELD,
        ActivationStep.NONE,
    )
    reserved, _, _ = obey(Activation(), call_of(Reserve), actuator=True)
    assert obey(reserved, call_of(Apply), actuator=True)[1:] == (Verdict.DONE, ActivationStep.START)
    let_go, _ = drop(reserved, [A])
    assert obey(let_go, call_of(Apply), actuator=True)[1:] == (Verdict.NOT_HELD, ActivationStep.NONE)


# Sharing.


def test_tasks_that_want_the_same_share_a_component_that_can_be_shared() -> None:
    one, _, _ = obey(Activation(), call_of(Apply, A, inputs=INPUTS, values=GOAL), shareable=True)
    both, verdict, step = obey(one, call_of(Apply, B, inputs=INPUTS, values=GOAL), shareable=True)
    assert (verdict, step) == (Verdict.DONE, ActivationStep.NONE)
    other, verdict, step = obey(both, call_of(Release, A, 6), shareable=True)
    assert (verdict, step, other.phase) == (Verdict.DONE, ActivationStep.NONE, ACTIVE)
    last, _, step = obey(other, call_of(Release, B, 6), shareable=True)
    assert (step, last.phase) == (ActivationStep.STOP, IDLE)


@pytest.mark.parametrize("wants", [{"inputs": OTHER, "values": GOAL}, {"inputs": INPUTS}, {}])
@pytest.mark.parametrize("call", [Reserve, Apply])
def test_tasks_that_want_something_else_share_no_component(wants: dict[str, object], call: type[Call]) -> None:
    held, _, _ = obey(Activation(), call_of(Reserve, A, inputs=INPUTS, values=GOAL), shareable=True)
    assert obey(held, call_of(call, B, **wants), shareable=True)[1] is Verdict.BUSY


def test_a_shared_component_acts_while_one_of_its_tasks_has_applied() -> None:
    both, _, _ = obey(activation_in(ACTIVE), call_of(Reserve, B), shareable=True)
    left, _, step = obey(both, call_of(Release, A, 6), shareable=True)
    assert (step, left.phase) == (ActivationStep.STOP, IDLE)  # B has only reserved it
    assert obey(left, call_of(Apply, B), shareable=True)[1:] == (Verdict.DONE, ActivationStep.START)


def test_of_the_tasks_that_share_a_component_the_first_in_rank_is_named() -> None:
    activation = Activation()
    for task, priority, beginning in ((A, 0, 2.0), (B, 0, 1.0), (C, 1, 9.0)):
        call = call_of(Reserve, task, priority=priority, beginning=beginning)
        activation, _, _ = obey(activation, call, shareable=True)
    order = []
    while activation.first is not None:
        order.append(activation.first.claim.task)
        activation, _ = drop(activation, [order[-1]])
    assert order == [C, B, A]


# Waiting, and being offered.


def test_higher_priority_waits_before_lower_and_of_equals_the_one_that_began_first() -> None:
    activation = activation_in(ACTIVE)
    for task, priority, beginning in ((B, 0, 2.0), (C, 0, 1.0), ("d~1", 3, 9.0), ("e~1", -1, 0.0)):
        activation, _, _ = obey(activation, call_of(Reserve, task, priority=priority, beginning=beginning))
    assert waiting_for(activation) == ["d~1", C, B, "e~1"]


def test_a_task_that_asks_again_waits_once() -> None:
    activation = activation_in(ACTIVE)
    for epoch in (5, 6, 7):
        activation, _, _ = obey(activation, call_of(Reserve, B, epoch))
    assert activation.waiting == (call_of(Reserve, B, 7),)


def test_only_so_many_tasks_wait_and_the_last_in_rank_by_asking_again() -> None:
    activation = activation_in(ACTIVE)
    for number in range(MOST_WAITING + 10):
        activation, verdict, _ = obey(activation, call_of(Reserve, f"{number:03}~1", beginning=float(-number)))
        assert verdict is Verdict.BUSY
    assert len(activation.waiting) == MOST_WAITING
    assert activation.waiting[0].task == f"{MOST_WAITING + 9:03}~1"


def test_a_task_that_only_waits_never_gets_hold_of_the_component() -> None:
    for before in (Activation(), activation_in(ACTIVE)):
        after, verdict, step = obey(before, call_of(Reserve, B, waits=True))
        assert (verdict, step, after.hold(B)) == (Verdict.BUSY, ActivationStep.NONE, None)
        assert waiting_for(after) == [B]


def test_a_task_that_is_served_or_released_waits_no_more() -> None:
    waiting, _, _ = obey(Activation(), call_of(Reserve, B, waits=True))
    for call in (Reserve, Apply, Release):
        after, verdict, _ = obey(waiting, call_of(call, B))
        assert (verdict, waiting_for(after)) == (Verdict.DONE, [])


def offered(*tasks: str, priorities: Mapping[str, int] | None = None) -> Activation:
    """A component that the task A has let go of, for which others wait in this order, offered to the first."""
    activation = activation_in(ACTIVE)
    for beginning, task in enumerate(tasks):
        priority = (priorities or {}).get(task, 0)
        call = call_of(Reserve, task, beginning=float(beginning), priority=priority)
        activation, _, _ = obey(activation, call)
    activation, _, _ = obey(activation, call_of(Release, epoch=6))
    activation, claim = offer(activation)
    assert claim is not None
    assert activation.kept_for == claim.task
    return activation


def test_a_component_that_is_held_is_offered_to_none() -> None:
    held, _, _ = obey(activation_in(ACTIVE), call_of(Reserve, B))
    assert offer(held) == (held, None)
    assert offer(Activation()) == (Activation(), None)


def test_a_component_that_is_kept_for_a_task_is_busy_for_those_that_come_later() -> None:
    activation = offered(B, C)
    assert activation.kept_for == B
    for call in (Reserve, Apply):
        kept, verdict, _ = obey(activation, call_of(call, C, beginning=1.0))
        assert (verdict, kept.kept_for) == (Verdict.BUSY, B)
        taken, verdict, _ = obey(kept, call_of(call, B, beginning=0.0))
        assert (verdict, taken.kept_for, waiting_for(taken)) == (Verdict.DONE, "", [C])


def test_a_component_that_is_kept_for_a_task_may_be_had_by_one_that_goes_before_it() -> None:
    taken, verdict, _ = obey(offered(B), call_of(Reserve, C, priority=1))
    assert (verdict, taken.holds[0].claim.task, waiting_for(taken)) == (Verdict.DONE, C, [B])


def test_an_offer_comes_once_for_each_holding() -> None:
    activation = offered(B, C)
    assert offer(activation) == (activation, None)  # one at a time
    activation, claim = offer(withdraw(activation, B))
    assert claim is not None
    assert claim.task == C
    activation = withdraw(activation, C)
    assert offer(activation) == (activation, None)
    assert waiting_for(activation) == [B, C]
    activation, verdict, _ = obey(activation, call_of(Reserve, A, 7))  # kept for none any more
    assert verdict is Verdict.DONE
    activation, _, _ = obey(activation, call_of(Release, A, 8))
    activation, claim = offer(activation)
    assert claim is not None
    assert claim.task == B


def test_an_offer_to_another_task_is_not_withdrawn() -> None:
    activation = offered(B, C)
    assert withdraw(activation, C) == activation


# Yielding.


def test_a_task_of_higher_priority_outranks_all_that_hold_a_component_or_none() -> None:
    for priority, expected in ((0, ()), (-1, ()), (1, (A,))):
        activation, _, _ = obey(activation_in(ACTIVE), call_of(Reserve, B, priority=priority))
        assert outranked(activation) == expected
    assert outranked(activation_in(ACTIVE)) == ()
    shared, _, _ = obey(activation_in(ACTIVE), call_of(Reserve, B, priority=1), shareable=True)
    shared, verdict, _ = obey(shared, call_of(Reserve, C, priority=1, inputs=OTHER), shareable=True)
    assert (verdict, outranked(shared)) == (Verdict.BUSY, ())


def test_a_task_outranks_those_that_share_a_component_with_it_and_want_what_it_wants_no_more() -> None:
    """What feeds the component was lost, and each of them wants something else to feed it."""
    for priority, expected in ((0, ()), (1, (A,))):
        shared, _, _ = obey(activation_in(ACTIVE), call_of(Apply, B, priority=priority), shareable=True)
        call = call_of(Apply, B, 6, priority=priority, inputs=OTHER)
        shared, verdict, _ = obey(shared, call, shareable=True)
        assert (verdict, outranked(shared)) == (Verdict.BUSY, ()), "the others may want the same in a moment"
        shared, verdict, _ = obey(shared, call, shareable=True)
        assert (verdict, outranked(shared)) == (Verdict.BUSY, expected)
        hold = in_the_way(shared, call)
        assert hold is not None
        assert hold.claim.task == A, "no task is in its own way"


def test_no_task_yields_to_one_that_follows_nothing_for_now() -> None:
    """What fed the component that they share was lost, and they may all want the same in its place."""
    shared, _, _ = obey(activation_in(ACTIVE), call_of(Apply, B, priority=1), shareable=True)
    call = call_of(Apply, B, 6, priority=1, inputs={"position": ()})
    after, verdict, _ = obey(shared, call, shareable=True)
    assert (verdict, outranked(after), waiting_for(after)) == (Verdict.BUSY, (), [])


def shared_by(*tasks: str, inputs: object = INPUTS) -> Activation:
    """A component that acts for several tasks, which want the same of it."""
    activation = Activation()
    for task in tasks:
        activation, verdict, _ = obey(activation, call_of(Apply, task, inputs=inputs), shareable=True)
        assert verdict is Verdict.DONE
    return activation


def inputs_of(activation: Activation) -> dict[str, object]:
    """What each task has a component follow."""
    return {hold.claim.task: hold.wants[0] for hold in activation.holds}


def test_a_component_that_is_shared_follows_something_else_once_all_ask_for_that() -> None:
    shared = shared_by(A, B, C)
    for task in (A, B):
        after, verdict, _ = obey(shared, call_of(Apply, task, 6, inputs=OTHER), shareable=True)
        assert (verdict, served(shared, after)) == (Verdict.BUSY, ())
        assert inputs_of(after) == inputs_of(shared), "it acts as all have wanted"
        shared = after
    after, verdict, step = obey(shared, call_of(Apply, C, 6, inputs=OTHER), shareable=True)
    assert (verdict, step) == (Verdict.DONE, ActivationStep.NONE)
    assert inputs_of(after) == dict.fromkeys((A, B, C), OTHER)
    assert served(shared, after) == (A, B), "these are told, and ask once more"
    for task in (A, B):
        after, verdict, step = obey(after, call_of(Apply, task, 6, inputs=OTHER), shareable=True)
        assert (verdict, step) == (Verdict.DONE, ActivationStep.NONE)


def test_a_component_that_is_shared_is_cut_off_once_all_ask_for_that() -> None:
    nothing = {"position": ()}
    shared, _, _ = obey(shared_by(A, B), call_of(Apply, A, 6, inputs=nothing), shareable=True)
    after, verdict, _ = obey(shared, call_of(Apply, B, 6, inputs=nothing), shareable=True)
    assert (verdict, inputs_of(after)) == (Verdict.DONE, dict.fromkeys((A, B), nothing))


@pytest.mark.parametrize("first", ["rests", "acts"])
def test_a_task_that_has_a_shared_actuator_rest_leaves_what_it_follows_to_the_others(first: str) -> None:
    nothing = {"position": ()}
    rest = call_of(Apply, B, 6, inputs=nothing, rests=True)
    shared = shared_by(A, B)
    if first == "acts":
        shared, verdict, _ = obey(shared, rest, shareable=True)
        assert (verdict, shared.rests) == (Verdict.BUSY, False)
    else:
        for task in (A, B):
            shared, _, _ = obey(shared, call_of(Apply, task, 6, inputs=nothing, rests=True), shareable=True)
        assert shared.rests
    shared, verdict, _ = obey(shared, call_of(Apply, A, 7, inputs=OTHER), shareable=True)
    assert (verdict, inputs_of(shared), shared.rests) == (Verdict.DONE, dict.fromkeys((A, B), OTHER), False)
    resting, verdict, _ = obey(shared, call_of(Apply, A, 8, inputs=nothing, rests=True), shareable=True)
    assert (verdict, resting.rests, inputs_of(resting)) == (Verdict.DONE, True, dict.fromkeys((A, B), nothing))
    left, _, _ = obey(shared, call_of(Release, A, 8), shareable=True)
    assert (left.rests, granted(left)) == (True, rest)
    whole, verdict, _ = obey(shared, call_of(Apply, B, 7, inputs=OTHER), shareable=True)
    assert (verdict, granted(whole)) == (Verdict.DONE, None)


@pytest.mark.parametrize("kind", [Apply, Reserve])
def test_a_task_may_ask_again_for_what_it_has_though_another_wishes_something_else(kind: type[Call]) -> None:
    nothing = {"position": ()}
    shared, _, _ = obey(shared_by(A, B), call_of(Apply, B, 6, inputs=nothing), shareable=True)
    shared, verdict, step = obey(shared, call_of(kind, A, 6, priority=1, inputs=INPUTS), shareable=True)
    assert (verdict, step, outranked(shared)) == (Verdict.DONE, ActivationStep.NONE, ())
    assert inputs_of(shared) == dict.fromkeys((A, B), INPUTS), "it acts as before"
    shared, verdict, _ = obey(shared, call_of(Apply, A, 7, inputs=nothing), shareable=True)
    assert (verdict, inputs_of(shared)) == (Verdict.DONE, dict.fromkeys((A, B), nothing))


def test_a_task_wants_again_what_it_has_once_another_wishes_something_else_than_it_does() -> None:
    shared = shared_by(A, B)
    for task, inputs in ((A, OTHER), (B, THIRD)):
        shared, verdict, _ = obey(shared, call_of(Apply, task, 6, inputs=inputs), shareable=True)
        assert verdict is Verdict.BUSY
    shared, verdict, _ = obey(shared, call_of(Apply, A, 7, inputs=INPUTS), shareable=True)
    assert (verdict, inputs_of(shared)) == (Verdict.DONE, dict.fromkeys((A, B), INPUTS))


def test_what_a_task_wishes_is_granted_once_nobody_disagrees_any_more() -> None:
    wish = call_of(Apply, A, 6, inputs=OTHER)
    shared, _, _ = obey(shared_by(A, B, C), wish, shareable=True)
    assert granted(shared) is None
    shared, _, _ = obey(shared, call_of(Release, B, 6), shareable=True)
    assert granted(shared) is None
    shared, _, _ = obey(shared, call_of(Release, C, 6), shareable=True)
    assert granted(shared) == wish
    assert granted(fail(shared)[0]) is None, "it would hide the failure"
    after, verdict, _ = obey(shared, wish, shareable=True)
    assert (verdict, granted(after)) == (Verdict.DONE, None)


def test_another_configurator_of_a_task_goes_on_with_it_also_where_it_wishes_something_else() -> None:
    call = call_of(Apply, A, 6, run=2, inputs=OTHER)
    gone = frozenset((supervisor(A),))
    shared, verdict, _ = obey(shared_by(A, B), call, shareable=True, gone=gone)
    assert (verdict, inputs_of(shared)) == (Verdict.BUSY, dict.fromkeys((A, B), INPUTS))
    assert drop(shared, held_under(shared, supervisor(A)))[0] == shared, "its configurator lives"


@pytest.mark.parametrize("ends", ["release", "orphan"])
def test_a_task_is_told_when_nobody_disagrees_any_more_with_what_it_wishes(ends: str) -> None:
    shared, _, _ = obey(shared_by(A, B), call_of(Apply, A, 6, inputs=OTHER), shareable=True)
    if ends == "release":
        after, _, _ = obey(shared, call_of(Release, B, 6), shareable=True)
    else:
        after, _ = drop(shared, held_under(shared, supervisor(B)))
    assert (served(shared, after), inputs_of(after)) == ((A,), {A: INPUTS})
    after, verdict, _ = obey(after, call_of(Apply, A, 6, inputs=OTHER), shareable=True)
    assert (verdict, inputs_of(after)) == (Verdict.DONE, {A: OTHER})


def test_a_task_that_wants_again_what_it_has_wishes_nothing_any_more() -> None:
    shared, _, _ = obey(shared_by(A, B), call_of(Apply, A, 6, inputs=OTHER), shareable=True)
    shared, verdict, _ = obey(shared, call_of(Apply, A, 7, inputs=INPUTS), shareable=True)
    assert verdict is Verdict.DONE
    after, verdict, _ = obey(shared, call_of(Apply, B, 6, inputs=OTHER), shareable=True)
    assert (verdict, inputs_of(after)) == (Verdict.BUSY, dict.fromkeys((A, B), INPUTS))


def test_a_task_that_only_reserves_a_component_gives_that_up_for_another_wish() -> None:
    """Else two that share it, and for neither of which it acts, would wait for each other for ever."""
    reserved = Activation()
    for task in (A, B):
        reserved, _, _ = obey(reserved, call_of(Reserve, task, inputs=INPUTS), shareable=True)
    after, verdict, _ = obey(reserved, call_of(Reserve, A, 6, inputs=OTHER), shareable=True)
    assert (verdict, waiting_for(after)) == (Verdict.BUSY, [A])
    assert after.hold(A) is None
    after, verdict, _ = obey(after, call_of(Reserve, B, 6, inputs=THIRD), shareable=True)
    assert verdict is Verdict.DONE
    assert obey(after, call_of(Reserve, A, 4, inputs=INPUTS), shareable=True)[1] is Verdict.STALE


def test_a_task_that_reserves_what_acts_for_it_wishes_what_it_will_apply() -> None:
    shared, _, _ = obey(shared_by(A, B), call_of(Apply, A, 6, inputs=OTHER), shareable=True)
    shared, verdict, _ = obey(shared, call_of(Reserve, B, 6, inputs=OTHER), shareable=True)
    assert (verdict, inputs_of(shared)) == (Verdict.DONE, dict.fromkeys((A, B), INPUTS))
    after, verdict, _ = obey(shared, call_of(Apply, A, 6, inputs=OTHER), shareable=True)
    assert (verdict, inputs_of(after)) == (Verdict.DONE, dict.fromkeys((A, B), OTHER))


def test_another_configurator_of_a_task_is_in_the_way_of_it_and_one_that_is_gone_is_not() -> None:
    activation, call = activation_in(ACTIVE), call_of(Apply, run=2)
    hold = in_the_way(activation, call)
    assert hold is not None
    assert hold.claim.supervisor == supervisor(A)
    assert in_the_way(activation, call, gone=frozenset({supervisor(A)})) is None


def test_nobody_is_asked_to_yield_for_a_task_that_did_not_come_until_it_asks_again() -> None:
    """Its configurator may be gone: else every task of lower priority would yield to it for ever."""
    activation = withdraw(offered(B, priorities={B: 9}), B)
    activation, _, _ = obey(activation, call_of(Apply, C))
    assert (outranked(activation), waiting_for(activation)) == ((), [B])
    asked, verdict, _ = obey(activation, call_of(Reserve, B, priority=9))
    assert (verdict, outranked(asked)) == (Verdict.BUSY, (C,))
    again, _, _ = obey(activation, call_of(Release, C, 6))
    _, claim = offer(again)
    assert claim is not None  # it waits on


def test_a_component_is_kept_for_no_task_once_another_that_ranks_before_it_has_it() -> None:
    offered, _, _ = obey(activation_in(IDLE), call_of(Reserve, B))
    offered, _, _ = obey(offered, call_of(Release, A))
    offered, claim = offer(offered)
    assert claim is not None
    held, verdict, _ = obey(offered, call_of(Reserve, C, priority=1))
    assert (verdict, held.kept_for) == (Verdict.DONE, "")
    assert withdraw(held, B).lapsed == frozenset(), "it has not been slow to come"


# Histories.

GONE = {supervisor(task, run): False for task in (A, B, C) for run in (1, 2)}
calls = st.builds(
    lambda kind, task, epoch, run, priority, wants, idles: call_of(
        kind,
        task,
        epoch,
        run,
        priority=priority,
        beginning=float(ord(task[0])),
        **({} if kind is Release else {"inputs": {"position": ()} if kind is Apply and idles else wants}),
        **({} if kind is Release else {"waits" if kind is Reserve else "rests": idles}),
    ),
    st.sampled_from([Reserve, Apply, Release]),
    st.sampled_from([A, B, C]),
    st.integers(0, 4),
    st.sampled_from([1, 1, 2]),
    st.integers(0, 1),
    st.sampled_from([INPUTS, INPUTS, OTHER]),
    st.sampled_from([False, False, True]),
)
mishaps = st.sampled_from(["fail", "offer", "withdraw", "preempt", *GONE])


@given(st.lists(calls | mishaps, max_size=40), st.booleans(), st.booleans(), st.sets(st.sampled_from(sorted(GONE))))
def test_the_invariants_hold_in_every_history(
    history: list[Call | str], shareable: bool, actuator: bool, gone: set[str]
) -> None:
    activation, running = Activation(), False
    for event in history:
        before = activation
        if isinstance(event, str):
            activation, told = _mishap(activation, event)
        else:
            kind = {"shareable": shareable, "actuator": actuator}
            activation, verdict, told = obey(activation, event, **kind, gone=frozenset(gone))
            _check_call(before, event, activation, verdict, gone, shareable, actuator)
        wish = granted(activation)
        assert wish is None or obey(activation, wish, shareable=shareable, gone=frozenset(gone))[1] is Verdict.DONE
        for task in (A, B, C):
            assert activation.epoch_of(task) >= before.epoch_of(task)
        running = _check_step(running, told)
        _check(activation, running, shareable, gone)


def _mishap(activation: Activation, event: str) -> tuple[Activation, ActivationStep]:
    """What happens to a component without a call."""
    if event == "fail":
        return fail(activation)
    if event == "offer":
        return offer(activation)[0], ActivationStep.NONE
    if event == "withdraw":
        return withdraw(activation, activation.kept_for), ActivationStep.NONE
    if event == "preempt":
        return drop(activation, outranked(activation))
    return drop(activation, held_under(activation, event))


def _check_call(
    before: Activation,
    call: Call,
    after: Activation,
    verdict: Verdict,
    gone: set[str],
    shareable: bool,
    actuator: bool,
) -> None:
    """What a call may change."""
    own = before.hold(call.task)
    if verdict in (Verdict.STALE, Verdict.NOT_HELD, Verdict.REFUSED):
        assert after == before
    assert (verdict is Verdict.STALE) == (call.epoch < before.epoch_of(call.task))
    assert verdict is not Verdict.NOT_HELD or (actuator and isinstance(call, Apply))
    assert verdict is not Verdict.REFUSED or (isinstance(call, Apply) and before.phase is FAILED)
    if verdict is Verdict.BUSY:
        assert after.phase is before.phase
        kept = [hold for hold in before.holds if hold is not own]
        assert [hold for hold in after.holds if hold.claim.task != call.task] == kept
        mine = after.hold(call.task)
        same = (mine and (mine.claim.epoch, mine.wants, mine.active)) == (
            own and (own.claim.epoch, own.wants, own.active)
        )
        assert same or (own and not own.active)
    if verdict is Verdict.DONE:
        assert own is None or own.claim.supervisor in (call.supervisor, *gone)
        assert after.epoch_of(call.task) == call.epoch
        assert call.task not in waiting_for(after)
        assert (after.hold(call.task) is None) == isinstance(call, Release)
        if isinstance(call, Apply):
            assert own is not None or not actuator
            assert after.phase is ACTIVE
            assert after.hold(call.task) == Hold(call, True)
            assert before.phase is not FAILED or own is None or not own.active or call.epoch > own.claim.epoch
        if isinstance(call, Reserve):
            assert not call.waits
            assert after.phase is before.phase
        if not isinstance(call, Release) and not shareable:
            others = [hold for hold in before.holds if hold.claim.task != call.task]
            assert all(hold.claim.supervisor in gone for hold in others)


def _check_step(running: bool, told: ActivationStep) -> bool:
    """Whether the code runs after a step; it is started only when it rests, and stopped only when it runs."""
    if told in (ActivationStep.START, ActivationStep.RESTART):
        assert running == (told is ActivationStep.RESTART)
        return True
    if told is ActivationStep.STOP:
        assert running
        return False
    assert running or told is not ActivationStep.RAISE_FAIL
    return running


def _check(activation: Activation, running: bool, shareable: bool, gone: set[str]) -> None:
    """What holds of every activation."""
    assert running == (activation.phase is not IDLE)
    assert (activation.phase is ACTIVE) <= any(hold.active for hold in activation.holds)
    assert running <= bool(activation.holds)
    tasks = [hold.claim.task for hold in activation.holds]
    assert len(tasks) == len(set(tasks))
    alive = [hold for hold in activation.holds if hold.claim.supervisor not in gone]
    assert shareable or len(alive) <= 1
    acts_for = [hold for hold in alive if hold.active]
    assert all(hold.wants == acts_for[0].wants for hold in acts_for), "nobody obeys two that disagree"
    ranks = [(-claim.priority, claim.beginning) for claim in activation.waiting]
    assert ranks == sorted(ranks)
    assert len(set(waiting_for(activation))) == len(ranks)
    assert {activation.kept_for} - {""} <= activation.passed <= set(waiting_for(activation))
    assert activation.lapsed <= set(waiting_for(activation))
    top = max((claim.priority for claim in activation.waiting), default=-1)
    outranking = [hold.claim.priority for hold in activation.holds if hold.claim.task in outranked(activation)]
    assert all(top > priority for priority in outranking)
