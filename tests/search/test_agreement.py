"""Every way to search gives one and the same answer."""

from __future__ import annotations

from hypothesis import given

from selfconf.model.configuration import Configuration
from selfconf.search import paper, solve
from selfconf.search.problem import Problem
from tests.search.oracle import World
from tests.search.worlds import agreement, problems


def _world(problem: Problem) -> World:
    return World(problem.task, problem.partition, problem.hierarchy)


@given(problems())
@agreement()
def test_first_is_what_enumeration_finds_first(problem: Problem) -> None:
    answer = solve.search(problem)
    assert (answer if isinstance(answer, Configuration) else None) == _world(problem).first()


@given(problems(roles=3, components=4))
@agreement(0.5)
def test_first_is_what_the_algorithm_of_the_paper_returns(problem: Problem) -> None:
    answer = solve.search(problem)
    assert (answer if isinstance(answer, Configuration) else None) == paper.search(problem)
