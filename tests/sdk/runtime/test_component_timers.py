"""What a component does every so often, which it does while it is active."""

from __future__ import annotations

import math
from typing import Any

import pytest

from selfconf.errors import ProgrammerError
from tests.lab import Recorder
from tests.sdk.stage import (
    US,
    Stage,
    apply,
    release,
)


def ticking() -> tuple[Stage, list[float]]:
    """A component that acts and begins a timer as it is started, with the times at which that has ticked."""
    ticks: list[float] = []

    class Ticking(Recorder):
        def started(self) -> None:
            self.every(0.1, lambda: ticks.append(stage.network.time))

    stage = Stage(Ticking())
    stage.call(apply(1, US))
    return stage, ticks


def test_timers_run_while_the_component_is_active_and_no_longer() -> None:
    stage, ticks = ticking()
    stage.let_pass(0.55)
    assert len(ticks) == 5
    stage.call(release(2, US))
    stage.let_pass(1.0)
    assert len(ticks) == 5
    stage.call(apply(3, US))
    stage.let_pass(0.35)
    assert len(ticks) == 8


def test_a_timer_that_has_ticked_for_a_long_time_is_kept_once() -> None:
    stage, ticks = ticking()
    stage.let_pass(100.05)
    assert len(ticks) == 1000
    assert len(stage.runtime._timers.running) == 1
    stage.call(release(2, US))
    assert not stage.runtime._timers.running


@pytest.mark.parametrize("seconds", [0, -1.0, math.nan, math.inf, "1", None])
def test_an_interval_that_is_none_is_refused(seconds: Any) -> None:
    stage = Stage()
    stage.call(apply(1, US))
    with pytest.raises(ProgrammerError, match="more than zero seconds"):
        stage.component.every(seconds, print)


def test_what_cannot_be_called_is_refused_where_it_is_handed_over() -> None:
    stage = Stage()
    stage.call(apply(1, US))
    with pytest.raises(ProgrammerError, match="`every` takes a function to call"):
        stage.component.every(1.0, None)  # as by `self.every(1.0, self.measure())`


def test_a_timer_of_a_component_that_is_not_active_is_not_kept() -> None:
    stage = Stage()
    for _ in range(100):
        stage.component.every(0.1, print)
    stage.let_pass(0.2)
    assert not stage.runtime._timers.running
