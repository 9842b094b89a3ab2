"""Harsher histories of tasks that live in the sites: disks, clocks, hosts and links (`harsh_kept_tasks.py`)."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from tests.faults.harsh_kept_tasks import KINDS, played
from tests.faults.kept_tasks import account
from tests.harness.effort import NIGHTLY

HARSH = 500 if NIGHTLY else len(KINDS)
BATCH = len(KINDS)


@pytest.mark.slow
@pytest.mark.parametrize("batch", range(0, HARSH, BATCH))
def test_after_all_that_befalls_sites_each_task_is_run_by_one_or_over_and_each_kind_happens(
    batch: int, tmp_path: Path
) -> None:
    done: Counter[str] = Counter()
    for seed in range(batch, batch + BATCH):
        history = played(seed, tmp_path / str(seed))
        assert not history.broken, account(seed, history)
        done += history.done
    assert done.keys() == {*KINDS}


@pytest.mark.parametrize(
    "seed", [pytest.param(783, id="a site is mute as it sees the others again, and a task has ended")]
)
def test_a_harsh_history_of_kept_tasks_that_was_broken_once_is_not_any_more(seed: int, tmp_path: Path) -> None:
    history = played(seed, tmp_path)
    assert not history.broken, account(seed, history)
