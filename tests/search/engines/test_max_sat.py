"""Weighted MaxSAT finds the least weight, and within a budget a bound and a solution."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from selfconf.search.budget import Budget
from selfconf.search.engines.clause_learning import ClauseSolver
from selfconf.search.engines.max_sat import minimise
from selfconf.search.engines.reduced_search import ReducedSearch
from selfconf.search.problem import Problem
from selfconf.search.reduction import Option
from selfconf.search.reduction.dominance import reduced
from tests.search.worlds import agreement, problems


@given(problems(), st.data())
@agreement(0.4)
def test_the_least_weight_is_that_of_the_lightest_solution_by_enumeration(
    problem: Problem, data: st.DataObject
) -> None:
    pytest.importorskip("pysat")
    given_ = reduced(problem)
    weight = {option: data.draw(st.integers(0, 6)) for options in given_.options for option in options}

    def total(solution: list[Option]) -> int:
        return sum(weight[option] for option in solution)

    totals = [total(found) for found in ReducedSearch(given_).solutions(Budget()) if isinstance(found, list)]
    if not totals:
        return
    for steps in (1, 2, 3, 5, None):
        with ClauseSolver(given_) as clauses:
            # One of two options may be the negation of the other: then the weights of both are one literal's.
            plays = [
                pair for role in zip(given_.options, clauses.plays, strict=True) for pair in zip(*role, strict=True)
            ]
            if any(-literal in [other for _, other in plays] for _, literal in plays):
                return
            bound, proved, lightest = minimise(clauses, {literal: weight[o] for o, literal in plays}, Budget(steps))
        assert bound <= min(totals)
        assert lightest is None or total(lightest) >= min(totals)
        if proved:
            assert lightest is not None
            assert bound == total(lightest) == min(totals)
        assert proved or steps is not None
