"""Which literals stand for a number, and for which."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import pytest

from selfconf.model.number import fraction, number, plain_number
from selfconf.model.term import IRI, XSD_NAMESPACE, Literal


def literal(lexical: str, datatype: str) -> Literal:
    """A literal of one of XML Schema's datatypes."""
    return Literal(lexical, IRI(XSD_NAMESPACE + datatype))


@pytest.mark.parametrize(
    ("lexical", "datatype", "found"),
    [
        ("2.50", "decimal", "2.50"),
        ("0.10000000000000000001", "decimal", "0.10000000000000000001"),
        ("-7", "byte", "-7"),
        ("1", "unsignedInt", "1"),
        ("1e3", "double", "1e3"),
        ("1e-400", "double", "0"),
    ],
)
def test_a_number_is_read_exactly_as_it_is_written(lexical: str, datatype: str, found: str) -> None:
    assert number(literal(lexical, datatype)) == Decimal(found)
    assert fraction(literal(lexical, datatype)) == Fraction(found)


@pytest.mark.parametrize(
    ("lexical", "datatype"),
    [
        ("2.50", "string"),
        ("fast", "integer"),
        ("1.5", "integer"),
        ("1e3", "decimal"),
        ("1_000", "integer"),
        ("٣", "integer"),
        (" 5", "integer"),
        ("128", "byte"),
        ("-1", "unsignedInt"),
        ("INF", "double"),
        ("NaN", "float"),
        ("1e999999999", "double"),
        ("9" * 1000, "integer"),
        ("1", "boolean"),
    ],
)
def test_a_literal_that_is_no_measurement_is_no_number(lexical: str, datatype: str) -> None:
    assert number(literal(lexical, datatype)) is None
    assert plain_number(literal(lexical, datatype)) is None


def test_a_whole_number_is_an_int_in_python_and_any_other_a_float() -> None:
    assert plain_number(literal("1", "unsignedInt")) == 1
    assert isinstance(plain_number(literal("1", "unsignedInt")), int)
    assert isinstance(plain_number(literal("1", "decimal")), float)
    assert number(IRI("urn:one")) is None
