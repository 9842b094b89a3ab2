"""A component that is blind: an actuator rests after as long as it tolerates, and starts again when it is fed."""

from __future__ import annotations

from dataclasses import replace

import pytest

from selfconf.model.profile import Input, Output, Ports, offered_operation
from selfconf.model.term import IRI, Literal, Term
from selfconf.protocol.messages import Cause, Wire
from selfconf.sdk.component import Refused
from selfconf.sdk.runtime import ComponentRuntime
from selfconf.sdk.unfed_inputs import TOLERATES
from tests.lab import Recorder
from tests.sdk.stage import DRIVE, DRIVE_PROFILE, KEYS, THEM, TRACKER, US, Stage, apply, follow, release, reserve

CHART = IRI("urn:c:chart")


class Driving(Recorder):
    """Writes down when it is blind, and counts the ticks of a timer that it begins in `started`."""

    ticks = 0

    def started(self) -> None:
        super().started()
        self.every(0.1, self.tick)

    def tick(self) -> None:
        self.ticks += 1

    def unfed(self, port: str) -> None:
        self.said.append(("unfed", port))

    def fed(self, port: str) -> None:
        self.said.append(("fed", port))


def driving(tolerates: float | None = None, outputs: tuple[Output, ...] = ()) -> tuple[Stage, ComponentRuntime]:
    """An actuator, where it has no outputs, that acts and is fed by a tracker."""
    ports = DRIVE_PROFILE.ports._replace(outputs=outputs)
    stage = Stage(Driving(), replace(DRIVE_PROFILE, tolerates=tolerates, ports=ports))
    tracker = stage.neighbour()
    stage.call(reserve())
    stage.call(follow(values={"goal": Literal("x")}))
    tracker.component.emit("pose", 1)
    stage.let_pass(0.1)
    assert stage.recorder.said == [("goal", "x"), ("started",), ("position", 1)]
    stage.recorder.said.clear()
    return stage, tracker


def test_an_actuator_that_is_reserved_with_other_inputs_than_it_follows_rests_and_one_with_the_same_acts_on() -> None:
    """Its task has given it up when it could not be heard; what it follows may act for another task by now."""
    stage, tracker = driving()
    stage.call(reserve(2, inputs={"position": (Wire(TRACKER, "pose"),)}))
    stage.let_pass(2 * TOLERATES)
    assert stage.recorder.said == []
    assert stage.call(reserve(3, inputs={"position": (Wire(CHART, "pose"),)})).active
    tracker.component.emit("pose", 2)
    stage.let_pass(2 * TOLERATES)
    assert stage.recorder.said == [("unfed", "position"), ("stopped",)]
    stage.call(follow(3, values={"goal": Literal("x")}))
    stage.let_pass(0.1)
    assert stage.recorder.said[2:] == [("goal", "x"), ("started",), ("fed", "position"), ("position", 2)]


@pytest.mark.parametrize(("tolerates", "seconds"), [(None, 0.0), (0.3, 0.0), (5.0, 4.0)])
def test_an_actuator_whose_configuration_stays_incomplete_rests_and_starts_when_it_is_fed(
    tolerates: float | None, seconds: float
) -> None:
    stage, tracker = driving(tolerates)
    stage.call(apply(2, US, {"position": ()}, {"goal": Literal("x")}, rests=True))
    if seconds:
        stage.let_pass(seconds - 0.1)
        assert stage.recorder.said == [("unfed", "position")]
        stage.let_pass(0.2)
    assert stage.recorder.said == [("unfed", "position"), ("stopped",)]
    stage.let_pass(2 * TOLERATES)
    assert stage.recorder.said[2:] == [], "it has stopped once"
    stage.call(follow(3, values={"goal": Literal("x")}))
    tracker.component.emit("pose", 2)
    stage.let_pass(0.1)
    assert stage.recorder.said[2:5] == [("goal", "x"), ("started",), ("fed", "position")]
    assert stage.recorder.said[-1] == ("position", 2)


