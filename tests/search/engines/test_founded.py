"""The solver of players and recruits has no model in which recruits only feed each other."""

from __future__ import annotations

import pytest

from selfconf.model.profile import Profile
from selfconf.search.budget import Budget
from selfconf.search.engines import FoundedSolver
from selfconf.search.problem import Problem
from selfconf.search.recruiting import founded
from selfconf.search.reduction import with_recruits as reduced_with_recruits
from tests.search.test_recruiting import with_recruits
from tests.search.worlds import component, problem

pytest.importorskip("pysat")


def user(*recruits: Profile) -> Problem:
    """A user of a signal S, and what could be recruited."""
    return with_recruits(problem({"user": [component("user", "s:S")]}), *recruits)


def solver(given: Problem, irredundant: bool = False) -> FoundedSolver:
    """The solver of a problem."""
    return founded(given, reduced_with_recruits(given), irredundant)


def test_a_circle_is_no_model_unless_it_is_fed_from_outside() -> None:
    given = user(
        component("a", "t:T", "s:S"),
        component("b", "s:S", "t:T"),
        component("c", "u:U", "t:T"),
        component("d", "", "u:U"),
    )
    with solver(given) as clauses:
        assert clauses.solve((), Budget()) is True
        assert clauses.solve([-clauses.recruits[2]], Budget()) is False
        assert clauses.solve([-clauses.recruits[1]], Budget()) is True
        assert set(clauses.recruited()) == {0, 2, 3}


def test_what_can_be_spared_is_no_model_where_that_is_asked() -> None:
    given = user(component("a", "", "s:S"), component("b", "", "s:S t:T"))
    with solver(given) as clauses:
        assert clauses.solve([clauses.recruits[0], clauses.recruits[1]], Budget()) is True
    with solver(given, irredundant=True) as clauses:
        assert clauses.solve([clauses.recruits[0], clauses.recruits[1]], Budget()) is False
        assert clauses.solve([clauses.recruits[1]], Budget()) is True


def test_the_last_model_that_is_one_is_kept_when_the_budget_ends() -> None:
    given = user(component("a", "t:T", "s:S"), component("b", "s:S", "t:T"), component("c", "", "s:S"))
    with solver(given) as clauses:
        assert clauses.solve([-clauses.recruits[0]], Budget()) is True
        clauses.solve([clauses.recruits[0], clauses.recruits[1], -clauses.recruits[2]], Budget(1))
        assert clauses.recruited() == [2]


def test_a_component_is_a_player_or_a_recruit() -> None:
    supplier = component("supplier", "", "s:S")
    given = with_recruits(problem({"user": [component("user", "s:S")], "job": [supplier]}), supplier)
    with solver(given) as clauses:
        assert clauses.solve((), Budget()) is False
