"""Which literals stand for a truth value."""

from __future__ import annotations

import pytest

from selfconf.model.term import IRI, STRING, Literal, Term
from selfconf.model.truth import BOOLEAN, truth


@pytest.mark.parametrize(
    ("term", "value"),
    [
        (Literal("true", IRI(BOOLEAN)), True),
        (Literal("1", IRI(BOOLEAN)), True),
        (Literal("false", IRI(BOOLEAN)), False),
        (Literal("0", IRI(BOOLEAN)), False),
        (Literal("TRUE", IRI(BOOLEAN)), None),
        (Literal("01", IRI(BOOLEAN)), None),
        (Literal("true", STRING), None),
        (IRI("urn:true"), None),
        (None, None),
    ],
)
def test_a_literal_of_the_datatype_stands_for_a_truth_value_if_xsd_says_so(
    term: Term | None, value: bool | None
) -> None:
    assert truth(term) is value
