"""The watch over the rate that an output has promised: when its silence is reported, and when it is excused."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from selfconf.sdk.inputs.silence_watch import BEGINNING, NETWORK_ANSWER, PATIENCE
from tests.sdk.stage import TRACKER, US, Stage, apply, follow, silence


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


@pytest.mark.parametrize("seconds", [0.3, 0.4, 0.9, 3.0])
def test_while_a_process_stands_still_that_follows_an_output_the_output_is_not_silent(seconds: float) -> None:
    """Whenever that begins, and however often: the output of a machine that stalls goes on when all else does."""
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(period=0.1))
    for number in range(30):
        tracker.component.emit("pose", number)
        stage.let_pass(0.1 * (number % 10) / 10)
        go_on = stage.network.stall()
        stage.let_pass(seconds)
        go_on()
        stage.let_pass(0.1)
    assert not silence(stage)


def test_an_output_that_is_silent_is_reported_also_after_the_process_has_stood_still() -> None:
    stage = Stage()
    stage.neighbour().component.emit("pose", 1)
    stage.call(follow(period=0.1))
    stage.neighbour().component.emit("pose", 2)
    stage.let_pass(0.05)
    go_on = stage.network.stall()
    stage.let_pass(3.0)
    go_on()
    stage.let_pass(PATIENCE * 0.1 - 0.1)
    assert not silence(stage)
    stage.let_pass(0.15)
    assert silence(stage)


def late_answers(stage: Stage, monkeypatch: pytest.MonkeyPatch, seconds: float) -> list[float]:
    """Have the network take some seconds to say who lives; returns when it was asked."""
    asked: list[float] = []
    bus = stage.runtime.bus

    def roll_call(key: str, most: float, done: Callable[[tuple[str, ...]], None]) -> None:
        asked.append(bus.now())
        bus.later(min(seconds, most), lambda: done(()))

    monkeypatch.setattr(bus, "roll_call", roll_call)
    return asked


def test_while_the_network_stands_still_the_output_is_not_silent(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(period=0.05))
    asked = late_answers(stage, monkeypatch, 0.3)
    for number in range(3):
        tracker.component.emit("pose", number)
        stage.let_pass(0.45)  # what was issued meanwhile comes when the network goes on
    assert asked
    assert not silence(stage)


@pytest.mark.parametrize("answer", [0.3, 100.0])
def test_an_output_is_excused_once_by_a_network_that_stands_still(
    answer: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(period=0.05))
    late_answers(stage, monkeypatch, answer)
    tracker.component.emit("pose", 1)
    stage.let_pass(0.2 + min(answer, NETWORK_ANSWER) + 0.15)
    assert not silence(stage)
    stage.let_pass(0.1)
    assert silence(stage) == [(TRACKER, "")]


def test_nothing_is_reported_by_an_answer_that_comes_when_nothing_is_expected(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Stage()
    tracker = stage.neighbour()
    stage.call(follow(period=0.05))
    asked = late_answers(stage, monkeypatch, 0.04)
    tracker.component.emit("pose", 1)
    stage.let_pass(0.22)
    assert asked
    stage.call(apply(epoch=2))
    stage.let_pass(1.0)
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
