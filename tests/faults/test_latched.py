"""Histories of tasks whose sources have one thing to say, as they start, and say it to each input that follows them."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.faults.ecologies import LATCHED
from tests.faults.script import Recipe
from tests.faults.test_histories import BATCH, HISTORIES, folder, play_well
from tests.harness.effort import NIGHTLY, batches

__all__ = ["folder"]
LATCHING = HISTORIES // (10 if NIGHTLY else 15)
"""So many histories more."""


def recipe(seed: int) -> Recipe:
    """The recipe of one of these histories: code is busy in some, and others are large."""
    return Recipe(seed, LATCHED, busy=seed % 3 == 1, large=seed % 4 == 2)


@pytest.mark.slow
@pytest.mark.parametrize("batch", batches(LATCHING, BATCH // 4))
def test_no_history_of_what_has_one_thing_to_say_breaks_an_invariant(batch: int, folder: Path) -> None:
    for seed in range(batch, batch + BATCH // 4):
        play_well(recipe(seed), folder)


BROKEN_ONCE = {
    "what stood by acts already for another task": Recipe(316, LATCHED),
    "an actuator loses sight of what feeds it for a moment": Recipe(823, LATCHED),
    "what feeds an actuator is out of sight, and in sight again at once": Recipe(2094, LATCHED, busy=True),
    "a signal waits for code that starts, and its source is seen late": Recipe(
        12007301, LATCHED, busy=True, large=True
    ),
    "an actuator that was cut off is reserved anew, and its source acts for another task": Recipe(
        9554465, LATCHED, large=True
    ),
    "a site ends for one task what another waits for, as it goes on": Recipe(3640000133, LATCHED),
}


@pytest.mark.parametrize("what", BROKEN_ONCE)
def test_a_history_of_what_has_one_thing_to_say_that_was_broken_once_is_not_any_more(what: str, folder: Path) -> None:
    play_well(BROKEN_ONCE[what], folder)
