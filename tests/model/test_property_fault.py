"""Faults of a property word themselves by its name."""

from __future__ import annotations

import pytest

from selfconf.model.property_fault import ConstraintFailed, NotAmong
from selfconf.model.term import IRI, XSD_NAMESPACE, Literal

HALL, CAMERA = IRI("https://example.org/home#hall"), IRI("https://example.org/home#Camera")
FIVE = Literal("5", IRI(XSD_NAMESPACE + "integer"))


def failed(constraint: str, wanted: IRI | Literal = FIVE) -> ConstraintFailed:
    """The hall fails a constraint."""
    return ConstraintFailed(frozenset((HALL,)), IRI(f"http://www.w3.org/ns/shacl#{constraint}"), wanted)


@pytest.mark.parametrize(
    ("constraint", "words"),
    [
        ("minInclusive", "at least 5"),
        ("minExclusive", "more than 5"),
        ("maxInclusive", "at most 5"),
        ("maxExclusive", "less than 5"),
        ("minLength", "at least 5 characters long"),
        ("maxLength", "at most 5 characters long"),
        ("pattern", "like /5/"),
        ("datatype", "a 5"),
    ],
)
def test_a_constraint_says_what_is_wanted(constraint: str, words: str) -> None:
    assert failed(constraint).said("place") == f"place is hall, not {words}"
    assert failed("class", CAMERA).said("place") == "place is hall, not a Camera"


def test_values_with_one_local_name_are_told_apart_by_their_whole_iris() -> None:
    here, there = IRI("https://example.org/here#bed1"), IRI("https://example.org/there#bed1")
    assert NotAmong(frozenset((here,)), frozenset((there,))).said("place") == f"place is {here!r}, not {there!r}"
    text = Literal("bed1")
    assert NotAmong(frozenset((text,)), frozenset((there,))).said("place") == f'place is "bed1", not {there!r}'


def test_of_several_values_that_one_that_is_not_allowed_is_named_as_a_further_one() -> None:
    first, second, third = (IRI(f"https://example.org/#bed{number}") for number in (1, 2, 3))
    fault = NotAmong(frozenset((first,)), frozenset((second, third)), partly=True)
    assert fault.said("bed") == "bed is bed1 as well, not only bed2 or bed3"
