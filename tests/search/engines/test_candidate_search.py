"""Depth-first search over the candidates themselves, within its budget."""

from __future__ import annotations

from hypothesis import given

from selfconf.search.budget import Budget
from selfconf.search.engines.candidate_search import CandidateSearch
from selfconf.search.problem import Problem
from tests.search.comparison import least_numbers
from tests.search.worlds import agreement, component, problem, problems


@given(problems())
@agreement(0.3)
def test_a_few_steps_find_the_least_solution_or_none(problem: Problem) -> None:
    found = CandidateSearch(problem, Budget(6)).first()
    if found is not None:
        assert [problem.candidates[r].index(c) for r, some in enumerate(found) for c in some] == least_numbers(problem)


def test_many_roles_that_draw_on_one_pool_are_filled_in_a_few_steps_each() -> None:
    pool = [component(f"c{number:02}") for number in range(60)]
    given_ = problem({f"role{number:02}": pool for number in range(60)})
    found = CandidateSearch(given_, Budget(4 * 60)).first()
    assert found == [[candidate] for candidate in given_.candidates[0]]


def test_skipping_components_that_play_already_uses_up_a_budget_too() -> None:
    pool = [component(f"c{number:02}") for number in range(60)]
    given_ = problem({f"role{number:02}": pool for number in range(60)})
    assert CandidateSearch(given_, Budget(60)).first() is None
