"""What runs is changed: a repair, a change for the better, and what moves outside or inside meanwhile."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.effects import (
    ApplyTo,
    Compose,
    Discover,
    ReleaseFrom,
    Running,
    Unwatch,
)
from selfconf.configurator.events import (
    Call,
    Discovered,
    Failed,
    HandedOver,
    Improvable,
    Rewired,
    Stopped,
    Unanswered,
)
from selfconf.configurator.state import Phase, Policy
from selfconf.model.configuration import Assignment, Configuration, Connection
from selfconf.model.term import IRI, Literal
from selfconf.protocol.messages import Cause
from tests.configurator.builders import (
    ARM,
    CONTROL,
    DRIVE,
    ODOMETRY,
    TASK,
    TRACKER,
    History,
    applied,
    kinds,
    lost_tracker,
    navigation,
    released,
    reserved,
    with_arm,
)


def test_a_repair_that_lacks_one_component_applies_to_it_and_to_what_it_feeds_at_once() -> None:
    history = lost_tracker()
    assert history.state.pending == {(ODOMETRY, Call.WAKE)}
    effects = history.answer(ODOMETRY, Call.WAKE)
    assert applied(effects) == [ODOMETRY, CONTROL]  # what the controller followed is lost: it waits for nothing
    assert history.all_answer() == [Running(navigation(ODOMETRY))]
    assert history.state.held[ODOMETRY].reserved


def test_a_repair_that_lacks_an_actuator_reserves_it_first() -> None:
    history = History(TASK).running(with_arm(navigation()))
    history.hear(Failed(ARM, "1", Cause.FAIL))
    history.composed(with_arm(navigation()))
    assert reserved(history.answer(ARM, Call.WAKE)) == [ARM]
    assert applied(history.answer(ARM, Call.RESERVE)) == [ARM]


def test_a_repair_that_lacks_several_components_reserves_them_before_any_change() -> None:
    history = History(TASK).running(with_arm(navigation()))
    history.hear(Failed(ARM, "1", Cause.FAIL), Failed(TRACKER, "1", Cause.FAIL))
    history.composed(with_arm(navigation(ODOMETRY)))
    assert reserved(history.all_answer(Call.WAKE)) == [ARM]
    assert reserved(history.answer(ARM, Call.RESERVE)) == [ODOMETRY]
    assert applied(history.answer(ODOMETRY, Call.RESERVE)) == [ODOMETRY, CONTROL]


def test_a_change_for_the_better_is_made_before_the_old_source_is_let_go() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered())
    history.composed(navigation())
    assert applied(history.answer(TRACKER, Call.WAKE)) == [TRACKER]  # not yet the controller
    assert applied(history.answer(TRACKER, Call.APPLY)) == [CONTROL]
    effects = history.answer(CONTROL, Call.APPLY)
    assert effects == [Running(navigation()), Unwatch(ODOMETRY), ReleaseFrom(ODOMETRY, history.state.epoch)]
    assert history.state.owed.keys() == {ODOMETRY}


def looped(position: IRI) -> Configuration:
    """A controller whose hints feed the position sensor that feeds it; its role comes first."""
    whole = navigation(position)
    sensor, control, drive = whole.assignments
    hints = Connection(CONTROL, "hint", position, "prediction")
    return replace(whole, assignments=(control, sensor, drive), connections=(*whole.connections, hints))


def test_a_change_for_the_better_in_a_loop_begins_with_what_is_new() -> None:
    """What acts follows it only once it has issued a signal: neither may wait for the other."""
    history = History(TASK).running(looped(ODOMETRY))
    history.hear(Improvable(), Discovered())
    history.composed(looped(TRACKER))
    assert applied(history.answer(TRACKER, Call.WAKE)) == [TRACKER]
    assert applied(history.answer(TRACKER, Call.APPLY)) == [CONTROL]
    assert Running(looped(TRACKER)) in history.answer(CONTROL, Call.APPLY)


def test_what_is_new_in_a_loop_does_not_wait_for_a_signal_of_what_is_started_after_it() -> None:
    ran, better = (
        replace(looped(position), assignments=tuple(Assignment(IRI(f"urn:r:{one}"), (one,)) for one in players))
        for position, players in ((ODOMETRY, (DRIVE, ODOMETRY)), (TRACKER, (DRIVE, TRACKER, CONTROL)))
    )
    ran = replace(ran, connections=(Connection(ODOMETRY, "pose", DRIVE, "velocity"),), settings=())
    history = History(TASK).running(ran)
    history.hear(Improvable(), Discovered())
    history.composed(better)
    history.all_answer(Call.WAKE)
    history.all_answer(Call.RESERVE)
    history.all_answer()
    calls = [one for one in history.effects if isinstance(one, ApplyTo) and one.epoch == history.state.epoch]
    assert [(one.component, one.gently) for one in calls] == [(TRACKER, False), (CONTROL, True), (DRIVE, True)]


def test_other_recruits_for_the_same_players_are_a_change_for_the_better() -> None:
    ran, better = (
        replace(whole, assignments=whole.assignments[1:], recruits=(recruit,))
        for whole, recruit in ((navigation(ODOMETRY), ODOMETRY), (navigation(), TRACKER))
    )
    history = History(TASK).running(ran)
    history.hear(Improvable(), Discovered())
    assert history.composed(ran) == []
    history.hear(Improvable(), Discovered())
    history.composed(better)
    history.all_answer()
    assert history.state.target == better
    assert history.state.held.keys() == {CONTROL, DRIVE, TRACKER}


def test_before_a_change_for_the_better_the_ecology_is_asked_anew_while_everything_runs_on() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    assert history.hear(Improvable()) == [Discover()]
    assert history.state.phase is Phase.RUNNING
    assert kinds(history.hear(Discovered())) == [Compose]
    assert history.hear(Discovered()) == []


def test_what_has_just_appeared_is_not_changed_to_and_what_runs_stays() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    unsettled = frozenset((TRACKER, ODOMETRY))
    (search,) = history.hear(Improvable(unsettled), Discovered())
    assert search == Compose(history.state.attempt, frozenset((TRACKER,)), None)
    (search,) = history.hear(Improvable(), Discovered())
    assert search == Compose(history.state.attempt, frozenset(), None)


def test_what_has_just_appeared_may_take_the_place_of_what_is_lost() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    history.hear(Improvable(frozenset((TRACKER,))), Discovered(), Failed(ODOMETRY, "1", Cause.FAIL))
    assert history.effects[-1] == Compose(history.state.attempt, frozenset((ODOMETRY,)), navigation(ODOMETRY))


def test_what_an_ecology_has_answered_to_a_look_for_better_starts_no_search_after_a_failure() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    history.hear(Improvable(), Failed(ODOMETRY, "1", Cause.FAIL))
    assert history.state.phase is Phase.COMPOSING
    assert history.hear(Discovered()) == []
    history.composed(navigation())
    assert history.state.phase is Phase.RESERVING


def test_who_follows_a_component_behind_which_others_stand_now_is_applied_to_again_and_nobody_else() -> None:
    history = History(TASK).running(navigation())
    effects = history.hear(Rewired(TRACKER))
    assert applied(effects) == [CONTROL]
    assert history.answer(CONTROL, Call.APPLY) == [Running(navigation())]
    assert applied(history.hear(Rewired(IRI("urn:c:stranger")))) == []


def test_what_moves_while_a_configuration_is_deployed_is_told_at_its_end() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered())
    history.composed(navigation())
    assert history.hear(Rewired(TRACKER)) == []
    assert applied(history.answer(TRACKER, Call.WAKE)) == [TRACKER]
    assert applied(history.answer(TRACKER, Call.APPLY)) == [CONTROL]
    assert applied(history.answer(CONTROL, Call.APPLY)) == [CONTROL]  # once more, with what stands behind now
    effects = history.answer(CONTROL, Call.APPLY)
    assert effects == [Running(navigation()), Unwatch(ODOMETRY), ReleaseFrom(ODOMETRY, history.state.epoch)]


def test_what_moves_while_a_change_for_the_better_reserves_lets_it_not_begin_anew() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered())
    history.composed(with_arm(navigation()))
    history.all_answer(Call.WAKE)
    assert history.state.pending == {(ARM, Call.RESERVE)}
    assert history.hear(Rewired(TRACKER)) == []
    history.all_answer()
    assert history.state.phase is Phase.RUNNING


def test_what_moves_while_another_configuration_is_looked_for_is_told_once_that_is_deployed() -> None:
    history = History(TASK).running(with_arm(navigation()))
    history.hear(Failed(ARM, "1", Cause.FAIL))
    assert history.hear(Rewired(TRACKER)) == []
    assert applied(history.composed(navigation())) == [CONTROL]
    assert history.answer(CONTROL, Call.APPLY)[0] == Running(navigation())


def test_what_is_outside_may_change_while_the_inside_of_a_composite_is_repaired() -> None:
    whole = IRI("urn:c:whole")
    inside = replace(navigation(), connections=(*navigation().connections, Connection(whole, "hint", DRIVE, "hint")))
    history = History(TASK).running(with_arm(inside))
    history.hear(Failed(ARM, "1", Cause.FAIL))
    assert history.hear(Rewired(whole)) == []
    assert applied(history.composed(inside)) == [DRIVE]
    assert history.answer(DRIVE, Call.APPLY)[0] == Running(inside)


def test_the_actuators_inside_of_a_composite_rest_while_that_is_part_of_something_incomplete() -> None:
    whole = IRI("urn:c:whole")
    inside = replace(navigation(), connections=(*navigation().connections, Connection(whole, "hint", TRACKER, "hint")))
    history = History(TASK).running(inside)
    for rests in (True, False):
        effects = [effect for effect in history.hear(Rewired(whole, rests)) if isinstance(effect, ApplyTo)]
        assert {effect.component: effect.rests for effect in effects} == {TRACKER: False, DRIVE: rests}
        history.all_answer()
        assert history.state.phase is Phase.RUNNING
        assert applied(history.hear(Rewired(whole, rests))) == [TRACKER], "the actuator is told once"
        history.all_answer()


def test_the_actuators_inside_of_a_composite_rest_while_it_is_repaired_and_then_if_that_is_still_so() -> None:
    whole = IRI("urn:c:whole")
    inside = replace(navigation(), connections=(*navigation().connections, Connection(whole, "hint", TRACKER, "hint")))
    history = History(TASK).running(with_arm(inside))
    history.hear(Failed(ARM, "1", Cause.FAIL))
    assert [effect.rests for effect in history.hear(Rewired(whole, True)) if isinstance(effect, ApplyTo)] == [True]
    assert history.hear(Rewired(whole, True)) == [], "they are told once"
    history.composed(inside)
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    told = [effect for effect in history.effects if isinstance(effect, ApplyTo) and effect.component == DRIVE]
    assert told[-1].rests


def test_the_actuators_inside_of_a_composite_rest_also_while_another_one_is_started() -> None:
    whole = IRI("urn:c:whole")
    inside = replace(navigation(), connections=(*navigation().connections, Connection(whole, "hint", TRACKER, "hint")))
    history = History(TASK).running(with_arm(inside))
    history.hear(Failed(ARM, "1", Cause.CRASH, startable=True))
    history.composed(with_arm(inside))
    history.all_answer(Call.WAKE, Call.RESERVE)
    assert history.state.pending == {(ARM, Call.APPLY)}
    for rests in (True, False):
        effects = [effect for effect in history.hear(Rewired(whole, rests)) if isinstance(effect, ApplyTo)]
        assert any(effect.component == DRIVE and effect.rests for effect in effects) is rests
        history.all_answer()
        assert history.state.phase is Phase.RUNNING
        assert history.state.held[DRIVE].rests is rests


def test_what_comes_to_rest_inside_of_a_composite_is_called_no_more_as_that_is_part_of_something_incomplete() -> None:
    whole = IRI("urn:c:whole")
    inside = replace(navigation(), connections=(*navigation().connections, Connection(whole, "hint", TRACKER, "hint")))
    history = History(TASK).running(inside)
    history.hear(Stopped())
    assert history.state.phase is Phase.DISMANTLING
    assert history.hear(Rewired(whole, True)) == [], "a call with a newer epoch than its release would let it act"


def test_what_gets_another_input_waits_for_its_source() -> None:
    first = navigation()
    more = replace(first, connections=(*first.connections, Connection(ODOMETRY, "pose", CONTROL, "hint")))
    more = replace(more, assignments=(*first.assignments, Assignment(IRI("urn:r:hint"), (ODOMETRY,))))
    history = History(TASK).running(first)
    history.hear(Improvable(), Discovered())
    history.composed(more)
    assert applied(history.answer(ODOMETRY, Call.WAKE)) == [ODOMETRY]
    assert applied(history.answer(ODOMETRY, Call.APPLY)) == [CONTROL]


def test_a_change_of_a_value_alone_waits_for_nothing() -> None:
    elsewhere = (replace(navigation().settings[0], value=Literal("(AT KITCHEN)")),)
    history = History(TASK).running(with_arm(navigation()))
    history.hear(Failed(ARM, "1", Cause.FAIL))
    history.composed(replace(with_arm(navigation()), settings=elsewhere))
    history.answer(ARM, Call.WAKE)
    assert applied(history.answer(ARM, Call.RESERVE)) == [CONTROL]
    assert applied(history.answer(CONTROL, Call.APPLY)) == [ARM]


@pytest.mark.parametrize("policy", Policy)
@pytest.mark.parametrize("cause", [Cause.CRASH, Cause.FAIL, Cause.YIELD, Cause.LET_GO])
def test_a_better_configuration_that_does_not_come_about_leaves_what_ran(cause: Cause, policy: Policy) -> None:
    history = History(replace(TASK, policy=policy)).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered())
    history.composed(navigation())
    history.answer(TRACKER, Call.WAKE)
    history.answer(TRACKER, Call.APPLY)
    effects = history.hear(Failed(TRACKER, "1", cause))
    assert applied(effects) == [CONTROL]
    assert released(effects) == [TRACKER]
    assert not any(isinstance(effect, Compose) for effect in effects)
    assert (TRACKER in history.state.lost) == (cause is not Cause.LET_GO)  # what has let go can be had again
    assert history.all_answer() == [Running(navigation(ODOMETRY))]


@pytest.mark.parametrize("cause", [Cause.YIELD, Cause.LET_GO])
def test_what_is_being_started_for_something_better_is_let_go_of_for_another_task(cause: Cause) -> None:
    """It has answered nothing yet, as its code takes its time, and is held by the apply."""
    history = History(TASK).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered())
    history.composed(navigation())
    assert applied(history.answer(TRACKER, Call.WAKE)) == [TRACKER]
    effects = history.hear(Failed(TRACKER, "1", cause))
    assert released(effects) == [TRACKER]
    assert history.all_answer() == [Running(navigation(ODOMETRY))]


@pytest.mark.parametrize("cause", [Cause.CRASH, Cause.YIELD])
def test_what_is_to_run_again_does_not_suffer_from_the_loss_of_what_it_does_without(cause: Cause) -> None:
    history = History(replace(TASK, policy=Policy.DISMANTLE)).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered())
    history.composed(with_arm(navigation()))
    history.all_answer(Call.WAKE, Call.RESERVE)
    history.answer(TRACKER, Call.APPLY)
    history.hear(Failed(TRACKER, "1", Cause.CRASH))
    effects = history.hear(Failed(ARM, "1", cause))
    assert released(effects) == [ARM]
    assert not any(isinstance(effect, Compose) for effect in effects)
    assert history.all_answer() == [Running(navigation(ODOMETRY))]


@pytest.mark.parametrize("policy", Policy)
def test_a_loss_before_a_better_configuration_has_come_about_changes_what_ran(policy: Policy) -> None:
    history = History(replace(TASK, policy=policy)).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered())
    history.composed(with_arm(navigation()))
    history.hear(Failed(CONTROL, "1", Cause.CRASH))
    if policy is Policy.REPAIR:
        assert history.effects[-1] == Compose(history.state.attempt, frozenset({CONTROL}), navigation(ODOMETRY))
    else:
        assert history.state.phase is Phase.DISMANTLING


def test_what_is_not_needed_any_more_is_released_sinks_first() -> None:
    history = History(TASK).running()
    history.hear(Failed(TRACKER, "1", Cause.CRASH))
    history.composed(Configuration(navigation().template, (Assignment(IRI("urn:r:position"), (ODOMETRY,)),)))
    history.all_answer(Call.WAKE, Call.RESERVE)
    assert released(history.answer(ODOMETRY, Call.APPLY)) == [DRIVE]
    assert set(history.state.held) == history.state.watched == {ODOMETRY}
    assert history.state.owed.keys() == {TRACKER, CONTROL, DRIVE}
    assert released(history.answer(DRIVE, Call.RELEASE, Unanswered.SILENT)) == [
        CONTROL
    ]  # what does not obey holds up no other
    assert released(history.answer(CONTROL, Call.RELEASE)) == []
    assert history.state.owed.keys() == {TRACKER, DRIVE}


def test_what_is_not_needed_any_more_rests_sinks_first_also_where_the_task_is_stopped_meanwhile() -> None:
    history = History(TASK).running()
    history.hear(Failed(TRACKER, "1", Cause.CRASH))
    history.composed(Configuration(navigation().template, (Assignment(IRI("urn:r:position"), (ODOMETRY,)),)))
    history.all_answer(Call.WAKE, Call.RESERVE)
    assert released(history.answer(ODOMETRY, Call.APPLY)) == [DRIVE]
    assert set(released(history.hear(Stopped()))) == {DRIVE, ODOMETRY}
    assert released(history.answer(ODOMETRY, Call.RELEASE)) == []
    assert released(history.answer(DRIVE, Call.RELEASE)) == [CONTROL]


@pytest.mark.parametrize("wanted", [False, True])
def test_what_has_not_come_to_rest_as_another_configuration_is_looked_for_is_released_at_once(wanted: bool) -> None:
    """But for what that wants again, where it is known already."""
    history = History(TASK).running()
    history.hear(Failed(TRACKER, "1", Cause.CRASH))
    history.composed(Configuration(navigation().template, (Assignment(IRI("urn:r:position"), (ODOMETRY,)),)))
    history.all_answer(Call.WAKE, Call.RESERVE)
    history.answer(ODOMETRY, Call.APPLY)
    assert history.state.unreleased == ((CONTROL,),)
    if wanted:
        history.state = replace(history.state, target=navigation(ODOMETRY))
        assert released(history.hear(Rewired(ODOMETRY))) == []
    else:
        assert released(history.hear(Failed(ODOMETRY, "1", Cause.CRASH))) == [ODOMETRY, CONTROL]
    assert history.state.unreleased == ()


def test_what_has_not_come_to_rest_as_the_task_is_handed_over_is_released_at_once() -> None:
    """The configurator that goes on with the task knows of no component that has been let go of."""
    history = History(TASK).running()
    history.hear(Failed(TRACKER, "1", Cause.CRASH))
    history.composed(Configuration(navigation().template, (Assignment(IRI("urn:r:position"), (ODOMETRY,)),)))
    history.all_answer(Call.WAKE, Call.RESERVE)
    assert released(history.answer(ODOMETRY, Call.APPLY)) == [DRIVE]
    assert released(history.hear(HandedOver())) == [CONTROL]


def test_what_comes_to_rest_as_the_task_is_handed_over_is_left_to_the_other_configurator() -> None:
    history = History(TASK).running()
    assert released(history.hear(Stopped())) == [DRIVE]
    assert released(history.hear(HandedOver())) == []


def test_an_actuator_that_has_not_said_that_it_acts_is_not_started_before_the_rest_acts() -> None:
    history = History(TASK).reserved()
    for component in (TRACKER, CONTROL):
        history.answer(component, Call.APPLY)
    assert history.state.pending == {(DRIVE, Call.APPLY)}
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    history.composed(navigation(ODOMETRY))
    history.all_answer(Call.WAKE, Call.RESERVE)
    assert history.state.pending == {(ODOMETRY, Call.APPLY), (CONTROL, Call.APPLY)}
    history.answer(ODOMETRY, Call.APPLY)
    assert applied(history.answer(CONTROL, Call.APPLY)) == [DRIVE]
