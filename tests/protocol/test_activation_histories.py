"""Random histories of calls and mishaps: the invariants of an activation hold at each step."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from selfconf.protocol.activation import (
    Activation,
    ActivationStep,
    Hold,
    drop,
    fail,
    granted,
    held_under,
    obey,
    offer,
    outranked,
    withdraw,
)
from selfconf.protocol.messages import Apply, Release, Reserve, Verdict
from tests.protocol.activations import (
    ACTIVE,
    FAILED,
    IDLE,
    INPUTS,
    OTHER,
    A,
    B,
    C,
    Call,
    call_of,
    supervisor,
    waiting_for,
)

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
    history: list[Call | str], shareable: bool, reserved_first: bool, gone: set[str]
) -> None:
    activation, running = Activation(), False
    for event in history:
        before = activation
        if isinstance(event, str):
            activation, told = _mishap(activation, event)
        else:
            kind = {"shareable": shareable, "reserved_first": reserved_first}
            activation, verdict, told = obey(activation, event, **kind, gone=frozenset(gone))
            _check_call(before, event, activation, verdict, gone, shareable, reserved_first)
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
        return withdraw(activation, activation.queue.kept_for), ActivationStep.NONE
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
    reserved_first: bool,
) -> None:
    """What a call may change."""
    own = before.hold(call.task)
    if verdict in (Verdict.STALE, Verdict.NOT_HELD, Verdict.REFUSED):
        assert after == before
    assert (verdict is Verdict.STALE) == (call.epoch < before.epoch_of(call.task))
    assert verdict is not Verdict.NOT_HELD or (reserved_first and isinstance(call, Apply))
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
            assert own is not None or not reserved_first
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
    ranks = [(-claim.priority, claim.beginning) for claim in activation.queue.claims]
    assert ranks == sorted(ranks)
    assert len(set(waiting_for(activation))) == len(ranks)
    assert {activation.queue.kept_for} - {""} <= activation.queue.passed <= set(waiting_for(activation))
    assert activation.queue.lapsed <= set(waiting_for(activation))
    top = max((claim.priority for claim in activation.queue.claims), default=-1)
    outranking = [hold.claim.priority for hold in activation.holds if hold.claim.task in outranked(activation)]
    assert all(top > priority for priority in outranking)
