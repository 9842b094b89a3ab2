"""The life of a component on the bus, as a configurator and its neighbours see it."""

from __future__ import annotations

import logging
import math
from typing import Any

import pytest

from selfconf.bus.memory import Network
from selfconf.bus.port import Replies, Sample, Urgency
from selfconf.errors import ProgrammerError
from selfconf.model.profile import Input, OperationalParameter, Output, Ports, Profile
from selfconf.model.term import IRI, Literal, Term
from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import (
    Apply,
    CallAnswer,
    Cause,
    Fail,
    Message,
    Release,
    SetParameters,
    Stamp,
    Verdict,
    Wire,
)
from selfconf.sdk.component import Component, Refused, Signal
from selfconf.sdk.inputs import BEGINNING, PATIENCE
from selfconf.sdk.runtime import ComponentRuntime
from selfconf.sdk.supervision import GRACE
from tests.lab import Recorder

KEYS = Keys("lab")
US, THEM = KEYS.configurator_life("us", "1"), KEYS.configurator_life("them", "1")
CAP, TRACKER = IRI("urn:c:cap"), IRI("urn:c:tracker")
XSD = "http://www.w3.org/2001/XMLSchema#"
CAP_PROFILE = Profile(
    CAP,
    ports=Ports((Input("position", IRI("urn:s:Pose")),), (Output("velocity", IRI("urn:s:Velocity")),)),
    parameters=(OperationalParameter("goal", IRI("urn:p:Goal")),),
)
TRACKER_PROFILE = Profile(TRACKER, ports=Ports(outputs=(Output("pose", IRI("urn:s:Pose")),)))


class Stage:
    """A component on a simulated network, with a configurator that is alive and can call it."""

    def __init__(self, component: Component | None = None, profile: Profile = CAP_PROFILE) -> None:
        self.network = Network()
        self.caller = self.network.node()
        self.others = self.network.node()
        self.leave = self.caller.announce(US)
        self.recorder = component if isinstance(component, Recorder) else Recorder()
        self.component = component or self.recorder
        self.profile = profile
        self.runtime = ComponentRuntime(self.network.node(), KEYS, profile, self.component, "life-1")
        self.fails: list[Fail] = []
        self.caller.subscribe(KEYS.any_fail(), lambda sample: self.fails.append(decode(sample.payload, Fail)))
        self.let_pass(0.1)

    def let_pass(self, seconds: float) -> None:
        """Simulated time passes."""
        self.network.run(lambda: False, seconds)

    def ask(self, call: str, payload: bytes) -> Replies:
        """Make a call, whatever it says."""
        replies: list[Replies] = []
        self.caller.ask(KEYS.call(self.profile.component, call), payload, 1.0, replies.append)
        assert self.network.run(lambda: bool(replies), 5.0)
        return replies[0]

    def call(self, message: Message) -> CallAnswer:
        """Make a call; the answer."""
        name = {Apply: "apply", SetParameters: "set", Release: "release"}[type(message)]
        (sample,) = self.ask(name, encode(message)).samples
        return decode(sample.payload, CallAnswer)

    def state(self) -> CallAnswer:
        """What the component says of itself."""
        (sample,) = self.ask("state", b"").samples
        return decode(sample.payload, CallAnswer)

    def neighbour(self, rate: float | None = None) -> ComponentRuntime:
        """A tracker that is active."""
        profile = Profile(TRACKER, ports=Ports(outputs=(Output("pose", IRI("urn:s:Pose"), rate),)))
        runtime = ComponentRuntime(self.network.node(), KEYS, profile, Component(), "life-t")
        replies: list[Replies] = []
        self.caller.ask(KEYS.call(TRACKER, "apply"), encode(Apply(1, US)), 1.0, replies.append)
        assert self.network.run(lambda: bool(replies), 5.0)
        return runtime


def follow(epoch: int = 1, period: float | None = None, supervisor: str = US) -> Apply:
    """Be active, and follow the tracker."""
    return Apply(epoch, supervisor, {"position": (Wire(TRACKER, "pose", period),)})


# Calls.


def test_a_component_is_idle_until_it_is_activated() -> None:
    stage = Stage()
    answer = stage.state()
    assert (answer.verdict, answer.active, answer.life, answer.component) == (Verdict.DONE, False, "life-1", CAP)
    answer = stage.call(Apply(7, US))
    assert (answer.verdict, answer.active, answer.epoch) == (Verdict.DONE, True, 7)
    assert stage.recorder.said == [("started",)]
    assert stage.component.active


