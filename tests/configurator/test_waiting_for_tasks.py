"""A component that another task holds is waited for: what comes of it, and when it is given up."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.deploying import MOST_ASKED, may_wait_for
from selfconf.configurator.effects import (
    AwaitRelease,
    Compose,
    ReleaseFrom,
    Running,
    WakeUp,
)
from selfconf.configurator.events import (
    Call,
    Composed,
    Discovered,
    Failed,
    Freed,
    Improvable,
    Unanswered,
    WaitedLong,
)
from selfconf.configurator.state import Held, Phase, State
from selfconf.model.holder import Holder
from selfconf.protocol.messages import Cause, Verdict
from tests.configurator.builders import (
    CONTROL,
    DRIVE,
    KEPT,
    LOWER,
    ODOMETRY,
    OTHERS,
    PATIENT,
    REFUSAL,
    RESERVING,
    TASK,
    TRACKER,
    History,
    applied,
    kinds,
    lost_tracker,
    navigation,
    released,
    reserved,
)


@pytest.mark.parametrize(
    ("patient", "holder", "later", "expected"),
    [
        (False, None, False, False),
        (True, None, False, False),
        (False, LOWER, False, True),
        (False, LOWER, True, True),
        (False, OTHERS, False, False),
        (True, OTHERS, False, False),
        (False, RESERVING, False, False),
        (True, RESERVING, False, True),
        (True, RESERVING, True, False),
        (True, replace(RESERVING, priority=3), False, True),
    ],
)
def test_waiting_is_for_what_will_come_and_in_no_circle(
    patient: bool, holder: Holder | None, later: bool, expected: bool
) -> None:
    held = {CONTROL: Held({}, reserved=True), TRACKER: Held({}, reserved=later)}
    assert may_wait_for(State(patient=patient, held=held), DRIVE, holder) is expected


def reserving(patient: bool = False, priority: int = 0) -> History:
    """A task asks for its first component."""
    history = History(replace(PATIENT if patient else TASK, priority=priority)).accepted()
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    return history


@pytest.mark.parametrize("answer", [None, Verdict.BUSY])
def test_what_was_asked_before_a_deployment_began_anew_may_be_held_until_it_answers(answer: Verdict | None) -> None:
    history = reserving(patient=True)
    history.answer(CONTROL, Call.RESERVE)
    if answer is not None:
        history.busy(DRIVE, RESERVING)
    history.hear(Failed(CONTROL, "1", Cause.CRASH))
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    effects = history.busy(CONTROL, RESERVING)
    assert kinds(effects) == ([ReleaseFrom, Compose] if answer is None else [AwaitRelease])


@pytest.mark.parametrize("obeyed", [True, False])
def test_what_has_not_obeyed_its_release_may_be_held_in_the_next_deployment(obeyed: bool) -> None:
    history = reserving(patient=True)
    history.answer(CONTROL, Call.RESERVE)
    history.hear(Failed(CONTROL, "1", Cause.LET_GO))
    for component in (CONTROL, DRIVE, TRACKER):
        if (component, Call.RELEASE) in history.state.pending:
            kept = component == DRIVE and not obeyed
            history.answer(component, Call.RELEASE, Unanswered.SILENT if kept else Verdict.DONE)
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    effects = history.busy(CONTROL, RESERVING)
    assert kinds(effects) == ([AwaitRelease] if obeyed else [ReleaseFrom, Compose])


def test_a_component_of_a_task_of_lower_priority_is_waited_for() -> None:
    history = reserving()
    epoch = history.state.epoch
    assert history.busy(CONTROL, LOWER) == [AwaitRelease(CONTROL, epoch)]
    assert history.state.phase is Phase.RESERVING
    assert reserved(history.hear(WaitedLong(CONTROL, epoch))) == [CONTROL]
    assert history.busy(CONTROL, LOWER) == [AwaitRelease(CONTROL, epoch)]
    assert reserved(history.hear(Freed(CONTROL))) == [CONTROL]
    assert reserved(history.answer(CONTROL, Call.RESERVE)) == [DRIVE]


def test_a_component_that_is_never_taken_from_a_task_of_lower_priority_is_given_up() -> None:
    history = reserving()
    for _ in range(MOST_ASKED):
        assert kinds(history.busy(CONTROL, LOWER)) == [AwaitRelease]
        history.hear(WaitedLong(CONTROL, history.state.epoch))
    history.busy(CONTROL, LOWER)
    assert history.state.lost[CONTROL].busy


def test_a_component_that_was_waited_for_is_asked_again_only_while_it_is_waited_for() -> None:
    history = reserving()
    epoch = history.state.epoch
    history.busy(CONTROL, LOWER)
    assert history.hear(WaitedLong(CONTROL, epoch - 1)) == []
    assert history.hear(WaitedLong(DRIVE, epoch)) == []
    history.answer(CONTROL, Call.RESERVE)
    assert history.hear(WaitedLong(CONTROL, epoch)) == []


def test_a_task_that_is_about_to_act_is_waited_for_by_a_patient_one_until_it_acts() -> None:
    history = reserving(patient=True)
    assert kinds(history.busy(CONTROL, RESERVING)) == [AwaitRelease]
    history.hear(WaitedLong(CONTROL, history.state.epoch))
    effects = history.busy(CONTROL, OTHERS)
    assert released(effects) == [CONTROL]
    assert effects[-1] == Compose(2, frozenset({CONTROL}), navigation())
    assert history.state.lost[CONTROL].busy


@pytest.mark.parametrize("priority", [0, 1])
def test_a_task_holds_nothing_while_it_waits_for_what_is_kept_for_one_that_goes_before(priority: int) -> None:
    """That one may need it: else both would wait until the component is kept for the first no more."""
    history = reserving(patient=True, priority=priority)
    assert kinds(history.busy(CONTROL, KEPT)) == [AwaitRelease], "it holds nothing yet"
    history.hear(WaitedLong(CONTROL, history.state.epoch))
    history.answer(CONTROL, Call.RESERVE)
    history.busy(DRIVE, KEPT)
    assert history.state.lost[DRIVE].busy


def test_a_task_that_runs_waits_for_what_is_kept_for_one_that_goes_before() -> None:
    history = History(replace(TASK, patient=True)).running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    history.composed(navigation(ODOMETRY))
    history.answer(ODOMETRY, Call.WAKE)
    history.busy(ODOMETRY, KEPT, Call.APPLY)
    assert ODOMETRY not in history.state.lost


def test_a_repair_whose_only_lack_is_held_by_a_task_of_lower_priority_waits_for_it() -> None:
    history = lost_tracker()
    history.answer(ODOMETRY, Call.WAKE)
    assert history.busy(ODOMETRY, LOWER, Call.APPLY)[-1] == WakeUp(ODOMETRY, history.state.epoch)
    assert ODOMETRY not in history.state.lost
    assert reserved(history.answer(ODOMETRY, Call.WAKE)) == [ODOMETRY]
    assert kinds(history.busy(ODOMETRY, LOWER)) == [AwaitRelease]
    history.hear(Freed(ODOMETRY))
    assert applied(history.answer(ODOMETRY, Call.RESERVE)) == [ODOMETRY]
    assert applied(history.answer(ODOMETRY, Call.APPLY)) == [CONTROL]
    assert history.all_answer() == [Running(navigation(ODOMETRY))]


def test_what_is_given_up_while_it_was_waited_for_does_not_remember_that_this_task_waits() -> None:
    history = reserving(patient=True)
    history.busy(CONTROL, RESERVING)
    assert history.state.queued == {CONTROL}
    history.hear(WaitedLong(CONTROL, history.state.epoch))
    assert released(history.busy(CONTROL, OTHERS)) == [CONTROL]
    assert history.state.queued == frozenset()


def test_a_search_that_ends_while_everything_runs_changes_nothing_if_it_finds_nothing_else() -> None:
    history = History(TASK).running()
    for outcome in (navigation(), REFUSAL):
        history.hear(Improvable(), Discovered())
        assert history.hear(Composed(history.state.attempt, outcome)) == []
        assert history.state.phase is Phase.RUNNING


def test_what_is_free_and_held_from_before_but_not_wanted_any_more_is_left_to_its_release() -> None:
    history = History().accepted()
    history.composed(navigation())
    assert any(call is Call.WAKE for _, call in history.state.pending)
    history.state = replace(history.state, held={**history.state.held, ODOMETRY: Held({}, asked=True)})
    assert history.hear(Freed(ODOMETRY)) == []
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert ODOMETRY not in history.state.held
