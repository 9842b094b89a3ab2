"""Which literals are numbers and truth values, and what they are in Python; the shapes say the same."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction

import pytest

from selfconf.model.literal_values import (
    BOOLEAN,
    DATATYPES,
    WHOLE_NUMBERS,
    as_python,
    fraction,
    integer,
    natural_number,
    number,
    of_range,
    plain_number,
    truth,
)
from selfconf.model.term import IRI, STRING, XSD_NAMESPACE, BlankNode, Literal, Term


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
        ("-9223372036854775809", "long"),
        ("18446744073709551616", "unsignedLong"),
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


def test_an_integer_may_lie_below_zero_and_has_one_datatype() -> None:
    assert integer(literal("-07", "integer")) == -7
    assert integer(literal("-7", "int")) is None
    assert integer(literal("7.0", "integer")) is None


@pytest.mark.parametrize(("lexical", "found"), [("0", 0), ("-0", 0), ("+1", 1), ("007", 7), ("-1", None), (" 1", None)])
def test_a_natural_number_is_zero_or_more_however_it_is_written(lexical: str, found: int | None) -> None:
    assert natural_number(literal(lexical, "integer")) == found
    assert natural_number(literal(lexical, "int")) is None
    assert natural_number(IRI("urn:x:1")) is None


def test_a_whole_number_is_an_int_in_python_and_any_other_a_float() -> None:
    assert plain_number(literal("1", "unsignedInt")) == 1
    assert isinstance(plain_number(literal("1", "unsignedInt")), int)
    assert isinstance(plain_number(literal("1", "decimal")), float)
    assert number(IRI("urn:one")) is None


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


def typed(lexical: str, datatype: str) -> Literal:
    return Literal(lexical, IRI(XSD_NAMESPACE + datatype))


def test_xsd_has_sixteen_datatypes_of_numbers_thirteen_of_them_whole() -> None:
    assert (len(DATATYPES), len(WHOLE_NUMBERS)) == (16, 13)


@pytest.mark.parametrize("datatype", sorted(DATATYPES), ids=lambda datatype: IRI(datatype).short)
def test_a_number_of_every_numeric_datatype_is_a_number_in_python(datatype: str) -> None:
    lexical = "-1" if datatype.endswith(("nonPositiveInteger", "negativeInteger")) else "1"
    value = as_python(Literal(lexical, IRI(datatype)))
    assert value == int(lexical)
    assert type(value) is (int if datatype in WHOLE_NUMBERS else float)


@pytest.mark.parametrize(
    ("term", "value"),
    [
        (typed("-7", "long"), -7),
        (typed("+3", "integer"), 3),
        (typed("0.5", "decimal"), 0.5),
        (typed(".5e1", "double"), 5.0),
        (typed("true", "boolean"), True),
        (typed("1", "boolean"), True),
        (typed("false", "boolean"), False),
        (typed("0", "boolean"), False),
        (typed("1", "string"), "1"),
        (Literal("1", IRI("urn:integer")), "1"),
        (Literal("eins", IRI("urn:x"), "de"), "eins"),
        (IRI("urn:x"), "urn:x"),
        (BlankNode("_:b"), "_:b"),
    ],
)
def test_a_term_is_a_truth_value_a_number_or_its_text(term: Term, value: object) -> None:
    found = as_python(term)
    assert (found, type(found)) == (value, type(value))


@pytest.mark.parametrize(
    "literal",
    [
        typed("three", "integer"),
        typed("1_000", "int"),
        typed("1.0", "unsignedInt"),
        typed("-1", "unsignedInt"),
        typed("", "decimal"),
        typed("infinite", "double"),
        typed("yes", "boolean"),
    ],
    ids=str,
)
def test_a_literal_that_is_none_of_its_datatype_is_an_error(literal: Literal) -> None:
    with pytest.raises(ValueError, match=f"is no xsd:{literal.datatype.short}"):
        as_python(literal)


@pytest.mark.parametrize("literal", [typed(text, "double") for text in ("INF", "-INF", "NaN", "1e999")], ids=str)
def test_of_a_literal_without_a_limit_it_is_said_that_it_is_not_finite(literal: Literal) -> None:
    with pytest.raises(ValueError, match="is no finite xsd:double"):
        as_python(literal)


@pytest.mark.parametrize(
    ("text", "datatype", "wanted", "fits"),
    [
        ("1", "integer", "integer", True),
        ("1", "integer", "decimal", True),
        ("1e3", "double", "decimal", True),
        ("INF", "double", "double", True),
        ("INF", "string", "double", False),
        ("1.5", "decimal", "integer", False),
        ("1", "string", "integer", False),
        ("300", "integer", "byte", False),
        ("true", "boolean", "boolean", True),
        ("true", "string", "boolean", False),
        ("2026-01-31", "date", "date", True),
        ("2026-01-31", "string", "date", False),
        ("31.1.2026", "date", "date", False),
        ("2026-01-31T12:00:00", "dateTime", "date", False),
        ("P1D", "dayTimeDuration", "duration", True),
        ("P1D", "duration", "dayTimeDuration", False),
        ("2026-01-31T12:00:00Z", "dateTimeStamp", "dateTime", True),
        ("5", "integer", "anyURI", True),
    ],
)
def test_a_literal_is_what_a_property_of_a_datatype_wants(text: str, datatype: str, wanted: str, fits: bool) -> None:
    assert of_range(text, XSD_NAMESPACE + datatype, XSD_NAMESPACE + wanted) is fits
