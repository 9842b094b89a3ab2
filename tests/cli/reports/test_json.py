"""Reports as one JSON object."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from selfconf.cli.main import main
from selfconf.cli.reports import RENDERERS
from selfconf.model.diagnostic import report
from tests.cli.diagnosed import NASTY


def test_json_holds_every_problem(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    main(["validate", "wrong.ttl", "broken.ttl", "--format", "json"])
    content = json.loads(capsys.readouterr().out)
    assert content["conforms"] is False
    assert (content["files"], content["errors"], content["warnings"]) == (2, 3, 0)
    assert content["unreadable"] == ["broken.ttl"]
    assert content["diagnostics"][1] == {
        "file": "wrong.ttl",
        "line": 10,
        "column": 1,
        "end_column": 7,
        "severity": "error",
        "code": "SC-A03",
        "message": "A component has a type besides sc:Component, which says what kind of component it is.",
        "hint": None,
        "shape": "https://w3id.org/selfconf/shapes#ComponentKind",
    }


def test_words_come_back_as_they_were() -> None:
    (found,) = json.loads(RENDERERS["json"](NASTY))["diagnostics"]
    (problem,) = NASTY.diagnostics
    assert (found["file"], found["message"], found["hint"]) == (problem.file, problem.message, "Try.")
    assert found["end_column"] - found["column"] == 2


def test_a_report_without_problems_conforms() -> None:
    content = json.loads(RENDERERS["json"](report(["a.ttl"], [])))
    assert (content["conforms"], content["files"], content["diagnostics"]) == (True, 1, [])
