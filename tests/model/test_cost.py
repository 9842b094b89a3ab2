"""What a component costs in a role, exactly."""

from __future__ import annotations

from fractions import Fraction

import pytest

from selfconf.model.cost import CostTerm, cost, unknown
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.profile import Profile
from selfconf.model.term import IRI, XSD_NAMESPACE, Literal, Term

PRICE, WEIGHT, DUES = (IRI(f"urn:{name}") for name in ("price", "weight", "dues"))
ROLE, OTHER = IRI("urn:role"), IRI("urn:other")


def number(lexical: str, datatype: str = "decimal") -> Literal:
    """A number."""
    return Literal(lexical, IRI(XSD_NAMESPACE + datatype))


def component(*properties: tuple[IRI, Term]) -> Profile:
    """A component with some properties."""
    return Profile(IRI("urn:c"), properties=properties)


def test_a_level_is_the_sum_of_its_terms_times_their_weights() -> None:
    level = (CostTerm(PRICE, Fraction(2)), CostTerm(WEIGHT, Fraction(-1)))
    lamp = component((PRICE, number("1.5")), (WEIGHT, number("4")))
    assert cost([level], ROLE, lamp) == (0, -1)


def test_a_sum_is_exact() -> None:
    level = (CostTerm(PRICE), CostTerm(WEIGHT))
    assert cost([level], ROLE, component((PRICE, number("0.1")), (WEIGHT, number("0.2")))) == (0, Fraction(3, 10))


def test_levels_are_apart_and_in_their_order() -> None:
    lamp = component((PRICE, number("1")), (WEIGHT, number("2")))
    assert cost([(CostTerm(WEIGHT),), (CostTerm(PRICE),)], ROLE, lamp) == (0, 2, 1)
    assert cost([], ROLE, lamp) == (0,)


@pytest.mark.parametrize("value", [None, Literal("cheap"), number("NaN", "double"), number("INF", "double")])
def test_what_is_not_known_comes_first_and_is_named(value: Term | None) -> None:
    lamp = component() if value is None else component((PRICE, value))
    assert cost([(CostTerm(PRICE),)], ROLE, lamp) == (1, 0)
    assert list(unknown([(CostTerm(PRICE),)], ROLE, lamp)) == [PRICE]
    assert cost([(CostTerm(PRICE),)], ROLE, lamp) > cost([(CostTerm(PRICE),)], ROLE, component((PRICE, number("999"))))


def test_what_the_template_says_instead_is_known_and_weighs_too() -> None:
    level = (CostTerm(PRICE, Fraction(3), otherwise=Fraction(5)),)
    assert cost([level], ROLE, component()) == (0, 15)
    assert list(unknown([level], ROLE, component())) == []


def test_a_term_of_another_role_counts_nothing() -> None:
    level = (CostTerm(PRICE, role=OTHER),)
    assert cost([level], ROLE, component()) == (0, 0)
    assert cost([level], OTHER, component((PRICE, number("7")))) == (0, 7)


@pytest.mark.parametrize(("weight", "spent"), [(1, 9), (-1, -2)])
def test_of_several_values_the_one_that_costs_most_counts(weight: int, spent: int) -> None:
    lamp = component((PRICE, number("2")), (PRICE, number("9")))
    assert cost([(CostTerm(PRICE, Fraction(weight)),)], ROLE, lamp) == (0, spent)


def test_a_subproperty_counts_where_the_hierarchy_is_seen() -> None:
    lamp, below = component((DUES, number("3"))), Hierarchy(properties=[(DUES, PRICE)])
    assert cost([(CostTerm(PRICE),)], ROLE, lamp) == (1, 0)
    assert cost([(CostTerm(PRICE),)], ROLE, lamp, below) == (0, 3)
    assert list(unknown([(CostTerm(PRICE),)], ROLE, lamp, below)) == []
