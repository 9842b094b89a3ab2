"""Histories in ecologies of random shape, whose tasks have programs of their own or are kept by the sites."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from selfconf.composition.composer import Composer
from selfconf.model.configuration import Configuration
from tests.faults.random_ecologies import random_ecology
from tests.faults.replay import played
from tests.faults.script import Recipe
from tests.faults.test_histories import HISTORIES, folder, play_well
from tests.harness.effort import NIGHTLY, batches
from tests.lab import Lab, task_of

__all__ = ["folder"]
RANDOM = HISTORIES // (10 if NIGHTLY else 15)
"""So many histories more, of which every third is one of tasks that the sites keep."""
BATCH = 10


def recipe(seed: int) -> Recipe:
    """The recipe of one of these histories: three in an ecology, each of another kind."""
    return Recipe(
        seed,
        random_ecology(seed // 3),
        busy=seed % 5 == 1,
        large=seed % 7 == 2,
        upgrades=seed % 11 == 3,
        harsh=seed % 2 == 1,
        kept=seed % 3 == 2,
    )


@pytest.mark.slow
@pytest.mark.parametrize("batch", batches(RANDOM, BATCH))
def test_no_history_in_an_ecology_of_random_shape_breaks_an_invariant(batch: int, folder: Path) -> None:
    for seed in range(batch, batch + BATCH):
        play_well(recipe(seed), folder)


def test_most_ecologies_of_random_shape_have_a_configuration_and_all_kinds_of_statements_occur(tmp_path: Path) -> None:
    said: Counter[str] = Counter()
    configured = 0
    for number in range(60):
        ecology = random_ecology(number)
        text = " ".join((*ecology.advertisements.values(), ecology.whole))
        said.update(word for word in text.split() if word.startswith("sc:"))
        lab = Lab(tmp_path / ecology.name, advertised=ecology.advertisements, still=True)
        found = {}
        for name, components in ecology.sites.items():
            found |= lab.site(name, *components).shelf.advertisements
        outcome = Composer(task_of(ecology.whole, (("goal", "x"),))).compose(found, frozenset(), None)
        configured += isinstance(outcome, Configuration)
    assert configured > 45
    expected = (
        "optional shareable tolerates hasParameter sets hasOperation needsOperation grounding minCount preference"
    )
    assert said.keys() >= {f"sc:{word}" for word in expected.split()}


def test_an_ecology_of_random_shape_is_decided_by_its_number() -> None:
    one = random_ecology(5)
    random_ecology.cache_clear()
    assert one == random_ecology(5) != random_ecology(6)


def test_sites_that_keep_tasks_run_them_and_go_on_with_them(folder: Path) -> None:
    """Of the tasks of a history some run in the end, at one site each, though a site dies for good."""
    ran = 0
    for seed in range(2, 17, 3):
        history = played(recipe(seed).script, folder / recipe(seed).ecology.name)
        tasks = [agent.state.task for agent in history.agents]
        assert len({*tasks}) == len(tasks)
        ran += any(agent.configuration is not None for agent in history.agents)
    assert ran >= 3


@pytest.mark.parametrize(
    "once",
    [
        pytest.param(
            Recipe(2200000634, random_ecology(733333544), kept=True),
            id="each configurator of a task finds what the one before it has reserved, and gives way to it",
        ),
        pytest.param(
            Recipe(2200000223, random_ecology(733333407), upgrades=True, harsh=True, kept=True),
            id="a component crashes that was adopted while its site was out of sight",
        ),
        pytest.param(
            Recipe(2500000035, random_ecology(833333345), harsh=True),
            id="of two components that others hold one can be shared if it follows something else",
        ),
        pytest.param(
            Recipe(2700200291, random_ecology(900066763), harsh=True, kept=True),
            id="a configurator does not know by an advertisement that what it has adopted can be shared",
        ),
    ],
)
def test_a_history_in_an_ecology_of_random_shape_that_was_broken_once_is_not_any_more(
    once: Recipe, folder: Path
) -> None:
    play_well(once, folder)
