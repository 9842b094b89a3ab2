"""Turtle for people says what the triples say."""

from __future__ import annotations

import pytest
from rdflib import Graph
from rdflib.compare import isomorphic

from selfconf.rdf.sparql import QUERY_PREFIXES
from selfconf.rdf.turtle.document import parse
from selfconf.rdf.turtle.pretty import pretty_turtle
from selfconf.rdf.turtle.serialization import ntriples
from tests.lab import ADVERTISEMENTS, PREFIXES

ODD = """@prefix : <https://w3id.org/selfconf#> .
:a :b [ :c [ :d [] ; :e 1.50, "x\\ny"@en, true ] ] , _:twice ; a :T . :f :g _:twice . _:twice :h 2 .
_:x :next _:y . _:y :next _:x . _:self :is _:self . [ :alone 1 ] . <urn:a%20b> :p <https://w3id.org/selfconf#x/y> ."""


@pytest.mark.parametrize("text", [*(PREFIXES + text for text in ADVERTISEMENTS.values()), ODD])
def test_it_can_be_read_back(text: str) -> None:
    triples = list(parse(text, "a.ttl").triples())
    written = pretty_turtle(triples, QUERY_PREFIXES)
    assert isomorphic(Graph().parse(data=written, format="turtle"), Graph().parse(data=ntriples(triples), format="nt"))


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
