"""The outputs of a component: what is issued, when, and what is latched."""

from __future__ import annotations

import math
import threading
from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import pytest

from selfconf.bus.memory import MemoryBus
from selfconf.bus.port import Replies, Sample
from selfconf.errors import ProgrammerError
from selfconf.model.profile import Output, Ports, Profile
from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Cause
from selfconf.sdk import outputs
from selfconf.sdk.component import Signal
from selfconf.sdk.outputs import NOTHING_YET
from selfconf.sdk.payloads import LARGEST_JSON
from selfconf.sdk.runtime import ComponentRuntime
from tests.lab import Recorder
from tests.sdk.stage import CAP, CAP_PROFILE, KEYS, TRACKER, TRACKER_PROFILE, US, Stage, apply, follow, release

POSE = IRI("urn:s:Pose")


class Listener(Recorder):
    """A component that keeps the signals that it receives."""

    def __init__(self) -> None:
        super().__init__()
        self.arrived: list[Signal] = []

    def received(self, port: str, signal: Signal) -> None:
        self.arrived.append(signal)


def test_what_is_emitted_arrives_with_its_source_number_and_time() -> None:
    listener = Listener()
    arrived, stage = listener.arrived, Stage(listener)
    tracker = stage.neighbour()
    stage.call(follow())
    tracker.component.emit("pose", {"x": 1.5}, time=12.0)
    tracker.component.emit("pose", b"\x00raw")
    stage.let_pass(0.1)
    assert [(s.value, s.source, s.sequence) for s in arrived] == [({"x": 1.5}, TRACKER, 1), (b"\x00raw", TRACKER, 2)]
    assert arrived[0].time == 12.0
    assert arrived[0]["x"] == 1.5
    assert arrived[1].time > 1e9


def test_an_image_arrives_with_its_encoding_and_is_what_it_was_when_it_was_emitted() -> None:
    numpy = pytest.importorskip("numpy")
    listener = Listener()
    arrived, stage = listener.arrived, Stage(listener)
    tracker = stage.neighbour()
    stage.call(follow())
    picture = numpy.arange(6, dtype="uint16").reshape(2, 3)
    tracker.component.emit("pose", picture, media="image/x-raw")
    picture[:] = 0
    tracker.component.emit("pose", b"\x89PNG", media="image/png")
    tracker.component.emit("pose", {"x": 1})
    stage.let_pass(0.1)
    assert [signal.media for signal in arrived] == ["image/x-raw", "image/png", ""]
    assert arrived[0].value.tolist() == [[0, 1, 2], [3, 4, 5]]
    assert arrived[0].value.dtype == "uint16"


def malformed(value: Any) -> str:
    """What is said of a component that emits something that is no signal, and fails."""
    stage = Stage()
    heard: list[Sample] = []
    stage.others.subscribe(KEYS.output(CAP, "velocity"), heard.append)
    stage.call(apply(1, US))
    stage.component.emit("velocity", value)
    stage.let_pass(0.1)
    assert (heard, stage.component.active) == ([], False)
    (fail,) = stage.fails
    assert (fail.component, fail.cause) == (CAP, Cause.MALFORMED)
    return fail.detail


def test_an_array_that_no_signal_can_carry_is_the_failure_of_the_component_that_emits_it() -> None:
    numpy = pytest.importorskip("numpy")
    assert "what it emits on 'velocity' is an array of '>f'" in malformed(numpy.zeros(2, ">f4"))


def test_what_keeps_a_value_from_being_a_signal_is_told_without_a_failure() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    assert stage.runtime.outputs.problem("velocity", {"x": 1}) is None
    assert "is nothing that JSON can say" in str(stage.runtime.outputs.problem("velocity", object()))
    assert stage.component.active


def test_the_signals_that_an_activation_sets_free_go_before_its_answer() -> None:
    class Eager(Recorder):
        def started(self) -> None:
            self.emit("velocity", 1)

    stage = Stage(Eager())
    order: list[str] = []
    stage.caller.subscribe(KEYS.output(CAP, "velocity"), lambda _: order.append("signal"))
    stage.caller.ask(KEYS.call(CAP, "apply"), encode(apply(1, US)), 1.0, lambda _: order.append("answer"))
    stage.let_pass(0.1)
    assert order == ["signal", "answer"]


