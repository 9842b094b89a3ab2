"""Histories whose tasks change to components that they would rather have: these come, go, fail and issue nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.faults.ecologies import CHOICE, COMPOSED, PAPER
from tests.faults.replay import played
from tests.faults.script import KINDS, Recipe, with_upgrades, write
from tests.faults.test_histories import BATCH, HISTORIES, folder, play_well
from tests.harness.effort import NIGHTLY, batches

__all__ = ["folder"]
UPGRADING = HISTORIES // (10 if NIGHTLY else 30)
"""In so many histories more, each of which takes as long as seven others, tasks change for the better."""


def recipe(seed: int) -> Recipe:
    """The recipe of one of these histories: code is busy in some, and others are large."""
    ecology = (CHOICE, PAPER, CHOICE, COMPOSED)[seed % 4]
    return Recipe(seed, ecology, busy=seed // 4 % 3 == 1, large=seed // 12 % 2 == 1, upgrades=True)


@pytest.mark.slow
@pytest.mark.parametrize("batch", batches(UPGRADING, BATCH // 4))
def test_no_history_of_upgrades_breaks_an_invariant(batch: int, folder: Path) -> None:
    for seed in range(batch, batch + BATCH // 4):
        play_well(recipe(seed), folder)


@pytest.mark.slow
@pytest.mark.parametrize(
    "seed",
    [
        pytest.param(36, id="what stood by has just issued a signal for another task"),
        pytest.param(138, id="the better actuator crashes as it is to act, and the task dismantles on failures"),
        pytest.param(316, id="a task of higher priority asks meanwhile for what runs"),
        pytest.param(150, id="the better source hangs as it starts, and the task dismantles on failures"),
    ],
)
def test_a_history_of_upgrades_that_was_broken_once_is_not_any_more(seed: int, folder: Path) -> None:
    play_well(recipe(seed), folder)


BROKEN_ONCE = {
    "what stands behind a better composite is silent, and is replaced": Recipe(990000411, COMPOSED, upgrades=True),
    "what stood by has let go of a task, and has not said if it acts": Recipe(3000747, CHOICE, upgrades=True),
    "what runs loses a source while what is better is silent": Recipe(3502067, CHOICE, large=True, upgrades=True),
    "an upgrade begins before a composite says what it is": Recipe(2004121, COMPOSED, busy=True, upgrades=True),
    "a composite is repaired inside, and its task has not told yet": Recipe(41004643, COMPOSED, upgrades=True),
    "what is followed was stopped since, which is heard of too late": Recipe(9303807, CHOICE, upgrades=True),
    "a task waits for what hung when another has asked for it": Recipe(9751881, CHOICE, busy=True, upgrades=True),
    "a source acts for another task when it is followed": Recipe(5002231, CHOICE, busy=True, upgrades=True),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", BROKEN_ONCE)
def test_another_history_of_upgrades_that_was_broken_once_is_not_any_more(what: str, folder: Path) -> None:
    play_well(BROKEN_ONCE[what], folder)


@pytest.mark.parametrize(("seed", "ended"), [(28, [False, True]), (42, [False, True, False, True])])
def test_upgrades_come_about_and_come_to_nothing(seed: int, ended: list[bool], folder: Path) -> None:
    """Else their invariants would say nothing."""
    history = played(recipe(seed).script, folder / recipe(seed).ecology.name)
    assert history.watch.upgrades.ended == ended


def test_a_script_with_upgrades_goes_on_where_the_one_without_ends() -> None:
    for seed in range(100):
        without, upgrading = write(seed, ecology=CHOICE), with_upgrades(write(seed, ecology=CHOICE))
        assert upgrading.actions[: len(without.actions)] == without.actions
        times = [action.time for action in upgrading.actions]
        assert times == sorted(times)
        assert {action.kind for action in upgrading.actions} <= {*KINDS, "hush"}
