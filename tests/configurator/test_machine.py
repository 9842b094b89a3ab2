"""The four acts as sentences: what the configurator wants done, step by step."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.effects import (
    ApplyTo,
    Compose,
    Discover,
    Finish,
    ReleaseFrom,
    Running,
    SetOn,
    Unwatch,
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
)
from selfconf.configurator.machine import wiring
from selfconf.configurator.state import Phase, Policy, State
from selfconf.model.configuration import Connection
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Verdict, Wire
from tests.configurator.builders import (
    CONTROL,
    DRIVE,
    GOAL,
    ODOMETRY,
    REFUSAL,
    TRACKER,
    History,
    applied,
    kinds,
    navigation,
    released,
    state_in,
)

DISMANTLE = State(policy=Policy.DISMANTLE)
PATIENT = State(patient=True)


# Deployment.


def test_a_task_goes_through_the_four_acts() -> None:
    history = History()
    assert kinds(history.hear(Accepted(100))) == [Discover]
    assert history.hear(Discovered()) == [Compose(1, frozenset(), None)]
    effects = history.composed(navigation())
    assert kinds(effects) == [Watch] * 3 + [ApplyTo] * 3
    assert history.answer(TRACKER, Call.APPLY) == []
    assert history.answer(DRIVE, Call.APPLY) == []
    assert history.answer(CONTROL, Call.APPLY) == [SetOn(CONTROL, history.state.epoch, {"goal": GOAL})]
    assert history.state.pending == {(CONTROL, Call.SET)}
    assert history.answer(CONTROL, Call.SET) == [Running(navigation())]
    assert history.state.phase is Phase.RUNNING


def test_the_wiring_names_all_the_outputs_that_an_input_follows() -> None:
    both = navigation()
    both = type(both)(
        both.template,
        both.assignments,
        (*both.connections, Connection(TRACKER, "quality", CONTROL, "position")),
    )
    assert wiring(both) == {
        TRACKER: {},
        CONTROL: {"position": (Wire(TRACKER, "pose"), Wire(TRACKER, "quality"))},
        DRIVE: {"velocity": (Wire(CONTROL, "set"),)},
    }


def test_the_epoch_starts_above_the_one_it_was_given_and_goes_with_every_call() -> None:
    history = History().accepted()
    effects = history.composed(navigation())
    assert history.state.epoch > 100
    assert {effect.epoch for effect in effects if isinstance(effect, ApplyTo)} == {history.state.epoch}


def test_a_configuration_without_settings_runs_as_soon_as_all_are_active() -> None:
    plain = navigation()
    plain = type(plain)(plain.template, plain.assignments, plain.connections)
    history = History().accepted()
    history.composed(plain)
    for component in (TRACKER, CONTROL, DRIVE):
        last = history.answer(component, Call.APPLY)
    assert last == [Running(plain)]


def test_a_configuration_without_components_runs_at_once() -> None:
    nobody = type(navigation())(navigation().template, ())
    history = History().accepted()
    assert history.composed(nobody) == [Running(nobody)]


def test_a_second_task_is_passed_over_while_there_is_one() -> None:
    history = History().running()
    assert history.hear(Accepted(999)) == []


def test_the_result_of_an_older_search_is_passed_over() -> None:
    history = History().accepted()
    assert history.hear(Composed(history.state.attempt - 1, navigation())) == []
    assert history.state.phase is Phase.COMPOSING


def test_an_answer_to_an_older_epoch_is_passed_over() -> None:
    history = History().accepted()
    history.composed(navigation())
    old = history.state.epoch - 1
    assert history.hear(Answered(TRACKER, Call.APPLY, old, Verdict.REFUSED)) == []
    assert TRACKER in history.state.held


def test_a_component_that_answers_twice_counts_once() -> None:
    history = History().accepted()
    history.composed(navigation())
    for _ in range(3):
        assert history.answer(TRACKER, Call.APPLY) == []
    assert history.state.phase is Phase.DEPLOYING


# Refusals of components.


@pytest.mark.parametrize("verdict", [Verdict.REFUSED, Verdict.BUSY, None])
def test_a_component_that_will_not_be_activated_is_dropped_and_the_search_runs_again(verdict: Verdict | None) -> None:
    history = History().accepted()
    history.composed(navigation())
    history.answer(CONTROL, Call.APPLY)
    effects = history.answer(TRACKER, Call.APPLY, verdict)
    assert released(effects) == [TRACKER]
    assert effects[-1] == Compose(2, frozenset({TRACKER}), navigation())
    assert history.state.lost[TRACKER].cause is Cause.REFUSED
    assert history.state.lost[TRACKER].busy == (verdict is Verdict.BUSY)
    effects = history.composed(navigation(ODOMETRY))
    assert sorted(applied(effects)) == sorted([ODOMETRY, CONTROL, DRIVE])
    assert kinds(history.all_answer()) == [Running]


def test_a_component_that_refuses_its_parameter_is_dropped() -> None:
    history = History(state_in(Phase.SETTING))
    effects = history.answer(CONTROL, Call.SET, Verdict.REFUSED)
    assert released(effects) == [CONTROL]
    assert effects[-1] == Compose(2, frozenset({CONTROL}), navigation())


def test_a_component_that_has_obeyed_a_newer_epoch_is_asked_with_one_newer_still() -> None:
    history = History().accepted()
    history.composed(navigation())
    for component in (CONTROL, DRIVE):
        history.answer(component, Call.APPLY)
    epoch = history.state.epoch
    effects = history.hear(Answered(TRACKER, Call.APPLY, epoch, Verdict.STALE, "1", 5000))
    assert effects == [ApplyTo(TRACKER, 5001, {})]
    assert kinds(history.all_answer()) == [Running]


def test_a_component_that_calls_an_epoch_stale_without_a_newer_one_is_dropped_for_that_would_never_end() -> None:
    history = History().accepted()
    history.composed(navigation())
    epoch = history.state.epoch
    history.hear(Answered(TRACKER, Call.APPLY, epoch, Verdict.STALE, "1", epoch))
    assert TRACKER in history.state.lost


def test_a_parameter_is_set_again_when_its_call_was_stale() -> None:
    history = History(state_in(Phase.SETTING))
    epoch = history.state.epoch
    effects = history.hear(Answered(CONTROL, Call.SET, epoch, Verdict.STALE, "1", 7000))
    assert effects == [SetOn(CONTROL, 7001, {"goal": GOAL})]
    assert history.answer(CONTROL, Call.SET) == [Running(navigation())]


def test_a_parameter_whose_setting_was_cut_short_is_set_when_the_rest_is_repaired() -> None:
    history = History(state_in(Phase.SETTING))
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    effects = history.composed(navigation(ODOMETRY))
    assert CONTROL in applied(effects)
    last = [effect for component in (ODOMETRY, CONTROL) for effect in history.answer(component, Call.APPLY)]
    assert last == [SetOn(CONTROL, history.state.epoch, {"goal": GOAL})]


def test_a_parameter_is_set_again_on_one_that_began_a_new_life_while_it_was_wired_anew() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    history.composed(navigation(ODOMETRY))
    history.answer(ODOMETRY, Call.APPLY)
    assert history.answer(CONTROL, Call.APPLY, life="2") == [SetOn(CONTROL, history.state.epoch, {"goal": GOAL})]
    assert history.answer(CONTROL, Call.SET, life="2") == [Running(navigation(ODOMETRY))]


def test_a_parameter_is_not_set_again_on_one_that_lives_on() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    history.composed(navigation(ODOMETRY))
    history.answer(ODOMETRY, Call.APPLY)
    assert history.answer(CONTROL, Call.APPLY) == [Running(navigation(ODOMETRY))]


# Losses.


def test_after_a_failure_the_rest_is_kept() -> None:
    history = History().running()
    effects = history.hear(Failed(TRACKER, "1", Cause.FAIL, "lost her"))
    assert released(effects) == [TRACKER]
    assert effects[-1] == Compose(2, frozenset({TRACKER}), navigation())
    effects = history.composed(navigation(ODOMETRY))
    assert applied(effects) == [ODOMETRY, CONTROL]
    assert effects.index(Watch(ODOMETRY)) < effects.index(
        next(effect for effect in effects if isinstance(effect, ApplyTo) and effect.component == ODOMETRY)
    )
    assert DRIVE not in released(effects)
    assert history.all_answer() == [Running(navigation(ODOMETRY))]
    assert not any(isinstance(effect, SetOn) for effect in effects)  # the goal is still set
    assert history.state.target == navigation(ODOMETRY)


def test_a_new_component_is_applied_to_before_one_that_waits_for_its_signals() -> None:
    first, then = (
        replace(configuration, assignments=configuration.assignments[::-1])
        for configuration in (navigation(), navigation(ODOMETRY))
    )
    history = History().running(first)
    history.hear(Failed(TRACKER, "1", Cause.FAIL, "lost her"))
    assert then.components.index(CONTROL) < then.components.index(ODOMETRY)
    assert applied(history.composed(then)) == [ODOMETRY, CONTROL]


def test_dismantling_releases_all_components_before_the_search() -> None:
    history = History(DISMANTLE).running()
    effects = history.hear(Failed(TRACKER, "1", Cause.FAIL))
    assert sorted(released(effects)) == sorted([TRACKER, CONTROL, DRIVE])
    assert not any(isinstance(effect, Compose) for effect in effects)
    history.answer(TRACKER, Call.RELEASE)
    history.answer(CONTROL, Call.RELEASE)
    assert history.answer(DRIVE, Call.RELEASE) == [Compose(2, frozenset({TRACKER}), None)]
    effects = history.composed(navigation(ODOMETRY))
    assert sorted(applied(effects)) == sorted([ODOMETRY, CONTROL, DRIVE])
    assert history.all_answer()[-1] == Running(navigation(ODOMETRY))


def test_the_goal_is_set_again_after_dismantling() -> None:
    history = History(DISMANTLE).running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    history.all_answer()
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    assert sum(isinstance(effect, SetOn) for effect in history.effects) == 2


def test_a_component_that_is_not_needed_any_more_is_released() -> None:
    alone = navigation(ODOMETRY)
    alone = type(alone)(alone.template, alone.assignments[:1])
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL))
    effects = history.composed(alone)
    assert sorted(released(effects)) == sorted([CONTROL, DRIVE])
    assert set(history.state.held) == {ODOMETRY}
    assert history.state.watched == {ODOMETRY}


def test_a_component_that_crashed_is_not_released_but_owed_a_release() -> None:
    history = History().running()
    effects = history.hear(Failed(TRACKER, "1", Cause.CRASH))
    assert released(effects) == []
    assert TRACKER in history.state.owed


def test_the_failure_of_an_earlier_life_is_passed_over() -> None:
    history = History().running()
    assert history.hear(Failed(TRACKER, "0", Cause.FAIL)) == []
    assert history.state.phase is Phase.RUNNING


def test_the_failure_of_a_stranger_is_passed_over() -> None:
    history = History().running()
    assert history.hear(Failed(ODOMETRY, "1", Cause.FAIL)) == []


def test_a_component_that_dies_during_deployment_is_replaced() -> None:
    history = History().accepted()
    history.composed(navigation())
    history.answer(CONTROL, Call.APPLY)
    assert history.hear(Failed(TRACKER, "1", Cause.CRASH))[-1] == Compose(2, frozenset({TRACKER}), navigation())
    history.composed(navigation(ODOMETRY))
    assert kinds(history.all_answer()) == [Running]


def test_the_silence_of_a_component_that_has_not_begun_is_no_loss() -> None:
    history = History().accepted()
    history.composed(navigation())
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
    assert sorted(released(effects)) == sorted([TRACKER, CONTROL, DRIVE])
    assert sorted(effect.component for effect in effects if isinstance(effect, Unwatch)) == sorted(
        [TRACKER, CONTROL, DRIVE]
    )
    assert history.all_answer() == [Finish(REFUSAL)]
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


def test_after_being_cut_off_all_components_are_applied_to_anew() -> None:
    history = History().running()
    assert history.hear(Reconnected()) == [Discover()]
    history.hear(Discovered())
    effects = history.composed(navigation())
    assert sorted(applied(effects)) == sorted([TRACKER, CONTROL, DRIVE])
    for component in (TRACKER, CONTROL, DRIVE):
        last = history.answer(component, Call.APPLY)
    assert kinds(last) == [SetOn]
    assert kinds(history.all_answer()) == [Running]


def test_after_being_cut_off_during_deployment_it_begins_anew() -> None:
    history = History().accepted()
    history.composed(navigation())
    assert history.hear(Reconnected()) == [Discover()]
    assert history.answer(TRACKER, Call.APPLY) == []
    history.hear(Discovered())
    assert sorted(applied(history.composed(navigation()))) == sorted([TRACKER, CONTROL, DRIVE])


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
    history.hear(Stopped())
    for component in (TRACKER, CONTROL):
        history.answer(component, Call.RELEASE)
    assert history.answer(DRIVE, Call.RELEASE, None) == [Finish()]
    assert history.state.owed.keys() == {DRIVE}


def test_a_stop_waits_for_a_component_that_was_just_released() -> None:
    history = History().running()
    history.hear(Failed(TRACKER, "1", Cause.FAIL), Stopped())
    for component in (CONTROL, DRIVE):
        history.answer(component, Call.RELEASE)
    assert history.state.phase is Phase.DISMANTLING
    assert history.answer(TRACKER, Call.RELEASE) == [Finish()]
