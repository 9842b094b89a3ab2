"""The tasks that wait for a component: in which order, what each is offered, and which yields to which."""

from __future__ import annotations

from collections.abc import Mapping

import pytest

from selfconf.protocol.activation import (
    Activation,
    ActivationStep,
    in_the_way,
    obey,
    offer,
    outranked,
    withdraw,
)
from selfconf.protocol.messages import Apply, Release, Reserve, Verdict
from selfconf.protocol.task_queue import MOST_WAITING, TaskQueue
from tests.protocol.activations import (
    ACTIVE,
    IDLE,
    OTHER,
    A,
    B,
    C,
    activation_in,
    call_of,
    waiting_for,
)


def test_higher_priority_waits_before_lower_and_of_equals_the_one_that_began_first() -> None:
    activation = activation_in(ACTIVE)
    for task, priority, beginning in ((B, 0, 2.0), (C, 0, 1.0), ("d~1", 3, 9.0), ("e~1", -1, 0.0)):
        activation, _, _ = obey(activation, call_of(Reserve, task, priority=priority, beginning=beginning))
    assert waiting_for(activation) == ["d~1", C, B, "e~1"]


def test_a_task_that_asks_again_waits_once() -> None:
    activation = activation_in(ACTIVE)
    for epoch in (5, 6, 7):
        activation, _, _ = obey(activation, call_of(Reserve, B, epoch))
    assert activation.queue.claims == (call_of(Reserve, B, 7),)


def test_only_so_many_tasks_wait_and_the_last_in_rank_by_asking_again() -> None:
    activation = activation_in(ACTIVE)
    for number in range(MOST_WAITING + 10):
        activation, verdict, _ = obey(activation, call_of(Reserve, f"{number:03}~1", beginning=float(-number)))
        assert verdict is Verdict.BUSY
    assert len(activation.queue.claims) == MOST_WAITING
    assert activation.queue.claims[0].task == f"{MOST_WAITING + 9:03}~1"


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
    assert activation.queue.kept_for == claim.task
    return activation


def test_a_component_that_is_held_is_offered_to_none() -> None:
    held, _, _ = obey(activation_in(ACTIVE), call_of(Reserve, B))
    assert offer(held) == (held, None)
    assert offer(Activation()) == (Activation(), None)


def test_a_component_that_is_kept_for_a_task_is_busy_for_those_that_come_later() -> None:
    activation = offered(B, C)
    assert activation.queue.kept_for == B
    for call in (Reserve, Apply):
        kept, verdict, _ = obey(activation, call_of(call, C, beginning=1.0))
        assert (verdict, kept.queue.kept_for) == (Verdict.BUSY, B)
        taken, verdict, _ = obey(kept, call_of(call, B, beginning=0.0))
        assert (verdict, taken.queue.kept_for, waiting_for(taken)) == (Verdict.DONE, "", [C])


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


@pytest.mark.parametrize(("priority", "expected"), [(0, None), (1, C)])
def test_what_is_kept_is_offered_instead_to_a_task_of_higher_priority_that_has_come_since(
    priority: int, expected: str | None
) -> None:
    """It would have the other one yield what that is about to have, and could say so only when it asks again."""
    activation = offered(B)
    activation, verdict, _ = obey(activation, call_of(Reserve, C, priority=priority, beginning=-1.0, waits=True))
    assert verdict is Verdict.BUSY
    activation, claim = offer(activation)
    assert (activation.queue.kept_for, claim and claim.task) == (expected or B, expected)
    if expected:
        assert offer(activation) == (activation, None)
        _, again = offer(withdraw(activation, C))
        assert again is not None
        assert again.task == B, "its own offer was cut short"


def test_an_offer_to_another_task_is_not_withdrawn() -> None:
    activation = offered(B, C)
    assert withdraw(activation, C) == activation


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


def test_nobody_is_asked_to_yield_for_a_task_that_did_not_come_until_it_asks_again() -> None:
    """Its configurator may be gone: else every task of lower priority would yield to it forever."""
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
    assert (verdict, held.queue.kept_for) == (Verdict.DONE, "")
    assert withdraw(held, B).queue.lapsed == frozenset(), "it has not been slow to come"


def test_the_component_is_kept_no_longer_for_a_task_that_leaves_and_comes_again() -> None:
    call = call_of(Reserve, B)
    kept, claim = TaskQueue().joined(call).offered()
    assert kept.kept is claim is call
    assert kept.left(B).joined(call).kept is None
    assert kept.left(C).kept is call
