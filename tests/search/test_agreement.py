"""Every way to search gives one and the same answer."""

from __future__ import annotations

import pytest
from hypothesis import given

from benchmarks.search import sparql
from selfconf.model.configuration import Configuration
from selfconf.search.problem import Problem
from selfconf.search.strategies import first as solve
from selfconf.search.strategies import paper
from tests.search.oracle import World
from tests.search.worlds import agreement, problems

Numbers = list[tuple[int, int]]


def _world(problem: Problem) -> World:
    return World(problem.task, problem.partition, problem.hierarchy)


def _first(problem: Problem) -> Configuration | None:
    answer = solve.search(problem)
    return answer if isinstance(answer, Configuration) else None


def _by_enumeration(problem: Problem) -> Numbers | None:
    """The least solution as pairs of a role and the number of a candidate, slot by slot."""
    players = next(_world(problem).solutions(), None)
    if players is None:
        return None
    return [(role, problem.candidates[role].index(c)) for role, chosen in enumerate(players) for c in chosen]


@given(problems())
@agreement()
def test_first_is_what_enumeration_finds_first(problem: Problem) -> None:
    assert _first(problem) == _world(problem).first()


@given(problems(roles=3, components=4))
@agreement()
def test_first_is_what_the_algorithm_of_the_paper_returns(problem: Problem) -> None:
    assert _first(problem) == paper.algorithm_1(problem)


@given(problems())
@agreement()
def test_first_is_the_best_answer_set_of_a_logic_program(problem: Problem) -> None:
    pytest.importorskip("clingo")
    from tests.search import encodings

    found = encodings.first(problem)
    assert found == _by_enumeration(problem)
    assert (found is None) == (_first(problem) is None)


@given(problems(roles=3, components=4))
@agreement()
def test_first_is_the_first_answer_to_one_query_for_the_whole_template(problem: Problem) -> None:
    found = sparql.first(problem)
    assert found == _by_enumeration(problem)
    assert sparql.oxigraph(problem) == (found is not None) == (_first(problem) is not None)