def test_nothing_is_emitted_while_a_component_is_not_active() -> None:
    stage = Stage()
    heard: list[Sample] = []
    stage.others.subscribe(KEYS.output(CAP, "velocity"), heard.append)
    stage.component.emit("velocity", 1)
    stage.call(apply(1, US))
    stage.component.emit("velocity", 2)
    stage.call(release(2, US))
    stage.component.emit("velocity", 3)
    stage.let_pass(0.1)
    assert [sample.payload for sample in heard] == [b"2"]


def test_what_two_threads_emit_leaves_in_the_order_of_its_numbers(monkeypatch: pytest.MonkeyPatch) -> None:
    """An input would take the one that comes later, with the lower number, for one that it has had."""
    listener = Listener()
    stage = Stage(listener)
    tracker = stage.neighbour()
    stage.call(follow())
    first = threading.Thread(target=lambda: tracker.component.emit("pose", "first"))
    is_numbered, other_is_out = threading.Event(), threading.Event()

    def clock() -> float:
        """What is looked at between the number and the network; there the first waits whether it is overtaken."""
        if threading.current_thread() is first:
            is_numbered.set()
            other_is_out.wait(0.2)
        return 12.0

    monkeypatch.setattr(outputs, "time", SimpleNamespace(time=clock))
    first.start()
    assert is_numbered.wait(5.0)
    tracker.component.emit("pose", "second")
    other_is_out.set()
    first.join()
    stage.let_pass(0.1)
    assert [(signal.value, signal.sequence) for signal in listener.arrived] == [("first", 1), ("second", 2)]


def test_nothing_is_emitted_after_a_fail_that_comes_while_the_value_is_written(monkeypatch: pytest.MonkeyPatch) -> None:
    """To an input it would be newer than what the FAIL says was the last, and feed it."""
    listener = Listener()
    stage = Stage(listener)
    tracker = stage.neighbour()
    stage.call(follow())
    tracker.component.emit("pose", "before")
    written = outputs.as_json

    def fail_meanwhile(value: Any) -> bytes:
        tracker.fail("as another thread has found")
        return written(value)

    monkeypatch.setattr(outputs, "as_json", fail_meanwhile)
    tracker.component.emit("pose", "after")
    stage.let_pass(0.1)
    assert [signal.value for signal in listener.arrived] == ["before"]
    assert stage.fails[0].sequence == tracker.outputs.newest == 1


