"""The outputs of a component: what is issued, when, and what is latched."""

from __future__ import annotations

import math
from typing import Any

import pytest

from selfconf.bus.port import Replies, Sample
from selfconf.errors import ProgrammerError
from selfconf.model.profile import Ports, Profile
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import (
    Apply,
    Release,
)
from selfconf.sdk.component import Signal
from selfconf.sdk.runtime import ComponentRuntime
from tests.lab import Recorder
from tests.sdk.stage import CAP, CAP_PROFILE, KEYS, TRACKER, US, Stage, follow


def test_what_is_emitted_arrives_with_its_source_number_and_time() -> None:
    arrived: list[Signal] = []

    class Listener(Recorder):
        def received(self, port: str, signal: Signal) -> None:
            arrived.append(signal)

    stage = Stage(Listener())
    tracker = stage.neighbour()
    stage.call(follow())
    tracker.component.emit("pose", {"x": 1.5}, time=12.0)
    tracker.component.emit("pose", b"\x00raw")
    stage.let_pass(0.1)
    assert [(s.value, s.source, s.sequence) for s in arrived] == [({"x": 1.5}, TRACKER, 1), (b"\x00raw", TRACKER, 2)]
    assert arrived[0].time == 12.0
    assert arrived[0]["x"] == 1.5
    assert arrived[1].time > 1e9


def test_the_signals_that_an_activation_sets_free_go_before_its_answer() -> None:
    class Eager(Recorder):
        def started(self) -> None:
            self.emit("velocity", 1)

    stage = Stage(Eager())
    order: list[str] = []
    stage.caller.subscribe(KEYS.output(CAP, "velocity"), lambda _: order.append("signal"))
    stage.caller.ask(KEYS.call(CAP, "apply"), encode(Apply(1, US)), 1.0, lambda _: order.append("answer"))
    stage.let_pass(0.1)
    assert order == ["signal", "answer"]


def test_nothing_is_emitted_while_a_component_is_not_active() -> None:
    stage = Stage()
    heard: list[Sample] = []
    stage.others.subscribe(KEYS.output(CAP, "velocity"), heard.append)
    stage.component.emit("velocity", 1)
    stage.call(Apply(1, US))
    stage.component.emit("velocity", 2)
    stage.call(Release(2, US))
    stage.component.emit("velocity", 3)
    stage.let_pass(0.1)
    assert [sample.payload for sample in heard] == [b"2"]


def test_an_output_that_is_not_advertised_is_the_programmers_error() -> None:
    stage = Stage()
    with pytest.raises(ProgrammerError, match="advertises no output 'speed'"):
        stage.component.emit("speed", 1)


@pytest.mark.parametrize("value", [math.nan, math.inf, {1, 2}, object()])
def test_a_value_that_json_does_not_have_is_the_programmers_error(value: Any) -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    with pytest.raises(ProgrammerError, match="velocity"):
        stage.component.emit("velocity", value)


def test_a_new_connection_carries_the_last_signal_at_once_and_an_old_one_does_not_carry_it_twice() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    tracker.emit("pose", "here", None)
    stage.let_pass(1.0)
    stage.call(follow())
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("position", "here")]
    profile = Profile(IRI("urn:c:other"), ports=Ports(CAP_PROFILE.inputs))
    again = ComponentRuntime(stage.network.node(), KEYS, profile, Recorder(), "l")
    replies: list[Replies] = []
    stage.caller.ask(KEYS.call(IRI("urn:c:other"), "apply"), encode(follow()), 1.0, replies.append)
    stage.let_pass(0.1)
    assert again.active
    assert stage.recorder.said.count(("position", "here")) == 1


def test_a_signal_of_an_earlier_activation_is_not_latched() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    tracker.emit("pose", "old", None)
    for name, message in (("release", Release(2, US)), ("apply", Apply(3, US))):
        stage.caller.ask(KEYS.call(TRACKER, name), encode(message), 1.0, lambda _: None)
        stage.let_pass(0.1)
    assert tracker.active
    stage.call(follow())
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",)]
