"""A task that is stopped ends with everything released, and one whose components are lost without end is given up."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.effects import (
    Decline,
    Finish,
    Running,
)
from selfconf.configurator.events import (
    Answered,
    Appeared,
    Call,
    Failed,
    Freed,
    Reconnected,
    Stopped,
)
from selfconf.configurator.machine import MOST_REPEATS
from selfconf.configurator.state import Phase, Policy, State
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Verdict
from tests.configurator.builders import (
    CONTROL,
    DISMANTLE,
    DRIVE,
    ODOMETRY,
    OTHERS,
    TASK,
    TRACKER,
    History,
    kinds,
    navigation,
    released,
    state_in,
)


@pytest.mark.parametrize("phase", [phase for phase in Phase if phase not in (Phase.REFUSED, Phase.STOPPED)])
@pytest.mark.parametrize("policy", Policy)
def test_a_stop_in_every_phase_ends_with_everything_released(phase: Phase, policy: Policy) -> None:
    history = History(state_in(phase, policy=policy))
    touched = set(history.state.held)
    history.hear(Stopped())
    history.all_answer()
    assert history.state.phase is Phase.STOPPED
    assert not history.state.held
    assert not history.state.owed
    assert touched <= {IRI(c) for c in released(history.effects)} | (touched if phase is Phase.DISMANTLING else set())
    assert kinds(history.effects).count(Finish) == 1
    assert history.hear(Stopped()) == []


def test_a_stop_while_dismantling_for_a_search_ends_it() -> None:
    history = History(DISMANTLE).running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL), Stopped())
    assert history.all_answer() == [Finish()]
    assert history.state.phase is Phase.STOPPED


def test_a_stop_does_not_wait_for_a_component_that_cannot_be_reached() -> None:
    history = History().running()
    assert released(history.hear(Stopped())) == [DRIVE]
    assert released(history.answer(DRIVE, Call.RELEASE, None)) == [CONTROL]
    assert released(history.answer(CONTROL, Call.RELEASE)) == [TRACKER]
    assert history.answer(TRACKER, Call.RELEASE) == [Finish()]
    assert history.state.owed.keys() == {DRIVE}


def test_a_stop_waits_for_a_component_that_was_just_released() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL), Stopped())
    history.answer(DRIVE, Call.RELEASE)
    history.answer(CONTROL, Call.RELEASE)
    assert history.state.pending == {(TRACKER, Call.RELEASE)}
    assert history.answer(TRACKER, Call.RELEASE) == [Finish()]


@pytest.mark.parametrize("state", [Phase.STOPPED, Phase.REFUSED])
def test_nothing_is_done_any_more_about_a_task_that_has_ended(state: Phase) -> None:
    history = History(state_in(state))
    late = Answered(TRACKER, Call.RESERVE, history.state.epoch, Verdict.DONE, "1")
    for event in (
        late,
        Appeared({TRACKER: "2"}),
        Reconnected(),
        Stopped(),
        Failed(TRACKER, "1", Cause.FAIL),
    ):
        assert history.hear(event) == []
    assert kinds(history.hear(Freed(TRACKER))) == [Decline]


@pytest.mark.parametrize("verdict", [Verdict.STALE, Verdict.NOT_HELD])
def test_a_component_that_has_everything_begin_anew_without_end_is_given_up(verdict: Verdict) -> None:
    history = History(TASK).reserved()
    for _ in range(MOST_REPEATS + 1):
        assert history.state.phase is Phase.DEPLOYING
        epoch = history.state.epoch
        history.hear(Answered(TRACKER, Call.APPLY, epoch, verdict, "1", newest=epoch + 1))
        if history.state.phase is not Phase.COMPOSING:
            history.all_answer(Call.WAKE, Call.RESERVE)
    assert history.state.phase is Phase.COMPOSING
    assert history.state.lost[TRACKER].cause is Cause.REFUSED
    history.composed(navigation(ODOMETRY))
    assert kinds(history.all_answer())[0] is Running


def test_an_epoch_that_no_clock_comes_to_is_not_taken_over() -> None:
    history = History(TASK).reserved()
    epoch = history.state.epoch
    history.hear(Answered(TRACKER, Call.APPLY, epoch, Verdict.STALE, "1", newest=(1 << 63) - 1))
    assert history.state.epoch == epoch + 1
    assert TRACKER in history.state.lost


@pytest.mark.parametrize("alone", [True, False], ids=["its own", "kept by sites"])
def test_only_a_task_that_another_configurator_may_have_is_left_to_that_one(alone: bool) -> None:
    history = History(State(task="navigate~1", alone=alone)).accepted()
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    component, _ = min(history.state.pending)
    history.busy(component, replace(OTHERS, task="navigate~1"))
    assert history.state.phase is (Phase.COMPOSING if alone else Phase.STOPPED)


def test_a_component_that_says_at_each_apply_that_another_task_holds_it_is_given_up() -> None:
    history = History(State(task="navigate~1", priority=5)).reserved()
    for _ in range(MOST_REPEATS + 1):
        assert history.state.phase is Phase.DEPLOYING
        history.busy(TRACKER, call=Call.APPLY)
        if history.state.phase is not Phase.COMPOSING:
            history.all_answer(Call.WAKE, Call.RESERVE)
    assert history.state.phase is Phase.COMPOSING
    assert history.state.lost[TRACKER].busy
