"""Tasks that share a component: what all of them want, and what one wishes that the others do not."""

from __future__ import annotations

import pytest

from selfconf.protocol.activation import (
    Activation,
    ActivationStep,
    drop,
    fail,
    granted,
    held_under,
    in_the_way,
    obey,
    outranked,
    served,
)
from selfconf.protocol.messages import Apply, Release, Reserve, Verdict
from tests.protocol.activations import (
    ACTIVE,
    GOAL,
    IDLE,
    INPUTS,
    OTHER,
    THIRD,
    A,
    B,
    C,
    Call,
    activation_in,
    call_of,
    inputs_of,
    shared_by,
    supervisor,
    waiting_for,
)


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


@pytest.mark.parametrize(("inputs", "sharing"), [(INPUTS, [A, B]), (OTHER, [B])])
def test_a_task_whose_supervisor_is_out_of_sight_shares_on_what_it_wants_as_well(
    inputs: object, sharing: list[str]
) -> None:
    """Else what follows the component for that task would follow one that acts for others alone."""
    gone = frozenset({supervisor(A)})
    both, verdict, step = obey(shared_by(A, B), call_of(Apply, B, 6, inputs=inputs), shareable=True, gone=gone)
    assert (verdict, step) == (Verdict.DONE, ActivationStep.NONE)
    assert [hold.claim.task for hold in both.holds] == sharing
    rested, verdict, step = obey(both, call_of(Release, B, 7), shareable=True, gone=gone)
    assert (verdict, step, rested.phase, rested.holds) == (Verdict.DONE, ActivationStep.STOP, IDLE, ())


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
    """Else two that share it, and for neither of which it acts, would wait for each other forever."""
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
