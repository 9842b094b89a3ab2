"""The runtime of a component: the calls it answers, its failures, its timers, and its end."""

from __future__ import annotations

import logging
import math
import os
import socket
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import pytest

from selfconf.bus.port import Publisher, Replies, Urgency
from selfconf.errors import ProgrammerError
from selfconf.model.profile import OperationalParameter
from selfconf.model.term import IRI, Literal, Term
from selfconf.model.wording import LONGEST_REMARK
from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Apply, CallAnswer, Cause, Fail, Release, Reserve, Verdict, Wire
from selfconf.sdk.component import Component, Refused, Signal
from selfconf.sdk.runtime import LIFE_ENDS, OFFER, YIELDING
from selfconf.sdk.supervision import GRACE
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP,
    CAP_PROFILE,
    DRIVE_PROFILE,
    KEYS,
    TASKS,
    THEM,
    TRACKER,
    TRACKER_PROFILE,
    US,
    XSD,
    Stage,
    apply,
    follow,
    release,
    reserve,
)


def test_a_component_is_idle_until_it_is_activated() -> None:
    stage = Stage()
    answer = stage.state()
    assert (answer.verdict, answer.active, answer.life, answer.component) == (Verdict.DONE, False, "life-1", CAP)
    answer = stage.call(apply(7, US))
    assert (answer.verdict, answer.active, answer.epoch) == (Verdict.DONE, True, 7)
    assert stage.recorder.said == [("started",)]
    assert stage.component.active


def test_it_says_which_configurator_holds_it_and_a_busy_component_says_so_in_words() -> None:
    stage = Stage()
    assert stage.state().supervisor == ""
    assert stage.call(apply(1, US)).supervisor == US
    stage.others.announce(THEM)
    answer = stage.call(apply(2, THEM))
    assert (answer.verdict, answer.supervisor) == (Verdict.BUSY, US)
    assert answer.detail == "the task task (priority 0, configurator us) holds it"
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert (stage.state().active, stage.state().supervisor) == (False, US)
    stage.leave()
    stage.let_pass(2 * GRACE)
    assert (stage.state().active, stage.state().supervisor) == (False, "")


def test_an_activation_that_is_repeated_starts_nothing_anew() -> None:
    stage = Stage()
    for epoch in (1, 1, 2):
        assert stage.call(apply(epoch, US)).verdict is Verdict.DONE
    assert stage.recorder.said == [("started",)]


def test_a_released_component_stops_and_may_be_activated_again() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    answer = stage.call(release(2, US))
    assert (answer.verdict, answer.active) == (Verdict.DONE, False)
    stage.call(apply(3, US))
    assert stage.recorder.said == [("started",), ("stopped",), ("started",)]


def test_parameters_are_set_by_name_and_as_values_of_python() -> None:
    stage = Stage()
    stage.call(apply(1, US))
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
        assert stage.call(apply(1, US, values={"goal": value})).verdict is Verdict.DONE
    assert stage.recorder.said[1:] == [("goal", value) for _, value in given]


def test_parameters_are_set_before_the_component_is_started_and_once() -> None:
    stage = Stage()
    for _ in range(2):
        assert stage.call(apply(1, US, values={"goal": Literal("x")})).verdict is Verdict.DONE
    assert stage.recorder.said == [("goal", "x"), ("started",)]


def test_a_parameter_that_changes_is_set_without_a_stop_and_the_others_are_not_set_again() -> None:
    parameters = tuple(OperationalParameter(name, IRI("urn:p:Goal")) for name in ("goal", "speed"))
    stage = Stage(profile=replace(CAP_PROFILE, parameters=parameters))
    stage.call(apply(1, US, values={"goal": Literal("x"), "speed": Literal("slow")}))
    stage.call(apply(2, US, values={"goal": Literal("x"), "speed": Literal("fast")}))
    assert stage.recorder.said == [("goal", "x"), ("speed", "slow"), ("started",), ("speed", "fast")]