def test_it_says_who_holds_it_and_a_busy_one_says_so_to_people() -> None:
    stage = Stage()
    assert stage.state().supervisor == ""
    assert stage.call(Apply(1, US)).supervisor == US
    stage.others.announce(THEM)
    answer = stage.call(Apply(2, THEM))
    assert (answer.verdict, answer.supervisor) == (Verdict.BUSY, US)
    assert answer.detail == "the configurator us holds it"
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert (stage.state().active, stage.state().supervisor) == (False, US)
    stage.leave()
    stage.let_pass(2 * GRACE)
    assert (stage.state().active, stage.state().supervisor) == (False, "")


def test_an_activation_that_is_repeated_starts_nothing_anew() -> None:
    stage = Stage()
    for epoch in (1, 1, 2):
        assert stage.call(Apply(epoch, US)).verdict is Verdict.DONE
    assert stage.recorder.said == [("started",)]


def test_a_released_component_stops_and_may_be_activated_again() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    answer = stage.call(Release(2, US))
    assert (answer.verdict, answer.active) == (Verdict.DONE, False)
    stage.call(Apply(3, US))
    assert stage.recorder.said == [("started",), ("stopped",), ("started",)]


def test_parameters_are_set_by_name_and_as_values_that_code_likes() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    given: list[tuple[Term, Any]] = [
        (Literal("(AT BEDROOM)"), "(AT BEDROOM)"),
        (IRI("urn:x"), "urn:x"),
        (Literal("3", IRI(XSD + "integer")), 3),
        (Literal("1", IRI(XSD + "unsignedInt")), 1),
        (Literal("0.5", IRI(XSD + "decimal")), 0.5),
        (Literal("0.5", IRI(XSD + "double")), 0.5),
        (Literal("0.5", IRI(XSD + "float")), 0.5),
        (Literal("true", IRI(XSD + "boolean")), True),
        (Literal("0", IRI(XSD + "boolean")), False),
    ]
    for value, _ in given:
        assert stage.call(SetParameters(1, US, {"goal": value})).verdict is Verdict.DONE
    assert stage.recorder.said[1:] == [("goal", value) for _, value in given]


def test_an_idle_component_takes_no_parameters() -> None:
    stage = Stage()
    assert stage.call(SetParameters(1, US, {"goal": Literal("x")})).verdict is Verdict.REFUSED
    assert stage.recorder.said == []


def test_a_parameter_that_is_not_declared_or_no_number_is_refused_with_a_reason() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    answer = stage.call(SetParameters(1, US, {"colour": Literal("red")}))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it declares no parameter 'colour'")
    answer = stage.call(SetParameters(1, US, {"goal": Literal("three", IRI(XSD + "integer"))}))
    assert answer.verdict is Verdict.REFUSED
    assert "goal" in answer.detail


def test_an_input_that_is_not_there_is_refused_and_nothing_starts() -> None:
    stage = Stage()
    answer = stage.call(Apply(1, US, {"sonar": (Wire(TRACKER, "pose"),)}))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it has no input 'sonar'")
    assert stage.recorder.said == []


@pytest.mark.parametrize(
    ("call", "payload"),
    [
        ("apply", b""),
        ("apply", b"{}"),
        ("apply", encode(Release(1, US))),
        ("dance", encode(Apply(1, US))),
        ("*", encode(Apply(1, US))),
        ("set", b"\xff"),
        ("apply", encode(Apply(1, "**"))),
        ("apply", encode(Apply(1, "selfconf/lab/conf/*/live/*"))),
        ("apply", encode(Apply(1, "selfconf/other/conf/us/live/1"))),
    ],
)
def test_a_call_that_is_none_is_refused_and_changes_nothing(call: str, payload: bytes) -> None:
    stage = Stage()
    replies = stage.ask(call, payload)
    assert replies.samples == ()
    assert len(replies.errors) == 1
    assert stage.recorder.said == []
    assert stage.call(Apply(1, US)).verdict is Verdict.DONE


# Components that refuse or break.


def test_a_component_that_refuses_to_start_says_why_and_stays_free() -> None:
    stage = Stage()
    stage.recorder.refusal = Refused("no light")
    answer = stage.call(Apply(1, US))
    assert (answer.verdict, answer.detail, answer.active) == (Verdict.REFUSED, "no light", False)
    stage.recorder.refusal = None
    stage.others.announce(THEM)
    assert stage.call(Apply(2, THEM)).verdict is Verdict.DONE


def test_a_component_that_breaks_when_it_is_started_says_how(caplog: pytest.LogCaptureFixture) -> None:
    stage = Stage()
    stage.recorder.refusal = ValueError("no camera")
    with caplog.at_level(logging.CRITICAL):
        answer = stage.call(Apply(1, US))
    assert answer.verdict is Verdict.REFUSED
    assert answer.detail == "it broke when it was started: ValueError: no camera"
    assert not stage.component.active


