"""Histories of five tasks that want the same few components at once, in opposite order, while these come and go."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.faults.ecologies import CROWDED
from tests.faults.script import Recipe, with_crowd, write
from tests.faults.test_histories import BATCH, HISTORIES, folder, play_well
from tests.harness.effort import NIGHTLY, batches

__all__ = ["folder"]
CROWDS = HISTORIES // (10 if NIGHTLY else 30)
"""So many histories more."""


def recipe(seed: int) -> Recipe:
    """The recipe of one of these histories: code is busy in some, others are large, and in some tasks change."""
    return Recipe(seed, CROWDED, busy=seed % 3 == 1, large=seed % 4 == 2, upgrades=seed % 5 == 0)


@pytest.mark.slow
@pytest.mark.parametrize("batch", batches(CROWDS, BATCH // 4))
def test_no_history_of_a_crowd_breaks_an_invariant(batch: int, folder: Path) -> None:
    for seed in range(batch, batch + BATCH // 4):
        play_well(recipe(seed), folder)


@pytest.mark.parametrize(
    "seed",
    [
        pytest.param(1847, id="an actuator that rests is started by the last signal, fails, and is replaced"),
        pytest.param(2578, id="the call to what replaces a source is lost, and another task holds that"),
        pytest.param(2658, id="what seems to have crashed is released, and acts for another task"),
        pytest.param(2726, id="a repair waits for what another task holds"),
    ],
)
def test_a_history_of_a_crowd_that_was_broken_once_is_not_any_more(seed: int, folder: Path) -> None:
    play_well(recipe(seed), folder)


def test_a_task_that_wants_again_what_has_not_obeyed_its_release_waits_for_no_other(folder: Path) -> None:
    play_well(Recipe(902408, CROWDED, large=True), folder)


def test_an_actuator_that_did_not_hear_that_it_is_to_rest_is_told_again(folder: Path) -> None:
    play_well(Recipe(9401546, CROWDED, busy=True, large=True, upgrades=True), folder)


def test_in_a_crowd_most_tasks_begin_at_once_and_some_are_of_either_template() -> None:
    scripts = [with_crowd(write(seed, ecology=CROWDED)) for seed in range(20)]
    at_once = [sum(one.kind == "begin" and one.time <= 0.5 for one in script.actions) for script in scripts]
    assert sum(at_once) > 3 * len(scripts)
    assert all(script.tasks.keys() == {*CROWDED.tasks} for script in scripts)
    assert {plan.drives for script in scripts for plan in script.tasks.values()} == {True, False}
