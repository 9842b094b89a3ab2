"""Subproblems: what is possible under some constraints is possible under fewer."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from selfconf.search.budget import Budget
from selfconf.search.engines.reduced_search import first_solution
from selfconf.search.problem import Problem
from selfconf.search.reduction.constraints import Constraint, Distinct, all_of, subproblem
from selfconf.search.reduction.dominance import reduced
from selfconf.search.reduction.reduced_problem import ReducedProblem
from tests.search.comparison import least_numbers
from tests.search.worlds import agreement, component, problem, problems


def feasible(given_: ReducedProblem, constraints: set[Constraint]) -> bool:
    """Return whether constraints can hold together, by depth-first search alone."""
    return first_solution(subproblem(given_, constraints), Budget(), Distinct() in constraints) is not None


@given(problems(roles=3, components=4), st.data())
@agreement(0.5)
def test_fewer_constraints_never_make_less_possible(problem: Problem, data: st.DataObject) -> None:
    given_ = reduced(problem)
    constraints = all_of(given_)
    some = data.draw(st.sets(st.sampled_from(constraints)))
    fewer = data.draw(st.sets(st.sampled_from(sorted(some, key=constraints.index)))) if some else set()
    assert feasible(given_, fewer) or not feasible(given_, some)


@given(problems(roles=3, components=4))
@agreement(0.3)
def test_all_constraints_together_are_the_problem(problem: Problem) -> None:
    given_ = reduced(problem)
    assert feasible(given_, set(all_of(given_))) == (least_numbers(problem) is not None)


def test_a_role_that_no_constraint_is_about_has_no_slots() -> None:
    given_ = reduced(problem({"eye": [component("camera", outputs="o:Image")], "mind": [component("cap", "i:Image")]}))
    played = next(one for one in all_of(given_))
    assert subproblem(given_, {played}).slots == (0,)