def test_a_component_that_failed_and_refuses_to_start_again_is_free() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    stage.recorder.refusal = Refused("still dark")
    assert stage.call(Apply(2, US)).verdict is Verdict.REFUSED
    assert stage.runtime.activation.phase is ActivationPhase.IDLE
    stage.recorder.refusal = None
    stage.others.announce(THEM)
    assert stage.call(Apply(3, THEM)).verdict is Verdict.DONE


def test_a_component_that_breaks_on_a_signal_fails(caplog: pytest.LogCaptureFixture) -> None:
    class Fragile(Recorder):
        def received(self, port: str, signal: Signal) -> None:
            raise KeyError("metres")

    stage = Stage(Fragile())
    tracker = stage.neighbour()
    stage.call(follow())
    with caplog.at_level(logging.CRITICAL):
        tracker.emit("pose", {"feet": 1}, None)
        stage.let_pass(0.1)
    assert [(fail.component, fail.cause, fail.detail) for fail in stage.fails] == [
        (CAP, Cause.FAIL, "KeyError: 'metres'")
    ]


def test_a_component_that_breaks_when_it_is_stopped_is_off_all_the_same(caplog: pytest.LogCaptureFixture) -> None:
    class Clumsy(Recorder):
        def stopped(self) -> None:
            raise RuntimeError("stuck")

    stage = Stage(Clumsy())
    stage.call(Apply(1, US))
    with caplog.at_level(logging.CRITICAL):
        answer = stage.call(Release(2, US))
    assert (answer.verdict, answer.active) == (Verdict.DONE, False)
    stage.let_pass(1.0)
    assert not stage.fails
    stage.call(Apply(3, US))
    stage.component.fail("again")
    stage.let_pass(0.1)
    with caplog.at_level(logging.CRITICAL):
        answer = stage.call(Apply(4, US))
    assert (answer.verdict, answer.active) == (Verdict.DONE, True)
    assert stage.runtime.activation.phase is ActivationPhase.ACTIVE


# Failing.


def test_a_component_raises_fail_with_its_life_its_epoch_and_a_reason() -> None:
    stage = Stage()
    stage.call(Apply(4, US))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert stage.fails == [Fail(CAP, "life-1", 4, Cause.FAIL, "lost her")]
    assert not stage.component.active
    assert not stage.state().active


def test_a_component_fails_once_and_an_idle_one_never() -> None:
    stage = Stage()
    stage.component.fail("idle")
    stage.let_pass(0.1)
    stage.call(Apply(1, US))
    for _ in range(3):
        stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert len(stage.fails) == 1


def test_a_component_may_fail_as_it_is_started() -> None:
    class Hopeless(Recorder):
        def started(self) -> None:
            self.fail("at once")

    stage = Stage(Hopeless())
    assert stage.call(Apply(1, US)).verdict is Verdict.DONE
    stage.let_pass(0.1)
    assert [fail.detail for fail in stage.fails] == ["at once"]


def test_a_component_that_failed_is_started_again_when_it_is_applied_to_again() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert stage.call(Apply(2, US)).active
    assert stage.recorder.said == [("started",), ("stopped",), ("started",)]


# Signals.


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


def test_timers_run_while_the_component_is_active_and_no_longer() -> None:
    ticks: list[float] = []

    class Ticking(Recorder):
        def started(self) -> None:
            self.every(0.1, lambda: ticks.append(stage.network.time))

    stage = Stage(Ticking())
    stage.call(Apply(1, US))
    stage.let_pass(0.55)
    assert len(ticks) == 5
    stage.call(Release(2, US))
    stage.let_pass(1.0)
    assert len(ticks) == 5
    stage.call(Apply(3, US))
    stage.let_pass(0.35)
    assert len(ticks) == 8


def test_a_timer_that_has_ticked_for_a_long_time_is_kept_once() -> None:
    ticks: list[float] = []

    class Ticking(Recorder):
        def started(self) -> None:
            self.every(0.1, lambda: ticks.append(stage.network.time))

    stage = Stage(Ticking())
    stage.call(Apply(1, US))
    stage.let_pass(100.05)
    assert len(ticks) == 1000
    assert len(stage.runtime._timers) == 1
    stage.call(Release(2, US))
    assert not stage.runtime._timers


def test_a_timer_of_a_component_that_is_not_active_is_not_kept() -> None:
    stage = Stage()
    for _ in range(100):
        stage.component.every(0.1, print)
    stage.let_pass(0.2)
    assert not stage.runtime._timers


