"""The refusal of a task that waits or was refused, explained apart from its configurator, bounded in time."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest

import selfconf as sc
from selfconf.api.method import Method
from selfconf.api.tasks.detached import task_record
from selfconf.deployment.runner import TaskRunner
from selfconf.serve import explained_refusals
from selfconf.serve.board import Board
from selfconf.serve.watching.change import EcologyChange
from tests.lab import NAVIGATE, Lab, iri
from tests.serve.asgi import ask, asked, meanwhile, served, watched

pytestmark = pytest.mark.process


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    """An ecology with what the task of the tests needs."""
    lab = Lab(tmp_path)
    lab.navigation()
    return lab


def agent(lab: Lab, robot: str) -> TaskRunner:
    """A configurator of a robot's task, which tells its task to whoever asks."""
    wanted = {"robot": robot, "goal": "(AT BEDROOM)"}
    record = task_record(sc.template(NAVIGATE).bind(**wanted).complete(), Method.of())
    return lab.agent(bound=tuple(wanted.items()), record=record)


def explained(lab: Lab, board: Board, task: str) -> Any:
    """What is answered about a task while the ecology goes on."""
    return meanwhile(lab, asked(served(board), f"/mend?task={quote(task)}")).json


def test_the_relaxations_of_a_task_are_found_or_why_not(
    lab: Lab, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert lab.running(agent(lab, ":Astrid"))
    watched(lab, board)
    (task,) = board.running()
    board.apply(EcologyChange(tasks={task: {"lost": {iri("astrid-drive"): {}}}, "old": {}}))
    told = explained(lab, board, task)
    assert [one["role"] for one in told["reasons"]] == [iri("drive")]
    assert any("let the role drive take pippi-drive" in one["message"] for one in told["repairs"])
    assert explained(lab, board, "old") == {"detail": "its configurator has not told its task"}
    monkeypatch.setattr(explained_refusals, "EXPLAINED_WITHIN", 0.01)
    assert explained(lab, board, task) == {"detail": "what would mend it was not found in 0.01 s"}


def test_a_task_that_was_refused_at_once_is_explained(lab: Lab, board: Board) -> None:
    watched(lab, board)
    agent(lab, ":Emil")
    lab.let_pass(2.0)
    assert lab.ended
    assert board.running() == []
    ((task, body),) = board.state()["tasks"].items()
    assert (body["phase"], body["over"]) == ("refused", True)
    told = explained(lab, board, task)
    assert iri("drive") in {one["role"] for one in told["reasons"]}
    assert iri("astrid-drive") in {one["component"] for one in told["near_misses"]}


def refused(phase: str, *repairs: str, **facts: Any) -> dict[str, Any]:
    """What is known of a task without a configuration; near misses are told at once, repairs may be later."""
    near = {"role": "urn:r", "component": "urn:c", "obstacle": "its place is kitchen"}
    told = {"reasons": [], "near_misses": [near], "repairs": [{"message": repair} for repair in repairs], "message": ""}
    return {"phase": phase, "over": False, "inside_of": "", "refusal": told, **facts}


def test_what_the_configurator_of_a_task_that_waits_tells_soon_is_not_searched_for(
    board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(explained_refusals, "TOLD_WITHIN", 60.0)
    board.apply(EcologyChange(tasks={"t": refused("waiting")}))

    async def explained() -> Any:
        asking = asyncio.create_task(asked(served(board), "/mend?task=t"))
        done, _ = await asyncio.wait([asking], timeout=0.3)
        assert not done
        board.apply(EcologyChange(tasks={"t": refused("waiting", "add one")}))
        return (await asking).json

    assert asyncio.run(explained()) == refused("waiting", "add one")["refusal"]
    assert ask(served(board), "/mend?task=t").json["repairs"] == [{"message": "add one"}]


@pytest.mark.parametrize(
    "facts",
    [
        {"over": True},
        {"inside_of": "outer~c1"},
        {"refusal": None},
    ],
    ids=["refused", "inside", "runs"],
)
def test_what_no_configurator_will_tell_is_searched_for_at_once(
    board: Board, monkeypatch: pytest.MonkeyPatch, facts: dict[str, Any]
) -> None:
    monkeypatch.setattr(explained_refusals, "TOLD_WITHIN", 60.0)
    board.apply(EcologyChange(tasks={"t": refused("waiting", **facts)}))
    assert ask(served(board), "/mend?task=t").json == {"detail": "its configurator has not told its task"}


def test_what_no_configurator_has_told_in_time_is_searched_for(board: Board, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(explained_refusals, "TOLD_WITHIN", 0.2)
    board.apply(EcologyChange(tasks={"t": refused("waiting")}))
    assert ask(served(board), "/mend?task=t").json == {"detail": "its configurator has not told its task"}


def test_a_task_that_nobody_knows_is_none(board: Board) -> None:
    assert ask(served(board), "/mend?task=none").status == 404
    assert ask(served(board), "/mend").status == 404
