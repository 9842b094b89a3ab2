"""What components answer: that others hold them, for which a patient task waits, or what has all begin anew."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.answering import MOST_REPEATS
from selfconf.configurator.effects import (
    Compose,
    Decline,
    Discover,
    Finish,
    QueueFor,
    ReleaseFrom,
    Running,
)
from selfconf.configurator.events import (
    Accepted,
    Answered,
    Appeared,
    Call,
    Composed,
    Discovered,
    Failed,
    Freed,
    Stopped,
    Unanswered,
)
from selfconf.configurator.state import Phase, State
from selfconf.model.refusal import Undecided
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Verdict
from tests.configurator.builders import (
    CONTROL,
    DRIVE,
    LOWER,
    ODOMETRY,
    OTHERS,
    PATIENT,
    REFUSAL,
    RESERVING,
    TASK,
    TRACKER,
    History,
    kinds,
    navigation,
    released,
    reserved,
)


def waiting() -> History:
    """A patient task that lacks what another task holds."""
    history = History(PATIENT)
    history.hear(Accepted(100), Discovered({TRACKER: OTHERS}))
    history.composed(REFUSAL)
    assert history.composed(navigation()) == [QueueFor(TRACKER, history.state.epoch)]
    assert history.state.phase is Phase.REFUSED
    return history


def test_a_patient_task_waits_for_what_another_holds_and_begins_when_it_is_free() -> None:
    history = waiting()
    assert history.hear(Freed(TRACKER)) == [Discover()]
    assert history.hear(Discovered()) == [Compose(3, frozenset(), None)]
    history.composed(navigation())
    assert kinds(history.all_answer()) == [Running]


def test_a_patient_task_waits_for_all_that_others_hold_and_that_could_help() -> None:
    history = History(PATIENT)
    history.hear(Accepted(100), Discovered({TRACKER: OTHERS, ODOMETRY: OTHERS, DRIVE: OTHERS}))
    history.composed(REFUSAL)
    found = Composed(history.state.attempt, navigation(), frozenset({TRACKER, ODOMETRY}))
    assert history.hear(found) == [QueueFor(one, history.state.epoch) for one in sorted((TRACKER, ODOMETRY))]
    held = tuple((one, OTHERS) for one in sorted((TRACKER, ODOMETRY)))
    assert history.state.refusal == replace(REFUSAL, held=held)
    assert list(history.state.lost) == sorted((TRACKER, ODOMETRY))
    assert not history.state.held
    assert history.hear(Freed(ODOMETRY)) == [Discover()]


def test_a_patient_task_waits_for_nothing_where_all_that_others_hold_would_not_do() -> None:
    history = History(PATIENT)
    history.hear(Accepted(100), Discovered({TRACKER: OTHERS}))
    history.composed(REFUSAL)
    assert history.hear(Composed(history.state.attempt, REFUSAL, frozenset({TRACKER}))) == []
    assert not history.state.queued


@pytest.mark.parametrize("usable", [frozenset({TRACKER}), frozenset[IRI]()])
def test_a_patient_task_waits_for_what_others_hold_where_it_is_not_decided_whether_that_would_do(
    usable: frozenset[IRI],
) -> None:
    history = History(PATIENT)
    history.hear(Accepted(100), Discovered({TRACKER: OTHERS}))
    history.composed(REFUSAL)
    undecided = Composed(history.state.attempt, Undecided(5000), usable)
    assert history.hear(undecided) == [QueueFor(TRACKER, history.state.epoch)]
    assert history.state.refusal == REFUSAL, "it is not said that there would be a configuration with it"
    assert history.hear(Freed(TRACKER)) == [Discover()]


def test_a_task_waits_for_a_component_that_has_obeyed_a_newer_epoch_of_it_by_asking_in_that() -> None:
    """Another configurator of the task had a clock that was ahead."""
    history = waiting()
    epoch = history.state.epoch
    stale = Answered(TRACKER, Call.RESERVE, epoch, Verdict.STALE, "1", newest=epoch + 300_000)
    assert history.hear(stale) == [QueueFor(TRACKER, epoch + 300_000)]
    assert history.hear(stale) == []  # it is of an epoch that is over
    assert history.hear(Freed(TRACKER)) == [Discover()]
    history.hear(Discovered())
    history.composed(navigation())
    assert history.state.epoch > epoch + 300_000


def test_a_task_waits_for_what_it_was_to_let_go_of_itself_once_that_has_obeyed() -> None:
    """A component that hangs, as another task waits for it, may be had again when that one has let go of it."""
    state = waiting().state
    history = History(replace(state, owed={TRACKER: state.epoch}))
    assert history.answer(TRACKER, Call.RELEASE, Unanswered.SILENT) == []
    assert history.answer(TRACKER, Call.RELEASE) == [QueueFor(TRACKER, state.epoch + 1)]
    assert history.answer(TRACKER, Call.RELEASE) == [], "once"
    assert history.hear(Freed(TRACKER)) == [Discover()]


def test_a_component_that_says_without_end_that_it_has_obeyed_a_newer_epoch_is_asked_a_few_times() -> None:
    history = waiting()
    for _ in range(MOST_REPEATS + 1):
        epoch = history.state.epoch
        effects = history.hear(Answered(TRACKER, Call.RESERVE, epoch, Verdict.STALE, "1", newest=epoch + 1))
    assert effects == []
    assert history.state.phase is Phase.REFUSED


def test_an_epoch_that_no_clock_comes_to_is_not_waited_in() -> None:
    history = waiting()
    epoch = history.state.epoch
    assert history.hear(Answered(TRACKER, Call.RESERVE, epoch, Verdict.STALE, "1", newest=(1 << 63) - 1)) == []
    assert history.state.epoch == epoch


def test_a_component_that_says_that_it_is_free_is_believed_more_than_its_last_holder() -> None:
    history = waiting()
    history.hear(Freed(TRACKER))
    assert history.hear(Discovered({TRACKER: OTHERS})) == [Compose(3, frozenset(), None)]
    history.composed(REFUSAL)
    history.hear(Appeared({ODOMETRY: "1"}))
    assert history.hear(Discovered({TRACKER: OTHERS}))[-1] == Compose(4, frozenset({TRACKER}), None)


def test_what_was_kept_for_a_task_counts_as_free_while_it_waits_for_the_rest() -> None:
    """A task that means to have both, and has reserved neither yet, says that it holds them."""
    meant = {TRACKER: RESERVING, CONTROL: RESERVING}
    history = History(PATIENT)
    history.hear(Accepted(100), Discovered(meant))
    history.composed(REFUSAL)
    history.composed(navigation())
    assert history.hear(Freed(TRACKER), Discovered(meant)) == [Compose(3, frozenset({CONTROL}), None)]
    history.composed(REFUSAL)
    epoch = history.state.epoch + 1
    assert history.composed(navigation()) == [QueueFor(CONTROL, epoch), Decline(TRACKER, epoch)]
    assert history.hear(Freed(CONTROL), Discovered(meant)) == [Compose(5, frozenset(), None)]


def test_a_task_waits_no_more_for_what_is_not_in_its_way() -> None:
    """A task of lower priority that holds it by now would yield it to one that cannot run."""
    history = waiting()
    history.hear(Appeared({ODOMETRY: "1"}), Discovered({TRACKER: LOWER, CONTROL: OTHERS}))
    history.composed(REFUSAL)
    epoch = history.state.epoch + 1
    assert history.composed(navigation()) == [QueueFor(CONTROL, epoch), Decline(TRACKER, epoch)]
    assert history.state.queued == {CONTROL}


def test_a_patient_task_that_has_found_something_else_waits_no_more() -> None:
    history = waiting()
    history.hear(Appeared({ODOMETRY: "1"}), Discovered({TRACKER: OTHERS}))
    history.composed(navigation(ODOMETRY))
    effects = history.all_answer()
    assert kinds(effects) == [Running, ReleaseFrom]
    assert released(effects) == [TRACKER]
    assert not history.state.queued


def test_a_patient_task_that_is_stopped_waits_no_more() -> None:
    history = waiting()
    assert released(history.hear(Stopped())) == [TRACKER]
    assert history.answer(TRACKER, Call.RELEASE) == [Finish()]


def test_a_component_that_was_free_and_was_not_taken_forgets_the_task() -> None:
    """It remembers the task until it is reserved or released: else it would be kept for one that cannot take it."""
    history = waiting()
    history.hear(Freed(TRACKER), Discovered())
    assert history.composed(REFUSAL) == [Decline(TRACKER, history.state.epoch)]
    assert history.state.phase is Phase.REFUSED
    assert history.hear(Stopped()) == [Finish()]


def test_what_was_not_free_for_this_task_counts_again_once_it_is() -> None:
    history = History(TASK).running()
    history.hear(Failed(TRACKER, "1", Cause.YIELD))
    history.all_answer()
    assert history.state.lost[TRACKER].busy
    history.hear(Freed(TRACKER))
    assert not history.state.lost
    assert history.composed(REFUSAL) == [Discover()]


def test_what_is_kept_for_a_task_that_cannot_take_it_now_goes_to_the_next() -> None:
    history = History(TASK).running()
    assert history.hear(Freed(ODOMETRY)) == [Decline(ODOMETRY, history.state.epoch)]


def test_what_is_free_while_a_task_searches_goes_to_no_other_before_that_has_found_something() -> None:
    history = waiting()
    history.hear(Freed(TRACKER))
    assert history.state.phase is Phase.DISCOVERING
    assert history.hear(Freed(ODOMETRY)) == []
    history.hear(Discovered())
    assert history.state.phase is Phase.COMPOSING
    assert history.hear(Freed(ODOMETRY)) == []


def test_what_is_kept_for_a_task_is_reserved_while_others_are_started() -> None:
    """It is not kept for as long as that takes, and a task that began later has all that it needs."""
    history = waiting()
    history.hear(Freed(TRACKER), Discovered())
    history.composed(navigation())
    assert history.answer(CONTROL, Call.WAKE) == [], "it is not offered, and comes in its turn"
    assert reserved(history.answer(TRACKER, Call.WAKE)) == [TRACKER]
    assert history.answer(TRACKER, Call.RESERVE) == []
    assert reserved(history.answer(DRIVE, Call.WAKE)) == [CONTROL]
    assert kinds(history.all_answer()) == [Running]


def test_what_is_kept_for_a_task_while_it_has_others_started_is_reserved_at_once() -> None:
    history = waiting()
    history.hear(Appeared({ODOMETRY: "1"}), Discovered())
    history.composed(navigation())
    assert history.answer(TRACKER, Call.WAKE) == []
    assert reserved(history.hear(Freed(TRACKER))) == [TRACKER]
    assert history.hear(Freed(TRACKER)) != [], "it says so again: it is asked again"


def test_a_notice_that_comes_after_the_component_was_reserved_lets_it_not_go() -> None:
    history = History(TASK).running()
    assert history.hear(Freed(TRACKER)) == []
    history = History(TASK).accepted()
    history.composed(navigation())
    assert history.hear(Freed(TRACKER)) == []  # it is about to be reserved


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