def test_a_component_that_is_part_of_no_ecology_says_so() -> None:
    component = Component()
    for use in (lambda: component.emit("a", 1), lambda: component.fail("x"), lambda: component.every(1.0, print)):
        with pytest.raises(ProgrammerError, match="not part of an ecology"):
            use()
    assert not Component().active


# Silence.


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


# Supervision.


def test_a_component_whose_configurator_is_gone_turns_itself_off_after_the_grace_period() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    stage.let_pass(100)
    assert stage.component.active
    stage.leave()
    stage.let_pass(GRACE - 0.1)
    assert stage.component.active
    stage.let_pass(0.2)
    assert stage.recorder.said == [("started",), ("stopped",)]
    assert stage.runtime.activation.phase is ActivationPhase.IDLE


def test_a_configurator_that_is_back_within_the_grace_period_is_obeyed_on() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    stage.leave()
    stage.let_pass(GRACE / 2)
    stage.caller.announce(US)
    stage.let_pass(10 * GRACE)
    assert stage.component.active


def test_a_component_that_is_cut_off_turns_itself_off() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    node = stage.network.nodes[2]
    assert stage.runtime.bus is node
    stage.network.cut(node, stage.caller)
    stage.let_pass(GRACE + 0.1)
    assert not stage.component.active


def test_a_configurator_that_was_never_there_is_not_obeyed_for_long() -> None:
    stage = Stage()
    stage.call(Apply(1, THEM))
    stage.let_pass(GRACE + 0.1)
    assert not stage.component.active


def test_a_component_that_has_failed_is_free_again_when_its_configurator_is_gone() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    stage.component.fail("lost her")
    stage.leave()
    stage.let_pass(GRACE + 0.1)
    assert stage.runtime.activation.phase is ActivationPhase.IDLE
    assert stage.recorder.said[-1] == ("stopped",)


def test_a_held_component_is_busy_for_another_configurator_as_long_as_its_own_lives() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(Apply(1, US))
    stage.let_pass(0.1)
    assert stage.call(Apply(2, THEM)).verdict is Verdict.BUSY
    assert stage.call(Release(2, THEM)).verdict is Verdict.BUSY
    assert stage.component.active


def test_another_configurator_may_take_over_as_soon_as_the_first_is_gone() -> None:
    stage = Stage()
    leave = stage.others.announce(THEM)
    stage.call(Apply(1, US))
    stage.let_pass(0.1)
    stage.leave()
    stage.let_pass(0.1)
    assert stage.call(SetParameters(2, THEM, {"goal": Literal("x")})).verdict is Verdict.BUSY
    assert stage.call(Apply(2, THEM)).verdict is Verdict.DONE
    stage.let_pass(10 * GRACE)
    assert stage.component.active
    assert stage.recorder.said == [("started",)]
    stage.caller.announce(US)
    stage.let_pass(0.1)
    assert stage.call(Apply(3, US)).verdict is Verdict.BUSY
    leave()
    stage.let_pass(GRACE + 0.1)
    assert not stage.component.active


def test_the_supervision_of_an_earlier_configuration_has_ended_with_it() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(Apply(1, US))
    stage.call(Release(2, US))
    stage.call(Apply(3, THEM))
    stage.leave()
    stage.let_pass(10 * GRACE)
    assert stage.component.active


def test_a_call_of_an_older_epoch_is_stale_and_names_the_newest() -> None:
    stage = Stage()
    stage.call(Apply(5, US))
    answer = stage.call(Release(4, US))
    assert (answer.verdict, answer.epoch) == (Verdict.STALE, 5)
    assert stage.component.active


# The end.


def test_closing_turns_the_component_off_and_ends_its_life() -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    called: list[tuple[str, ...]] = []
    stage.runtime.close()
    stage.caller.roll_call(KEYS.any_life(), 1.0, called.append)
    stage.let_pass(0.1)
    assert called == [()]
    assert stage.recorder.said == [("started",), ("stopped",)]
    assert stage.ask("state", b"") == Replies((), (), True)


def test_closing_an_idle_component_does_not_stop_it() -> None:
    stage = Stage()
    stage.runtime.close()
    assert stage.recorder.said == []


@pytest.mark.parametrize("value", [math.nan, math.inf, {1, 2}, object()])
def test_what_json_cannot_say_is_the_programmers_error(value: Any) -> None:
    stage = Stage()
    stage.call(Apply(1, US))
    with pytest.raises(ProgrammerError, match="velocity"):
        stage.component.emit("velocity", value)
