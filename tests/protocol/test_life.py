"""The life of a component: its table, and the two guards before it."""

from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.protocol.life import Life, Phase, Step, fail, obey, orphaned
from selfconf.protocol.messages import Apply, Release, SetParameters, Verdict

US, THEM = "selfconf/e/conf/us/live/1", "selfconf/e/conf/them/live/1"
Call = Apply | SetParameters | Release

TABLE = [
    (Phase.IDLE, Apply, Phase.ACTIVE, Verdict.DONE, Step.START),
    (Phase.ACTIVE, Apply, Phase.ACTIVE, Verdict.DONE, Step.NONE),
    (Phase.FAILED, Apply, Phase.ACTIVE, Verdict.DONE, Step.RESTART),
    (Phase.IDLE, SetParameters, Phase.IDLE, Verdict.REFUSED, Step.NONE),
    (Phase.ACTIVE, SetParameters, Phase.ACTIVE, Verdict.DONE, Step.NONE),
    (Phase.FAILED, SetParameters, Phase.FAILED, Verdict.DONE, Step.NONE),
    (Phase.IDLE, Release, Phase.IDLE, Verdict.DONE, Step.NONE),
    (Phase.ACTIVE, Release, Phase.IDLE, Verdict.DONE, Step.STOP),
    (Phase.FAILED, Release, Phase.IDLE, Verdict.DONE, Step.STOP),
]


def life_in(phase: Phase, epoch: int = 5) -> Life:
    """A life in a phase, as it can come about."""
    return Life(phase, epoch, None if phase is Phase.IDLE else US)


@pytest.mark.parametrize(("phase", "call", "after", "verdict", "step"), TABLE)
def test_every_phase_answers_every_call(
    phase: Phase, call: type[Call], after: Phase, verdict: Verdict, step: Step
) -> None:
    repeated = (phase, call) == (Phase.FAILED, Apply)
    for epoch in (6,) if repeated else (5, 6):
        life, said, told = obey(life_in(phase), call(epoch, US))
        assert (life.phase, said, told, life.epoch) == (after, verdict, step, epoch)
        assert life.supervisor == (None if after is Phase.IDLE else US)


@pytest.mark.parametrize("phase", Phase)
@pytest.mark.parametrize("call", [Apply, SetParameters, Release])
def test_a_call_of_an_older_epoch_changes_nothing(phase: Phase, call: type[Call]) -> None:
    before = life_in(phase)
    for supervisor in (US, THEM):
        assert obey(before, call(4, supervisor)) == (before, Verdict.STALE, Step.NONE)


@pytest.mark.parametrize("phase", [Phase.ACTIVE, Phase.FAILED])
@pytest.mark.parametrize("call", [Apply, SetParameters, Release])
def test_a_component_that_is_held_obeys_nobody_else(phase: Phase, call: type[Call]) -> None:
    before = life_in(phase)
    assert obey(before, call(9, THEM)) == (before, Verdict.BUSY, Step.NONE)


@pytest.mark.parametrize(
    ("phase", "after", "step"),
    [
        (Phase.IDLE, Phase.IDLE, Step.NONE),
        (Phase.ACTIVE, Phase.FAILED, Step.TELL),
        (Phase.FAILED, Phase.FAILED, Step.NONE),
    ],
)
def test_fail_is_raised_once_and_only_by_who_acts(phase: Phase, after: Phase, step: Step) -> None:
    life, told = fail(life_in(phase))
    assert (life.phase, told) == (after, step)


@pytest.mark.parametrize("phase", Phase)
def test_an_orphan_turns_itself_off_and_is_free_for_others(phase: Phase) -> None:
    life, told = orphaned(life_in(phase))
    assert (life.phase, life.supervisor, life.epoch) == (Phase.IDLE, None, 5)
    assert told is (Step.NONE if phase is Phase.IDLE else Step.STOP)
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
            life, told = fail(life) if event == "fail" else orphaned(life)
        else:
            life, verdict, told = obey(life, event)
            assert (verdict in (Verdict.STALE, Verdict.BUSY)) <= (life == before)
            assert (verdict is Verdict.REFUSED) <= (life.phase is before.phase)
        assert life.epoch >= before.epoch
        assert (life.supervisor is None) == (life.phase is Phase.IDLE)
        if told in (Step.START, Step.RESTART):
            assert running == (told is Step.RESTART)
            running = True
        elif told is Step.STOP:
            assert running
            running = False
        assert running == (life.phase is not Phase.IDLE)


def test_an_old_apply_that_comes_after_its_release_does_not_wake_the_component() -> None:
    life = Life()
    late = Apply(1, US)
    for call in (late, Release(2, US)):
        life, verdict, _ = obey(life, call)
        assert verdict is Verdict.DONE
    assert obey(life, late)[1] is Verdict.STALE


def test_an_apply_that_is_repeated_does_not_hide_a_failure() -> None:
    failed = life_in(Phase.FAILED)
    assert obey(failed, Apply(5, US)) == (failed, Verdict.REFUSED, Step.NONE)


def test_the_table_is_complete() -> None:
    wanted = set(itertools.product(Phase, (Apply, SetParameters, Release)))
    assert {(phase, call) for phase, call, *_ in TABLE} == wanted