def test_a_component_that_fails_and_is_started_again_has_its_parameters_set_again() -> None:
    stage = Stage()
    stage.call(apply(1, US, values={"goal": Literal("x")}))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    stage.call(apply(2, US, values={"goal": Literal("x")}))
    assert stage.recorder.said == [("goal", "x"), ("started",), ("stopped",), ("goal", "x"), ("started",)]


def test_a_component_that_refuses_a_parameter_is_not_started() -> None:
    class Picky(Recorder):
        def parameter_set(self, name: str, value: Any) -> None:
            raise Refused

    stage = Stage(Picky())
    answer = stage.call(apply(1, US, values={"goal": Literal("x")}))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it refuses goal = x")
    assert stage.recorder.said == []
    assert stage.runtime.activation.phase is ActivationPhase.IDLE


def test_a_parameter_that_is_not_declared_or_no_number_is_refused_with_a_reason() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    answer = stage.call(apply(1, US, values={"colour": Literal("red")}))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it declares no parameter 'colour'")
    answer = stage.call(apply(1, US, values={"goal": Literal("three", IRI(XSD + "integer"))}))
    assert answer.verdict is Verdict.REFUSED
    assert "goal" in answer.detail


def test_an_input_that_is_not_there_is_refused_and_nothing_starts() -> None:
    stage = Stage()
    answer = stage.call(apply(1, US, {"sonar": (Wire(TRACKER, "pose"),)}))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it has no input 'sonar'")
    assert stage.recorder.said == []


@pytest.mark.parametrize(
    ("call", "payload"),
    [
        ("apply", b""),
        ("apply", b"{}"),
        ("apply", encode(release(1, US))),
        ("dance", encode(apply(1, US))),
        ("*", encode(apply(1, US))),
        ("apply", encode(Apply(1, US))),
        ("release", encode(Release(1, US))),
        ("reserve", b"\xff"),
        ("state", b"\xff"),
        ("apply", encode(apply(1, "**"))),
        ("apply", encode(apply(1, "selfconf/lab/conf/*/live/*"))),
        ("apply", encode(apply(1, "selfconf/other/conf/us/live/1"))),
    ],
)
def test_a_call_that_is_none_is_refused_and_changes_nothing(call: str, payload: bytes) -> None:
    stage = Stage()
    replies = stage.ask(call, payload)
    assert replies.samples == ()
    assert len(replies.errors) == 1
    assert stage.recorder.said == []
    assert stage.call(apply(1, US)).verdict is Verdict.DONE


def test_a_component_that_refuses_to_start_says_why_and_stays_free() -> None:
    stage = Stage()
    stage.recorder.refusal = Refused("no light")
    answer = stage.call(apply(1, US))
    assert (answer.verdict, answer.detail, answer.active) == (Verdict.REFUSED, "no light", False)
    stage.recorder.refusal = None
    stage.others.announce(THEM)
    assert stage.call(apply(2, THEM)).verdict is Verdict.DONE


def test_a_component_that_breaks_when_it_is_started_says_how(caplog: pytest.LogCaptureFixture) -> None:
    stage = Stage()
    stage.recorder.refusal = ValueError("no camera")
    with caplog.at_level(logging.CRITICAL):
        answer = stage.call(apply(1, US))
    assert answer.verdict is Verdict.REFUSED
    assert answer.detail == "it broke in started: ValueError: no camera"
    assert not stage.component.active


def test_a_component_that_failed_and_refuses_to_start_again_is_free() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    stage.recorder.refusal = Refused("still dark")
    assert stage.call(apply(2, US)).verdict is Verdict.REFUSED
    assert stage.runtime.activation.phase is ActivationPhase.IDLE
    stage.recorder.refusal = None
    stage.others.announce(THEM)
    assert stage.call(apply(3, THEM)).verdict is Verdict.DONE


def test_a_component_that_breaks_on_a_signal_fails(caplog: pytest.LogCaptureFixture) -> None:
    class Fragile(Recorder):
        def received(self, port: str, signal: Signal) -> None:
            raise KeyError("metres")

    stage = Stage(Fragile())
    tracker = stage.neighbour()
    stage.call(follow())
    with caplog.at_level(logging.CRITICAL):
        tracker.component.emit("pose", {"feet": 1})
        stage.let_pass(0.1)
    assert [(fail.component, fail.cause, fail.detail) for fail in stage.fails] == [
        (CAP, Cause.FAIL, "KeyError: 'metres'")
    ]


