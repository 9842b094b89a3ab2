"""The solver of players and recruits has no model in which recruits only feed each other."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from random import Random

import pytest

from selfconf.model.profile import Profile
from selfconf.search.budget import Budget
from selfconf.search.engines import FoundedSolver
from selfconf.search.engines.founded import Reach
from selfconf.search.problem import Problem
from selfconf.search.recruiting.recruiting import founded
from selfconf.search.reduction import InterchangeabilityClass, Option
from selfconf.search.reduction import with_recruits as reduced_with_recruits
from tests.search.recruiting.test_recruiting import with_recruits
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


def met_by(every: Sequence[tuple[int, Option]], literals: Collection[int]) -> set[int]:
    """The needs that some options meet, of which the first, a player, waits for nothing: looked for again and again."""
    met, before = set[int](), -1
    while len(met) != before:
        before = len(met)
        for literal, option in every:
            if literal in literals and (literal == 1 or met.issuperset(option.kind.needs)):
                met.update(option.kind.supports)
    return met


@pytest.mark.parametrize("seed", range(300))
def test_all_options_but_those_of_a_landmark_are_not_enough_and_each_of_these_would_be(seed: int) -> None:
    rng = Random(seed)
    every = []
    for number in range(10):
        needs, supports = (tuple(sorted(rng.sample(range(8), rng.randint(least, 2 + least)))) for least in (0, 1))
        every.append((number + 1, Option(number, 0, InterchangeabilityClass(0, needs, supports, {}, number))))
    needing = {need: [literal for literal, option in every[1:] if need in option.kind.needs] for need in range(8)}
    reach = Reach(every, needing, players=1)
    chosen = rng.sample(range(1, 11), rng.randint(0, 4))
    for literal in chosen:
        assert reach.add(literal)
    assert reach.met == met_by(every, chosen)
    for need in set(range(8)) - reach.met:
        landmark = reach.without(need)
        others = [literal for literal, _ in every if literal not in landmark]
        assert set(chosen).issubset(others)
        assert need not in met_by(every, others)
        assert all(need in met_by(every, [*others, literal]) for literal in landmark)
