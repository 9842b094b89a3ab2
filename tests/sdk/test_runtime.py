"""The runtime of a component: the calls it answers, its failures, its timers, and its end."""

from __future__ import annotations

import logging
from typing import Any

import pytest

from selfconf.bus.port import Replies
from selfconf.errors import ProgrammerError
from selfconf.model.term import IRI, Literal, Term
from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import (
    Apply,
    Cause,
    Fail,
    Release,
    SetParameters,
    Verdict,
    Wire,
)
from selfconf.sdk.component import Component, Refused, Signal
from selfconf.sdk.supervision import GRACE
from tests.lab import Recorder
from tests.sdk.stage import CAP, KEYS, THEM, TRACKER, US, XSD, Stage, follow


def test_a_component_is_idle_until_it_is_activated() -> None:
    stage = Stage()
    answer = stage.state()
    assert (answer.verdict, answer.active, answer.life, answer.component) == (Verdict.DONE, False, "life-1", CAP)
    answer = stage.call(Apply(7, US))
    assert (answer.verdict, answer.active, answer.epoch) == (Verdict.DONE, True, 7)
    assert stage.recorder.said == [("started",)]
    assert stage.component.active


def test_it_says_which_configurator_holds_it_and_a_busy_component_says_so_in_words() -> None:
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


def test_parameters_are_set_by_name_and_as_values_of_python() -> None:
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


def test_a_call_of_an_older_epoch_is_stale_and_names_the_newest() -> None:
    stage = Stage()
    stage.call(Apply(5, US))
    answer = stage.call(Release(4, US))
    assert (answer.verdict, answer.epoch) == (Verdict.STALE, 5)
    assert stage.component.active


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
