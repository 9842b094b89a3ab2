"""What crashed counts before a task is refused for lack of it, if its site starts it or it comes back in time."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.effects import AwaitReturn, Compose, Discover, Finish, ReleaseFrom, WakeUp
from selfconf.configurator.events import (
    Answered,
    Appeared,
    Call,
    Discovered,
    Event,
    Failed,
    Freed,
    Reconnected,
    StayedAway,
    Unanswered,
)
from selfconf.configurator.state import MOST_PUT_OFF, Phase, State
from selfconf.protocol.messages import Cause, Verdict
from tests.configurator.builders import (
    CONTROL,
    DRIVE,
    ODOMETRY,
    OTHERS,
    REFUSAL,
    TASK,
    TRACKER,
    History,
    navigation,
    released,
)


def lost(cause: Cause = Cause.CRASH, startable: bool = True, patient: bool = False) -> History:
    """The tracker of a running task is lost, and the search without it is going on."""
    history = History(State(patient=patient)).running()
    history.hear(Failed(TRACKER, "1", cause, "it is gone", startable))
    assert history.effects[-1] == Compose(history.state.attempt, frozenset({TRACKER}), history.state.target)
    return history


@pytest.mark.parametrize("cause", [Cause.CRASH, Cause.HUNG])
@pytest.mark.parametrize("patient", [False, True])
def test_what_can_be_started_again_is_searched_with_before_the_task_is_refused(cause: Cause, patient: bool) -> None:
    history = lost(cause, patient=patient)
    effects = history.composed(REFUSAL)
    assert effects == [Compose(history.state.attempt, frozenset(), history.state.target)]
    effects = history.composed(navigation())
    assert [effect.component for effect in effects if isinstance(effect, WakeUp)] == [TRACKER]
    assert not [effect for effect in effects if isinstance(effect, ReleaseFrom)]
    assert {CONTROL, DRIVE} < set(history.state.held)
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert not history.state.owed


def test_another_candidate_that_is_there_comes_first() -> None:
    history = lost()
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert TRACKER in history.state.lost


@pytest.mark.parametrize("cause", [Cause.FAIL, Cause.SILENCE, Cause.MALFORMED])
def test_what_can_be_started_but_says_that_it_cannot_act_is_not_asked_again(cause: Cause) -> None:
    history = lost(cause)
    history.composed(REFUSAL)
    assert history.state.phase is Phase.DISMANTLING


@pytest.mark.parametrize("cause", [Cause.FAIL, Cause.SILENCE, Cause.MALFORMED])
@pytest.mark.parametrize(("life", "startable"), [("1", True), ("1", False), ("0", True)])
def test_what_cannot_act_is_searched_with_once_its_life_has_ended_if_its_site_can_start_it(
    cause: Cause, life: str, startable: bool
) -> None:
    history = lost(cause)
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    assert history.hear(Failed(TRACKER, life, Cause.CRASH, "its life has ended", startable)) == []
    assert history.state.phase is Phase.RUNNING
    history.hear(Failed(ODOMETRY, "1", Cause.FAIL, "it slips", startable=True))
    history.composed(REFUSAL)
    if startable and life == "1":
        assert history.effects[-1] == Compose(history.state.attempt, frozenset({ODOMETRY}), history.state.target)
    elif cause is Cause.SILENCE and life == "1":
        assert history.state.awaits_return, "it may have been cut off, with all that it issued"
    else:
        assert history.state.phase is Phase.DISMANTLING


def test_what_went_with_its_site_is_searched_with_when_that_is_back() -> None:
    history = lost(startable=False, patient=True)
    history.composed(REFUSAL)
    history.all_answer(Call.RELEASE)
    assert history.state.phase is Phase.REFUSED
    assert history.hear(Appeared({})) == [Discover()]
    history.hear(Failed(TRACKER, "1", Cause.CRASH, "its life has ended", startable=True))
    history.hear(Discovered())
    assert history.composed(REFUSAL) == [Compose(history.state.attempt, frozenset(), None)]


def test_what_could_not_be_reached_stays_lost_when_another_component_appears() -> None:
    history = lost(patient=True)
    history.composed(navigation(ODOMETRY))
    history.all_answer(Call.WAKE, Call.RESERVE)
    history.answer(ODOMETRY, Call.APPLY, Unanswered.SILENT)
    assert ODOMETRY in history.state.lost
    history.hear(Appeared({DRIVE: "2"}))
    assert ODOMETRY in history.state.lost
    history.hear(Appeared({}))
    assert ODOMETRY not in history.state.lost, "its site may have been cut off with it"


def test_a_component_that_another_task_had_and_that_ends_before_this_one_has_it_is_lost() -> None:
    history = History(TASK).accepted()
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    history.busy(CONTROL)
    history.hear(Freed(CONTROL))
    history.composed(navigation())
    assert (CONTROL, Call.WAKE) in history.state.pending
    history.hear(Failed(CONTROL, "1", Cause.CRASH))
    assert CONTROL in history.state.lost


def out_of_sight() -> History:
    """The tracker, which no site can start, has gone without a word, and nothing can be had instead."""
    history = lost(startable=False)
    assert history.composed(REFUSAL) == [AwaitReturn(history.state.attempt)]
    return history


def test_what_no_site_can_start_may_have_been_cut_off_and_back_in_a_moment() -> None:
    history = out_of_sight()
    assert history.hear(Appeared({TRACKER: "1"}))[-1] == Discover()
    assert history.hear(Discovered())[-1] == Compose(history.state.attempt, frozenset(), history.state.target)
    history.hear(StayedAway(history.state.attempt - 2))
    assert not history.state.has_awaited_return
    history.composed(navigation())
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert {CONTROL, DRIVE} < set(history.state.held)
    assert not history.state.owed


@pytest.mark.parametrize("found", [True, False])
def test_others_may_have_let_go_of_something_while_what_was_lost_stayed_away(found: bool) -> None:
    history = out_of_sight()
    since = history.state.attempt
    history.hear(Appeared({}), Discovered({ODOMETRY: OTHERS}))
    assert history.composed(REFUSAL) == []
    assert history.hear(StayedAway(since)) == [Discover()]
    history.hear(Discovered({} if found else {ODOMETRY: OTHERS}))
    history.composed(navigation(ODOMETRY) if found else REFUSAL)
    if not found:  # it is not waited for any longer
        history.composed(REFUSAL)
    history.all_answer()
    assert history.state.phase is (Phase.RUNNING if found else Phase.REFUSED)


def test_what_comes_after_a_wait_in_vain_while_the_ecology_is_asked_once_more_counts() -> None:
    history = out_of_sight()
    since = history.state.attempt
    history.hear(Appeared({}), Discovered({ODOMETRY: OTHERS}))
    history.composed(REFUSAL)
    history.hear(StayedAway(since), Appeared({}), Discovered({ODOMETRY: OTHERS}))
    history.hear(Appeared({TRACKER: "2"}))
    assert history.composed(REFUSAL) == [Discover()]
    history.hear(Discovered({ODOMETRY: OTHERS}))
    history.composed(navigation())
    history.all_answer()
    assert history.state.phase is Phase.RUNNING


def test_what_has_not_come_back_in_time_is_a_reason_to_refuse() -> None:
    history = out_of_sight()
    history.hear(StayedAway(history.state.attempt))
    history.all_answer()
    assert history.state.phase is Phase.REFUSED
    assert history.effects[-1] == Finish(REFUSAL)


@pytest.mark.parametrize("patient", [False, True])
def test_what_is_held_and_not_advertised_any_more_goes_on(patient: bool) -> None:
    history = History(State(patient=patient)).running()
    history.hear(Reconnected(), Discovered(unseen=True))
    history.composed(REFUSAL)
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert history.state.target == navigation()


def test_what_is_lost_while_something_is_not_advertised_any_more_may_be_so_for_a_moment() -> None:
    history = History(State()).running()
    history.hear(Reconnected(), Failed(TRACKER, "", Cause.FAIL, "lost"), Discovered(unseen=True))
    assert history.composed(REFUSAL) == [AwaitReturn(history.state.attempt)]
    assert history.hear(Appeared({}))[-1] == Discover()
    history.hear(Discovered())
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    assert history.state.phase is Phase.RUNNING


@pytest.mark.parametrize("is_asked", [False, True])
def test_what_was_lost_is_waited_for_as_long_whatever_comes_and_goes(is_asked: bool) -> None:
    history = out_of_sight()
    since = history.state.attempt
    for _ in range(2 * MOST_PUT_OFF):
        history.hear(Appeared({ODOMETRY: "1"}), Discovered())
        assert history.composed(REFUSAL) == []
    if is_asked:
        history.hear(Appeared({ODOMETRY: "1"}))
        assert history.hear(StayedAway(since)) == []
        history.hear(Discovered())
        assert history.composed(REFUSAL) == [Discover()]  # what was asked meanwhile may have been answered before
        history.hear(Discovered())
        history.composed(REFUSAL)
    else:
        history.hear(StayedAway(since))
    assert history.state.phase is Phase.DISMANTLING


def test_what_was_lost_is_waited_for_though_very_much_has_appeared_at_once() -> None:
    history = lost(startable=False)
    for _ in range(MOST_PUT_OFF):
        history.hear(Appeared({ODOMETRY: "1"}))
        assert history.composed(REFUSAL) == [Discover()]
        history.hear(Discovered())
    assert history.composed(REFUSAL) == [AwaitReturn(history.state.attempt)]


@pytest.mark.parametrize("event", [Failed(CONTROL, "1", Cause.CRASH), Failed(CONTROL, "1", Cause.YIELD), Reconnected()])
def test_the_wait_for_what_was_lost_begins_anew_with_another_loss_and_after_this_node_was_cut_off(event: Event) -> None:
    history = out_of_sight()
    since = history.state.attempt
    history.hear(event)
    history.all_answer(Call.RELEASE)
    effects = [] if history.state.phase is Phase.DISCOVERING else history.composed(REFUSAL)
    if history.state.phase is Phase.DISCOVERING:
        history.hear(Discovered())
        effects = history.composed(REFUSAL)
    assert effects == [AwaitReturn(history.state.attempt)]
    assert history.hear(StayedAway(since)) == []
    assert history.state.phase is Phase.COMPOSING


@pytest.mark.parametrize("state", [State(patient=True), State(inside=True)])
def test_where_a_refusal_is_no_end_it_is_not_put_off(state: State) -> None:
    """A task that waits lets go of what it holds meanwhile, and what a composite is part of may do without it."""
    history = History(state).running()
    history.hear(Failed(TRACKER, "1", Cause.CRASH, "it is gone"))
    history.composed(REFUSAL)
    history.all_answer()
    assert history.state.phase is Phase.REFUSED
    assert not history.state.held


def test_what_its_site_starts_no_more_is_a_reason_to_refuse() -> None:
    history = lost()
    history.composed(REFUSAL)
    history.composed(navigation())
    history.answer(TRACKER, Call.WAKE, Unanswered.NOT_STARTED)
    assert not history.state.lost[TRACKER].startable
    history.composed(REFUSAL)
    history.all_answer()
    assert history.state.phase is Phase.REFUSED
    assert history.effects[-1] == Finish(REFUSAL)


def test_what_has_gone_with_its_site_may_be_cut_off_and_is_waited_for_a_moment() -> None:
    history = lost()
    history.composed(REFUSAL)
    history.composed(navigation())
    history.answer(TRACKER, Call.WAKE, Unanswered.SITE_UNSEEN)
    assert (history.state.lost[TRACKER].cause, history.state.lost[TRACKER].answered) == (Cause.CRASH, False)
    since = history.state.attempt
    assert history.composed(REFUSAL) == [AwaitReturn(since)]
    assert history.hear(Appeared({TRACKER: "1"}))[-1] == Discover()
    assert TRACKER not in history.state.lost


def test_what_was_silent_before_its_life_seemed_to_end_was_cut_off_also_if_its_site_could_start_it() -> None:
    history = lost(Cause.SILENCE)
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    history.hear(Failed(TRACKER, "1", Cause.CRASH, "its life has ended", startable=True))
    assert history.state.lost[TRACKER].startable
    history.hear(Appeared({TRACKER: "1"}))
    assert TRACKER not in history.state.lost


def test_what_was_not_there_before_is_not_waited_for_where_its_site_cannot_be_reached() -> None:
    history = History().accepted()
    history.composed(navigation())
    history.answer(TRACKER, Call.WAKE, Unanswered.SITE_UNSEEN)
    assert history.state.lost[TRACKER].cause is Cause.REFUSED
    history.composed(REFUSAL)
    assert history.state.phase is Phase.DISMANTLING


@pytest.mark.parametrize("call", [Call.RESERVE, Call.APPLY])
@pytest.mark.parametrize("startable", [True, False])
def test_what_says_that_its_life_is_over_is_searched_with_if_its_site_can_start_it(call: Call, startable: bool) -> None:
    history = History().accepted()
    history.composed(navigation())
    while (TRACKER, call) not in history.state.pending:
        history.answer(*min(history.state.pending))
    over = Answered(TRACKER, call, history.state.epoch, Verdict.OTHER_LIFE, "1", detail="it ends", startable=startable)
    history.hear(over)
    assert (history.state.lost[TRACKER].cause, history.state.lost[TRACKER].detail) == (Cause.CRASH, "it ends")
    again = Compose(history.state.attempt + 1, frozenset(), history.state.target)
    assert history.composed(REFUSAL) == [again if startable else AwaitReturn(history.state.attempt)]


def silent(history: History, call: Call, why: Unanswered = Unanswered.SILENT) -> None:
    """The tracker, which its site can start, does not answer a call."""
    while (TRACKER, call) not in history.state.pending:
        history.answer(*min(history.state.pending))
    history.hear(Answered(TRACKER, call, history.state.epoch, why, startable=True))


def test_the_end_of_a_life_that_hangs_is_heeded_where_it_was_to_be_reserved_and_does_not_answer() -> None:
    history = lost(Cause.HUNG)
    history.composed(REFUSAL)
    history.composed(navigation())
    ended = Failed(TRACKER, "1", Cause.CRASH, "its life has ended", True)
    assert history.hear(ended) == [WakeUp(TRACKER, history.state.epoch)]
    history.state = replace(history.state, pending=frozenset({(TRACKER, Call.RESERVE)}))
    history.hear(ended)
    loss = history.state.lost[TRACKER]
    assert (loss.cause, loss.life, loss.again, loss.startable) == (Cause.HUNG, "1", True, True)
    assert history.state.phase is Phase.COMPOSING


def test_the_end_of_a_life_whose_site_is_gone_is_a_loss_of_its_own() -> None:
    history = lost(Cause.HUNG)
    history.composed(REFUSAL)
    history.composed(navigation())
    history.state = replace(history.state, pending=frozenset({(TRACKER, Call.RESERVE)}))
    history.hear(Failed(TRACKER, "1", Cause.CRASH, "its life has ended"))
    loss = history.state.lost[TRACKER]
    assert (loss.cause, loss.again, loss.lasts) == (Cause.CRASH, False, False)


@pytest.mark.parametrize("call", [Call.RESERVE, Call.APPLY])
def test_a_life_that_does_not_answer_is_called_once_more_as_its_site_ends_it_meanwhile(call: Call) -> None:
    history = History().accepted()
    history.composed(navigation())
    silent(history, call)
    assert released(history.effects[-2:]) == [TRACKER]
    assert history.composed(REFUSAL) == [Compose(history.state.attempt, frozenset(), history.state.target)]
    history.composed(navigation())
    silent(history, Call.RESERVE)
    history.composed(REFUSAL)
    assert history.state.phase is Phase.DISMANTLING


def test_each_life_that_does_not_answer_is_followed_by_another_as_often_as_its_site_starts_it() -> None:
    history = History().accepted()
    history.composed(navigation())
    for _ in range(3):
        silent(history, Call.RESERVE)
        history.composed(REFUSAL)
        history.composed(navigation())
        history.all_answer(Call.WAKE)
        history.hear(Failed(TRACKER, "", Cause.CRASH, "its life has ended", True))
        history.composed(REFUSAL)
        history.composed(navigation())
        assert (TRACKER, Call.WAKE) in history.state.pending
    history.all_answer()
    assert history.state.phase is Phase.RUNNING


def test_a_site_that_does_not_start_what_it_can_start_is_not_asked_again() -> None:
    history = History().accepted()
    history.composed(navigation())
    silent(history, Call.WAKE, Unanswered.NOT_STARTED)
    history.composed(REFUSAL)
    assert history.state.phase is Phase.DISMANTLING


def test_what_crashes_again_while_it_is_waited_for_is_started_again_as_often_as_its_site_does() -> None:
    history = lost()
    for _ in range(3):
        history.composed(REFUSAL)
        history.composed(navigation())
        assert (TRACKER, Call.WAKE) in history.state.pending
        history.hear(Failed(TRACKER, "", Cause.CRASH, "it is gone again", True))
    history.composed(REFUSAL)
    history.composed(navigation())
    history.all_answer()
    assert history.state.phase is Phase.RUNNING


def broke(cause: Cause = Cause.CRASH) -> History:
    """The tracker was lost before it acted, and lives again, while odometry is being started in its place."""
    history = History(TASK).accepted()
    history.composed(navigation())
    history.all_answer(Call.WAKE, Call.RESERVE)
    history.hear(Failed(TRACKER, "1", cause, "it broke in started", startable=True))
    history.composed(navigation(ODOMETRY))
    history.hear(Appeared({TRACKER: "2"}))
    return history


@pytest.mark.parametrize("cause", [Cause.CRASH, Cause.HUNG])
def test_what_broke_before_it_acted_is_not_tried_again_before_the_rest_was_tried(cause: Cause) -> None:
    history = broke(cause)
    history.all_answer(Call.WAKE, Call.RESERVE)
    history.hear(Failed(ODOMETRY, "1", cause, "it broke in started", startable=True))
    assert history.effects[-1] == Compose(
        history.state.attempt, frozenset({TRACKER, ODOMETRY}), history.state.target
    ), "two that break in turn would be tried for ever, and a third one never"
    assert history.composed(REFUSAL) == [Compose(history.state.attempt, frozenset(), history.state.target)]


def test_what_broke_before_it_acted_and_lives_again_counts_once_the_task_runs() -> None:
    history = broke()
    assert TRACKER in history.state.lost
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert TRACKER not in history.state.lost


def test_what_acted_before_it_crashed_counts_as_soon_as_it_lives_again() -> None:
    history = lost()
    history.composed(navigation(ODOMETRY))
    history.hear(Appeared({TRACKER: "2"}))
    assert TRACKER not in history.state.lost


def test_what_was_silent_before_its_life_seemed_to_end_may_have_been_cut_off_and_back_in_a_moment() -> None:
    history = lost(Cause.SILENCE, startable=False)
    history.hear(Failed(TRACKER, "1", Cause.CRASH, "its life has ended"))
    assert history.state.lost[TRACKER].cause is Cause.CRASH
    assert history.composed(REFUSAL) == [AwaitReturn(history.state.attempt)]
    assert history.hear(Appeared({TRACKER: "1"}))[-1] == Discover()
    assert TRACKER not in history.state.lost
