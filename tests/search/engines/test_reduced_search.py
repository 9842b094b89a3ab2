"""Depth-first search over a reduced problem: the least solution, or no answer when the budget ends."""

from __future__ import annotations

from hypothesis import given

from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines.matching import MaintainedMatching
from selfconf.search.engines.reduced_search import first_solution
from selfconf.search.problem import Problem
from selfconf.search.reduction.constraints import pruned
from selfconf.search.reduction.dominance import reduced
from tests.search.comparison import least_numbers, numbers
from tests.search.worlds import agreement, problems


@given(problems())
@agreement(0.6)
def test_the_least_solution_is_found_before_and_after_arc_consistency(problem: Problem) -> None:
    expected = least_numbers(problem)
    assert numbers(first_solution(pruned(reduced(problem)), Budget())) == expected
    assert numbers(first_solution(reduced(problem), Budget())) == expected


@given(problems())
@agreement(0.3)
def test_a_budget_that_ends_is_no_answer(problem: Problem) -> None:
    expected = least_numbers(problem)
    for steps in range(12):
        found = first_solution(pruned(reduced(problem)), Budget(steps))
        assert isinstance(found, Undecided) or numbers(found) == expected


@given(problems())
@agreement(0.4)
def test_a_maintained_matching_leaves_no_solution_out(problem: Problem) -> None:
    given_ = reduced(problem)
    matching = MaintainedMatching(given_.slots, [[o.component for o in some] for some in given_.options])
    assert numbers(first_solution(given_, Budget(), matching=matching)) == least_numbers(problem)