def test_a_component_that_breaks_when_it_is_stopped_is_off_all_the_same(caplog: pytest.LogCaptureFixture) -> None:
    class Clumsy(Recorder):
        def stopped(self) -> None:
            raise RuntimeError("stuck")

    stage = Stage(Clumsy())
    stage.call(apply(1, US))
    with caplog.at_level(logging.CRITICAL):
        answer = stage.call(release(2, US))
    assert (answer.verdict, answer.active) == (Verdict.DONE, False)
    stage.let_pass(1.0)
    assert not stage.fails
    stage.call(apply(3, US))
    stage.component.fail("again")
    stage.let_pass(0.1)
    with caplog.at_level(logging.CRITICAL):
        answer = stage.call(apply(4, US))
    assert (answer.verdict, answer.active) == (Verdict.DONE, True)
    assert stage.runtime.activation.phase is ActivationPhase.ACTIVE


def test_a_component_raises_fail_with_its_life_its_epoch_and_a_reason() -> None:
    stage = Stage()
    stage.call(apply(4, US))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert stage.fails == [Fail(CAP, "life-1", 4, Cause.FAIL, "lost her")]
    assert not stage.component.active
    assert not stage.state().active


def test_a_component_fails_once_and_an_idle_one_never() -> None:
    stage = Stage()
    stage.component.fail("idle")
    stage.let_pass(0.1)
    stage.call(apply(1, US))
    for _ in range(3):
        stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert len(stage.fails) == 1


def test_a_component_may_fail_as_it_is_started() -> None:
    class Hopeless(Recorder):
        def started(self) -> None:
            self.fail("at once")

    stage = Stage(Hopeless())
    assert stage.call(apply(1, US)).verdict is Verdict.DONE
    stage.let_pass(0.1)
    assert [fail.detail for fail in stage.fails] == ["at once"]


def test_a_component_that_fails_as_a_parameter_is_set_says_so_and_is_not_started() -> None:
    class Unable(Recorder):
        def parameter_set(self, name: str, value: Any) -> None:
            super().parameter_set(name, value)
            if value == "x":
                self.fail("cannot take it")
                self.fail("once more")

    stage = Stage(Unable())
    answer = stage.call(apply(1, US, values={"goal": Literal("x")}))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it has failed")
    assert stage.fails == [Fail(CAP, "life-1", 1, Cause.FAIL, "cannot take it")]
    assert stage.recorder.said == [("goal", "x")]
    assert not stage.state().active
    again = stage.call(apply(1, US, values={"goal": Literal("y")}))
    assert (again.verdict, again.detail) == (Verdict.REFUSED, "it has failed"), "it stays failed for its epoch"
    assert stage.call(apply(2, US, values={"goal": Literal("y")})).active
    assert stage.recorder.said == [("goal", "x"), ("goal", "y"), ("started",)]


def test_a_component_that_failed_is_started_again_when_it_is_applied_to_again() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert stage.call(apply(2, US)).active
    assert stage.recorder.said == [("started",), ("stopped",), ("started",)]


def test_timers_run_while_the_component_is_active_and_no_longer() -> None:
    ticks: list[float] = []

    class Ticking(Recorder):
        def started(self) -> None:
            self.every(0.1, lambda: ticks.append(stage.network.time))

    stage = Stage(Ticking())
    stage.call(apply(1, US))
    stage.let_pass(0.55)
    assert len(ticks) == 5
    stage.call(release(2, US))
    stage.let_pass(1.0)
    assert len(ticks) == 5
    stage.call(apply(3, US))
    stage.let_pass(0.35)
    assert len(ticks) == 8


def test_a_timer_that_has_ticked_for_a_long_time_is_kept_once() -> None:
    ticks: list[float] = []

    class Ticking(Recorder):
        def started(self) -> None:
            self.every(0.1, lambda: ticks.append(stage.network.time))

    stage = Stage(Ticking())
    stage.call(apply(1, US))
    stage.let_pass(100.05)
    assert len(ticks) == 1000
    assert len(stage.runtime._timers) == 1
    stage.call(release(2, US))
    assert not stage.runtime._timers