def test_an_actuator_that_is_to_rest_does_so_though_it_is_fed_and_starts_when_it_is_told() -> None:
    stage, tracker = driving()
    stage.call(follow(2, values={"goal": Literal("x")}, rests=True))
    assert stage.recorder.said == [("stopped",)]
    tracker.component.emit("pose", 2)
    stage.let_pass(2 * TOLERATES)
    assert stage.recorder.said[1:] == []
    stage.call(follow(3, values={"goal": Literal("x")}))
    stage.let_pass(0.1)
    assert stage.recorder.said[1:] == [("goal", "x"), ("started",), ("position", 2)], "it hears what it has missed"


def test_an_actuator_that_starts_again_hears_the_last_of_its_other_inputs_once_more() -> None:
    ports = Ports((*DRIVE_PROFILE.inputs, Input("map", (IRI("urn:s:Pose"),))))
    stage = Stage(Driving(), replace(DRIVE_PROFILE, ports=ports))
    tracker, chart = stage.neighbour(), stage.neighbour(component=CHART)
    inputs = {"position": (Wire(TRACKER, "pose"),), "map": (Wire(CHART, "pose"),)}
    stage.call(reserve())
    stage.call(apply(1, US, inputs, {"goal": Literal("x")}))
    for source, value in ((tracker, 1), (chart, "old map")):
        source.component.emit("pose", value)
    stage.let_pass(0.1)
    stage.call(apply(2, US, inputs | {"position": ()}, {"goal": Literal("x")}))
    stage.let_pass(2 * TOLERATES)
    assert stage.recorder.said[-1] == ("stopped",)
    chart.component.emit("pose", "new map")
    stage.let_pass(0.1)
    stage.recorder.said.clear()
    stage.call(apply(3, US, inputs, {"goal": Literal("x")}))
    stage.let_pass(0.1)
    assert stage.recorder.said[:3] == [("goal", "x"), ("started",), ("fed", "position")]
    assert stage.recorder.said[3:] == [("position", 1), ("map", "new map")]


@pytest.mark.parametrize(
    "inputs", [(), (Input("position", (IRI("urn:t:Pose"),), optional=True),)], ids=["none", "optional"]
)
def test_an_actuator_that_requires_no_input_rests_as_well(inputs: tuple[Input, ...]) -> None:
    stage = Stage(Driving(), replace(DRIVE_PROFILE, ports=Ports(inputs)))
    stage.call(reserve())
    stage.call(apply(1, US, {}, {"goal": Literal("x")}))
    stage.call(apply(2, US, {}, {"goal": Literal("x")}, rests=True))
    assert stage.recorder.said == [("goal", "x"), ("started",), ("stopped",)]
    stage.let_pass(2 * TOLERATES)
    stage.call(apply(3, US, {}, {"goal": Literal("y")}))
    assert [one for one in stage.recorder.said[3:] if one == ("started",)] == [("started",)]
    assert ("goal", "y") in stage.recorder.said[3:]


def test_an_actuator_that_tasks_share_rests_while_all_of_them_lack_something() -> None:
    stage = Stage(Driving(), replace(DRIVE_PROFILE, ports=Ports(), shareable=True))
    values: dict[str, Term] = {}
    for task in (US, THEM):
        stage.call(reserve(supervisor=task))
        stage.call(apply(1, task, {}, values))
    stage.call(apply(2, US, {}, values, rests=True))
    assert stage.recorder.said[-1] == ("started",), "the other task lacks nothing"
    stage.call(apply(2, THEM, {}, values, rests=True))
    assert stage.recorder.said[-1] == ("stopped",)
    stage.call(apply(3, US, {}, values))
    assert stage.recorder.said[-1] == ("started",)
    stage.call(release(3, US))
    assert stage.recorder.said[-1] == ("stopped",), "the other one lacks something still"


def shared_drive() -> Stage:
    """An actuator that acts for two tasks, and follows the tracker for both."""
    stage = Stage(Driving(), replace(DRIVE_PROFILE, shareable=True))
    stage.others.announce(THEM)
    tracker = stage.neighbour()
    for task in (US, THEM):
        stage.call(reserve(supervisor=task, inputs=follow().inputs))
        stage.call(follow(supervisor=task))
    tracker.component.emit("pose", 1)
    stage.let_pass(0.1)
    return stage


