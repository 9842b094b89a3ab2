"""What would mend a task that waits: asked of its configurator, found out apart, and bounded in time."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest

import selfconf as sc
from selfconf.api.answer import Method
from selfconf.api.detached import task_record
from selfconf.configurator.state import Policy
from selfconf.protocol.keys import Keys
from selfconf.serve import mends
from selfconf.serve.board import Board
from selfconf.serve.change import EcologyChange
from selfconf.serve.running_tasks import running_tasks
from tests.lab import NAVIGATE, Lab, iri
from tests.serve.asgi import ask, asked, meanwhile, served

pytestmark = pytest.mark.process


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    """An ecology with a task that tells what it is."""
    lab = Lab(tmp_path)
    lab.navigation()
    task = sc.template(NAVIGATE).bind(robot=":Astrid", goal="(AT BEDROOM)").complete()
    assert lab.running(lab.agent(record=task_record(task, Method.of(), Policy.REPAIR)))
    return lab


def test_what_would_mend_a_task_is_told_or_why_not(lab: Lab, board: Board, monkeypatch: pytest.MonkeyPatch) -> None:
    bus = lab.network.node()
    (record,) = meanwhile(lab, running_tasks(bus, Keys("lab")))
    board.apply(EcologyChange(tasks={record.task: {"lost": {iri("astrid-drive"): {}}}, "old": {}}))

    def answer(task: str) -> Any:
        return meanwhile(lab, asked(served(board, bus=bus), f"/mend?task={quote(task)}")).json

    told = answer(record.task)
    assert [one["role"] for one in told["reasons"]] == [iri("drive")]
    assert any("let pippi-drive play drive" in one["message"] for one in told["repairs"])
    assert answer("old") == {"detail": "its configurator does not tell its task"}
    monkeypatch.setattr(mends, "MENDING", 0.01)
    assert answer(record.task) == {"detail": "what would mend it was not found in 0.01 s"}


def test_a_task_that_nobody_knows_is_none(board: Board) -> None:
    assert ask(served(board), "/mend?task=none").status == 404
    assert ask(served(board), "/mend").status == 404
