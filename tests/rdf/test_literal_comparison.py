"""Literals compared as pySHACL compares them: what is well-typed, what has a value, what is greater."""

from __future__ import annotations

from itertools import product

import pytest
from pyoxigraph import Store

from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.literal_comparison import has_value, order, well_typed
from selfconf.rdf.shacl.value_tests import PairTest, ValueTest
from selfconf.rdf.vocabulary import RDF, SH, XSD


def typed(text: str, datatype: str) -> Literal:
    """A literal of a datatype of XML Schema."""
    return Literal(text, XSD[datatype])


NAN = typed("NaN", "double")


@pytest.mark.parametrize(
    "literal",
    [
        Literal("lamp"),
        typed("007", "integer"),
        typed("INF", "double"),
        typed("2024-02-29", "date"),
        Literal("x", IRI("urn:x:own")),
        Literal("hall", RDF.langString, "en"),
    ],
)
def test_a_lexical_form_of_its_datatype_is_well_typed(literal: Literal) -> None:
    assert well_typed(literal)


@pytest.mark.parametrize("literal", [typed("seven", "integer"), typed("2023-02-29", "date"), typed("", "decimal")])
def test_a_lexical_form_of_another_datatype_is_not_well_typed_and_has_no_value(literal: Literal) -> None:
    assert not well_typed(literal)
    assert not has_value(literal)


def test_a_literal_of_an_unknown_datatype_is_well_typed_but_has_no_value() -> None:
    unknown = Literal("x", IRI("urn:x:own"))
    assert well_typed(unknown)
    assert not has_value(unknown)
    assert has_value(typed("7", "integer"))


@pytest.mark.parametrize(
    ("less", "greater"),
    [
        (typed("9", "integer"), typed("10", "integer")),
        (typed("1", "integer"), typed("1.5", "decimal")),
        (typed("-INF", "double"), typed("0", "integer")),
        (Literal("Lamp"), Literal("lamp")),
        (typed("Lamp", "normalizedString"), Literal("lamp")),
        (typed("PT1H", "dayTimeDuration"), typed("PT2H", "duration")),
        (typed("5", "unsignedByte"), typed("6.5", "float")),
        (typed("2024-02-28", "date"), typed("2024-02-29", "date")),
        (typed("2024-01-01T00:00:00Z", "dateTime"), typed("2024-01-01T00:00:00-01:00", "dateTime")),
    ],
)
def test_of_two_literals_with_an_order_one_is_greater(less: Literal, greater: Literal) -> None:
    below, above = order(less, greater), order(greater, less)
    assert below is not None
    assert above is not None
    assert below < 0 < above


def test_one_number_in_two_forms_is_equal() -> None:
    assert order(typed("1", "integer"), typed("01.0", "decimal")) == 0


@pytest.mark.parametrize(
    ("value", "limit"),
    [
        *product([Literal("5"), IRI("urn:x:a"), BlankNode("_:a")], [typed("5", "integer")]),
        (typed("5", "integer"), IRI("urn:x:a")),
        (typed("2024-01-01T00:00:00Z", "dateTime"), typed("2024-01-01T00:00:00", "dateTime")),
        (typed("2024-01-01", "date"), typed("5", "integer")),
        (typed("2024-01-01", "date"), typed("2023-01-01T00:00:00", "dateTime")),
        (typed("true", "boolean"), typed("0", "integer")),
        (typed("PT1H", "duration"), typed("5", "decimal")),
        (Literal("x", IRI("urn:x:own")), typed("5", "integer")),
        *product([typed("300", "byte"), typed("-3", "unsignedByte")], [typed("5", "integer"), typed("5.0", "decimal")]),
        (typed("1.0", "decimal"), NAN),
        (NAN, typed("1", "integer")),
        (typed("1", "float"), NAN),
        (NAN, NAN),
        *product([Literal("<a/>", RDF.XMLLiteral), Literal("<a/>", RDF.HTML)], repeat=2),
        (Literal("<a/>", RDF.XMLLiteral), Literal("<b/>")),
    ],
)
def test_what_has_no_order_is_told_so_and_raises_nothing(value: Term, limit: Term) -> None:
    assert order(value, limit) is None


def test_text_in_a_language_has_an_order_with_text_in_the_same_language_alone_as_in_sparql() -> None:
    texts = [Literal(text, RDF.langString, tag) for text in ("a", "b") for tag in ("en", "EN", "de", "en-GB")]
    for value, other in product([Literal("a"), Literal("b"), *texts], repeat=2):
        found = order(value, other)
        for constraint, sign in (("lessThan", "<"), ("lessThanOrEquals", "<=")):
            query = f"ASK {{ FILTER ( {value.turtle(str)} {sign} {other.turtle(str)} ) }}"
            expected = bool(Store().query(query))
            assert (found is not None and (found < 0 or (found == 0 and sign == "<="))) == expected, query
            assert PairTest(SH[constraint], IRI("urn:x:q")).passes(value, [other]) == expected, query
        least = ValueTest(SH.minInclusive, other)
        assert least.passes(value) == (found is not None and found >= 0)
