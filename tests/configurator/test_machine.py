"""The four acts as sentences: what the configurator wants done, step by step; act 4 itself is in `test_deploying`."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.effects import (
    ApplyTo,
    Compose,
    Decline,
    Discover,
    Finish,
    QueueFor,
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
    Freed,
    Improvable,
    Ranked,
    Reconnected,
    Stopped,
)
from selfconf.configurator.machine import MOST_REPEATS
from selfconf.configurator.state import MOST_PUT_OFF, Phase, Policy, State
from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Verdict
from tests.configurator.builders import (
    CONTROL,
    DRIVE,
    ODOMETRY,
    OTHERS,
    REFUSAL,
    TRACKER,
    History,
    applied,
    kinds,
    navigation,
    released,
    reserved,
    state_in,
)

DISMANTLE = State(policy=Policy.DISMANTLE, task="go~1")
PATIENT = State(patient=True, task="go~1")
TASK = State(task="go~1")
HIGHER, LOWER = replace(OTHERS, priority=1), replace(OTHERS, priority=-1)


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
@pytest.mark.parametrize("verdict", [Verdict.REFUSED, Verdict.BUSY, None])
def test_a_component_that_will_not_be_had_is_dropped_and_the_search_runs_again(
    call: Call, verdict: Verdict | None
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
    assert (loss.cause, loss.busy, loss.answered) == (Cause.REFUSED, verdict is Verdict.BUSY, verdict is not None)
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
    history.hear(Answered(TRACKER, Call.RELEASE, history.state.owed[TRACKER], None))
    assert TRACKER in history.state.owed


def test_the_failure_of_an_earlier_life_is_passed_over() -> None:
    history = History().running()
    assert history.hear(Failed(TRACKER, "0", Cause.FAIL)) == []
    assert history.state.phase is Phase.RUNNING


@pytest.mark.parametrize("life", ["", "1"])
def test_the_end_of_a_life_that_is_told_by_its_site_and_by_its_token_is_one_loss(life: str) -> None:
    history = History(TASK).running()
    history.hear(Failed(TRACKER, life, Cause.CRASH, startable=True))
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


def test_two_that_fail_at_once_are_both_dropped() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL), Failed(DRIVE, "1", Cause.FAIL))
    assert set(history.state.lost) == {TRACKER, DRIVE}
    assert history.effects[-1] == Compose(3, frozenset({TRACKER, DRIVE}), navigation())


# Refusals of the task.


def test_a_refusal_releases_all_that_was_touched() -> None:
    history = History().running()
    history.hear(Failed(DRIVE, "1", Cause.FAIL))
    effects = history.composed(REFUSAL)
    assert effects[:3] == [Unwatch(component) for component in sorted([TRACKER, CONTROL, DRIVE])]
    assert sorted(released(effects)) == sorted([DRIVE, CONTROL])  # what the drive gave up feeds nothing any more
    history.answer(DRIVE, Call.RELEASE)
    assert released(history.answer(CONTROL, Call.RELEASE)) == [TRACKER]
    assert history.answer(TRACKER, Call.RELEASE) == [Finish(REFUSAL)]
    assert (history.state.phase, dict(history.state.held)) == (Phase.REFUSED, {})


def test_a_refusal_with_nothing_touched_ends_at_once() -> None:
    history = History().accepted()
    assert history.composed(REFUSAL) == [Finish(REFUSAL)]


def test_a_refusal_is_said_once() -> None:
    history = History().accepted()
    history.composed(REFUSAL)
    assert history.hear(Stopped()) == []
    assert history.hear(Appeared({ODOMETRY: "2"})) == []


def test_a_refusal_does_not_count_if_something_has_appeared_since_the_ecology_was_asked() -> None:
    history = History().running()
    history.hear(Appeared({ODOMETRY: "1"}), Failed(TRACKER, "1", Cause.FAIL))
    assert history.composed(REFUSAL) == [Discover()]
    assert history.hear(Discovered()) == [Compose(3, frozenset({TRACKER}), navigation())]
    assert history.composed(REFUSAL)[-1] != Discover()


def test_where_something_appears_all_the_time_a_task_is_refused_all_the_same() -> None:
    history = History().accepted()
    for _ in range(MOST_PUT_OFF):
        history.hear(Appeared({ODOMETRY: "1"}))
        assert history.composed(REFUSAL) == [Discover()]
        history.hear(Discovered())
    history.hear(Appeared({ODOMETRY: "1"}))
    assert history.composed(REFUSAL) == [Finish(REFUSAL)]


def test_a_loss_while_the_ecology_is_asked_waits_for_its_answer() -> None:
    history = History().running()
    history.hear(Appeared({}), Failed(TRACKER, "1", Cause.FAIL))
    history.composed(REFUSAL)
    effects = history.hear(Failed(DRIVE, "1", Cause.FAIL))
    assert released(effects) == [DRIVE]
    assert history.state.phase is Phase.DISCOVERING
    assert history.hear(Discovered()) == [Compose(3, frozenset({TRACKER, DRIVE}), navigation())]


def test_patience_waits_for_something_to_appear() -> None:
    history = History(PATIENT).accepted()
    assert history.composed(REFUSAL) == []
    assert history.state.phase is Phase.REFUSED
    assert history.hear(Appeared({})) == [Discover()]
    history.hear(Discovered())
    history.composed(navigation())
    assert kinds(history.all_answer()) == [Running]


def test_patience_does_not_miss_what_appears_while_everything_is_taken_down() -> None:
    history = History(PATIENT).running()
    history.hear(Failed(DRIVE, "1", Cause.FAIL))
    history.composed(REFUSAL)
    history.hear(Appeared({DRIVE: "2"}))
    assert history.all_answer() == [Discover()]


def test_patience_ends_with_a_stop() -> None:
    history = History(PATIENT).accepted()
    history.composed(REFUSAL)
    assert history.hear(Stopped()) == [Finish()]
    assert history.state.phase is Phase.STOPPED


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
    history.hear(Answered(TRACKER, Call.RELEASE, epoch, None))
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


def test_a_component_that_appears_while_everything_is_taken_down_comes_to_rest_in_its_turn() -> None:
    history = History(TASK).running()
    history.hear(Stopped())
    assert history.hear(Appeared({TRACKER: "1", DRIVE: "1"})) == [ReleaseFrom(DRIVE, history.state.epoch)]


# Other tasks.


def test_a_task_of_another_rank_claims_what_runs_anew_and_nothing_stops() -> None:
    history = History(replace(TASK, priority=0)).running()
    epoch = history.state.epoch
    effects = history.hear(Ranked(2))
    assert kinds(effects) == [ApplyTo] * 3
    assert set(applied(effects)) == {TRACKER, CONTROL, DRIVE}
    assert (history.state.priority, history.state.epoch) == (2, epoch + 1)
    assert kinds(history.all_answer()) == [Running]


def test_a_task_of_another_rank_reserves_anew_what_does_not_act_yet() -> None:
    history = History(replace(TASK, priority=0)).reserved()
    assert history.state.pending == {(TRACKER, Call.APPLY)}
    assert kinds(history.hear(Ranked(2))) == [WakeUp, WakeUp]
    history.answer(CONTROL, Call.WAKE)
    assert reserved(history.answer(DRIVE, Call.WAKE)) == [CONTROL]


def test_what_tasks_of_a_lower_priority_hold_than_a_task_now_has_counts_for_the_search() -> None:
    history = History(replace(TASK, priority=0)).running()
    history.hear(Reconnected(), Discovered({ODOMETRY: OTHERS}))
    history.composed(navigation())
    history.all_answer()
    history.hear(Ranked(OTHERS.priority + 1))
    (search,) = [one for one in history.hear(Failed(TRACKER, "1", Cause.FAIL)) if isinstance(one, Compose)]
    assert search.lost == frozenset({TRACKER})


def test_what_tasks_of_the_same_or_a_higher_priority_hold_does_not_count_for_the_search() -> None:
    history = History(replace(TASK, priority=0))
    history.hear(Accepted(100))
    effects = history.hear(Discovered({TRACKER: OTHERS, ODOMETRY: LOWER, CONTROL: HIGHER}))
    assert effects == [Compose(1, frozenset({TRACKER, CONTROL}), None)]


def test_what_this_task_holds_itself_counts_whoever_says_that_he_holds_it() -> None:
    history = History(TASK).running()
    history.hear(Reconnected())
    assert history.hear(Discovered({TRACKER: OTHERS})) == [Compose(2, frozenset(), navigation())]


def test_a_refusal_for_lack_of_what_others_hold_names_it() -> None:
    history = History(TASK)
    history.hear(Accepted(100), Discovered({TRACKER: OTHERS, ODOMETRY: OTHERS}))
    assert history.composed(REFUSAL) == [Compose(2, frozenset(), None)]
    assert history.composed(navigation()) == [Finish(replace(REFUSAL, held=((TRACKER, OTHERS),)))]
    assert history.state.lost.keys() == {TRACKER}
    assert history.state.lost[TRACKER].busy
    assert history.state.lost[TRACKER].detail == str(OTHERS)


def test_a_refusal_that_nobody_else_is_to_blame_for_names_nobody() -> None:
    history = History(TASK)
    history.hear(Accepted(100), Discovered({TRACKER: OTHERS}))
    history.composed(REFUSAL)
    assert history.composed(REFUSAL) == [Finish(REFUSAL)]
    assert not history.state.lost


def sharers(configuration: Configuration) -> dict[IRI, Holder]:
    """Another task that holds the controller, which it would share, as in a configuration of its own."""
    return {CONTROL: replace(OTHERS, wants=configuration.wants(CONTROL))}


def test_what_can_be_shared_counts_as_long_as_all_want_the_same_of_it() -> None:
    history = History(TASK)
    history.hear(Accepted(100), Discovered({}, sharers(navigation())))
    assert kinds(history.composed(navigation()))[-1] is WakeUp
    assert history.state.phase is Phase.RESERVING


def test_what_can_be_shared_is_taken_where_its_holder_wants_something_else_of_it() -> None:
    history = History(TASK)
    history.hear(Accepted(100), Discovered({}, sharers(navigation(ODOMETRY))))
    assert history.composed(navigation()) == [Compose(2, frozenset({TRACKER}), None)], (
        "at first without what it follows"
    )
    assert history.composed(REFUSAL) == [Compose(3, frozenset({CONTROL}), None)]
    assert history.composed(REFUSAL) == [Compose(4, frozenset(), None)]
    held = ((CONTROL, sharers(navigation(ODOMETRY))[CONTROL]),)
    assert history.composed(navigation()) == [Finish(replace(REFUSAL, held=held))]
    assert not history.state.watched


def test_what_runs_is_not_changed_to_something_of_which_its_holder_wants_something_else() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    better = navigation(TRACKER)
    history.hear(Improvable(), Discovered({}, {TRACKER: replace(OTHERS, wants=better.wants(CONTROL))}))
    assert history.composed(better) == [Compose(history.state.attempt, frozenset({TRACKER}), None)]
    assert history.composed(navigation(ODOMETRY)) == []
    assert history.state.target == navigation(ODOMETRY)


def test_what_a_task_of_lower_priority_wants_of_a_component_that_can_be_shared_does_not_matter() -> None:
    history = History(TASK)
    other = navigation(ODOMETRY)
    history.hear(Accepted(100), Discovered({}, {CONTROL: replace(LOWER, wants=other.wants(CONTROL))}))
    history.composed(navigation())
    assert history.state.phase is Phase.RESERVING


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


def test_a_patient_task_that_has_found_something_else_waits_no_more() -> None:
    history = waiting()
    history.hear(Appeared({ODOMETRY: "1"}), Discovered({TRACKER: OTHERS}))
    history.composed(navigation(ODOMETRY))
    effects = history.all_answer()
    assert kinds(effects) == [Running, ReleaseFrom]
    assert released(effects) == [TRACKER]


def test_a_patient_task_that_is_stopped_waits_no_more() -> None:
    history = waiting()
    assert released(history.hear(Stopped())) == [TRACKER]
    assert history.answer(TRACKER, Call.RELEASE) == [Finish()]


def test_a_component_that_was_free_and_was_not_taken_forgets_the_task_that_is_stopped() -> None:
    """It remembers the task until it is reserved or released: else it would be kept for a task that has ended."""
    history = waiting()
    history.hear(Freed(TRACKER), Discovered())
    history.composed(REFUSAL)
    assert history.state.phase is Phase.REFUSED
    assert released(history.hear(Stopped())) == [TRACKER]
    assert history.answer(TRACKER, Call.RELEASE) == [Finish()]


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


def test_a_notice_that_comes_after_the_component_was_reserved_lets_it_not_go() -> None:
    history = History(TASK).running()
    assert history.hear(Freed(TRACKER)) == []
    history = History(TASK).accepted()
    history.composed(navigation())
    assert history.hear(Freed(TRACKER)) == []  # it is about to be reserved


def test_a_task_that_is_asked_to_yield_comes_to_rest_sinks_first_and_is_configured_without_that_component() -> None:
    history = History(TASK).running()
    effects = history.hear(Failed(TRACKER, "1", Cause.YIELD))
    assert released(effects) == [DRIVE]
    assert released(history.answer(DRIVE, Call.RELEASE)) == [CONTROL]
    assert released(history.answer(CONTROL, Call.RELEASE)) == [TRACKER]
    assert history.answer(TRACKER, Call.RELEASE) == [Compose(2, frozenset({TRACKER}), None)]
    history.composed(navigation(ODOMETRY))
    assert kinds(history.all_answer()) == [Running]


def test_a_component_that_has_let_go_brings_the_rest_to_rest_and_may_be_had_again() -> None:
    history = History(TASK).running()
    effects = history.hear(Failed(TRACKER, "1", Cause.LET_GO))
    assert released(effects) == [DRIVE]
    assert released(history.answer(DRIVE, Call.RELEASE)) == [CONTROL]
    assert released(history.answer(CONTROL, Call.RELEASE)) == [TRACKER]
    assert history.answer(TRACKER, Call.RELEASE) == [Compose(2, frozenset(), None)]
    history.composed(navigation())
    assert kinds(history.all_answer()) == [Running]


def test_the_task_that_a_component_is_asked_to_yield_for_does_not_yield_itself() -> None:
    """It watches what it waits for, and hears that the component asks its holder to let go of it."""
    history = History(TASK).accepted()
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    history.busy(CONTROL, LOWER)
    assert history.hear(Failed(CONTROL, "1", Cause.YIELD)) == []
    assert history.state.phase is Phase.RESERVING


def test_a_configurator_whose_task_another_goes_on_with_leaves_everything_as_it_is() -> None:
    history = History(TASK).running()
    history.hear(Reconnected())
    history.hear(Discovered())
    history.composed(navigation())
    effects = history.busy(TRACKER, replace(OTHERS, task="go~1"), Call.APPLY)
    assert kinds(effects) == [Unwatch] * 3 + [Finish]
    assert (history.state.phase, dict(history.state.held), dict(history.state.owed)) == (Phase.STOPPED, {}, {})


def test_a_life_that_had_begun_before_the_call_was_meant_for_the_last_one_counts_when_it_is_heard_of() -> None:
    history = History(TASK).reserved()
    history.answer(TRACKER, Call.APPLY, Verdict.OTHER_LIFE, life="2")
    history.hear(Failed(TRACKER, "1", Cause.CRASH), Appeared({TRACKER: "2"}))
    assert TRACKER not in history.state.lost


# The end.


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
