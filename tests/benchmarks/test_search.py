"""The benchmark of the search: its short run works, its SPARQL query is right, and its page says what was measured."""

from __future__ import annotations

from dataclasses import replace

import pytest

from benchmarks.search import first, measure, sparql
from benchmarks.search.engines import installed
from benchmarks.search.families import scaling, wiring
from benchmarks.search.measure import Measured
from benchmarks.search.report import Row, exponents, page, verdict
from selfconf.model.partition import Candidate
from selfconf.model.profile import Input, Output, Ports, Profile
from selfconf.model.term import IRI
from selfconf.search.problem import Problem
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough


@thorough
@pytest.mark.process
def test_the_short_run_runs() -> None:
    printed = short_run("benchmarks.search.run")
    assert "## Time to the proof that there is none" in printed


@pytest.mark.parametrize("solvable", [True, False])
def test_rdflib_answers_the_same_query(solvable: bool) -> None:
    assert sparql.rdflib_graph(scaling.navigation(3, 1, solvable)) is solvable
    assert sparql.oxigraph(scaling.navigation(3, 1, solvable)) is solvable
    assert sparql.oxigraph(scaling.fleet(3, 4, 1))


def test_types_of_signals_and_masks_of_values_are_touched_before_the_time_of_an_engine_begins() -> None:
    touched: list[object] = []

    class Watched(tuple):
        def __iter__(self):
            touched.append(self)
            return super().__iter__()

    wanted, issued, masks = Watched([wiring.iri("a")]), Watched([wiring.iri("b")]), Watched([1])
    ports = Ports((Input("in", wanted),), (Output("out", issued),))
    problem = wiring.made([[Candidate(Profile(wiring.iri("c"), ports=ports), masks)]], [])
    touched.clear()
    measure._own(problem)
    assert [id(one) for one in touched] == [id(masks), id(wanted), id(issued)]


PROBLEMS = {
    "navigation": scaling.navigation(12, 7001),
    "tree": scaling.graph("tree", 12, 6, 3, 7001),
    "distinct": scaling.distinct(8, 8),
    "scarce": scaling.scarce(12, 0.4, 1),
    "3-SAT": scaling.satisfiability(20, 3.0, 7001),
    "fleet": scaling.fleet(6, 20, 7001),
    "impossible": scaling.navigation(4, 7001, solvable=False),
}


@pytest.mark.parametrize("problem", PROBLEMS.values(), ids=PROBLEMS)
def test_whoever_is_asked_for_the_first_configuration_names_it(problem: Problem) -> None:
    asked = [engine for engine in first.ENGINES if engine.partition(",")[0] in installed()]
    assert {"selfconf", "clingo, heuristic", "clingo, weights", "MiniCard"} <= set(asked)
    assert len({first.ENGINES[engine](problem) for engine in asked}) == 1


def row(size: int, mine: float, other: float | None, answer: bool | None = True) -> Row:
    """A row of the table."""
    instance = wiring.Instance("navigation", f"{size} per role", size, lambda: scaling.navigation(1, 1))
    beside = Measured(3.0, None) if other is None else Measured(other, answer)
    return Row(instance, {"selfconf": Measured(mine, answer), "clingo": beside}, answer)


def test_a_goal_that_is_missed_is_said_to_be_missed() -> None:
    good, bad = row(100, 0.02, 0.5), row(1000, 0.2, 0.1)
    assert "met on all" in "\n".join(verdict([good]))
    text = "\n".join(verdict([good, bad]))
    assert "missed on 1 of them: navigation, 1000 per role (2.00)" in text
    assert "1 time-out counts" in "\n".join(verdict([row(10, 0.1, None)]))
    whole = page([good, bad, row(10, 0.1, 0.2, False), row(20, 3.0, None, None)], 3.0)
    assert "**2.00**" in whole
    assert "## Decided by nobody" in whole


def test_the_easier_question_is_told_from_the_same_one() -> None:
    who = (IRI("urn:test:somebody"),)
    lines = list(verdict([row(100, 0.02, 0.01), replace(row(100, 0.02, 0.05), answer=who)]))
    assert "first configuration" in lines[0]
    assert "met on all" in lines[0]
    assert "any configuration" in lines[1]
    assert "missed on 1" in lines[1]
    assert "## Time to the first configuration" in page([replace(row(100, 0.02, 0.05), answer=who)], 3.0)


def test_growth_is_the_slope_in_a_log_log_diagram() -> None:
    rows = [row(10**k, 0.002 * 10**k, 0.002 * 100**k) for k in range(3)]
    assert "| navigation | selfconf | 1.0 |" in exponents(rows)
    assert "| navigation | clingo | 2.0 |" in exponents(rows)
