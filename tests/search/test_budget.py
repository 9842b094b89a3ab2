"""A budget is shared, and never falls below zero."""

from __future__ import annotations

from selfconf.search.budget import Budget


def test_what_a_portion_spends_is_taken_from_the_whole() -> None:
    budget = Budget(10)
    with budget.portion(4) as portion:
        assert portion.steps == 4
        portion.spend(3)
    assert budget.steps == 7


def test_a_portion_is_no_more_than_what_is_left() -> None:
    budget = Budget(3)
    with budget.portion(4) as portion:
        portion.spend(5)
        assert portion.steps == 0
    assert budget.steps == 0


def test_a_portion_of_an_unlimited_budget_is_limited() -> None:
    budget = Budget()
    with budget.portion(4) as portion:
        assert portion.steps == 4
        portion.spend(4)
    assert budget.steps is None
