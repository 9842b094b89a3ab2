"""Triples as text say what the triples say, and are read back as they were."""

from __future__ import annotations

import pytest
from hypothesis import given
from rdflib import Graph
from rdflib.compare import isomorphic

from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.sparql import QUERY_PREFIXES
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.turtle import serialization as write
from selfconf.rdf.turtle.document import parse
from selfconf.rdf.turtle.serialization import ntriples, pretty_turtle
from selfconf.rdf.vocabulary import SC, XSD
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


ODD = """@prefix : <https://w3id.org/selfconf#> .
:a :b [ :c [ :d [] ; :e 1.50, "x\\ny"@en, true ] ] , _:twice ; a :T . :f :g _:twice . _:twice :h 2 .
_:x :next _:y . _:y :next _:x . _:self :is _:self . [ :alone 1 ] . <urn:a%20b> :p <https://w3id.org/selfconf#x/y> ."""


@pytest.mark.parametrize("text", [*(PREFIXES + text for text in ADVERTISEMENTS.values()), ODD])
def test_it_can_be_read_back(text: str) -> None:
    triples = list(parse(text, "a.ttl").triples())
    written = pretty_turtle(triples, QUERY_PREFIXES)
    assert isomorphic(Graph().parse(data=written, format="turtle"), Graph().parse(data=ntriples(triples), format="nt"))


@pytest.mark.parametrize("local", ["5µm", "m²", "µ", "метр", "a.b", "a."])
def test_a_name_of_any_letters_is_read_back_by_a_strict_parser(local: str) -> None:
    triple = (IRI(f"{SC.base}{local}"), SC.name, Literal("x"))
    assert list(parse(pretty_turtle([triple], QUERY_PREFIXES), "a.ttl").triples()) == [triple]


def test_blank_nodes_stand_where_they_are_named_and_only_used_prefixes_are_declared() -> None:
    text = '<urn:a> <https://w3id.org/selfconf#hasOutput> [ <https://w3id.org/selfconf#name> "pose" ] ; a <urn:T> .'
    written = pretty_turtle(parse(text, "a.ttl").triples(), QUERY_PREFIXES)
    assert written == (
        '@prefix sc: <https://w3id.org/selfconf#> .\n\n<urn:a> a <urn:T> ;\n    sc:hasOutput [ sc:name "pose" ] .\n'
    )


def test_what_nests_without_end_is_written_flat() -> None:
    deep = 3000
    text = "<urn:a> <urn:p> " + "[ <urn:p> " * deep + "1" + " ]" * deep + " ."
    written = pretty_turtle(parse(text, "a.ttl").triples(), {})
    assert written.count(" .\n") == deep + 1