@pytest.mark.parametrize("seconds", [0, -1.0, math.nan, math.inf])
def test_an_interval_that_is_none_is_refused(seconds: float) -> None:
    stage = Stage()
    stage.call(apply(1, US))
    with pytest.raises(ProgrammerError, match="more than zero seconds"):
        stage.component.every(seconds, print)


@pytest.mark.parametrize(
    ("reason", "heard"),
    [
        pytest.param("x" * 3_000_000, "x" * LONGEST_REMARK, id="too long"),
        pytest.param("\ud800 broken", "? broken", id="half a character"),
        pytest.param(None, "None", id="no text"),
    ],
)
def test_a_failure_is_heard_whatever_its_reason(reason: Any, heard: str) -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.fail(reason)
    stage.let_pass(0.1)
    assert [fail.detail for fail in stage.fails] == [heard]


def test_a_refusal_to_start_is_heard_whatever_its_reason() -> None:
    stage = Stage()
    stage.recorder.refusal = ValueError("x" * 3_000_000)
    answer = stage.call(apply(1, US))
    assert answer.verdict is Verdict.REFUSED
    assert len(answer.detail) == LONGEST_REMARK


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
    stage.call(apply(5, US))
    answer = stage.call(release(4, US))
    assert (answer.verdict, answer.epoch) == (Verdict.STALE, 5)
    assert stage.component.active


def test_closing_turns_the_component_off_and_ends_its_life() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    called: list[tuple[str, ...]] = []
    stage.runtime.close()
    stage.caller.roll_call(KEYS.any_life(), 1.0, called.append)
    stage.let_pass(0.1)
    assert called == [()]
    assert stage.recorder.said == [("started",), ("stopped",)]
    assert stage.ask("state", b"") == Replies((), (), True)


@pytest.mark.parametrize(
    ("make", "verdict"),
    [(apply, Verdict.OTHER_LIFE), (reserve, Verdict.OTHER_LIFE), (release, Verdict.DONE)],
)
def test_a_call_that_waits_for_code_that_leaves_hears_that_this_life_is_over_and_no_refusal(
    make: Callable[..., Apply | Reserve | Release], verdict: Verdict
) -> None:
    answers: list[CallAnswer] = []

    class Stopping(Recorder):
        def stopped(self) -> None:
            name = make.__name__
            stage.runtime._answer(name, encode(make(1, THEM, life="life-1")), answers.append)

    stage = Stage(Stopping())
    stage.call(apply(1, US))
    stage.runtime.close()
    assert [(answer.verdict, answer.detail) for answer in answers] == [(verdict, LIFE_ENDS)]


def test_a_component_that_leaves_while_it_starts_does_not_say_that_it_refuses() -> None:
    class Ending(Recorder):
        def started(self) -> None:
            stage.runtime.close()

    stage = Stage(Ending())
    answer = stage.call(apply(1, US))
    assert (answer.verdict, answer.detail, answer.life) == (Verdict.OTHER_LIFE, LIFE_ENDS, "life-1")


def test_closing_an_idle_component_does_not_stop_it() -> None:
    stage = Stage()
    stage.runtime.close()
    assert stage.recorder.said == []


# Which life is meant, and who else is the component.


OTHER_LIFE: list[Apply | Reserve | Release] = [make(1, US, life="life-0") for make in (apply, reserve, release)]


@pytest.mark.parametrize("message", OTHER_LIFE)
def test_a_call_that_means_another_life_changes_nothing(message: Apply | Reserve | Release) -> None:
    stage = Stage()
    stage.call(apply(1, US, life="life-1"))
    answer = stage.call(message)
    assert (answer.verdict, answer.life) == (Verdict.OTHER_LIFE, "life-1")
    assert stage.component.active
    assert stage.recorder.said == [("started",)]


# Who holds it, and who comes next.


