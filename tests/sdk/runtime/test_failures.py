"""What breaks, fails or refuses in a component is heard with its reason; it goes on, or is started again."""

from __future__ import annotations

import logging
from dataclasses import replace
from typing import Any

import pytest

from selfconf.model.profile import Output, offered_operation
from selfconf.model.wording import LONGEST_REMARK
from selfconf.protocol.activation import ActivationPhase
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import Cause, Fail, Verdict, Wire
from selfconf.sdk.component import Signal
from tests.lab import Recorder
from tests.sdk.stage import (
    CAP,
    DRIVE_PROFILE,
    THEM,
    TRACKER,
    US,
    Stage,
    apply,
    follow,
    release,
    reserve,
)


def test_a_component_that_breaks_when_it_is_started_says_how(caplog: pytest.LogCaptureFixture) -> None:
    stage = Stage()
    stage.recorder.refusal = ValueError("no camera")
    with caplog.at_level(logging.CRITICAL):
        answer = stage.call(apply(1, US))
    assert answer.verdict is Verdict.REFUSED
    assert answer.detail == "it broke in started: ValueError: no camera"
    assert not stage.component.active


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


def test_a_sensor_that_breaks_when_it_is_stopped_is_off_all_the_same(caplog: pytest.LogCaptureFixture) -> None:
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


class Jammed(Recorder):
    """Cannot come to rest."""

    def stopped(self) -> None:
        super().stopped()
        raise RuntimeError("jammed")


@pytest.mark.parametrize("offered", [(), (offered_operation("home", None, None),)])
def test_an_actuator_that_breaks_when_it_is_released_has_not_obeyed(
    offered: tuple[Output, ...], caplog: pytest.LogCaptureFixture
) -> None:
    profile = replace(DRIVE_PROFILE, ports=DRIVE_PROFILE.ports._replace(outputs=offered))
    stage = Stage(recorder := Jammed(), profile)
    stage.call(reserve(1, US))
    stage.call(apply(1, US))
    with caplog.at_level(logging.CRITICAL):
        replies = stage.ask("release", encode(release(2, US)))
    assert (replies.samples, replies.errors) == ((), ())
    assert (stage.state().stopping, stage.state().active) == (True, False)
    assert recorder.said == [("started",), ("stopped",)]
    assert not stage.ask("reserve", encode(reserve(3, THEM))).samples


def test_an_actuator_that_breaks_when_it_is_to_rest_fails_and_is_stopped_once_more_by_the_release(
    caplog: pytest.LogCaptureFixture,
) -> None:
    stage = Stage(recorder := Jammed(), DRIVE_PROFILE)
    stage.neighbour()
    stage.call(reserve(1, US))
    stage.call(apply(2, US, {"position": (Wire(TRACKER, "pose", None),)}))
    with caplog.at_level(logging.CRITICAL):
        stage.call(apply(3, US, {"position": ()}))
        stage.let_pass(2.0)
    assert [(fail.cause, fail.detail) for fail in stage.fails] == [
        (Cause.HUNG, "it broke in stopped: RuntimeError: jammed")
    ]
    with caplog.at_level(logging.CRITICAL):
        assert not stage.ask("release", encode(release(4, US))).samples
    assert recorder.said.count(("stopped",)) == 2


def test_an_actuator_that_breaks_when_it_is_stopped_to_start_again_does_not_start(
    caplog: pytest.LogCaptureFixture,
) -> None:
    stage = Stage(recorder := Jammed(), DRIVE_PROFILE)
    stage.call(reserve(1, US))
    stage.call(apply(1, US))
    stage.component.fail("overheated")
    stage.let_pass(0.1)
    with caplog.at_level(logging.CRITICAL):
        answer = stage.call(apply(2, US))
    assert (answer.verdict, answer.detail) == (Verdict.REFUSED, "it has not come to rest")
    assert (answer.stopping, answer.active) == (True, False)
    assert recorder.said.count(("started",)) == 1


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


def test_a_component_that_failed_is_started_again_when_it_is_applied_to_again() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert stage.call(apply(2, US)).active
    assert stage.recorder.said == [("started",), ("stopped",), ("started",)]


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


def test_a_component_that_failed_stays_failed_for_an_apply_that_comes_late() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    stage.component.fail("lost her")
    stage.let_pass(0.1)
    assert stage.call(apply(1, US)).verdict is Verdict.REFUSED
    assert not stage.component.active
