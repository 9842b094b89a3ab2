"""The comparison of two trees: its short run works, its problems are as they were, and its page is honest."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks import failover
from benchmarks.compare import __main__ as compare
from benchmarks.compare import inputs, report
from benchmarks.compare.report import Row
from benchmarks.compare.trees import both
from benchmarks.search import engines
from selfconf.cli.main import main
from tests.harness.effort import at_night

ROOT = Path(__file__).resolve().parents[2]
in_git = pytest.mark.skipif(not (ROOT / ".git").exists(), reason="there is no git repository to take a revision from")


@at_night
@pytest.mark.process
@in_git
def test_the_short_run_runs() -> None:
    command = [sys.executable, "-m", "benchmarks.compare", "HEAD", "--smoke", "--only", "validate"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode in (0, 1), done.stderr  # 1 where work in progress changes an answer
    assert "20 files, one in ten with a mistake" in done.stdout


@in_git
def test_the_tree_of_a_revision_is_gone_afterwards() -> None:
    with both("HEAD") as (before, after):
        assert (before.path / "selfconf" / "__init__.py").exists()
        assert after.path == ROOT
        assert before.run("-c", "import selfconf; print(selfconf.__file__)").out.startswith(str(before.path))
    assert not before.path.exists()


def test_what_is_no_revision_is_told_in_a_sentence() -> None:
    with pytest.raises(SystemExit, match="git rev-parse"), both("no-such-revision"):
        pass


@pytest.mark.parametrize("name", [name for name in inputs.FIRST if "1,000" not in name and "100 var" not in name])
def test_a_problem_of_a_family_is_as_possible_on_files(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    template, ads = tmp_path / "template.ttl", tmp_path / "ads.ttl"
    problem = inputs.FIRST[name]()
    for path, text in zip((template, ads), inputs.turtle(problem), strict=True):
        path.write_text(text)
    code = main(["configure", str(template), "--ads", str(ads), "--format", "json"])
    body = json.loads(capsys.readouterr().out)
    assert (code == 0) is engines.selfconf(problem)
    assert list(body["eligible"].values()) == [len(candidates) for candidates in problem.candidates]


def test_different_answers_are_named() -> None:
    rows = [Row("start", "help", "process", 0.2, 0.1), Row("search", "tree", "search", 0.1, 0.103, False)]
    text = report.page(rows, ["v1", "the tree as it is"])
    assert "| help | process | 200.00 | 100.00 | **0.50** |" in text
    assert "| tree | search | 100.00 | 103.00 | 1.03 |" in text
    assert "different answers to:**\n\n* search: tree\n" in text
    assert "the same answer to every command" in report.page(rows[:1], ["v1", "the tree as it is"])


def test_the_failover_of_any_tree_is_measured_after_the_rest_that_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    measured: list[tuple[float, list[str]]] = []
    monkeypatch.setattr(failover, "PAUSE", failover.PAUSE)
    monkeypatch.setattr(failover, "main", lambda: measured.append((failover.PAUSE, sys.argv[1:])))
    monkeypatch.setattr(sys, "argv", ["-c", "0.7", "--trials", "3"])
    exec(compare.AFTER_REST, {})
    assert measured == [(0.7, ["--trials", "3"])]


def test_a_failover_is_compared_with_the_search_too() -> None:
    parts = {"round trip": [0.001], "detect": [0.001], "decide": [0.002], "deploy": [0.001], "undecided": [0.005]}
    printed = failover.report(parts)
    found = dict(compare.medians(printed))
    assert found["FAIL to first message"] == pytest.approx(found["decide"] + 5.0) == pytest.approx(7.0)
