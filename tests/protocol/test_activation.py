"""The activation of a component: its table, and the two guards before it."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.protocol.activation import Activation, ActivationPhase, ActivationStep, fail, obey, orphan
from selfconf.protocol.messages import Apply, Release, SetParameters, Verdict

US, THEM = "selfconf/e/conf/us/live/1", "selfconf/e/conf/them/live/1"
Call = Apply | SetParameters | Release

TABLE = [
    (ActivationPhase.IDLE, Apply, ActivationPhase.ACTIVE, Verdict.DONE, ActivationStep.START),
    (ActivationPhase.ACTIVE, Apply, ActivationPhase.ACTIVE, Verdict.DONE, ActivationStep.NONE),
    (ActivationPhase.FAILED, Apply, ActivationPhase.ACTIVE, Verdict.DONE, ActivationStep.RESTART),
    (ActivationPhase.IDLE, SetParameters, ActivationPhase.IDLE, Verdict.REFUSED, ActivationStep.NONE),
    (ActivationPhase.ACTIVE, SetParameters, ActivationPhase.ACTIVE, Verdict.DONE, ActivationStep.NONE),
    (ActivationPhase.FAILED, SetParameters, ActivationPhase.FAILED, Verdict.DONE, ActivationStep.NONE),
    (ActivationPhase.IDLE, Release, ActivationPhase.IDLE, Verdict.DONE, ActivationStep.NONE),
    (ActivationPhase.ACTIVE, Release, ActivationPhase.IDLE, Verdict.DONE, ActivationStep.STOP),
    (ActivationPhase.FAILED, Release, ActivationPhase.IDLE, Verdict.DONE, ActivationStep.STOP),
]


def activation_in(phase: ActivationPhase, epoch: int = 5) -> Activation:
    """An activation in a phase, as it can come about."""
    return Activation(phase, epoch, None if phase is ActivationPhase.IDLE else US)


@pytest.mark.parametrize(("phase", "call", "after", "verdict", "step"), TABLE)
def test_every_phase_answers_every_call(
    phase: ActivationPhase, call: type[Call], after: ActivationPhase, verdict: Verdict, step: ActivationStep
) -> None:
    repeated = (phase, call) == (ActivationPhase.FAILED, Apply)
    for epoch in (6,) if repeated else (5, 6):
        activation, said, told = obey(activation_in(phase), call(epoch, US))
        assert (activation.phase, said, told, activation.epoch) == (after, verdict, step, epoch)
        assert activation.supervisor == (None if after is ActivationPhase.IDLE else US)


@pytest.mark.parametrize("phase", ActivationPhase)
@pytest.mark.parametrize("call", [Apply, SetParameters, Release])
def test_a_call_of_an_older_epoch_changes_nothing(phase: ActivationPhase, call: type[Call]) -> None:
    before = activation_in(phase)
    for supervisor in (US, THEM):
        assert obey(before, call(4, supervisor)) == (before, Verdict.STALE, ActivationStep.NONE)


@pytest.mark.parametrize("phase", [ActivationPhase.ACTIVE, ActivationPhase.FAILED])
@pytest.mark.parametrize("call", [Apply, SetParameters, Release])
def test_a_held_component_obeys_no_other_configurator(phase: ActivationPhase, call: type[Call]) -> None:
    before = activation_in(phase)
    assert obey(before, call(9, THEM)) == (before, Verdict.BUSY, ActivationStep.NONE)


@pytest.mark.parametrize(
    ("phase", "after", "step"),
    [
        (ActivationPhase.IDLE, ActivationPhase.IDLE, ActivationStep.NONE),
        (ActivationPhase.ACTIVE, ActivationPhase.FAILED, ActivationStep.RAISE_FAIL),
        (ActivationPhase.FAILED, ActivationPhase.FAILED, ActivationStep.NONE),
    ],
)
def test_fail_is_raised_once_and_only_by_an_active_component(
    phase: ActivationPhase, after: ActivationPhase, step: ActivationStep
) -> None:
    activation, told = fail(activation_in(phase))
    assert (activation.phase, told) == (after, step)


@pytest.mark.parametrize("phase", ActivationPhase)
def test_an_orphan_turns_itself_off_and_is_free_for_others(phase: ActivationPhase) -> None:
    activation, told = orphan(activation_in(phase))
    assert (activation.phase, activation.supervisor, activation.epoch) == (ActivationPhase.IDLE, None, 5)
    assert told is (ActivationStep.NONE if phase is ActivationPhase.IDLE else ActivationStep.STOP)
    assert obey(activation, Apply(6, THEM))[1] is Verdict.DONE


calls = st.builds(
    lambda kind, epoch, supervisor: kind(epoch, supervisor),
    st.sampled_from([Apply, SetParameters, Release]),
    st.integers(0, 4),
    st.sampled_from([US, THEM]),
)


@given(st.lists(calls | st.sampled_from(["fail", "orphaned"]), max_size=30))
def test_whatever_happens_the_epoch_never_falls_and_only_a_held_component_acts(
    history: list[Call | str],
) -> None:
    activation = Activation()
    running = False
    for event in history:
        before = activation
        if isinstance(event, str):
            activation, told = fail(activation) if event == "fail" else orphan(activation)
        else:
            activation, verdict, told = obey(activation, event)
            assert (verdict in (Verdict.STALE, Verdict.BUSY)) <= (activation == before)
            assert (verdict is Verdict.REFUSED) <= (activation.phase is before.phase)
        assert activation.epoch >= before.epoch
        assert (activation.supervisor is None) == (activation.phase is ActivationPhase.IDLE)
        if told in (ActivationStep.START, ActivationStep.RESTART):
            assert running == (told is ActivationStep.RESTART)
            running = True
        elif told is ActivationStep.STOP:
            assert running
            running = False
        assert running == (activation.phase is not ActivationPhase.IDLE)


def test_an_old_apply_that_comes_after_its_release_does_not_wake_the_component() -> None:
    activation = Activation()
    late = Apply(1, US)
    for call in (late, Release(2, US)):
        activation, verdict, _ = obey(activation, call)
        assert verdict is Verdict.DONE
    assert obey(activation, late)[1] is Verdict.STALE


def test_an_apply_that_is_repeated_does_not_hide_a_failure() -> None:
    failed = activation_in(ActivationPhase.FAILED)
    assert obey(failed, Apply(5, US)) == (failed, Verdict.REFUSED, ActivationStep.NONE)


def test_the_table_is_complete() -> None:
    wanted = set(itertools.product(ActivationPhase, (Apply, SetParameters, Release)))
    assert {(phase, call) for phase, call, *_ in TABLE} == wanted
