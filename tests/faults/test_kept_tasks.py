"""Histories of tasks that live in the sites: whatever happens to these, one runs each task, and none what has ended."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.bus.port import Replies
from selfconf.deployment import Keeper, TaskRunner
from selfconf.protocol.messages import TaskRecord
from tests.effort import NIGHTLY, examples
from tests.faults.kept_tasks import account, played

HISTORIES = 2_000 if NIGHTLY else examples(50)  # 20 for every push


@pytest.mark.slow
@pytest.mark.parametrize("batch", range(0, HISTORIES, 10))
def test_after_all_that_happens_to_sites_each_task_is_run_by_one_or_over(batch: int, tmp_path: Path) -> None:
    for seed in range(batch, min(batch + 10, HISTORIES)):
        history = played(seed, tmp_path / str(seed))
        assert not history.broken, account(seed, history)


def counts_revisions_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(TaskRecord, "supersedes", lambda self, known: known is None or self.revision > known.revision)


def asks_no_site_that_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    def all_answered(self: Keeper, replies: Replies) -> None:
        for sample in replies.samples:
            self._take(sample)
        self._look()

    monkeypatch.setattr(Keeper, "_all_answered", all_answered)
    monkeypatch.setattr(Keeper, "_take_all", lambda self, replies: None)


def lets_go_of_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(TaskRunner, "hand_over", lambda self: None)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mutation", "seed", "what"),
    [
        (counts_revisions_alone, 138, "keep different tasks"),
        (asks_no_site_that_comes, 152, "keep different tasks"),
        (lets_go_of_nothing, 100, "is run by"),
    ],
    ids=lambda value: getattr(value, "__name__", ""),
)
def test_a_keeper_that_is_broken_on_purpose_is_noticed(
    mutation: object, seed: int, what: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert not played(seed, tmp_path / "whole").broken
    assert callable(mutation)
    mutation(monkeypatch)
    assert any(what in one for one in played(seed, tmp_path / "mutated").broken)