def test_no_output_is_taken_back_while_another_thread_issues_a_signal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Zenoh would raise an error, and the component leave the ecology by half."""
    is_issuing, is_over, told = threading.Event(), threading.Event(), list[str]()

    class Slow:
        def put(self, payload: bytes, attachment: bytes = b"") -> None:
            is_issuing.set()
            is_over.wait(0.2)
            told.append("issued")

        def undeclare(self) -> None:
            told.append("taken back")

    publisher = MemoryBus.publisher

    def slow(bus: MemoryBus, key: str, *how: Any, **more: Any) -> Any:
        return Slow() if key == KEYS.output(TRACKER, "pose") else publisher(bus, key, *how, **more)

    monkeypatch.setattr(MemoryBus, "publisher", slow)
    stage = Stage(profile=TRACKER_PROFILE)
    stage.call(apply(1, US))
    emitting = threading.Thread(target=lambda: stage.component.emit("pose", 1))
    emitting.start()
    assert is_issuing.wait(5.0)
    stage.runtime.close()
    is_over.set()
    emitting.join()
    assert told == ["issued", "taken back"]
    stage.component.emit("pose", 2)
    assert told == ["issued", "taken back"]


def test_an_output_that_is_not_advertised_is_the_programmers_error() -> None:
    stage = Stage()
    with pytest.raises(ProgrammerError, match="advertises no output 'speed'; its outputs: 'velocity'"):
        stage.component.emit("speed", 1)


def nested(depth: int) -> list[Any]:
    """A list in a list, and so on."""
    value: list[Any] = []
    for _ in range(depth):
        value = [value]
    return value


CIRCLE: list[Any] = []
CIRCLE.append(CIRCLE)


@pytest.mark.parametrize(
    ("value", "why"),
    [
        (math.nan, "JSON can say: Out of range"),
        ({"x": 1.0, "more": [math.inf]}, "JSON can say: Out of range"),
        ({1, 2}, "JSON can say: an object of type set"),
        (CIRCLE, "JSON can say: Circular reference"),
        (nested(100_000), "JSON can say: maximum recursion depth"),
        ({"name": "\ud800"}, r"JSON can say: 'utf-8' codec can't encode character '\ud800'"),
        ("x" * LARGEST_JSON, f"has {LARGEST_JSON + 2} bytes as JSON"),
    ],
    ids=["nan", "infinity", "set", "circle", "nested", "surrogate", "large"],
)
def test_a_value_that_json_does_not_have_is_the_failure_of_the_component_that_emits_it(value: Any, why: str) -> None:
    assert why in malformed(value)


def test_a_new_connection_carries_the_last_signal_at_once_and_an_old_one_does_not_carry_it_twice() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    tracker.component.emit("pose", "here")
    stage.let_pass(1.0)
    stage.call(follow())
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",), ("position", "here")]
    assert another_follower(stage).said == [("started",), ("position", "here")]
    assert stage.recorder.said.count(("position", "here")) == 1


def another_follower(stage: Stage, name: str = "urn:c:other") -> Recorder:
    """A second component that follows the tracker, once it has been activated."""
    recorder = Recorder()
    profile = Profile(IRI(name), ports=CAP_PROFILE.ports)
    ComponentRuntime(stage.network.node(), KEYS, profile, recorder, "l")
    stage.caller.ask(KEYS.call(IRI(name), "apply"), encode(follow()), 1.0, lambda _: None)
    stage.let_pass(0.1)
    return recorder


def test_every_new_follower_gets_the_last_signal_though_others_follow_already() -> None:
    """The bus says only that an output begins to be followed, not that it is followed by one more."""
    stage = Stage()
    tracker = stage.neighbour()
    stage.others.subscribe(KEYS.output(TRACKER, "pose"), lambda _: None)
    stage.let_pass(0.1)
    tracker.component.emit("pose", "here")
    stage.let_pass(1.0)
    for number in range(3):
        assert another_follower(stage, f"urn:c:{number}").said == [("started",), ("position", "here")]


def test_an_output_that_is_asked_for_its_last_signal_answers_for_itself_and_only_while_it_acts() -> None:
    stage = Stage(profile=replace(CAP_PROFILE, ports=Ports((), (Output("a", (POSE,)), Output("b", (POSE,))))))
    replies: list[Replies] = []

    def last(port: str) -> list[bytes]:
        stage.caller.ask(KEYS.output(CAP, port), b"", 1.0, replies.append)
        stage.let_pass(0.1)
        return [sample.payload for sample in replies[-1].samples]

    stage.call(apply(1, US))
    assert last("a") == []
    assert replies[-1].errors == (NOTHING_YET,)
    stage.component.emit("a", 1)
    stage.component.emit("a", 2)
    stage.component.emit("b", 3)
    assert (last("a"), last("b"), last("c")) == ([b"2"], [b"3"], [])
    stage.call(release(2, US))
    assert last("a") == []
    assert replies[-1] == Replies()


def test_a_signal_of_an_earlier_activation_is_not_latched() -> None:
    stage = Stage()
    tracker = stage.neighbour()
    tracker.component.emit("pose", "old")
    for name, message in (("release", release(2, US)), ("apply", apply(3, US))):
        stage.caller.ask(KEYS.call(TRACKER, name), encode(message), 1.0, lambda _: None)
        stage.let_pass(0.1)
    assert tracker.active
    stage.call(follow())
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",)]


@pytest.mark.parametrize("moment", [math.nan, math.inf])
def test_a_signal_of_no_time_is_refused(moment: float) -> None:
    stage = Stage(profile=TRACKER_PROFILE)
    stage.call(apply(1, US))
    with pytest.raises(ProgrammerError, match="cannot emit a signal of the time"):
        stage.component.emit("pose", 1, moment)
