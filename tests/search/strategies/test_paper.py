"""The algorithm of the paper, as printed but for its errata, gives the answer of `first`."""

from __future__ import annotations

from hypothesis import given

from selfconf.search.problem import Problem
from selfconf.search.strategies import paper
from tests.search.comparison import first_configuration
from tests.search.worlds import agreement, problems


@given(problems(roles=3, components=4))
@agreement()
def test_first_is_what_the_algorithm_of_the_paper_returns(problem: Problem) -> None:
    assert first_configuration(problem) == paper.algorithm_1(problem)
