"""Behavioural goals."""

from __future__ import annotations

import pytest

from sim.home.apartment import Apartment
from sim.home.goal import GoalError, read_goal


@pytest.mark.parametrize("text", ["(AT BEDROOM)", "(at bedroom)", "  ( AT  Bedroom ) "])
def test_a_goal_names_a_place_whatever_its_case_and_spaces(apartment: Apartment, text: str) -> None:
    place, standing = read_goal(text, apartment)
    assert place.iri == "https://w3id.org/selfconf/peis-home#bedroom"
    assert apartment.room_at(standing.x, standing.y) is not None


@pytest.mark.parametrize("text", ["", "AT BEDROOM", "(AT BEDROOM", "(AT)", "(AT BEDROOM KITCHEN)", "(AT (BEDROOM))"])
def test_a_malformed_goal_is_refused_with_an_example(apartment: Apartment, text: str) -> None:
    with pytest.raises(GoalError, match=r"is no proposition: write it like \(AT BEDROOM\)"):
        read_goal(text, apartment)


def test_an_unknown_place_is_refused_with_the_known_ones(apartment: Apartment) -> None:
    with pytest.raises(GoalError, match="CELLAR is none of BEDROOM, KITCHEN, LIVING-ROOM"):
        read_goal("(AT CELLAR)", apartment)


def test_an_unknown_predicate_is_refused(apartment: Apartment) -> None:
    with pytest.raises(GoalError, match="has the predicate NEAR, and only AT is known"):
        read_goal("(NEAR BEDROOM)", apartment)
