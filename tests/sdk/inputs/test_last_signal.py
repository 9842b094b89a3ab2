"""An input asks an output for the signal that it has issued last: when, how often, and what it makes of it."""

from __future__ import annotations

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Request, Urgency
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Stamp, Wire
from selfconf.sdk.inputs.last_signal import ASK_FOR_LAST
from tests.sdk.stage import (
    KEYS,
    TRACKER,
    Stage,
    apply,
    follow,
)


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


def test_an_output_that_does_not_answer_is_asked_for_its_last_signal_until_it_does() -> None:
    """Though it has issued one before: it was out of sight, so that the input is unfed, and has nothing else to say."""
    stage = Stage()
    tracker = stage.network.node()
    unanswered: list[Request] = []
    tracker.announce(KEYS.life(TRACKER, "l"))
    stop = tracker.serve(KEYS.outputs(TRACKER), lambda request: request.finish())
    stage.call(follow(1))
    said = encode(Stamp(TRACKER, "l", 1, 0.0))
    tracker.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT).put(b"7", said)
    stage.let_pass(10.0)
    stop()
    stop = tracker.serve(KEYS.outputs(TRACKER), unanswered.append)
    node = stage.runtime.bus
    assert isinstance(node, MemoryBus)
    stage.network.cut(node, tracker)
    stage.let_pass(0.1)
    stage.network.reconnect(node, tracker)
    stage.let_pass(8.0)
    assert len(unanswered) == 4  # each had twice the time of the one before
    stop()

    answered: list[Request] = []

    def answer(request: Request) -> None:
        answered.append(request)
        request.reply(KEYS.output(TRACKER, "pose"), b"7", said)
        request.finish()

    tracker.serve(KEYS.outputs(TRACKER), answer)
    stage.let_pass(8.0)
    assert stage.recorder.said.count(("position", 7)) == 2
    asked = len(answered)
    stage.let_pass(40.0)
    assert len(answered) == asked


def test_an_answer_that_takes_longer_than_a_second_is_had_in_the_end() -> None:
    """A large signal over a slow link: each question has twice the time of the one before."""
    stage = Stage()
    tracker = stage.network.node()
    asked: list[float] = []

    def answer(request: Request) -> None:
        def say() -> None:
            request.reply(KEYS.output(TRACKER, "pose"), b"7", encode(Stamp(TRACKER, "l", 1, 0.0)))
            request.finish()

        asked.append(stage.network.time)
        tracker.later(6.0, say)

    tracker.announce(KEYS.life(TRACKER, "l"))
    tracker.serve(KEYS.outputs(TRACKER), answer)
    stage.call(follow(1))
    stage.let_pass(60.0)
    assert stage.recorder.said.count(("position", 7)) == 1
    assert len(asked) < 10


def test_an_answer_that_is_too_large_for_the_bus_is_asked_for_only_as_often_as_before_the_first_signal(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    stage = Stage()
    tracker = stage.network.node()
    asked: list[Request] = []

    def answer(request: Request) -> None:
        asked.append(request)
        request.reply(KEYS.output(TRACKER, "pose"), b"7" * 200_000, encode(Stamp(TRACKER, "l", 1, 0.0)))
        request.finish()

    monkeypatch.setattr("selfconf.bus.memory.questions.LARGEST_REPLIES", 100_000)
    tracker.announce(KEYS.life(TRACKER, "l"))
    tracker.serve(KEYS.outputs(TRACKER), answer)
    stage.call(follow(1))
    stage.let_pass(30.0)
    assert len(asked) == 1 + len(ASK_FOR_LAST)


def test_a_signal_is_not_new_of_an_output_that_says_it_has_none_by_now() -> None:
    """It was issued for a task of which its component has let go just before it was listened to."""
    stage = Stage()
    tracker = stage.network.node()
    tracker.announce(KEYS.life(TRACKER, "l"))
    tracker.serve(KEYS.outputs(TRACKER), lambda request: request.finish())

    def has_a_subscriber(matching: bool) -> None:
        publisher.put(b"7", encode(Stamp(TRACKER, "l", 1, 0.0)))

    publisher = tracker.publisher(KEYS.output(TRACKER, "pose"), Urgency.EVENT, has_a_subscriber)
    other = Wire(IRI("urn:c:other"), "pose", None)
    stage.call(apply(1, inputs={"position": (other,)}, standby={"position": (Wire(TRACKER, "pose", None),)}))
    stage.let_pass(0.1)
    stage.call(follow(2))
    stage.let_pass(0.1)
    assert ("position", 7) not in stage.recorder.said
