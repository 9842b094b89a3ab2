"""The four acts as sentences: what the configurator wants done, step by step; act 4 itself is in `test_deploying`."""

from __future__ import annotations

import pytest

from selfconf.configurator.effects import (
    ApplyTo,
    Compose,
    Discover,
    ReleaseFrom,
    ReserveOf,
    Running,
    Unwatch,
    WakeUp,
    Watch,
)
from selfconf.configurator.events import (
    Accepted,
    Answered,
    Appeared,
    Call,
    Composed,
    Discovered,
    Failed,
    Reconnected,
    Stopped,
    Unanswered,
)
from selfconf.configurator.state import Phase
from selfconf.protocol.messages import Cause, Verdict
from tests.configurator.builders import (
    ARM,
    CONTROL,
    DISMANTLE,
    DRIVE,
    ODOMETRY,
    OTHERS,
    REFUSAL,
    TASK,
    TRACKER,
    History,
    applied,
    kinds,
    navigation,
    released,
    reserved,
)

# The four acts.


def test_a_task_goes_through_the_four_acts() -> None:
    history = History()
    assert kinds(history.hear(Accepted(100))) == [Discover]
    assert history.hear(Discovered()) == [Compose(1, frozenset(), None)]
    assert kinds(history.composed(navigation())) == [Watch] * 3 + [WakeUp] * 3
    assert kinds(history.all_answer()) == [Running]
    assert kinds(history.effects[-7:]) == [ReserveOf] * 3 + [ApplyTo] * 3 + [Running]
    assert history.state.phase is Phase.RUNNING


def test_the_epoch_starts_above_the_one_it_was_given_and_goes_with_every_call() -> None:
    history = History().running()
    calls = [effect for effect in history.effects if isinstance(effect, WakeUp | ReserveOf | ApplyTo)]
    assert {effect.epoch for effect in calls} == {history.state.epoch} == {101}


def test_a_second_task_is_passed_over_while_there_is_one() -> None:
    history = History().running()
    assert history.hear(Accepted(999)) == []


def test_the_result_of_an_older_search_is_passed_over() -> None:
    history = History().accepted()
    assert history.hear(Composed(history.state.attempt - 1, navigation())) == []
    assert history.state.phase is Phase.COMPOSING


# Refusals of components.


@pytest.mark.parametrize("call", [Call.RESERVE, Call.APPLY])
@pytest.mark.parametrize("verdict", [Verdict.REFUSED, Verdict.BUSY, Unanswered.SILENT])
def test_a_component_that_will_not_be_had_is_dropped_and_the_search_runs_again(
    call: Call, verdict: Verdict | Unanswered
) -> None:
    history = History(TASK).reserved() if call is Call.APPLY else History(TASK).accepted()
    if call is Call.RESERVE:
        history.composed(navigation())
        history.all_answer(Call.WAKE)
        history.answer(CONTROL, Call.RESERVE)
        history.answer(DRIVE, Call.RESERVE)
    effects = history.answer(TRACKER, call, verdict, holder=OTHERS)
    assert released(effects) == [TRACKER]
    assert effects[-1] == Compose(2, frozenset({TRACKER}), navigation())
    loss = history.state.lost[TRACKER]
    assert (loss.cause, loss.busy, loss.answered) == (
        Cause.REFUSED,
        verdict is Verdict.BUSY,
        isinstance(verdict, Verdict),
    )
    history.composed(navigation(ODOMETRY))
    assert reserved(history.answer(ODOMETRY, Call.WAKE)) == [ODOMETRY]
    assert applied(history.answer(ODOMETRY, Call.RESERVE)) == [ODOMETRY]
    assert kinds(history.all_answer()) == [Running]


# Losses.


def test_after_a_failure_the_rest_is_kept() -> None:
    history = History(TASK).running()
    effects = history.hear(Failed(TRACKER, "1", Cause.FAIL, "lost her"))
    assert released(effects) == [TRACKER]
    assert effects[-1] == Compose(2, frozenset({TRACKER}), navigation())
    effects = history.composed(navigation(ODOMETRY))
    assert effects == [Watch(ODOMETRY), WakeUp(ODOMETRY, history.state.epoch), Unwatch(TRACKER)]
    effects = history.answer(ODOMETRY, Call.WAKE)
    assert applied(effects) == [ODOMETRY, CONTROL]
    assert history.all_answer() == [Running(navigation(ODOMETRY))]
    assert released(history.effects) == [TRACKER]
    assert history.state.target == navigation(ODOMETRY)


