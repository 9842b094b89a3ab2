"""The life of a component: its table, and the two guards before it."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.protocol.life import Life, LifePhase, LifeStep, fail, obey, orphan
from selfconf.protocol.messages import Apply, Release, SetParameters, Verdict

US, THEM = "selfconf/e/conf/us/live/1", "selfconf/e/conf/them/live/1"
Call = Apply | SetParameters | Release

TABLE = [
    (LifePhase.IDLE, Apply, LifePhase.ACTIVE, Verdict.DONE, LifeStep.START),
    (LifePhase.ACTIVE, Apply, LifePhase.ACTIVE, Verdict.DONE, LifeStep.NONE),
    (LifePhase.FAILED, Apply, LifePhase.ACTIVE, Verdict.DONE, LifeStep.RESTART),
    (LifePhase.IDLE, SetParameters, LifePhase.IDLE, Verdict.REFUSED, LifeStep.NONE),
    (LifePhase.ACTIVE, SetParameters, LifePhase.ACTIVE, Verdict.DONE, LifeStep.NONE),
    (LifePhase.FAILED, SetParameters, LifePhase.FAILED, Verdict.DONE, LifeStep.NONE),
    (LifePhase.IDLE, Release, LifePhase.IDLE, Verdict.DONE, LifeStep.NONE),
    (LifePhase.ACTIVE, Release, LifePhase.IDLE, Verdict.DONE, LifeStep.STOP),
    (LifePhase.FAILED, Release, LifePhase.IDLE, Verdict.DONE, LifeStep.STOP),
]


def life_in(phase: LifePhase, epoch: int = 5) -> Life:
    """A life in a phase, as it can come about."""
    return Life(phase, epoch, None if phase is LifePhase.IDLE else US)


@pytest.mark.parametrize(("phase", "call", "after", "verdict", "step"), TABLE)
def test_every_phase_answers_every_call(
    phase: LifePhase, call: type[Call], after: LifePhase, verdict: Verdict, step: LifeStep
) -> None:
    repeated = (phase, call) == (LifePhase.FAILED, Apply)
    for epoch in (6,) if repeated else (5, 6):
        life, said, told = obey(life_in(phase), call(epoch, US))
        assert (life.phase, said, told, life.epoch) == (after, verdict, step, epoch)
        assert life.supervisor == (None if after is LifePhase.IDLE else US)


@pytest.mark.parametrize("phase", LifePhase)
@pytest.mark.parametrize("call", [Apply, SetParameters, Release])
def test_a_call_of_an_older_epoch_changes_nothing(phase: LifePhase, call: type[Call]) -> None:
    before = life_in(phase)
    for supervisor in (US, THEM):
        assert obey(before, call(4, supervisor)) == (before, Verdict.STALE, LifeStep.NONE)


@pytest.mark.parametrize("phase", [LifePhase.ACTIVE, LifePhase.FAILED])
@pytest.mark.parametrize("call", [Apply, SetParameters, Release])
def test_a_component_that_is_held_obeys_nobody_else(phase: LifePhase, call: type[Call]) -> None:
    before = life_in(phase)
    assert obey(before, call(9, THEM)) == (before, Verdict.BUSY, LifeStep.NONE)


@pytest.mark.parametrize(
    ("phase", "after", "step"),
    [
        (LifePhase.IDLE, LifePhase.IDLE, LifeStep.NONE),
        (LifePhase.ACTIVE, LifePhase.FAILED, LifeStep.TELL),
        (LifePhase.FAILED, LifePhase.FAILED, LifeStep.NONE),
    ],
)
def test_fail_is_raised_once_and_only_by_who_acts(phase: LifePhase, after: LifePhase, step: LifeStep) -> None:
    life, told = fail(life_in(phase))
    assert (life.phase, told) == (after, step)


@pytest.mark.parametrize("phase", LifePhase)
def test_an_orphan_turns_itself_off_and_is_free_for_others(phase: LifePhase) -> None:
    life, told = orphan(life_in(phase))
    assert (life.phase, life.supervisor, life.epoch) == (LifePhase.IDLE, None, 5)
    assert told is (LifeStep.NONE if phase is LifePhase.IDLE else LifeStep.STOP)
    assert obey(life, Apply(6, THEM))[1] is Verdict.DONE


calls = st.builds(
    lambda kind, epoch, supervisor: kind(epoch, supervisor),
    st.sampled_from([Apply, SetParameters, Release]),
    st.integers(0, 4),
    st.sampled_from([US, THEM]),
)


@given(st.lists(calls | st.sampled_from(["fail", "orphaned"]), max_size=30))
def test_whatever_happens_the_epoch_never_falls_and_only_who_is_held_acts(
    history: list[Call | str],
) -> None:
    life = Life()
    running = False
    for event in history:
        before = life
        if isinstance(event, str):
            life, told = fail(life) if event == "fail" else orphan(life)
        else:
            life, verdict, told = obey(life, event)
            assert (verdict in (Verdict.STALE, Verdict.BUSY)) <= (life == before)
            assert (verdict is Verdict.REFUSED) <= (life.phase is before.phase)
        assert life.epoch >= before.epoch
        assert (life.supervisor is None) == (life.phase is LifePhase.IDLE)
        if told in (LifeStep.START, LifeStep.RESTART):
            assert running == (told is LifeStep.RESTART)
            running = True
        elif told is LifeStep.STOP:
            assert running
            running = False
        assert running == (life.phase is not LifePhase.IDLE)


def test_an_old_apply_that_comes_after_its_release_does_not_wake_the_component() -> None:
    life = Life()
    late = Apply(1, US)
    for call in (late, Release(2, US)):
        life, verdict, _ = obey(life, call)
        assert verdict is Verdict.DONE
    assert obey(life, late)[1] is Verdict.STALE


def test_an_apply_that_is_repeated_does_not_hide_a_failure() -> None:
    failed = life_in(LifePhase.FAILED)
    assert obey(failed, Apply(5, US)) == (failed, Verdict.REFUSED, LifeStep.NONE)


def test_the_table_is_complete() -> None:
    wanted = set(itertools.product(LifePhase, (Apply, SetParameters, Release)))
    assert {(phase, call) for phase, call, *_ in TABLE} == wanted