@pytest.mark.parametrize("ends", ["release", "orphan"])
def test_a_shared_actuator_rests_when_the_task_lets_go_of_it_that_lacked_nothing(ends: str) -> None:
    stage = shared_drive()
    stage.call(apply(2, THEM, {"position": ()}, rests=True))
    stage.let_pass(0.1)
    assert stage.recorder.said[-1] == ("position", 1), "the other task lacks nothing"
    if ends == "release":
        stage.call(release(2, US))
    else:
        stage.leave()
        stage.let_pass(1.2)
    assert stage.recorder.said[-1] == ("stopped",)
    stage.let_pass(0.1)
    stage.call(follow(3, supervisor=THEM))
    stage.let_pass(0.1)
    assert (stage.recorder.said[-1] == ("position", 1)) is (ends == "release"), "the tracker has ended with its task"


def test_a_shared_actuator_rests_when_the_last_of_its_tasks_says_so() -> None:
    stage = shared_drive()
    for task in (US, THEM):
        stage.call(apply(2, task, {"position": ()}, rests=True))
    assert stage.recorder.said[-1] == ("stopped",)


def test_what_feeds_others_acts_on_in_a_configuration_that_is_incomplete() -> None:
    source = Stage()
    source.call(follow())
    source.call(apply(2, US, {"position": ()}, rests=True))
    source.let_pass(2 * TOLERATES)
    assert ("stopped",) not in source.recorder.said


@pytest.mark.parametrize(("tolerates", "seconds"), [(None, TOLERATES), (0.3, 0.3), (5.0, 5.0)])
def test_an_actuator_rests_when_it_has_been_blind_for_longer_than_it_tolerates(
    tolerates: float | None, seconds: float
) -> None:
    stage, tracker = driving(tolerates)
    tracker.bus.close()
    stage.let_pass(seconds - 0.05)
    assert stage.recorder.said == [("unfed", "position")]
    stage.let_pass(0.1)
    assert stage.recorder.said == [("unfed", "position"), ("stopped",)]
    stage.let_pass(100)
    assert stage.recorder.said == [("unfed", "position"), ("stopped",)]


def test_an_actuator_rests_though_it_offers_an_operation_and_what_has_an_output_acts_on() -> None:
    offered = offered_operation("go", IRI("http://x#Goal"), IRI("http://x#Reached"))
    for outputs, said in (((offered,), [("stopped",)]), ((offered, Output("odometry", ())), [])):
        stage, tracker = driving(outputs=outputs)
        tracker.bus.close()
        stage.let_pass(10 * TOLERATES)
        assert stage.recorder.said == [("unfed", "position"), *said]


def test_it_is_still_held_and_starts_again_with_its_parameters_when_it_is_fed() -> None:
    stage, tracker = driving()
    tracker.bus.close()
    stage.let_pass(2 * TOLERATES)
    assert stage.state().active
    stage.recorder.said.clear()
    stage.neighbour(life="life-u").component.emit("pose", 2)
    stage.let_pass(0.1)
    assert stage.recorder.said == [("goal", "x"), ("started",), ("fed", "position"), ("position", 2)]
    assert stage.fails == []


def test_an_actuator_that_is_fed_again_in_time_does_not_rest() -> None:
    stage, tracker = driving()
    tracker.bus.close()
    stage.let_pass(TOLERATES / 2)
    stage.neighbour(life="life-u").component.emit("pose", 2)
    stage.let_pass(10 * TOLERATES)
    assert stage.recorder.said == [("unfed", "position"), ("fed", "position"), ("position", 2)]


def test_its_timers_rest_too_and_are_not_doubled_when_it_starts_again() -> None:
    stage, tracker = driving()
    component = stage.component
    assert isinstance(component, Driving)
    tracker.bus.close()
    stage.let_pass(2 * TOLERATES)
    component.ticks = 0
    stage.let_pass(1.0)
    assert component.ticks == 0
    stage.neighbour(life="life-u").component.emit("pose", 2)
    stage.let_pass(1.05)
    assert component.ticks == 10