def test_a_component_is_reserved_without_acting() -> None:
    stage = Stage()
    answer = stage.call(reserve(1, US))
    assert (answer.verdict, answer.active, answer.task) == (Verdict.DONE, False, TASKS[US])
    assert stage.recorder.said == []
    stage.others.announce(THEM)
    answer = stage.call(apply(1, THEM))
    assert (answer.verdict, answer.task) == (Verdict.BUSY, TASKS[US])
    assert stage.call(apply(2, US)).active
    assert stage.recorder.said == [("started",)]


def test_an_actuator_does_not_act_for_a_task_that_has_not_reserved_it() -> None:
    stage = Stage(profile=DRIVE_PROFILE)
    assert stage.call(apply(1, US)).verdict is Verdict.NOT_HELD
    assert stage.recorder.said == []
    stage.call(reserve(1, US))
    assert stage.call(apply(1, US)).verdict is Verdict.DONE


def test_a_component_that_is_free_is_offered_to_those_that_wait_in_order() -> None:
    """Higher priority first, then the earlier beginning; each has a moment to come for it."""
    stage = Stage()
    stage.call(apply(1, US))
    stage.others.announce(THEM)
    for task, priority, beginning in (("late~1", 0, 9.0), ("early~1", 0, 3.0), ("high~1", 0, 1.0)):
        message = reserve(1, THEM, task=task, priority=priority, beginning=beginning)
        assert stage.call(message).verdict is Verdict.BUSY
    assert stage.freed == []
    stage.call(release(2, US))
    stage.let_pass(0.05)
    assert stage.freed == ["high~1"]
    stage.let_pass(OFFER)
    assert stage.freed == ["high~1", "early~1"]
    assert stage.call(reserve(1, THEM, task="late~1", beginning=9.0)).verdict is Verdict.BUSY
    assert stage.call(reserve(1, THEM, task="early~1", beginning=3.0)).verdict is Verdict.DONE
    stage.let_pass(3 * OFFER)
    assert stage.freed == ["high~1", "early~1"]


def test_a_component_declares_what_tells_that_it_is_free_once() -> None:
    stage, declared = Stage(), list[str]()
    bus, declare = stage.runtime.bus, stage.runtime.bus.publisher

    def publisher(key: str, urgency: Urgency) -> Publisher:
        declared.append(key)
        return declare(key, urgency)

    bus.publisher = publisher  # type: ignore[assignment, method-assign]  # it is declared as a component declares it
    stage.others.announce(THEM)
    for epoch in (1, 3):
        stage.call(apply(epoch, US))
        assert stage.call(reserve(epoch, THEM, task="late~1")).verdict is Verdict.BUSY
        stage.call(release(epoch + 1, US))
        stage.let_pass(0.05)
        stage.call(release(epoch + 1, THEM, task="late~1"))
    assert stage.freed.count("late~1") == 2
    assert declared == [KEYS.free(CAP)]


def test_a_component_that_nobody_comes_for_is_offered_to_each_once_and_is_free_for_anybody_then() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.others.announce(THEM)
    for task in ("a~1", "b~1"):
        stage.call(reserve(1, THEM, task=task))
    stage.call(release(2, US))
    stage.let_pass(10 * OFFER)
    assert stage.freed == ["a~1", "b~1"]
    assert stage.call(apply(1, THEM, task="c~1")).verdict is Verdict.DONE


def test_a_task_of_lower_priority_yields_when_it_is_asked_to() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    assert stage.call(reserve(1, THEM, priority=1)).verdict is Verdict.BUSY
    stage.let_pass(0.1)
    assert [(fail.component, fail.cause, fail.task) for fail in stage.fails] == [(CAP, Cause.YIELD, TASKS[US])]
    assert stage.component.active
    stage.call(release(2, US))
    stage.let_pass(0.1)
    assert stage.freed == [TASKS[THEM]]
    assert stage.call(apply(1, THEM, priority=1)).verdict is Verdict.DONE
    stage.let_pass(2 * YIELDING)
    assert stage.component.active
    assert len(stage.fails) == 1


