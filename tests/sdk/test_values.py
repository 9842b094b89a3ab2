"""What the values of operational parameters are in Python."""

from __future__ import annotations

import pytest

from selfconf.model.number import DATATYPES, WHOLE_NUMBERS
from selfconf.model.term import IRI, XSD_NAMESPACE, BlankNode, Literal, Term
from selfconf.sdk.values import as_python


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
        typed("NaN", "double"),
        typed("yes", "boolean"),
    ],
    ids=str,
)
def test_a_literal_that_is_none_of_its_datatype_is_an_error(literal: Literal) -> None:
    with pytest.raises(ValueError, match=f"is no xsd:{literal.datatype.short}"):
        as_python(literal)
