"""Histories of tasks that live in the sites: whatever happens to these, one runs each task, and none what has ended."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from selfconf.bus.port import Replies
from selfconf.deployment import Keeper
from selfconf.deployment.record_exchange import RecordExchange
from selfconf.protocol.codec import encode
from selfconf.protocol.messages import TaskRecord
from tests.faults.kept_tasks import FAULTY, TASKS, KeptHistory, account, played
from tests.harness.effort import NIGHTLY, batches, examples

HISTORIES = 2_000 if NIGHTLY else examples(50)  # 20 for every push


@pytest.mark.slow
@pytest.mark.parametrize("batch", batches(HISTORIES, 10))
def test_after_all_that_happens_to_sites_each_task_is_run_by_one_or_over(batch: int, tmp_path: Path) -> None:
    for seed in range(batch, min(batch + 10, HISTORIES)):
        history = played(seed, tmp_path / str(seed))
        assert not history.broken, account(seed, history)


class Undisturbed(KeptHistory):
    """A history of one task that goes on as the sites that keep it die, come back, and are frozen.

    Others advertise its components, and keep tasks as well, so that there is always one that can go on with it.
    """

    def play(self) -> None:
        """Let all of that happen, and note what has been stopped."""
        faults = (self._end, self._come_back_unless_one_is_frozen, self._pause)
        self.network.faults = replace(self.network.faults, most_event_delay=0.0)  # the grace is for such delays
        moments = sorted(self._chance.uniform(3.0, 3.0 + FAULTY) for _ in range(self._chance.randrange(2, 10)))
        self._user.ask(self.lab.keys.keep(), encode(TASKS[0]), 1.0, lambda replies: None)
        for moment in moments:
            self.lab.let_pass(max(0.0, moment - self.network.time))
            self._chance.choice(faults)()
        self.lab.let_pass(1.0)
        self._cease()
        self.lab.let_pass(15.0)
        said = self.lab.components.items()
        self.broken += [f"{name} was stopped" for name, component in said if ("stopped",) in component.said]

    def _come_back_unless_one_is_frozen(self) -> None:
        """A site that begins asks all others what they keep, and waits two seconds for the answer of a frozen one."""
        if not any(node.paused for node in self._nodes.values()):
            self._come_back()


@pytest.mark.slow
@pytest.mark.parametrize("batch", batches(HISTORIES, 10))
def test_no_component_stops_as_a_task_goes_from_site_to_site(batch: int, tmp_path: Path) -> None:
    for seed in range(batch, min(batch + 10, HISTORIES)):
        history = Undisturbed(seed, tmp_path / str(seed))
        history.play()
        assert not history.broken, account(seed, history)


def counts_revisions_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(TaskRecord, "supersedes", lambda self, known: known is None or self.revision > known.revision)


def asks_no_site_that_comes(monkeypatch: pytest.MonkeyPatch) -> None:
    def all_answered(self: RecordExchange, replies: Replies) -> None:
        for sample in replies.samples:
            self._take(sample)
        self._keeper.caught_up()

    monkeypatch.setattr(RecordExchange, "_all_answered", all_answered)
    monkeypatch.setattr(RecordExchange, "_take_all", lambda self, replies: None)


def lets_go_of_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Keeper, "_hand_over", lambda self, task: None)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("mutation", "seed", "what"),
    [
        (counts_revisions_alone, 712, "keep different tasks"),
        (asks_no_site_that_comes, 152, "keep different tasks"),
        (lets_go_of_nothing, 4, "is run by"),
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
