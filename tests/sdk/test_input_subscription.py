"""One input's subscription to one output: what is passed over, what waits, and when silence is reported."""

from __future__ import annotations

import itertools
from dataclasses import replace
from typing import Any

import pytest

from selfconf.bus.memory import Network
from selfconf.bus.port import Request, Urgency
from selfconf.model.profile import Input, Ports
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Stamp
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.input_subscription import BEGINNING, PATIENCE, InputEvents
from selfconf.sdk.inputs import Inputs
from selfconf.sdk.signal_queue import EVENTS
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP,
    CAP_PROFILE,
    KEYS,
    TRACKER,
    US,
    Stage,
    apply,
    follow,
    release,
    silence,
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


def test_signals_that_come_late_or_twice_are_passed_over_and_a_new_life_counts_from_one_again() -> None:
    stage = Stage()
    stage.call(follow())
    source = stage.others.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT)
    for life, sequence in (("a", 1), ("a", 3), ("a", 2), ("a", 3), ("b", 1), ("b", 2)):
        source.put(b"%d" % sequence, encode(Stamp(TRACKER, life, sequence, 0.0)))
    stage.let_pass(0.1)
    assert [value for _, value in stage.recorder.said[1:]] == [1, 3, 1, 2]


def test_an_output_that_promised_a_rate_and_stops_is_reported_and_again_as_long_as_nothing_comes() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(period=0.1))
    tracker.component.emit("pose", 1)
    stage.let_pass(PATIENCE * 0.1 - 0.05)
    assert not silence(stage)
    stage.let_pass(0.1)
    assert silence(stage) == [(TRACKER, "")]
    assert stage.fails[-1].detail == f"no signal on 'pose' for {PATIENCE * 0.1:.2f} s"
    stage.let_pass(PATIENCE * 0.1)
    assert len(silence(stage)) == 2
    tracker.component.emit("pose", 2)
    stage.let_pass(0.1)
    assert len(silence(stage)) == 2


def test_an_output_that_keeps_its_promise_is_not_reported() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(period=0.1))
    for number in range(50):
        tracker.component.emit("pose", number)
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
    stage.neighbour().component.emit("pose", 1)
    stage.call(follow())
    stage.let_pass(100)
    assert not silence(stage)


def test_an_output_that_is_followed_no_more_may_be_silent() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(1, period=0.1))
    tracker.component.emit("pose", 1)
    stage.let_pass(0.05)
    stage.call(apply(2, US))
    stage.let_pass(10)
    assert not silence(stage)


# Queues, where the component's code has a thread of its own.


class Slow:
    """An input that follows one output, and a component whose code has no time until `poll` of its thread."""

    def __init__(self, period: float | None = None, depth: int | None = None) -> None:
        self.network, self.code = Network(), CodeThread(inline=False)
        self.heard: list[Any] = []
        self.unfed: list[str] = []
        profile = replace(CAP_PROFILE, ports=Ports((Input("position", (IRI("urn:s:Pose"),), depth),)))
        events = InputEvents(lambda port, signal: self.heard.append(signal.value), lambda *_: None, self.unfed.append)
        self.inputs = Inputs(self.network.node(), KEYS, self.code, profile, events)
        self.inputs.follow(follow(period=period))
        self._source = self.network.node().publisher(KEYS.output(TRACKER, "pose"), Urgency.SIGNAL)
        self._numbers = itertools.count(1)

    def issue(self, count: int) -> None:
        """Signals come, numbered from 1."""
        for number in itertools.islice(self._numbers, count):
            self._source.put(b"%d" % number, encode(Stamp(TRACKER, "l", number, 0.0)))
        self.network.run(lambda: False, 0.1)


def test_of_an_output_with_a_rate_a_slow_component_gets_the_newest_signal() -> None:
    slow = Slow(period=0.1)
    slow.issue(100)
    slow.code.poll()
    assert slow.heard == [100]
    slow.issue(5)
    slow.code.poll()
    assert slow.heard == [100, 105]


def test_of_an_output_without_a_rate_a_slow_component_gets_every_signal_up_to_a_bound() -> None:
    slow = Slow()
    slow.issue(EVENTS)
    slow.code.poll()
    assert slow.heard == [*range(1, EVENTS + 1)]
    slow.heard.clear()
    slow.issue(EVENTS + 7)
    slow.code.poll()
    assert slow.heard == [*range(EVENTS + 8, 2 * EVENTS + 8)]


@pytest.mark.parametrize("period", [None, 0.1])
def test_an_input_may_say_itself_how_many_signals_wait(period: float | None) -> None:
    slow = Slow(period, depth=3)
    slow.issue(10)
    slow.code.poll()
    assert slow.heard == [8, 9, 10]


def test_what_is_dropped_is_counted() -> None:
    slow = Slow(depth=3)
    slow.issue(10)
    assert slow.inputs.dropped == 7
    slow.inputs.end()
    assert slow.inputs.dropped == 7


def test_what_waits_when_an_input_is_connected_to_something_else_is_not_delivered_any_more() -> None:
    slow = Slow()
    slow.issue(10)
    slow.inputs.follow(apply(2))
    slow.code.poll()
    assert slow.heard == []


def test_an_output_that_has_issued_nothing_is_asked_for_its_last_signal_again() -> None:
    stage = Stage()
    asked: list[str] = []

    def answer(request: Request) -> None:
        asked.append(request.key)
        if len(asked) > 1:  # the first question was there before the signal, and the signal before the subscription
            request.reply(KEYS.output(TRACKER, "pose"), b"7", encode(Stamp(TRACKER, "l", 1, 0.0)))
        request.finish()

    stage.others.serve(KEYS.outputs(TRACKER), answer)
    stage.call(follow(1))
    stage.let_pass(10.0)
    assert ("position", 7) in stage.recorder.said
    assert len(asked) == 2


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


def test_what_waits_when_an_output_is_lost_is_not_delivered_after_its_loss_and_feeds_nothing() -> None:
    """A slow component acts on what has come since it was unfed, not on what its dead source had said before."""
    slow = Slow()
    leave = slow.network.node().announce(KEYS.life(TRACKER, "l"))
    slow.issue(10)
    leave()
    slow.network.run(lambda: False, 0.1)
    slow.code.poll()
    assert (slow.unfed, slow.heard) == (["position"], [])
    slow.issue(1)
    slow.code.poll()
    assert slow.heard == [11]