def test_dismantling_releases_all_components_before_the_search_sinks_first() -> None:
    history = History(DISMANTLE).running()
    effects = history.hear(Failed(TRACKER, "1", Cause.FAIL))
    assert kinds(effects) == [Unwatch] * 3 + [ReleaseFrom]
    assert released(effects) == [DRIVE]
    assert released(history.answer(DRIVE, Call.RELEASE)) == [CONTROL]
    assert released(history.answer(CONTROL, Call.RELEASE)) == [TRACKER]
    assert history.answer(TRACKER, Call.RELEASE) == [Compose(2, frozenset({TRACKER}), None)]
    history.composed(navigation(ODOMETRY))
    assert history.state.pending == {(ODOMETRY, Call.WAKE), (CONTROL, Call.WAKE), (DRIVE, Call.WAKE)}
    assert history.all_answer()[-1] == Running(navigation(ODOMETRY))


def test_a_component_that_seems_to_have_crashed_is_released_and_owed_that_until_it_obeys() -> None:
    history = History().running()
    assert released(history.hear(Failed(TRACKER, "1", Cause.CRASH))) == [TRACKER]
    history.hear(Answered(TRACKER, Call.RELEASE, history.state.owed[TRACKER], Unanswered.SILENT))
    assert TRACKER in history.state.owed


def test_the_failure_of_an_earlier_life_is_passed_over() -> None:
    history = History().running()
    assert history.hear(Failed(TRACKER, "0", Cause.FAIL)) == []
    assert history.state.phase is Phase.RUNNING


@pytest.mark.parametrize("cause", [Cause.CRASH, Cause.HUNG])
def test_a_process_that_has_ended_without_a_life_is_none_of_a_component_that_lives(cause: Cause) -> None:
    """Its site has started a second one, which leaves as the component lives already, and at last is given up."""
    history = History().running()
    assert history.hear(Failed(TRACKER, "", cause, startable=True)) == []
    assert history.state.phase is Phase.RUNNING


def test_the_end_of_a_life_that_is_told_by_its_site_and_by_its_token_is_one_loss() -> None:
    history = History(TASK).running()
    history.hear(Failed(TRACKER, "1", Cause.CRASH, startable=True))
    history.composed(REFUSAL)
    history.composed(navigation())
    assert (TRACKER, Call.WAKE) in history.state.pending
    again = history.hear(Failed(TRACKER, "1", Cause.CRASH, startable=True))
    assert again == [WakeUp(TRACKER, history.state.epoch)], "its site may have thought that it runs still"
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert history.hear(Failed(TRACKER, "1", Cause.CRASH)), "a failure of the life that is held now counts"


def test_the_failure_of_a_stranger_is_passed_over() -> None:
    history = History().running()
    assert history.hear(Failed(ODOMETRY, "1", Cause.FAIL)) == []


def test_a_component_that_dies_during_deployment_is_replaced() -> None:
    history = History().reserved()
    history.answer(TRACKER, Call.APPLY)
    assert history.hear(Failed(TRACKER, "1", Cause.CRASH))[-1] == Compose(2, frozenset({TRACKER}), navigation())
    history.composed(navigation(ODOMETRY))
    assert kinds(history.all_answer()) == [Running]


def test_the_silence_of_a_component_that_has_not_begun_is_no_loss() -> None:
    history = History().reserved()
    assert history.hear(Failed(TRACKER, "", Cause.SILENCE)) == []
    history.answer(TRACKER, Call.APPLY)
    assert released(history.hear(Failed(TRACKER, "", Cause.SILENCE))) == [TRACKER]


def test_a_release_has_a_newer_epoch_than_the_call_that_activated() -> None:
    """Else that call, doubled and late, would activate the component again."""
    history = History().running()
    applied_with = history.state.epoch
    effects = history.hear(Failed(TRACKER, "1", Cause.FAIL))
    assert [effect.epoch > applied_with for effect in effects if isinstance(effect, ReleaseFrom)] == [True]


