"""The inputs of a component: they change together, as a call says."""

from __future__ import annotations

from dataclasses import replace

from selfconf.model.profile import Input
from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire
from selfconf.sdk.unfed_inputs import TOLERATES
from tests.sdk.stage import (
    CAP_PROFILE,
    DRIVE_PROFILE,
    ODOMETRY,
    TRACKER,
    US,
    Stage,
    Watchful,
    apply,
    follow,
    other_source,
    reserve,
)


def test_rewiring_an_input_neither_stops_nor_starts_the_component() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(1))
    tracker.component.emit("pose", 1)
    stage.let_pass(0.1)
    stage.call(apply(2, US, {"position": (Wire(IRI("urn:c:odometry"), "pose"),)}))
    tracker.component.emit("pose", 2)
    stage.let_pass(0.1)
    stage.call(apply(3, US, {"position": (Wire(TRACKER, "pose"),)}))
    tracker.component.emit("pose", 3)
    stage.let_pass(0.1)
    assert [said for said in stage.recorder.said if said != ("position", 2)] == [
        ("started",),
        ("position", 1),
        ("position", 3),
    ]


def test_an_actuator_that_starts_while_nothing_stands_behind_its_source_rests_until_something_does() -> None:
    """A composite that feeds it is being repaired inside."""
    stage = Stage(profile=DRIVE_PROFILE)
    stage.call(reserve())
    stage.call(apply(1))
    assert stage.recorder.said == [("started",)]
    stage.let_pass(TOLERATES + 0.1)
    assert stage.recorder.said == [("started",), ("stopped",)]
    tracker = stage.neighbour()
    stage.call(follow(2))
    tracker.component.emit("pose", 1)
    stage.let_pass(0.1)
    assert stage.recorder.said[2:] == [("started",), ("position", 1)]


def test_a_component_hears_what_it_has_lost_before_what_it_has_gained() -> None:
    """By one call the first input changes to an output that has just issued, and the second one is left with none."""
    two = tuple(Input(name, (IRI("urn:s:Pose"),)) for name in ("first", "second"))
    stage = Stage(Watchful(), replace(CAP_PROFILE, ports=CAP_PROFILE.ports._replace(inputs=two)))
    tracker, odometry = stage.neighbour(), other_source(stage)
    pose, other = (Wire(TRACKER, "pose"),), (Wire(ODOMETRY, "pose"),)
    stage.call(apply(1, US, {"first": pose, "second": pose}, standby={"first": other}))
    tracker.component.emit("pose", "old")
    stage.let_pass(0.1)
    odometry.component.emit("pose", "new")
    stage.let_pass(0.1)
    heard = len(stage.recorder.said)
    stage.call(apply(2, US, {"first": other, "second": (Wire(IRI("urn:c:button"), "pose"),)}))
    stage.let_pass(0.1)
    assert stage.recorder.said[heard:] == [("unfed", "second"), ("first", "new")]
