"""Hundreds of histories in which everything goes wrong; each ends in order, or its seed is printed.

How to replay one is said at the head of `tests/faults/histories.py`.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.faults.histories import History

BATCHES = range(15)
BATCH = 20


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One folder of advertisements for all histories."""
    return tmp_path_factory.mktemp("advertisements")


def replay(seed: int, folder: Path) -> None:
    """Run one history, and say what is not in order."""
    history = History(seed, folder)
    history.run()
    disorder = list(history.disorder())
    assert not disorder, "\n".join([*history.told, *disorder])


@pytest.mark.parametrize("batch", BATCHES)
def test_after_every_history_the_ecology_is_in_order(batch: int, folder: Path, request: pytest.FixtureRequest) -> None:
    wanted = request.config.getoption("--seed")
    if wanted is not None:
        replay(wanted + batch, folder)
        return
    for seed in range(batch * BATCH, (batch + 1) * BATCH):
        replay(seed, folder)


def test_a_history_is_replayed_by_its_seed(folder: Path) -> None:
    histories: list[History] = []
    for _ in range(2):
        histories.append(History(7, folder))
        histories[-1].run()
    one, other = histories
    assert one.told == other.told
    assert {n: r.said for n, r in one.lab.components.items()} == {n: r.said for n, r in other.lab.components.items()}
