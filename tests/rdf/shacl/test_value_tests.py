"""Constraints on single values, compiled."""

from __future__ import annotations

import pyshacl
import pytest
import rdflib

from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.pyshacl_corrections.linear_patterns import linear_patterns
from selfconf.rdf.shacl.value_tests import PairTest, ValueTest, compiled
from selfconf.rdf.vocabulary import SH, XSD


def number(text: str) -> Literal:
    """A whole number."""
    return Literal(text, XSD.integer)


@pytest.mark.parametrize(
    ("constraint", "wanted", "passing", "failing"),
    [
        (SH.nodeKind, SH.IRI, IRI("urn:a"), Literal("a")),
        (SH.datatype, XSD.integer, number("5"), number("five")),
        (SH.minInclusive, number("5"), Literal("5.0", XSD.decimal), number("4")),
        (SH.maxExclusive, number("5"), number("4"), Literal("4")),
        (SH.minLength, number("2"), Literal("ab"), Literal("a")),
        (SH.minLength, number("0"), Literal(""), BlankNode("_:a")),
        (SH.maxInclusive, number("5"), Literal("-INF", XSD.double), Literal("NaN", XSD.double)),
        (SH.maxLength, number("2"), Literal("ab"), BlankNode("_:a")),
        (SH.pattern, Literal("^a+$"), Literal("aa"), Literal("ab")),
    ],
)
def test_a_value_passes_or_fails(constraint: IRI, wanted: Term, passing: Term, failing: Term) -> None:
    test = ValueTest(constraint, wanted)
    assert test.passes(passing)
    assert not test.passes(failing)


def test_a_value_is_less_than_every_value_of_another_property() -> None:
    date = Literal("2024-01-01", XSD.date)
    test = PairTest(SH.lessThan, IRI("urn:until"))
    assert test.passes(number("5"), [number("6"), Literal("5.5", XSD.decimal)])
    assert test.passes(number("5"), [])
    assert not test.passes(number("5"), [number("6"), number("5")])
    assert not test.passes(date, [number("5")])
    assert not test.passes(IRI("urn:a"), [IRI("urn:b")])
    assert PairTest(SH.lessThanOrEquals, IRI("urn:until")).passes(number("5"), [number("5")])


def test_what_is_no_constraint_on_one_value_is_not_compiled() -> None:
    tests, covered = compiled({SH.datatype: [XSD.integer], SH.uniqueLang: [Literal("true", XSD.boolean)]})
    assert tests == [ValueTest(SH.datatype, XSD.integer)]
    assert covered == {SH.datatype}


def test_a_pattern_that_is_none_and_two_datatypes_are_not_compiled() -> None:
    assert compiled({SH.pattern: [Literal("(")]}) == ([], set())
    assert compiled({SH.datatype: [XSD.integer, XSD.string]}) == ([], set())


@pytest.mark.parametrize(
    ("expression", "flags", "passing", "failing"),
    [
        ("a.b", "s", "a\nb", "ab"),
        ("a.b", "", "axb", "a\nb"),
        (" a b [ c] # ", "xi", "AB #", "a b"),
        (r"a\ b", "x", "a b", "ab"),
        ("a.b", "q", "a.b", "axb"),
        ("^b", "m", "a\nb", "ab"),
        ("^a$", "", "a", "a\n"),
        ("^a$", "m", "a\nb", "ab"),
        (r"\$[$]$", "", "$$", "$$\n"),
        ("[]$]$", "", "]", "]\n"),
        ("a$", "q", "a$", "a"),
    ],
)
def test_flags_are_those_of_sparql_in_the_tests_and_in_pyshacl(
    expression: str, flags: str, passing: str, failing: str
) -> None:
    test = ValueTest(SH.pattern, Literal(expression), flags)
    assert (test.passes(Literal(passing)), test.passes(Literal(failing))) == (True, False)
    shapes = rdflib.Graph()
    shape, focus = rdflib.URIRef("urn:s"), rdflib.SH.targetNode
    shapes.add((shape, rdflib.RDF.type, rdflib.SH.NodeShape))
    shapes.add((shape, rdflib.SH.pattern, rdflib.Literal(expression)))
    shapes.add((shape, rdflib.SH.flags, rdflib.Literal(flags)))
    for text, conforms in ((passing, True), (failing, False)):
        aimed = shapes + rdflib.Graph()
        aimed.add((shape, focus, rdflib.Literal(text)))
        with linear_patterns():
            assert pyshacl.validate(rdflib.Graph(), shacl_graph=aimed)[0] is conforms
