"""One input's subscription to one output: what is passed over, and how the component's code reads the rest."""

from __future__ import annotations

from typing import Any

import pytest

from selfconf.bus.port import Urgency
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Stamp, Wire
from selfconf.sdk.inputs.followed_output import FollowedOutput
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP,
    KEYS,
    TRACKER,
    US,
    Stage,
    apply,
    follow,
    release,
)


@pytest.mark.parametrize(
    ("payload", "attachment"),
    [
        (b"1", b""),
        (b"1", b"raw"),
        (b"not json", encode(Stamp(TRACKER, "l", 1, 0.0))),
        (b"[" * 100_000, encode(Stamp(TRACKER, "l", 1, 0.0))),
        (b"1", encode(Stamp(CAP, "l", 1, 0.0))),
        (b"1", encode(release(1, US))),
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


def test_whether_a_signal_has_just_come_is_judged_once_as_an_output_that_stood_by_is_followed(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Else it may neither count nor be asked for, as time passes between."""
    stage = Stage()
    position = {"position": (Wire(TRACKER, "pose"),)}
    stage.call(apply(1, US, standby=position))
    stage.others.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT).put(b"7", encode(Stamp(TRACKER, "l", 1, 0.0)))
    stage.let_pass(0.1)
    judged = iter((True, False))
    monkeypatch.setattr(FollowedOutput, "just_issued", property(lambda _: next(judged)))
    stage.call(apply(2, US, position))
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("position", 7)]


def test_signals_that_come_late_or_twice_are_passed_over_and_a_new_life_counts_from_one_again() -> None:
    stage = Stage()
    stage.call(follow())
    source = stage.others.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT)
    for life, sequence in (("a", 1), ("a", 3), ("a", 2), ("a", 3), ("b", 1), ("b", 2)):
        source.put(b"%d" % sequence, encode(Stamp(TRACKER, life, sequence, 0.0)))
    stage.let_pass(0.1)
    assert [value for _, value in stage.recorder.said[1:]] == [1, 3, 1, 2]


def test_a_component_may_read_values_in_a_way_of_its_own() -> None:
    class Reader(Recorder):
        @staticmethod
        def signal_value(value: Any, media: str) -> Any:
            if value == b"broken":
                raise ValueError("broken")
            return value, media

    stage = Stage(Reader())
    tracker = stage.neighbour()
    stage.call(follow())
    for value in (b"broken", b"whole"):
        tracker.component.emit("pose", value, media="text/plain")
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("position", (b"whole", "text/plain"))]


def test_what_breaks_as_a_component_reads_a_value_is_its_failure_and_no_end_of_its_program() -> None:
    class Reader(Recorder):
        @staticmethod
        def signal_value(value: Any, media: str) -> Any:
            return value["x"]

    stage = Stage(Reader())
    tracker = stage.neighbour()
    stage.call(follow())
    tracker.component.emit("pose", {"y": 1})
    stage.let_pass(0.1)
    assert [fail.detail for fail in stage.fails] == ["it broke in signal_value: KeyError: 'x'"]
    assert not stage.component.active
