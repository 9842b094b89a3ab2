"""The inputs of a component: what they pass on, what they pass over, and when they report silence."""

from __future__ import annotations

import pytest

from selfconf.bus.port import Urgency
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import (
    Apply,
    Cause,
    Release,
    Stamp,
    Wire,
)
from selfconf.sdk.inputs import BEGINNING, PATIENCE
from tests.sdk.stage import CAP, KEYS, TRACKER, US, Stage, follow


def test_rewiring_an_input_neither_stops_nor_starts_the_component() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(1))
    tracker.emit("pose", 1, None)
    stage.let_pass(0.1)
    stage.call(Apply(2, US, {"position": (Wire(IRI("urn:c:odometry"), "pose"),)}))
    tracker.emit("pose", 2, None)
    stage.let_pass(0.1)
    stage.call(Apply(3, US, {"position": (Wire(TRACKER, "pose"),)}))
    tracker.emit("pose", 3, None)
    stage.let_pass(0.1)
    assert [said for said in stage.recorder.said if said != ("position", 2)] == [
        ("started",),
        ("position", 1),
        ("position", 3),
    ]


@pytest.mark.parametrize(
    ("payload", "attachment"),
    [
        (b"1", b""),
        (b"1", b"raw"),
        (b"not json", encode(Stamp(TRACKER, "l", 1, 0.0))),
        (b"[" * 100_000, encode(Stamp(TRACKER, "l", 1, 0.0))),
        (b"1", encode(Stamp(CAP, "l", 1, 0.0))),
        (b"1", encode(Release(1, US))),
        (b"\xff\xfe", encode(Stamp(TRACKER, "l", 1, 0.0))),
    ],
)
def test_what_is_no_signal_of_the_source_is_passed_over(payload: bytes, attachment: bytes) -> None:
    stage = Stage()
    stage.call(follow())
    stage.others.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT).put(payload, attachment)
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",)]
    assert stage.component.active


def test_signals_that_come_late_or_twice_are_passed_over_and_a_new_life_counts_from_one_again() -> None:
    stage = Stage()
    stage.call(follow())
    source = stage.others.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT)
    for life, sequence in (("a", 1), ("a", 3), ("a", 2), ("a", 3), ("b", 1), ("b", 2)):
        source.put(b"%d" % sequence, encode(Stamp(TRACKER, life, sequence, 0.0)))
    stage.let_pass(0.1)
    assert [value for _, value in stage.recorder.said[1:]] == [1, 3, 1, 2]


def silence(stage: Stage) -> list[tuple[IRI, str]]:
    """Whose silence was reported, and in which life."""
    return [(fail.component, fail.life) for fail in stage.fails if fail.cause is Cause.SILENCE]


def test_an_output_that_promised_a_rate_and_stops_is_reported_and_again_as_long_as_nothing_comes() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(period=0.1))
    tracker.emit("pose", 1, None)
    stage.let_pass(PATIENCE * 0.1 - 0.05)
    assert not silence(stage)
    stage.let_pass(0.1)
    assert silence(stage) == [(TRACKER, "")]
    stage.let_pass(PATIENCE * 0.1)
    assert len(silence(stage)) == 2
    tracker.emit("pose", 2, None)
    stage.let_pass(0.1)
    assert len(silence(stage)) == 2


def test_an_output_that_keeps_its_promise_is_not_reported() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(period=0.1))
    for number in range(50):
        tracker.emit("pose", number, None)
        stage.let_pass(0.1)
    assert not silence(stage)


def test_an_output_may_take_its_time_to_begin_but_not_for_ever() -> None:
    stage = Stage()
    stage.neighbour()
    stage.call(follow(period=0.1))
    stage.let_pass(BEGINNING - 1)
    assert not silence(stage)
    stage.let_pass(1.1)
    assert silence(stage)


def test_an_output_that_promised_nothing_may_be_silent() -> None:
    stage = Stage()
    stage.neighbour().emit("pose", 1, None)
    stage.call(follow())
    stage.let_pass(100)
    assert not silence(stage)


def test_an_output_that_is_followed_no_more_may_be_silent() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(1, period=0.1))
    tracker.emit("pose", 1, None)
    stage.let_pass(0.05)
    stage.call(Apply(2, US))
    stage.let_pass(10)
    assert not silence(stage)
