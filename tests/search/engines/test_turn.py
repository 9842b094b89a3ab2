"""A question about several slots asks for what propagation leaves them, and no question is needed for most slots."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.search.families import scaling
from benchmarks.search.families.random_relations import plant
from selfconf.search.budget import Budget
from selfconf.search.engines import turn
from selfconf.search.engines.clause_learning import ClauseSolver
from selfconf.search.engines.least_solution import least_by_clauses
from selfconf.search.engines.ordered_decisions import OrderedDecisions
from selfconf.search.engines.turn import Turn
from selfconf.search.problem import Problem
from selfconf.search.reduction import pruned, reduced
from tests.search.comparison import least_numbers, numbers
from tests.search.worlds import agreement, problems, rivalries

pytest.importorskip("pysat")


@given(st.one_of(problems(), rivalries()), st.integers(0, 3))
@agreement()
def test_questions_about_many_slots_lead_to_the_least_solution(problem: Problem, easy: int) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(OrderedDecisions, "available", staticmethod(lambda _: False))
        patch.setattr(turn, "EASY", easy)
        assert numbers(least_by_clauses(reduced(problem), Budget(100_000))) == least_numbers(problem)


def test_what_propagation_refutes_is_left_out_of_a_question_and_is_a_step() -> None:
    given_ = pruned(reduced(scaling.distinct(3, 3)))
    with ClauseSolver(given_) as clauses:
        ahead, budget = Turn(clauses), Budget(100)
        assert ahead.ahead(given_.slots, clauses.plays, budget) == [0]
        ahead.reach = 3
        # The first role has the first component, so that the second one is the first that is left to the second role.
        assert ahead.ahead(given_.slots, clauses.plays, budget) == [0, 1, 2]
        assert budget.steps == 97
        assert ahead.ahead(given_.slots, clauses.plays, Budget(0)) == [0]


def test_what_follows_from_the_options_before_is_not_propagated_again(monkeypatch: pytest.MonkeyPatch) -> None:
    given_ = pruned(reduced(scaling.distinct(3, 3)))
    propagated: list[list[int]] = []
    implied = ClauseSolver.implied

    def counted(solver: ClauseSolver, literals: Sequence[int]) -> set[int] | None:
        propagated.append(list(literals))
        return implied(solver, literals)

    monkeypatch.setattr(ClauseSolver, "implied", counted)
    with ClauseSolver(given_) as clauses:
        ahead = Turn(clauses)
        ahead.reach = 3
        assert ahead.ahead(given_.slots, clauses.plays, Budget()) == [0, 1, 2]
        # Not the second role with the first component, nor what is left to the third one.
        assert propagated == [[clauses.plays[0][0]], [clauses.plays[0][0], clauses.plays[1][1]]]


def test_where_all_options_are_refuted_half_of_the_slots_are_asked_about() -> None:
    given_ = pruned(reduced(scaling.distinct(4, 4)))
    with ClauseSolver(given_) as clauses:
        first, second, third = clauses.plays[:3]
        either = clauses.literal()
        for literal in third:
            for one in (either, -either):
                clauses.add([-first[0], -second[1], -literal, one])
        ahead, budget = Turn(clauses), Budget(100)
        ahead.reach = 3
        assert ahead.ahead(given_.slots, clauses.plays, budget) == [0]
        assert budget.steps == 100 - (1 + len(third))


@pytest.mark.parametrize(
    ("slots", "possible", "conflicts", "reach"),
    [(1, True, 0, 2), (16, True, 0, 16), (4, False, 0, 2), (1, False, 0, 1), (8, True, 61, 1), (8, None, 0, 1)],
)
def test_how_far_it_looks_follows_from_the_last_answer(
    slots: int, possible: bool | None, conflicts: int, reach: int
) -> None:
    with ClauseSolver(pruned(reduced(scaling.distinct(2, 2)))) as clauses:
        one = Turn(clauses)
        one.answered(slots, possible, conflicts)
        assert one.reach == reach


def test_there_are_many_fewer_questions_than_slots(monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[int] = []
    ask = ClauseSolver.ask

    def counted(solver: ClauseSolver, assumed: Sequence[int], budget: Budget, most: int | None = None) -> bool | None:
        asked.append(len(assumed))
        return ask(solver, assumed, budget, most)

    monkeypatch.setattr(ClauseSolver, "ask", counted)
    given_ = pruned(reduced(plant(10, 6, 2, 16, 8, 1)))
    assert least_by_clauses(given_, Budget())
    assert len(asked) * 5 < len(given_.slots)