def test_a_component_that_feeds_others_is_told_that_it_is_blind_and_acts_on() -> None:
    stage = Stage(Driving())
    tracker = stage.neighbour()
    stage.call(follow())
    stage.let_pass(0.1)
    tracker.bus.close()
    stage.let_pass(100)
    assert stage.recorder.said == [("started",), ("unfed", "position")]


def test_an_actuator_that_cannot_start_again_fails() -> None:
    stage, tracker = driving()
    tracker.bus.close()
    stage.let_pass(2 * TOLERATES)
    stage.recorder.refusal = Refused("the battery is empty")
    stage.neighbour(life="life-u").component.emit("pose", 2)
    stage.let_pass(0.1)
    assert [(fail.component, fail.cause, fail.detail) for fail in stage.fails] == [
        (DRIVE, Cause.FAIL, "the battery is empty")
    ]
    assert not stage.component.active


def test_an_actuator_that_is_released_while_it_rests_stays_off() -> None:
    stage, tracker = driving()
    tracker.bus.close()
    stage.let_pass(2 * TOLERATES)
    stage.call(release(2))
    stage.neighbour(life="life-u").component.emit("pose", 2)
    stage.let_pass(10)
    assert stage.recorder.said == [("unfed", "position"), ("stopped",)]


def test_an_actuator_that_is_released_while_it_is_blind_is_stopped_once() -> None:
    stage, tracker = driving()
    tracker.bus.close()
    stage.let_pass(TOLERATES / 2)
    stage.call(release(2))
    stage.let_pass(10)
    assert stage.recorder.said == [("unfed", "position"), ("stopped",)]


def test_an_actuator_that_rests_hears_that_an_input_is_fed_and_its_signal_once_it_is_started() -> None:
    ports = Ports((*DRIVE_PROFILE.inputs, Input("map", (IRI("urn:s:Pose"),))))
    stage = Stage(Driving(), replace(DRIVE_PROFILE, ports=ports))
    tracker, chart = stage.neighbour(), stage.neighbour(component=CHART)
    inputs = {"position": (Wire(TRACKER, "pose"),), "map": (Wire(CHART, "pose"),)}
    stage.call(reserve())
    stage.call(apply(1, US, inputs, {"goal": Literal("x")}))
    tracker.bus.close()
    chart.bus.close()
    stage.let_pass(2 * TOLERATES)
    assert stage.recorder.said[-1] == ("stopped",)
    stage.recorder.said.clear()
    stage.neighbour(life="life-u", component=CHART).component.emit("pose", "map")
    stage.let_pass(0.1)
    assert stage.recorder.said == [("fed", "map")]
    stage.neighbour(life="life-u").component.emit("pose", 2)
    stage.let_pass(0.1)
    assert stage.recorder.said[1:3] == [("goal", "x"), ("started",)]
    assert stage.recorder.said[3:] == [("fed", "position"), ("position", 2), ("map", "map")]


def test_each_input_may_be_unfed_for_that_long_by_itself() -> None:
    inputs = (Input("left", (IRI("urn:s:Pose"),)), Input("right", (IRI("urn:s:Pose"),)))
    stage = Stage(Driving(), replace(DRIVE_PROFILE, ports=Ports(inputs)))
    wires = {"left": (Wire(TRACKER, "pose"),), "right": (Wire(IRI("urn:c:other"), "pose"),)}
    left = stage.neighbour()
    right = stage.network.node()
    end_right = right.announce(KEYS.life(IRI("urn:c:other"), "1"))
    stage.call(reserve())
    stage.call(apply(1, US, wires))
    stage.let_pass(0.1)
    left.bus.close()
    stage.let_pass(0.8 * TOLERATES)
    end_right()
    stage.let_pass(0.1)
    stage.neighbour(life="life-u").component.emit("pose", 2)
    stage.let_pass(0.7 * TOLERATES)
    assert ("stopped",) not in stage.recorder.said
    stage.let_pass(0.3 * TOLERATES)
    assert stage.recorder.said[-1] == ("stopped",)
