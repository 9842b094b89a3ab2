"""Act 4 as a transaction: wake, reserve in the order of the IRIs, then activate, sources first and actuators last."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.effects import (
    ApplyTo,
    Compose,
    Decline,
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
    Accepted,
    Adopted,
    Answered,
    Appeared,
    Call,
    Composed,
    Discovered,
    Failed,
    HandedOver,
    Unanswered,
)
from selfconf.configurator.starting_order import plan_of, wiring
from selfconf.configurator.state import Held, Loss, Phase, Policy
from selfconf.model.configuration import Assignment, Configuration, Connection
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, RecordedLoss, Verdict, Wire
from tests.configurator.builders import (
    ARM,
    CONTROL,
    DRIVE,
    GOAL,
    ODOMETRY,
    OTHERS,
    REFUSAL,
    TASK,
    TRACKER,
    History,
    applied,
    kinds,
    navigation,
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


def test_the_plan_that_comes_with_a_configuration_is_taken_and_one_of_another_is_not() -> None:
    history, made, other = History().accepted(), navigation(), plan_of(navigation(ODOMETRY))
    history.hear(Composed(1, made, plan=plan_of(made)))
    assert history.state.plan is not None
    assert history.state.plan.configuration is made
    again = History().accepted()
    again.hear(Composed(1, made, plan=other))
    assert again.state.plan == history.state.plan


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
    effects = history.answer(TRACKER, Call.WAKE, Unanswered.NOT_STARTED)
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


# Adoption.


def test_a_task_that_is_adopted_goes_on_and_every_component_hears_for_whom() -> None:
    history = History(TASK)
    assert kinds(history.hear(Adopted(500, navigation()))) == [Watch] * 3 + [Discover]
    assert history.hear(Discovered()) == [Compose(1, frozenset(), navigation())]
    claims = history.composed(navigation())
    assert reserved(claims) == [CONTROL, DRIVE, TRACKER]
    effects = [one for component in reserved(claims) for one in history.answer(component, Call.RESERVE, acts=True)]
    assert kinds(effects) == [ApplyTo] * 3
    assert {effect.epoch for effect in (*claims, *effects) if isinstance(effect, (ReserveOf, ApplyTo))} == {500}
    assert history.all_answer() == [Running(navigation())]
    assert history.hear(Adopted(900, navigation())) == []


def test_what_is_adopted_and_has_come_to_rest_starts_in_its_turn() -> None:
    history = History(TASK)
    history.hear(Adopted(500, navigation()), Discovered())
    history.composed(navigation())
    stale = Answered(TRACKER, Call.RESERVE, 500, Verdict.STALE, "1", 700)
    assert reserved(history.hear(stale)) == [CONTROL, DRIVE]
    history.answer(TRACKER, Call.WAKE)
    history.answer(CONTROL, Call.RESERVE)
    assert reserved(history.answer(DRIVE, Call.RESERVE)) == [TRACKER]
    assert applied(history.answer(TRACKER, Call.RESERVE)) == [TRACKER]
    assert applied(history.answer(TRACKER, Call.APPLY)) == [CONTROL]
    assert history.all_answer() == [Running(navigation())]


def test_nothing_that_is_adopted_starts_where_another_task_holds_a_part_by_now() -> None:
    history = History(replace(TASK, patient=True))
    history.hear(Adopted(500, navigation()), Discovered())
    history.composed(navigation())
    history.answer(CONTROL, Call.RESERVE)
    history.answer(TRACKER, Call.RESERVE)
    assert reserved(history.busy(DRIVE)) == [DRIVE]
    effects = history.busy(DRIVE)
    assert not applied(effects)
    assert history.state.phase is Phase.COMPOSING


@pytest.mark.parametrize("policy", Policy)
def test_what_the_configurator_before_has_lost_does_not_count_until_it_lives_anew(policy: Policy) -> None:
    lost = RecordedLoss(TRACKER, "1", Cause.FAIL, "lost Astrid")
    history = History(replace(TASK, policy=policy, patient=True))
    history.hear(Adopted(500, navigation(), (lost,)))
    assert history.state.lost == {TRACKER: Loss(Cause.FAIL, "lost Astrid", "1")}
    assert TRACKER not in history.state.held
    history.hear(Appeared({TRACKER: "1"}))
    assert history.state.lost.keys() == {TRACKER}
    history.hear(Appeared({TRACKER: "2"}))
    assert not history.state.lost


def test_what_another_configurator_has_lost_of_a_task_that_begins_does_not_count() -> None:
    history = History(TASK)
    history.hear(Accepted(100, (RecordedLoss(TRACKER, "1", Cause.FAIL, "lost Astrid"),)))
    assert history.hear(Discovered()) == [Compose(1, frozenset({TRACKER}), None)]


def test_what_is_adopted_and_taken_down_for_a_loss_is_not_refused_before_the_ecology_was_asked() -> None:
    history = History(replace(TASK, policy=Policy.DISMANTLE))
    history.hear(Adopted(500, navigation(), (RecordedLoss(TRACKER, "1", Cause.FAIL),)))
    history.all_answer()
    assert history.state.phase is Phase.COMPOSING
    assert history.composed(REFUSAL) == [Discover()]


@pytest.mark.parametrize("acts", [True, False])
def test_what_is_adopted_hears_of_that_while_what_takes_the_place_of_another_is_woken(acts: bool) -> None:
    history = History(TASK)
    history.hear(Adopted(500, navigation()), Failed(TRACKER, "1", Cause.CRASH), Discovered())
    assert reserved(history.composed(navigation(ODOMETRY))) == [CONTROL, DRIVE]
    history.answer(ODOMETRY, Call.WAKE)
    history.answer(DRIVE, Call.RESERVE, acts=acts)
    last = history.answer(CONTROL, Call.RESERVE, acts=True)
    if not acts:
        assert reserved(last) == [ODOMETRY]
        last = history.answer(ODOMETRY, Call.RESERVE)
    assert sorted(applied(last)) == [CONTROL, DRIVE, ODOMETRY] if acts else [CONTROL, ODOMETRY]
    assert history.all_answer() == [Running(navigation(ODOMETRY))]


def test_a_task_that_another_configurator_goes_on_with_is_left_to_that_one_though_something_is_being_woken() -> None:
    history = History(TASK)
    history.hear(Adopted(500, navigation()), Failed(TRACKER, "1", Cause.CRASH), Discovered())
    history.composed(navigation(ODOMETRY))
    other = replace(OTHERS, task=TASK.task)
    assert Finish() in history.answer(DRIVE, Call.RESERVE, Verdict.BUSY, holder=other)
    assert history.state.phase is Phase.STOPPED


def test_a_task_that_is_handed_over_is_left_as_it_runs() -> None:
    history = History(TASK).running()
    assert kinds(history.hear(HandedOver())) == [Unwatch] * 3 + [Finish]
    assert (history.state.phase, dict(history.state.held), dict(history.state.owed)) == (Phase.STOPPED, {}, {})
    assert history.hear(HandedOver()) == []


def test_what_does_not_act_yet_is_let_go_of_where_another_configurator_goes_on_with_the_task() -> None:
    history = History(TASK).accepted()
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    history.answer(CONTROL, Call.RESERVE)
    effects = history.answer(DRIVE, Call.RESERVE, Verdict.BUSY, holder=replace(OTHERS, task=TASK.task))
    declined = [effect.component for effect in effects if isinstance(effect, Decline)]
    assert declined == [CONTROL]
    assert effects[-1] == Finish()


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
