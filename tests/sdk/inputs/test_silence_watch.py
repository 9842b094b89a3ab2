"""The watch over the rate that an output has promised: when its silence is reported, and when it is excused."""

from __future__ import annotations

import pytest

from selfconf.sdk.inputs.silence_watch import BEGINNING, PATIENCE
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
