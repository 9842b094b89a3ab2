"""Histories of harsher kinds: machines stall, hosts freeze, links flap, answers come late, and more (`harsh.py`)."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pytest

from selfconf.bus.memory import Faults
from tests.faults import script
from tests.faults.ecologies import COMPOSED, ECOLOGIES, LATCHED, PAPER
from tests.faults.harsh import KINDS, STALLS, promising, write
from tests.faults.histories import History
from tests.faults.replay import account, played, told
from tests.faults.script import Action, Recipe, Script, TaskPlan
from tests.faults.test_histories import folder
from tests.harness.effort import NIGHTLY

__all__ = ["folder"]
HARSH, BATCH = (4_000, 200) if NIGHTLY else (40, 40)
"""How many histories there are, and of how many together each kind happens: one that comes to nothing is none."""


def recipe(seed: int) -> Recipe:
    """The recipe of one of these histories: code is busy in some, others are large, and at night some upgrade."""
    ecology = [*ECOLOGIES.values()][seed % len(ECOLOGIES)]
    upgrades = NIGHTLY and seed % 4 == 3 and not ecology.crowd
    return Recipe(seed, ecology, busy=seed % 5 == 1, large=seed % 7 == 2, upgrades=upgrades, harsh=True)


@pytest.mark.slow
@pytest.mark.parametrize("batch", range(0, HARSH, BATCH))
def test_no_harsh_history_breaks_an_invariant_and_each_kind_of_fault_happens(batch: int, folder: Path) -> None:
    done: Counter[str] = Counter()
    for seed in range(batch, batch + BATCH):
        history = played(recipe(seed).script, folder / recipe(seed).ecology.name)
        assert not history.broken, told(recipe(seed), history)
        done.update(history.done)
    assert done.keys() >= KINDS.keys()


def test_each_kind_of_harsh_action_comes_first_in_turn_and_twice_at_least() -> None:
    for seed, kind in enumerate(KINDS):
        actions = [action.kind for action in write(seed, COMPOSED).actions]
        assert actions.count(kind) >= 2
        assert {action.kind for action in write(seed, only=(kind,)).actions} == {kind, "begin"}


BROKEN_ONCE = {
    "what is fed is out of sight, and then its source answers too late": Script(
        2746,
        LATCHED,
        tasks={"task-1": TaskPlan()},
        actions=(
            Action(0.0, "begin", "task-1"),
            Action(5.3, "deafen", "mower", seconds=0.3),
            Action(5.3, "answer_late", "planner", seconds=3.0),
            Action(6.8, "start", "wall"),
        ),
    ),
    "what stood by has issued a signal just before it let go of a task": Script(
        1639,
        COMPOSED,
        tasks={"task-1": TaskPlan(upgrade=0.5)},
        startable=frozenset({"odometry", "tracker-1", "tracker-2", "lamp-2", "drive", "screen"}),
        actions=(
            Action(0.0, "begin", "task-1"),
            Action(10.0, "flap_all", "living-room", seconds=0.3),
            Action(12.0, "crash", "screen"),
        ),
        period=script.PERIOD,
    ),
    "what a task waits for is ended by its site, as it has not obeyed an earlier release of that task": Recipe(
        1003000080, harsh=True
    ).script,
    "a FAIL comes after what its source has issued since it acts again": Script(
        830001140,
        LATCHED,
        Faults(least_delay=0.0005, most_delay=0.02, most_event_delay=0.1),
        tasks={"task-1": TaskPlan(), "task-2": TaskPlan()},
        actions=(
            Action(0.0, "begin", "task-1"),
            Action(5.511, "begin", "task-2"),
            Action(6.112, "flap", "chart", "task-2", seconds=8.0),
            Action(6.622, "flap", "task-2", "second-planner", seconds=0.05),
            Action(6.622, "fail", "second-planner"),
            Action(6.623, "flap", "chart", "second-mower", seconds=8.0),
        ),
    ),
}


@pytest.mark.parametrize("what", BROKEN_ONCE)
def test_a_harsh_history_that_was_broken_once_is_not_any_more(what: str, folder: Path) -> None:
    one = BROKEN_ONCE[what]
    history = played(one, folder / one.ecology.name)
    assert not history.broken, account(history)


@pytest.mark.parametrize("seconds", STALLS)
def test_a_machine_that_stalls_and_goes_on_loses_nothing(seconds: float, folder: Path) -> None:
    """Although outputs promise rates, and are silent meanwhile."""
    stalls = tuple(Action(5.0 + 7 * number, "stall_machine", seconds=seconds) for number in range(5))
    actions = (Action(0.0, "begin", "task-1"), *stalls, Action(45.0, "begin", "task-1"))
    tasks = {"task-1": TaskPlan()}
    history = History(Script(1, PAPER, tasks=tasks, actions=actions, promised=True, period=script.PERIOD), folder)
    history.run()
    assert not history.broken
    assert history.done["stall_machine"] == 5
    assert not history.agents[0].state.lost
    assert "lost" not in [event.act for event in history.lab.events]


def test_outputs_promise_the_rate_at_which_they_issue_signals(folder: Path) -> None:
    for name, text in PAPER.advertisements.items():
        assert promising(text).count("sc:rate") == text.count("sc:hasOutput"), name
