"""The model's terms as rdflib's, and back."""

from __future__ import annotations

import pytest

from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.literal_comparison import has_value, order, well_typed
from selfconf.rdf.rdflib_terms import from_rdflib, rdflib_term, to_rdflib
from selfconf.rdf.vocabulary import RDF, XSD


@pytest.mark.parametrize(
    "value",
    [
        IRI("urn:a"),
        BlankNode("_:b"),
        Literal("text"),
        Literal("05", XSD.integer),
        Literal("mot", RDF.langString, "fr"),
    ],
)
def test_a_term_comes_back_as_it_was(value: Term) -> None:
    assert from_rdflib(rdflib_term(value)) == value


def test_equal_triples_are_one_in_a_graph() -> None:
    triple = (IRI("urn:a"), IRI("urn:b"), Literal("05", XSD.integer))
    assert len(to_rdflib([triple, triple])) == 1


def test_literals_are_compared_as_rdflib_does() -> None:
    assert order(Literal("05", XSD.integer), Literal("5.0", XSD.decimal)) == 0
    assert order(Literal("5"), Literal("5", XSD.integer)) is None
    assert well_typed(Literal("5", XSD.integer))
    assert not well_typed(Literal("five", XSD.integer))
    assert not has_value(Literal("five", XSD.integer))
