"""The algorithm of the paper, as printed but for its errata, gives the answer of `first`."""

from __future__ import annotations

from hypothesis import given

from selfconf.search.problem import Problem
from selfconf.search.strategies import paper
from tests.search.comparison import first_configuration
from tests.search.worlds import agreement, component, problem, problems


@given(problems(roles=3, components=4))
@agreement()
def test_first_is_what_the_algorithm_of_the_paper_returns(drawn: Problem) -> None:
    assert first_configuration(drawn) == paper.algorithm_1(drawn)


def test_a_role_that_asks_for_more_than_memory_holds_fails_at_once() -> None:
    asked = problem({"speaker": [component("left"), component("right")]}, counts={"speaker": (10**17, None)})
    assert paper.algorithm_1(asked) is None
