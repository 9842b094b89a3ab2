"""Act 4 as a transaction: wake, reserve in the order of the IRIs, then activate, sources first and actuators last."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.deploying import MOST_ASKED, may_wait_for
from selfconf.configurator.effects import (
    ApplyTo,
    AwaitRelease,
    Compose,
    Discover,
    Finish,
    ReleaseFrom,
    ReserveOf,
    Running,
    Unwatch,
    WakeUp,
    Watch,
)
from selfconf.configurator.events import (
    Adopted,
    Answered,
    Call,
    Composed,
    Discovered,
    Failed,
    Freed,
    HandedOver,
    Improvable,
    Rewired,
    WaitedLong,
)
from selfconf.configurator.starting_order import plan_of, wiring
from selfconf.configurator.state import Held, Phase, Policy, State
from selfconf.model.configuration import Assignment, Configuration, Connection
from selfconf.model.holder import Holder
from selfconf.model.term import IRI, Literal
from selfconf.protocol.messages import Cause, Verdict, Wire
from tests.configurator.builders import (
    ARM,
    CONTROL,
    DRIVE,
    GOAL,
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
    navigation,
    released,
    reserved,
    with_arm,
)

# Waking and reserving.


def test_all_are_watched_and_woken_at_once_before_anything_else() -> None:
    history = History().accepted()
    effects = history.composed(navigation())
    assert kinds(effects) == [Watch] * 3 + [WakeUp] * 3
    assert history.state.phase is Phase.RESERVING
    assert history.answer(DRIVE, Call.WAKE) == []
    assert history.answer(TRACKER, Call.WAKE) == []
    assert reserved(history.answer(CONTROL, Call.WAKE)) == [CONTROL]


def test_components_are_reserved_one_after_the_other_in_the_order_of_their_iris() -> None:
    history = History().accepted()
    history.composed(navigation())
    effects = history.all_answer(Call.WAKE)
    wires, order = wiring(navigation()), []
    while isinstance(effects[0], ReserveOf):
        (reserve,) = effects
        values = {"goal": GOAL} if reserve.component == CONTROL else {}
        assert reserve == ReserveOf(reserve.component, history.state.epoch, wires[reserve.component], values)
        order.append(reserve.component)
        effects = history.answer(reserve.component, Call.RESERVE)
    assert order == sorted(navigation().components)
    assert applied(effects) == [TRACKER]


def test_what_each_component_is_to_do_is_found_out_once_for_a_deployment() -> None:
    history = History().accepted()
    history.composed(navigation())
    plan = history.state.plan
    assert plan == plan_of(navigation())
    while history.state.pending:
        history.answer(*min(history.state.pending))
        assert history.state.plan is plan
    assert history.state.phase is Phase.RUNNING


def test_nothing_is_applied_to_before_all_are_reserved() -> None:
    history = History().accepted()
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    while history.state.phase is Phase.RESERVING:
        assert applied(history.effects) == []
        history.answer(*min(history.state.pending))
    assert all(held.reserved for held in history.state.held.values())


def test_a_component_that_cannot_be_woken_is_lost() -> None:
    history = History().accepted()
    history.composed(navigation())
    effects = history.answer(TRACKER, Call.WAKE, None)
    assert effects[-1] == Compose(2, frozenset({TRACKER}), navigation())
    assert not history.state.lost[TRACKER].answered


def test_what_is_held_already_is_neither_woken_nor_reserved_again() -> None:
    history = History().accepted()
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    history.answer(CONTROL, Call.RESERVE)
    history.answer(DRIVE, Call.RESERVE, Verdict.REFUSED)
    other = replace(
        navigation(),
        assignments=(*navigation().assignments[:2], Assignment(IRI("urn:r:drive"), (ARM,))),
        connections=(navigation().connections[0], Connection(CONTROL, "set", ARM, "velocity")),
    )
    effects = history.composed(other)
    assert [effect.component for effect in effects if isinstance(effect, WakeUp)] == [ARM, TRACKER]
    assert reserved(history.all_answer(Call.WAKE)) == [ARM]
    assert reserved(history.answer(ARM, Call.RESERVE)) == [TRACKER]
    assert applied(history.answer(TRACKER, Call.RESERVE)) == [TRACKER]


# Activating.


def test_what_feeds_has_confirmed_before_what_it_feeds_is_applied_to() -> None:
    history = History(TASK).reserved()
    epoch = history.state.epoch
    assert history.state.pending == {(TRACKER, Call.APPLY)}
    followed = {"position": (Wire(TRACKER, "pose"),)}
    assert history.answer(TRACKER, Call.APPLY) == [ApplyTo(CONTROL, epoch, followed, {"goal": GOAL})]
    assert history.answer(CONTROL, Call.APPLY) == [ApplyTo(DRIVE, epoch, {"velocity": (Wire(CONTROL, "set"),)}, {})]
    assert history.answer(DRIVE, Call.APPLY) == [Running(navigation())]
    assert history.state.phase is Phase.RUNNING


def test_actuators_are_started_when_everything_else_acts() -> None:
    history = History().reserved(with_arm(navigation()))
    assert applied(history.answer(TRACKER, Call.APPLY)) == [CONTROL]  # not the arm, although its source acts
    assert applied(history.answer(CONTROL, Call.APPLY)) == [DRIVE, ARM]


def test_a_loop_is_started_in_the_order_of_its_roles() -> None:
    loop = replace(
        navigation(), connections=(*navigation().connections, Connection(CONTROL, "hint", TRACKER, "prediction"))
    )
    history = History().reserved(loop)
    assert history.state.pending == {(TRACKER, Call.APPLY)}
    assert applied(history.answer(TRACKER, Call.APPLY)) == [CONTROL]


def test_a_configuration_without_components_runs_at_once() -> None:
    nobody = Configuration(navigation().template, ())
    assert History().accepted().composed(nobody) == [Running(nobody)]


def test_a_single_actuator_is_reserved_and_a_single_source_too_as_nothing_acts_yet() -> None:
    for component in (DRIVE, TRACKER):
        alone = Configuration(navigation().template, (Assignment(IRI("urn:r:one"), (component,)),))
        history = History().accepted()
        history.composed(alone)
        assert reserved(history.answer(component, Call.WAKE)) == [component]
        assert applied(history.answer(component, Call.RESERVE)) == [component]
        assert history.answer(component, Call.APPLY) == [Running(alone)]


# Repair.


def lost_tracker() -> History:
    """A task that runs loses its tracker, and the search has found odometry instead."""
    history = History(TASK).running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    history.composed(navigation(ODOMETRY))
    return history


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
    assert effects == [Running(navigation()), ReleaseFrom(ODOMETRY, history.state.epoch), Unwatch(ODOMETRY)]
    assert history.state.owed.keys() == {ODOMETRY}


def test_before_a_change_for_the_better_the_ecology_is_asked_anew_while_everything_runs_on() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    assert history.hear(Improvable()) == [Discover()]
    assert history.state.phase is Phase.RUNNING
    assert kinds(history.hear(Discovered())) == [Compose]
    assert history.hear(Discovered()) == []


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
    assert effects == [Running(navigation()), ReleaseFrom(ODOMETRY, history.state.epoch), Unwatch(ODOMETRY)]


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
    assert released(history.all_answer()) == [DRIVE, CONTROL]
    assert set(history.state.held) == history.state.watched == {ODOMETRY}
    assert history.state.owed.keys() == {TRACKER, CONTROL, DRIVE}


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


# Adoption.


def test_a_task_that_is_adopted_goes_on_and_every_component_hears_for_whom() -> None:
    history = History(TASK)
    assert kinds(history.hear(Adopted(500, navigation()))) == [Watch] * 3 + [Discover]
    assert history.hear(Discovered()) == [Compose(1, frozenset(), navigation())]
    effects = history.composed(navigation())
    assert kinds(effects) == [ApplyTo] * 3
    assert {effect.epoch for effect in effects if isinstance(effect, ApplyTo)} == {500}
    assert history.all_answer() == [Running(navigation())]
    assert history.hear(Adopted(900, navigation())) == []


def test_a_task_that_is_handed_over_is_left_as_it_runs() -> None:
    history = History(TASK).running()
    assert kinds(history.hear(HandedOver())) == [Unwatch] * 3 + [Finish]
    assert (history.state.phase, dict(history.state.held), dict(history.state.owed)) == (Phase.STOPPED, {}, {})
    assert history.hear(HandedOver()) == []


# What is not done.


def test_a_component_that_has_obeyed_a_newer_epoch_is_asked_with_one_newer_still() -> None:
    history = History(TASK).reserved()
    stale = Answered(TRACKER, Call.APPLY, history.state.epoch, Verdict.STALE, "1", 5000)
    assert history.hear(stale) == [ApplyTo(TRACKER, 5001, {}, {})]
    assert history.all_answer() == [Running(navigation())]


def test_a_reservation_that_was_stale_is_made_again() -> None:
    history = History(TASK).accepted()
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    stale = Answered(CONTROL, Call.RESERVE, history.state.epoch, Verdict.STALE, "1", 7000)
    history.hear(stale)
    assert history.state.epoch == 7001
    assert kinds(history.all_answer()) == [Running]


def test_a_component_that_calls_an_epoch_stale_without_a_newer_one_is_dropped_for_that_would_never_end() -> None:
    history = History(TASK).reserved()
    history.answer(TRACKER, Call.APPLY, Verdict.STALE)
    assert TRACKER in history.state.lost


def test_an_actuator_that_is_not_held_any_more_is_reserved_again() -> None:
    history = History(TASK).reserved()
    for component in (TRACKER, CONTROL):
        history.answer(component, Call.APPLY)
    epoch = history.state.epoch
    effects = history.answer(DRIVE, Call.APPLY, Verdict.NOT_HELD)
    assert effects == [WakeUp(DRIVE, epoch + 1)]
    assert history.state.held[DRIVE] == Held({"velocity": (Wire(CONTROL, "set"),)}, life="1")
    assert reserved(history.answer(DRIVE, Call.WAKE)) == [DRIVE]
    assert applied(history.answer(DRIVE, Call.RESERVE)) == [DRIVE]
    assert history.answer(DRIVE, Call.APPLY) == [Running(navigation())]


def test_an_answer_of_another_life_means_that_the_one_that_was_meant_has_ended() -> None:
    history = History(TASK).reserved()
    effects = history.answer(TRACKER, Call.APPLY, Verdict.OTHER_LIFE, life="2")
    assert effects[-1] == Compose(2, frozenset({TRACKER}), navigation())
    assert history.state.lost[TRACKER].cause is Cause.CRASH
    assert TRACKER in history.state.owed


def test_an_answer_to_an_older_epoch_is_passed_over() -> None:
    history = History(TASK).reserved()
    old = history.state.epoch - 1
    assert history.hear(Answered(TRACKER, Call.APPLY, old, Verdict.REFUSED)) == []
    assert TRACKER in history.state.held


def test_a_component_that_answers_twice_counts_once() -> None:
    history = History(TASK).reserved()
    assert applied(history.answer(TRACKER, Call.APPLY)) == [CONTROL]
    for _ in range(2):
        assert history.answer(TRACKER, Call.APPLY) == []
    assert history.state.phase is Phase.DEPLOYING


def test_a_component_that_was_given_up_and_reserves_late_is_released() -> None:
    history = History(TASK).accepted()
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    epoch = history.state.epoch
    history.hear(Failed(CONTROL, "", Cause.CRASH))
    effects = history.hear(Answered(CONTROL, Call.RESERVE, epoch, Verdict.DONE, "1", epoch))
    assert effects == [ReleaseFrom(CONTROL, history.state.epoch)]
    assert CONTROL in history.state.owed


# Waiting for another task.


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
            history.answer(component, Call.RELEASE, None if kept else Verdict.DONE)
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