# What comes back.


def test_a_new_life_of_a_lost_component_is_not_the_one_that_was_lost() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    history.hear(Appeared({TRACKER: "1"}))
    assert TRACKER in history.state.lost
    history.hear(Appeared({TRACKER: "2"}))
    assert TRACKER not in history.state.lost


def test_a_component_that_seemed_dead_and_lives_was_only_cut_off_and_is_released_again() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.CRASH))
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    effects = history.hear(Appeared({TRACKER: "1"}))
    assert released(effects) == [TRACKER]
    assert TRACKER not in history.state.lost
    assert history.hear(Answered(TRACKER, Call.RELEASE, history.state.owed[TRACKER], Verdict.DONE)) == []
    assert not history.state.owed
    assert history.hear(Appeared({TRACKER: "1"})) == []


def test_of_what_has_not_obeyed_its_release_only_what_appears_is_released_again() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.CRASH))
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    assert history.hear(Appeared({ARM: "1"})) == []
    assert history.state.owed.keys() == {TRACKER}


def test_a_component_that_is_applied_to_again_is_owed_no_release() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.CRASH), Appeared({TRACKER: "1"}))
    history.composed(navigation())
    assert not history.state.owed
    assert history.hear(Appeared({TRACKER: "1"})) == []


def test_a_release_that_could_not_be_delivered_stays_owed() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    epoch = history.state.owed[TRACKER]
    history.hear(Answered(TRACKER, Call.RELEASE, epoch, Unanswered.SILENT))
    assert TRACKER in history.state.owed
    history.hear(Answered(TRACKER, Call.RELEASE, epoch - 1, Verdict.DONE))
    assert TRACKER in history.state.owed
    history.hear(Answered(TRACKER, Call.RELEASE, epoch, Verdict.BUSY))
    assert TRACKER in history.state.owed  # an older call to activate it may still be on the way
    history.hear(Answered(TRACKER, Call.RELEASE, epoch, Verdict.STALE))
    assert not history.state.owed


def test_after_being_cut_off_all_components_are_applied_to_anew_in_order() -> None:
    history = History(TASK).running()
    assert history.hear(Reconnected()) == [Discover()]
    history.hear(Discovered())
    assert applied(history.composed(navigation())) == [TRACKER]
    assert applied(history.answer(TRACKER, Call.APPLY)) == [CONTROL]
    assert applied(history.answer(CONTROL, Call.APPLY)) == [DRIVE]
    history.answer(DRIVE, Call.APPLY, Verdict.NOT_HELD)  # it has turned itself off meanwhile
    assert kinds(history.all_answer()) == [Running]


def test_after_being_cut_off_during_deployment_it_begins_anew() -> None:
    history = History(TASK).reserved()
    assert history.hear(Reconnected()) == [Discover()]
    assert history.answer(TRACKER, Call.APPLY) == []
    history.hear(Discovered())
    assert applied(history.composed(navigation())) == [TRACKER]
    assert kinds(history.all_answer()) == [Running]


def test_two_that_fail_at_once_are_both_dropped() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL), Failed(DRIVE, "1", Cause.FAIL))
    assert set(history.state.lost) == {TRACKER, DRIVE}
    assert history.effects[-1] == Compose(3, frozenset({TRACKER, DRIVE}), navigation())


def test_a_component_that_appears_while_everything_is_taken_down_comes_to_rest_in_its_turn() -> None:
    history = History(TASK).running()
    history.hear(Stopped())
    assert history.hear(Appeared({TRACKER: "1", DRIVE: "1"})) == [ReleaseFrom(DRIVE, history.state.epoch)]


def test_a_life_that_had_begun_before_the_call_was_meant_for_the_last_one_counts_when_it_is_heard_of() -> None:
    history = History(TASK).reserved()
    history.answer(TRACKER, Call.APPLY, Verdict.OTHER_LIFE, life="2")
    history.hear(Failed(TRACKER, "1", Cause.CRASH), Appeared({TRACKER: "2"}))
    assert TRACKER not in history.state.lost