def test_what_is_released_while_another_task_has_reserved_it_says_nothing_that_configurators_heed() -> None:
    stage = Stage(profile=TRACKER_PROFILE)
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    assert stage.call(reserve(5, THEM)).verdict is Verdict.DONE
    assert not stage.call(release(2, US)).active
    stage.let_pass(0.1)
    assert [(fail.cause, fail.epoch, fail.task) for fail in stage.said] == [(Cause.LET_GO, 0, "")]


def test_a_task_of_lower_priority_that_does_not_yield_is_preempted() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    stage.call(reserve(1, THEM, priority=1))
    stage.let_pass(YIELDING - 0.1)
    assert stage.component.active
    stage.let_pass(0.2)
    assert stage.recorder.said == [("started",), ("stopped",)]
    assert [(fail.cause, fail.task) for fail in stage.fails][1:] == [(Cause.LET_GO, TASKS[US])]
    assert stage.freed == [TASKS[THEM]]
    assert stage.call(reserve(1, THEM, priority=1)).verdict is Verdict.DONE


def test_a_task_is_asked_to_yield_before_it_is_preempted_even_if_another_was_asked_just_before() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US))
    stage.call(reserve(1, THEM, priority=1))
    stage.let_pass(YIELDING / 2)
    stage.call(release(2, US))
    stage.call(reserve(2, THEM, priority=1))
    stage.call(release(3, THEM))
    stage.call(apply(4, US))
    stage.call(reserve(4, THEM, priority=1))
    stage.let_pass(YIELDING - 0.1)
    assert stage.component.active
    assert [fail.cause for fail in stage.fails] == [Cause.YIELD] * 2
    stage.let_pass(0.2)
    assert not stage.component.active


def test_tasks_of_one_priority_never_take_from_each_other() -> None:
    stage = Stage()
    stage.others.announce(THEM)
    stage.call(apply(1, US, priority=1, beginning=9.0))
    stage.call(reserve(1, THEM, priority=1, beginning=1.0))
    stage.let_pass(10 * YIELDING)
    assert stage.component.active
    assert stage.fails == []


def test_a_component_that_is_asked_to_yield_still_feeds_those_that_follow_it() -> None:
    class Watchful(Recorder):
        def unfed(self, port: str) -> None:
            self.said.append(("unfed", port))

    stage = Stage(Watchful())
    tracker = stage.neighbour()
    stage.others.announce(THEM)
    stage.call(follow())
    tracker._put_fail(Cause.YIELD, "somebody asks for it")
    stage.let_pass(0.1)
    assert stage.recorder.said == [("started",)]


def test_a_shared_component_acts_while_one_of_its_tasks_has_applied_to_it() -> None:
    stage = Stage(profile=replace(CAP_PROFILE, shareable=True))
    stage.others.announce(THEM)
    for supervisor in (US, THEM):
        assert stage.call(apply(1, supervisor)).verdict is Verdict.DONE
    assert stage.call(apply(1, THEM, values={"goal": Literal("x")}, task="other~1")).verdict is Verdict.BUSY
    assert stage.call(release(2, US)).verdict is Verdict.DONE
    assert stage.component.active
    assert (stage.state(TASKS[THEM]).active, stage.state(TASKS[US]).task) == (True, TASKS[THEM])
    stage.call(release(2, THEM))
    assert stage.recorder.said == [("started",), ("stopped",)]


def test_a_component_that_failed_stays_failed_for_an_apply_that_comes_late() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert stage.call(apply(1, US)).verdict is Verdict.REFUSED
    assert not stage.component.active


def test_what_a_component_says_of_itself_names_its_process_and_who_holds_it_since_when() -> None:
    stage = Stage()
    stage.call(apply(1, US, priority=3, beginning=12.0))
    answer = stage.state()
    assert (answer.task, answer.priority, answer.beginning, answer.supervisor) == (TASKS[US], 3, 12.0, US)
    assert answer.place == f"process {os.getpid()} on {socket.gethostname()}"


def test_the_answer_to_state_says_how_long_it_has_lived_what_it_takes_and_what_it_has_issued() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.emit("velocity", 1)
    stage.let_pass(2.0)
    answer = stage.state()
    assert answer.age >= 2.0
    assert answer.memory > 0
    assert answer.issued == {"velocity": 1}
    assert stage.call(apply(2, US)).issued == {}
