"""What is written is read again as it was."""

from __future__ import annotations

from hypothesis import given

from selfconf.model.term import Literal, Term
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.turtle import serialization as write
from selfconf.rdf.vocabulary import XSD
from tests.lab import ADVERTISEMENTS, PREFIXES, iri
from tests.protocol.strategies import literals


def test_an_advertisement_on_the_wire_is_read_as_it_was() -> None:
    for name, text in ADVERTISEMENTS.items():
        (sent,), _ = advertisements.read_document(turtle.parse(PREFIXES + text, name))
        (received,), _ = advertisements.read_document(turtle.parse(write.ntriples(sent.triples), name))
        assert received.profile == sent.profile


@given(literals)
def test_every_literal_survives_the_wire(value: Literal) -> None:
    if value.datatype.startswith("https://example.org/") and " " in value.datatype:
        return
    term: Term = Literal(value.lexical, XSD.string if value.language is None else value.datatype, value.language)
    document = turtle.parse(write.ntriples([(iri("s"), iri("p"), term)]), "wire")
    assert document.values(iri("s"), iri("p")) == [term]
