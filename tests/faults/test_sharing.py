"""Histories of four tasks that share cameras and trackers, and lose what these follow while they do."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.faults.ecologies import SHARED
from tests.faults.script import Recipe
from tests.faults.test_histories import BATCH, HISTORIES, folder, play_well
from tests.harness.effort import NIGHTLY, batches

__all__ = ["folder"]
SHARING = HISTORIES // (10 if NIGHTLY else 30)
"""So many histories more."""


def recipe(seed: int) -> Recipe:
    """The recipe of one of these histories: code is busy in some, others are large, and in some tasks change."""
    return Recipe(seed, SHARED, busy=seed % 5 == 1, large=seed % 3 == 2, upgrades=seed % 7 == 0)


@pytest.mark.slow
@pytest.mark.parametrize("batch", batches(SHARING, BATCH // 4))
def test_no_history_of_tasks_that_share_breaks_an_invariant(batch: int, folder: Path) -> None:
    for seed in range(batch, batch + BATCH // 4):
        play_well(recipe(seed), folder)


@pytest.mark.slow
@pytest.mark.parametrize(
    "seed",
    [
        pytest.param(33, id="two that share a tracker want another camera before it acts for either"),
        pytest.param(98, id="a tracker can be shared if it follows the camera that is not preferred"),
        pytest.param(182, id="a change for the better wants something else of what others share"),
        pytest.param(474, id="a tracker can be shared if it follows the last of several cameras"),
    ],
)
def test_a_history_of_tasks_that_share_that_was_broken_once_is_not_any_more(seed: int, folder: Path) -> None:
    play_well(recipe(seed), folder)


@pytest.mark.slow
def test_what_was_adopted_and_is_not_wanted_any_more_may_act_again_before_it_is_let_go(folder: Path) -> None:
    """It has obeyed an apply that was overtaken by a reserve of the next epoch, and says that it acts."""
    play_well(Recipe(3100000079, SHARED, kept=True), folder)
