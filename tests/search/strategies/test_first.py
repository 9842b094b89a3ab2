"""Every way to search for the first configuration gives one and the same answer."""

from __future__ import annotations

import random

import pytest
from hypothesis import given

from benchmarks.search import sparql
from benchmarks.search.families import scaling
from benchmarks.search.families.wiring import made, profile
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines.least_solution import least_by_clauses
from selfconf.search.engines.ordered_decisions import OrderedDecisions
from selfconf.search.problem import Problem
from selfconf.search.reduction.dominance import LazyReduction, reduced
from selfconf.search.strategies import first
from tests.search.comparison import first_configuration, least_pairs, numbers
from tests.search.oracle import World
from tests.search.worlds import agreement, problems


@given(problems())
@agreement()
def test_first_is_what_enumeration_finds_first(problem: Problem) -> None:
    assert first_configuration(problem) == World(problem.task, problem.partition, problem.hierarchy).first()


@given(problems())
@agreement()
def test_first_is_the_best_answer_set_of_a_logic_program(problem: Problem) -> None:
    pytest.importorskip("clingo")
    from tests.search import encodings

    found = encodings.first(problem)
    assert found == least_pairs(problem)
    assert (found is None) == (first_configuration(problem) is None)


@given(problems(roles=3, components=4, plain=True))
@agreement()
def test_first_is_the_first_answer_to_one_query_for_the_whole_template(problem: Problem) -> None:
    found = sparql.first(problem)
    assert found == least_pairs(problem)
    assert sparql.oxigraph(problem) == (found is not None) == (first_configuration(problem) is not None)


@pytest.mark.parametrize("seed", range(12))
def test_a_cause_near_the_beginning_is_found_there_and_the_answer_is_the_same(seed: int) -> None:
    pytest.importorskip("pysat")
    problem = scaling.graph("graph", 150, 10 + seed, 3, seed)
    given_ = LazyReduction(problem)
    found = first.solution(given_, Budget())
    expected = numbers(least_by_clauses(reduced(problem), Budget()))
    assert isinstance(found, list) == (expected is not None)
    if isinstance(found, list):
        assert [problem.candidates[r].index(c) for r, some in enumerate(found) for c in some] == expected


def test_where_the_first_roles_are_impossible_the_whole_problem_is_not_reduced() -> None:
    pytest.importorskip("pysat")
    given_ = LazyReduction(scaling.graph("graph", 200, 10, 3, 7_001))
    assert first.solution(given_, Budget()) is None
    assert "reduced" not in vars(given_)


def _relays(roles: int, pool: int, kinds: int, seed: int) -> Problem:
    """Return a chain of roles of one pool, whose components all have ports of their own."""
    rng = random.Random(seed)
    some = [
        Candidate(profile(f"relay{k:04}", [rng.randrange(kinds)], [rng.randrange(kinds), f"of{k}"]))
        for k in range(pool)
    ]
    source = [Candidate(profile("source", (), range(kinds)))]
    return made([source, *[some] * roles], [(role, role + 1) for role in range(roles)])


@pytest.mark.parametrize("seed", range(3))
def test_many_candidates_are_not_reduced_where_the_first_that_fits_is_met_soon(seed: int) -> None:
    pytest.importorskip("pysat")
    problem = _relays(12, 960, 15, seed)
    given_ = LazyReduction(problem)
    found = first.solution(given_, Budget())
    assert isinstance(found, list)
    assert "reduced" not in vars(given_)
    assert [problem.candidates[r].index(c) for r, some in enumerate(found) for c in some] == numbers(
        least_by_clauses(reduced(problem), Budget())
    )


def test_a_problem_is_possible_though_the_steps_end_before_its_first_solution_is_proved(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    pytest.importorskip("pysat")
    # The solver that decides in order meets no other solution than the first.
    monkeypatch.setattr(OrderedDecisions, "available", staticmethod(lambda _: False))
    problem = scaling.satisfiability(60, 3.8, seed=2)
    # Each call of the solver is a step, and the first solution takes one more for each slot at least.
    undecided = [
        steps
        for steps in range(300, 540, 6)
        if isinstance(first.solution(LazyReduction(problem), Budget(steps)), Undecided)
    ]
    assert any(first.possible(problem, Budget(steps)) for steps in undecided)
