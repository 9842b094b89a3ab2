"""Which roles a component could play: asked of the configurators, judged apart, kept, and bounded in time."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from urllib.parse import quote

import pytest

import selfconf as sc
from selfconf.api.method import Method
from selfconf.api.tasks.detached import task_record
from selfconf.serve import fits
from selfconf.serve.board import Board
from tests.lab import NAVIGATE, Lab, iri
from tests.serve.asgi import asked, meanwhile, served, watched

pytestmark = pytest.mark.process


def answers(lab: Lab, board: Board, *names: str) -> list[Any]:
    """What is said of some components, one after the other, while the ecology goes on."""
    watched(lab, board)
    app = served(board)
    paths = [f"/fit?component={quote(iri(name), safe='')}" for name in names]
    return [meanwhile(lab, asked(app, path)).json["tasks"] for path in paths]


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    lab = Lab(tmp_path)
    lab.navigation()
    task = sc.template(NAVIGATE).bind(robot=":Astrid", goal="(AT BEDROOM)").complete()
    agent = lab.agent(record=task_record(task, Method.of()))
    assert lab.running(agent)
    return lab


def test_the_roles_of_the_tasks_that_run_judge_a_component_once(
    lab: Lab, board: Board, monkeypatch: pytest.MonkeyPatch
) -> None:
    judged = []
    real = fits._judged

    async def counting(record: bytes, advertisement: bytes) -> Any:
        judged.append(advertisement)
        return await real(record, advertisement)

    monkeypatch.setattr(fits, "_judged", counting)
    pippi, odometry, again = answers(lab, board, "pippi-drive", "absolute-odometry", "pippi-drive")
    ((task, body),) = pippi.items()
    assert task.startswith("navigate~")
    assert body["name"] == "navigate"
    near = [(one["role"], one["obstacles"]) for one in body["roles"] if one["near"]]
    assert near == [(iri("drive"), ["support is Pippi, not Astrid"])]
    assert [one["role"] for one in odometry[task]["roles"] if one["eligible"]] == [iri("position")]
    assert again == pippi
    assert len(judged) == 2


def test_what_takes_too_long_is_ended_and_said(lab: Lab, board: Board, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fits, "JUDGING", 0.01)
    ((body,),) = (one.values() for one in answers(lab, board, "wheels"))
    assert body["detail"] == "what its roles ask for was not judged in 0.01 s"


def test_a_configurator_that_does_not_tell_its_task_is_passed_over(tmp_path: Path, board: Board) -> None:
    lab = Lab(tmp_path)
    lab.navigation()
    assert lab.running(lab.agent())
    assert answers(lab, board, "wheels") == [{}]
