"""The benchmark of the search: its short run works, its SPARQL query is right, and its page says what was measured."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.search import families, sparql
from benchmarks.search.measure import Measured
from benchmarks.search.report import Row, exponents, page, verdict

ROOT = Path(__file__).resolve().parents[1]


def test_the_short_run_runs() -> None:
    command = [sys.executable, "-m", "benchmarks.search.run", "--smoke"]
    done = subprocess.run(
        command,
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    assert "## Time to the proof that there is none" in done.stdout


@pytest.mark.parametrize("solvable", [True, False])
def test_rdflib_answers_the_same_query(solvable: bool) -> None:
    assert sparql.rdflib_graph(families.navigation(3, 1, solvable)) is solvable
    assert sparql.oxigraph(families.navigation(3, 1, solvable)) is solvable
    assert sparql.oxigraph(families.fleet(3, 4, 1))


def row(size: int, mine: float, other: float | None, answer: bool | None = True) -> Row:
    """A row of the table."""
    instance = families.Instance("navigation", f"{size} per role", size, lambda: families.navigation(1, 1))
    beside = Measured(3.0, None) if other is None else Measured(other, answer)
    return Row(instance, {"selfconf": Measured(mine, answer), "clingo": beside}, answer)


def test_a_goal_that_is_missed_is_said_to_be_missed() -> None:
    good, bad = row(100, 0.02, 0.5), row(1000, 0.2, 0.1)
    assert "met on all" in "\n".join(verdict([good]))
    text = "\n".join(verdict([good, bad]))
    assert "missed on 1 of them: navigation, 1000 per role (2.00)" in text
    assert "time-outs" in "\n".join(verdict([row(10, 0.1, None)]))
    whole = page([good, bad, row(10, 0.1, 0.2, False), row(20, 3.0, None, None)], 3.0)
    assert "**2.00**" in whole
    assert "## Decided by nobody" in whole


def test_growth_is_the_slope_in_a_log_log_diagram() -> None:
    rows = [row(10**k, 0.002 * 10**k, 0.002 * 100**k) for k in range(3)]
    assert "| navigation | selfconf | 1.0 |" in exponents(rows)
    assert "| navigation | clingo | 2.0 |" in exponents(rows)
