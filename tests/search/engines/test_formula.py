"""Formulas: the models of what is added to them, found by trying all."""

from __future__ import annotations

from itertools import product

from selfconf.search.engines.formula import AtMost, Formula


def models(formula: Formula) -> list[set[int]]:
    """The sets of literals above zero that hold in a model."""
    found = []
    for signs in product((1, -1), repeat=formula.top):
        held = {sign * literal for literal, sign in enumerate(signs, 1)}
        clauses = all(not held.isdisjoint(clause) for clause in formula.clauses())
        if clauses and all(sum(one in held for one in some) <= most for some, most, *_ in formula.bounds):
            found.append({literal for literal in held if literal > 0})
    return found


def test_a_literal_for_any_of_some_holds_iff_one_of_them_does_and_is_made_once() -> None:
    formula = Formula()
    some = [formula.literal(), formula.literal()]
    either = formula.any_of(some)
    assert formula.any_of(some) == either
    assert formula.any_of(some[:1]) == some[0]
    assert sorted(map(sorted, models(formula))) == [[], [1, 2, 3], [1, 3], [2, 3]]
    assert formula.size == len(list(formula.clauses())) == 3


def test_a_contradiction_leaves_no_model() -> None:
    formula = Formula()
    assert models(formula) == [set()]
    formula.contradict()
    assert models(formula) == []


def test_a_bound_that_always_holds_is_not_written() -> None:
    formula = Formula()
    some = [formula.literal() for _ in range(3)]
    formula.at_most(some, 3)
    assert formula.bounds == []
    formula.at_most(some, 1)
    assert formula.bounds == [AtMost(some, 1)]
    assert sorted(map(len, models(formula))) == [0, 1, 1, 1]


def test_what_holds_has_a_value_in_common() -> None:
    formula = Formula()
    low, high, low_or_middle = (formula.literal() for _ in range(3))
    formula.one_value([(low, 0b001), (high, 0b100), (low_or_middle, 0b011)], ())
    held = {frozenset(model & {low, high, low_or_middle}) for model in models(formula)}
    assert {low, low_or_middle} in held
    assert not any(high in some and len(some) > 1 for some in held)


def test_what_holds_of_two_sequences_is_in_order() -> None:
    formula = Formula()
    first, second = ([formula.literal() for _ in range(3)] for _ in range(2))
    for some in (first, second):
        formula.statements.append(some)
        formula.at_most(some, 1)
    formula.ascending(first, second)
    chosen = {tuple(sorted(model & {*first, *second})) for model in models(formula)}
    assert chosen == {(first[low], second[high]) for low in range(3) for high in range(3) if low < high}
