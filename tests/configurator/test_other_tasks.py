"""A task among others: its rank, the components that others hold or share, and when it yields one to another."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.effects import (
    ApplyTo,
    AwaitReturn,
    Compose,
    Discover,
    Finish,
    Running,
    Unwatch,
    WakeUp,
)
from selfconf.configurator.events import (
    Accepted,
    Appeared,
    Call,
    Discovered,
    Failed,
    Improvable,
    Ranked,
    Reconnected,
    StayedAway,
)
from selfconf.configurator.state import Phase
from selfconf.model.configuration import Configuration
from selfconf.model.holder import Holder
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause
from tests.configurator.builders import (
    CONTROL,
    DRIVE,
    HIGHER,
    LOWER,
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


@pytest.mark.parametrize("higher", [0, 1])
def test_what_tasks_of_a_lower_priority_hold_than_a_task_now_has_counts_for_the_search(higher: int) -> None:
    history = History(replace(TASK, priority=0)).running()
    history.hear(Reconnected(), Discovered({ODOMETRY: OTHERS}))
    history.composed(navigation())
    history.all_answer()
    history.hear(Ranked(OTHERS.priority + higher))
    (search,) = [one for one in history.hear(Failed(TRACKER, "1", Cause.FAIL)) if isinstance(one, Compose)]
    assert search.left_out == (frozenset({TRACKER}) if higher else frozenset({TRACKER, ODOMETRY}))


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


def test_what_appears_while_it_is_found_out_who_holds_what_is_lacking_counts_before_the_refusal() -> None:
    history = History(TASK)
    history.hear(Accepted(100), Discovered({TRACKER: OTHERS}))
    history.composed(REFUSAL)
    history.hear(Appeared({ODOMETRY: "2"}))
    assert history.composed(navigation()) == [Discover()]
    history.hear(Discovered({TRACKER: OTHERS}))
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    assert history.state.phase is Phase.RUNNING


def test_a_refusal_that_nobody_else_is_to_blame_for_names_nobody() -> None:
    history = History(TASK)
    history.hear(Accepted(100), Discovered({TRACKER: OTHERS}))
    history.composed(REFUSAL)
    assert history.composed(REFUSAL) == [Finish(REFUSAL)]
    assert not history.state.lost


@pytest.mark.parametrize("looks_for_better", [False, True])
def test_what_others_held_when_a_task_began_to_run_is_asked_for_once_more_before_it_is_refused(
    looks_for_better: bool,
) -> None:
    history = History(TASK)
    held = Discovered({ODOMETRY: OTHERS})
    history.hear(Accepted(100), Discovered() if looks_for_better else held)
    history.composed(navigation())
    history.all_answer()
    if looks_for_better:
        history.hear(Improvable(), held)
        assert history.composed(navigation()) == []
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    assert history.composed(REFUSAL) == [Discover()]
    assert history.hear(Discovered()) == [Compose(history.state.attempt, frozenset({TRACKER}), navigation())]


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
    assert history.composed(navigation()) == [Compose(2, frozenset({(0, TRACKER)}), None)], (
        "at first without what it follows, in that role"
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


@pytest.mark.parametrize("how", ["yield", "busy"])
def test_a_refusal_names_the_task_to_which_this_one_has_lost_a_component(how: str) -> None:
    """Before it is a refusal, the ecology is asked who holds what: that another asks for it does not say so."""
    if how == "yield":
        history = History(TASK).running()
        history.hear(Failed(TRACKER, "1", Cause.YIELD))
        history.all_answer()
    else:
        history = History(TASK).accepted()
        history.composed(navigation())
        history.all_answer(Call.WAKE)
        history.busy(CONTROL, OTHERS)
    lost = TRACKER if how == "yield" else CONTROL
    assert history.composed(REFUSAL)[-1] == Discover()
    history.hear(Discovered({lost: HIGHER}))
    if how == "yield":  # the other task may be about to let go of what it has changed for this
        assert history.composed(REFUSAL) == [AwaitReturn(history.state.attempt)]
        assert history.hear(StayedAway(history.state.attempt)) == [Discover()]
        history.hear(Discovered({lost: HIGHER}))
    history.composed(REFUSAL)
    history.composed(navigation())
    history.all_answer()
    assert isinstance(history.state.refusal, Refusal)
    assert history.state.refusal.held == ((lost, HIGHER),)


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
