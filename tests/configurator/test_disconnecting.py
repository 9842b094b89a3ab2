"""What is lost is followed no more, and no actuator acts for long on a part of its configuration."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.configurator.effects import ApplyTo, AwaitRelease
from selfconf.configurator.events import (
    Adopted,
    Call,
    Discovered,
    Event,
    Failed,
    Improvable,
    LossLasts,
    Reconnected,
    Rewired,
)
from selfconf.configurator.starting_order import wiring
from selfconf.configurator.state import Phase
from selfconf.model.configuration import Assignment, Configuration, Connection
from selfconf.model.holder import Holder
from selfconf.model.term import IRI
from selfconf.protocol.messages import Cause, Wire
from tests.configurator.builders import (
    ARM,
    CONTROL,
    DRIVE,
    LOWER,
    ODOMETRY,
    OTHERS,
    TASK,
    TRACKER,
    History,
    applied,
    kinds,
    navigation,
    reserved,
    state_in,
    with_arm,
)

LAMP = IRI("urn:c:lamp")
LOST = Failed(TRACKER, "1", Cause.CRASH)


@pytest.mark.parametrize("holder", [OTHERS, LOWER])
def test_nobody_follows_a_component_that_turns_out_to_act_for_another_task(holder: Holder) -> None:
    history = History(TASK).running()
    history.hear(Failed(TRACKER, "1", Cause.CRASH))
    history.composed(navigation(ODOMETRY))
    assert {ODOMETRY, CONTROL} == {*applied(history.answer(ODOMETRY, Call.WAKE))}, "at once"
    before = history.state.epoch
    effects = history.busy(ODOMETRY, holder, Call.APPLY)
    (apart,) = [effect for effect in effects if isinstance(effect, ApplyTo)]
    assert (apart.component, apart.inputs["position"]) == (CONTROL, ())
    assert apart.epoch > before, "it is obeyed whatever comes first"
    if holder is LOWER:
        assert reserved(history.all_answer(Call.WAKE)) == [ODOMETRY], "it is asked to let go of it"
        assert kinds(history.busy(ODOMETRY, holder)) == [AwaitRelease], "nobody follows it any more"
    else:
        history.composed(navigation(ARM))
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert history.state.held[CONTROL].inputs["position"] != ()


def with_dormant_source() -> History:
    """What runs has lost a source, and the next one has to be started by its site, which takes long."""
    history = History(TASK).running(with_arm(navigation()))
    history.hear(Failed(TRACKER, "1", Cause.CRASH))
    history.composed(with_arm(navigation(ODOMETRY)))
    assert history.state.pending == {(ODOMETRY, Call.WAKE)}
    return history


def test_what_follows_a_component_that_was_lost_follows_it_no_longer_than_a_moment() -> None:
    history = with_dormant_source()
    before = history.state.epoch
    apart = {effect.component: effect for effect in history.hear(LossLasts()) if isinstance(effect, ApplyTo)}
    assert apart.keys() == {CONTROL, ARM}
    assert (apart[CONTROL].inputs["position"], apart[ARM].inputs["target"]) == ((), ())
    assert not any(effect.rests for effect in apart.values())
    assert all(effect.epoch > before for effect in apart.values())
    assert history.hear(LossLasts()) == [], "they follow nothing that is lost any more"
    assert history.state.held[DRIVE].confirmed
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert history.state.held[CONTROL].inputs["position"] == (Wire(ODOMETRY, "pose"),)


def test_no_actuator_acts_for_long_on_a_part_and_all_start_again_when_it_is_whole() -> None:
    history = with_dormant_source()
    history.hear(LossLasts())
    rests = [effect for effect in history.hear(LossLasts(frozenset((DRIVE, ARM)))) if isinstance(effect, ApplyTo)]
    assert [(effect.component, effect.inputs, effect.rests) for effect in rests] == [
        (DRIVE, {"velocity": ()}, True),
        (ARM, {"target": ()}, True),
    ]
    history.answer(ODOMETRY, Call.WAKE)
    history.all_answer(Call.WAKE, Call.RESERVE)
    assert applied(history.answer(ODOMETRY, Call.APPLY)) == [CONTROL], "actuators come last, also one that it feeds"
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert history.state.held[DRIVE].inputs == wiring(navigation(ODOMETRY))[DRIVE]


def test_an_actuator_rests_that_acts_and_is_just_being_connected_anew() -> None:
    history = with_dormant_source()
    history.hear(LossLasts())
    history.all_answer(Call.WAKE, Call.RESERVE)
    assert applied(history.answer(ODOMETRY, Call.APPLY)) == [CONTROL, ARM]
    rests = [effect for effect in history.hear(LossLasts(frozenset((DRIVE, ARM)))) if isinstance(effect, ApplyTo)]
    assert [(one.component, one.rests) for one in rests] == [(DRIVE, True), (ARM, True), (CONTROL, False)]
    assert {*applied(history.answer(CONTROL, Call.APPLY))} == {DRIVE, ARM}, "when everything else acts"
    history.all_answer()
    assert history.state.phase is Phase.RUNNING


def driven_by_calls() -> Configuration:
    """The arm has no input: it calls an operation of a lamp, which may be lost as well."""
    calls = Connection(LAMP, "shine()", ARM, "light()")
    roles = (Assignment(IRI("urn:r:arm"), (ARM,)), Assignment(IRI("urn:r:lamp"), (LAMP,)))
    whole = navigation()
    return replace(whole, assignments=(*whole.assignments, *roles), connections=(*whole.connections, calls))


@pytest.mark.parametrize("events", [(Reconnected(), LOST), (LOST, Reconnected())], ids=["before", "after"])
def test_an_actuator_without_inputs_rests_though_nothing_is_sure_any_more(events: tuple[Event, ...]) -> None:
    history = History(TASK).running(driven_by_calls())
    history.hear(*events)
    told = [effect for effect in history.hear(LossLasts(frozenset((ARM,)))) if isinstance(effect, ApplyTo)]
    assert [one.rests for one in told if one.component == ARM] == [True]
    assert ARM not in applied(history.hear(LossLasts(frozenset((ARM,))))), "it is told once"


def test_an_actuator_that_rests_rests_on_when_what_it_calls_is_lost_as_well() -> None:
    history = History(TASK).running(driven_by_calls())
    history.hear(LOST)
    history.hear(LossLasts(frozenset((ARM,))))
    history.hear(Failed(LAMP, "1", Cause.CRASH))
    told = [effect for effect in history.hear(LossLasts()) if isinstance(effect, ApplyTo) and effect.component == ARM]
    assert [(one.inputs, one.rests) for one in told] == [({"light()": ()}, True)]


def test_an_actuator_inside_of_a_composite_that_is_to_rest_rests_on_when_something_inside_is_lost() -> None:
    whole = IRI("urn:c:whole")
    ports = (Connection(whole, "hint", CONTROL, "hint"), Connection(TRACKER, "pose", DRIVE, "way"))
    inside = replace(navigation(), connections=(*navigation().connections, *ports))
    history = History(TASK).running(inside)
    history.hear(Rewired(whole, True))
    history.all_answer()
    history.hear(LOST)
    told = [effect for effect in history.hear(LossLasts()) if isinstance(effect, ApplyTo)]
    assert {one.component: one.rests for one in told} == {CONTROL: False, DRIVE: True}


@pytest.mark.parametrize("phase", [Phase.RUNNING, Phase.REFUSED, Phase.DISMANTLING, Phase.IDLE])
def test_nothing_comes_of_a_loss_that_was_made_good_or_has_ended_the_task(phase: Phase) -> None:
    history = History(state_in(phase))
    assert history.hear(LossLasts(), LossLasts(frozenset((DRIVE, ARM)))) == []


def test_actuators_act_on_in_what_ran_while_something_better_is_prepared() -> None:
    history = History(TASK).running(navigation(ODOMETRY))
    history.hear(Improvable(), Discovered())
    history.composed(with_arm(navigation()))
    assert history.hear(LossLasts(frozenset((DRIVE, ARM)))) == []


@pytest.mark.parametrize("events", [(Reconnected(), LOST), (LOST, Reconnected())], ids=["before", "after"])
def test_actuators_rest_that_may_act_though_nothing_is_sure_any_more(events: tuple[Event, ...]) -> None:
    """The configurator was suspended, or cut off, before or after a component was lost."""
    history = History(TASK).running()
    history.hear(*events)
    assert DRIVE in applied(history.hear(LossLasts(frozenset((DRIVE,)))))
    history.hear(Discovered())
    history.composed(navigation(ODOMETRY))
    history.all_answer()
    assert history.state.phase is Phase.RUNNING
    assert history.state.held[DRIVE].inputs == wiring(navigation(ODOMETRY))[DRIVE]


def test_an_actuator_acts_on_while_only_another_actuator_is_started() -> None:
    """It would be started again at once, as actuators do not wait for each other."""
    history = History(TASK).running(with_arm(navigation()))
    history.hear(Failed(ARM, "1", Cause.CRASH, startable=True))
    history.composed(with_arm(navigation()))
    history.answer(ARM, Call.WAKE)
    history.answer(ARM, Call.RESERVE)
    assert history.state.pending == {(ARM, Call.APPLY)}
    assert history.hear(LossLasts(frozenset((DRIVE, ARM)))) == []


def test_what_is_inside_of_a_composite_follows_what_is_outside_on_when_something_inside_is_lost() -> None:
    whole = IRI("urn:c:whole")
    ports = (Connection(whole, "hint", CONTROL, "hint"), Connection(CONTROL, "set", whole, "out"))
    inside = replace(navigation(), connections=(*navigation().connections, *ports))
    history = History(TASK).running(inside)
    history.hear(LOST)
    (apart,) = [effect for effect in history.hear(LossLasts()) if isinstance(effect, ApplyTo)]
    assert apart.inputs == {"position": (), "hint": (Wire(whole, "hint"),)}


def test_what_was_adopted_hears_less_as_one_that_acts_already() -> None:
    """What stands behind the composites that it follows is not known yet."""
    history = History(TASK)
    history.hear(Adopted(100, navigation()), LOST)
    (apart,) = [effect for effect in history.hear(LossLasts()) if isinstance(effect, ApplyTo)]
    assert (apart.component, apart.adopted) == (CONTROL, True)


@pytest.mark.parametrize("acts", [True, False])
def test_an_actuator_that_acts_on_since_it_was_given_up_follows_nothing_that_is_lost_again(acts: bool) -> None:
    history = History(TASK).running()
    history.hear(Failed(DRIVE, "1", Cause.CRASH), Failed(CONTROL, "1", Cause.CRASH))
    history.composed(navigation())
    history.all_answer(Call.WAKE)
    history.answer(CONTROL, Call.RESERVE)
    history.answer(DRIVE, Call.RESERVE, acts=acts)
    assert history.state.phase is Phase.DEPLOYING
    history.hear(Failed(CONTROL, "1", Cause.FAIL))
    effects = [effect for effect in history.hear(LossLasts()) if isinstance(effect, ApplyTo)]
    told = [effect.component for effect in effects if not any(effect.inputs.values())]
    assert told == ([DRIVE] if acts else [])
