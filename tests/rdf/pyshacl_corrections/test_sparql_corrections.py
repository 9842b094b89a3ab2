"""Queries of shapes: what rdflib answers in the block is what SPARQL 1.1 says, and what Oxigraph answers."""

from __future__ import annotations

from itertools import pairwise

import pyoxigraph as ox
import pytest
import rdflib

from selfconf.model.term import IRI
from selfconf.rdf.conformance import violations
from selfconf.rdf.pyshacl_corrections.prepared_queries import prepared_queries
from selfconf.rdf.pyshacl_corrections.sparql_corrections import sparql_corrections
from selfconf.rdf.rdflib_terms import to_rdflib
from selfconf.rdf.turtle import document as turtle

XSD = "http://www.w3.org/2001/XMLSchema#"
HEAD = f"@prefix : <urn:x:> . @prefix sh: <http://www.w3.org/ns/shacl#> . @prefix xsd: <{XSD}> .\n"
PROLOGUE = f"PREFIX : <urn:x:> PREFIX xsd: <{XSD}>\n"
SAID = """
:five :load 5 ; :next :five . :zero :load 0 . :empty :load "" . :false :load false . :heavy :load "heavy" , 7 .
:german :load "schwer"@de . :dated :load "2020-01-01"^^xsd:date . :unknown :load "x"^^:kilo .
:nan :load "NaN"^^xsd:double . :wrong :load "many"^^xsd:integer . :linked :next :five , :a . :a :next :b . :b :next :a .
:due :load "2020-06-01T10:00:00Z"^^xsd:dateTime . :noted :load "2020-01-01Z" . :late :load "2020-01-01T10:00:00Z" .
:hour :load "10:00:00Z" . :day :load "P1D" , "P1D"^^xsd:duration . :never :load "2020-13-01" .
:bare :note 1 . :decimal :load 5.0 . :cold :load -2.5 .
"""
NODES = sorted({line.split()[0] for line in SAID.replace(" . ", "\n").splitlines() if line.strip()})


def by_shape(query: str) -> set[str]:
    """The nodes that a shape finds wrong whose SPARQL constraint is a query."""
    shape = f':shape sh:sparql [ sh:select """{PROLOGUE}{query}""" ] .'
    subjects, shapes = (to_rdflib(turtle.parse(HEAD + text, "a.ttl").triples()) for text in (SAID, shape))
    focus = [IRI(node.replace(":", "urn:x:")) for node in NODES]
    return {node.replace("urn:x:", ":") for node in violations(subjects, shapes, IRI("urn:x:shape"), focus, "a.ttl")}


def by_oxigraph(query: str) -> set[str]:
    """The nodes for which Oxigraph answers a query, each as the value of $this."""
    store = ox.Store()
    store.load((HEAD + SAID).encode(), format=ox.RdfFormat.TURTLE)
    nodes = {node: ox.NamedNode(node.replace(":", "urn:x:")) for node in NODES}
    return {
        name
        for name, node in nodes.items()
        if any(store.query(PROLOGUE + query, substitutions={ox.Variable("this"): node}))
    }


@pytest.mark.parametrize(
    "pattern",
    [
        "$this :load ?v . ?v :next* 0",
        "$this :load ?v . ?v :next* 5",
        '$this :load ?v . FILTER NOT EXISTS { ?v :next? "" }',
        "$this :load/:next* ?v . FILTER ( isLiteral(?v) && ?v = 0 )",
        "$this :next+ $this",
        "$this :next+ :b",
        "?v :next+ $this",
        "?v :next? ?w . $this :load ?w",
        "$this :next* ?v . ?v :load 5",
        ":five !(^:note) $this",
        "$this !(:load|:note) ?v",
        "?v !(:load|^:next) $this",
        "$this !^:load ?v",
    ],
)
def test_a_path_leads_where_oxigraph_finds_that_it_leads(pattern: str) -> None:
    query = f"SELECT $this {{ {pattern} }}"
    assert by_shape(query) == by_oxigraph(query)


@pytest.mark.parametrize(
    "condition",
    [
        "?v < 6",
        "?v >= 6",
        "!(:a < ?v)",
        "!(:a < :b)",
        '?v > "a"',
        '!(?v <= "2020-01-01"^^xsd:date)',
        'isNumeric(?v) && !(?v = "y"^^:kilo)',
        "?v != 5",
        "?v = ?v",
        "?v IN (5, 7)",
        "?v NOT IN (5, 7)",
        "?v IN ()",
        "?v",
        "!?v",
        "?v || ?nothing",
        "?nothing || ?v",
        "!(?v && ?nothing)",
        "?nothing || BOUND(?v)",
        "abs(?v) = 5",
        "?v + 1 > 5",
        '!(?v - 1 = "x"^^xsd:integer)',
        "xsd:integer(?v) = 5",
        "xsd:boolean(?v)",
        "xsd:decimal(?v) = 5",
        'xsd:date(?v) > "2019-12-31"^^xsd:date',
        'STR(xsd:dateTime(?v)) >= "2020-01-01T00:00:00"',
        'xsd:time(?v) > "09:00:00Z"^^xsd:time',
        'xsd:dayTimeDuration(?v) = "P1D"^^xsd:dayTimeDuration',
        "BOUND(?v) && BOUND($this) && (xsd:date(?v) = ?v || xsd:time(?v) = ?v || xsd:dateTime(?v) = ?v)",
        "IF(?v > 4, ?v < 6, false)",
        "COALESCE(?v = 4, true)",
        "false",
        "0",
        "?v IN (-2.5)",
        "!(-2.5)",
        "! -2.5 || ?v = 5",
        'REPLACE(STR(?v), "(", "x") = "x" || ?v = 5',
    ],
)
def test_a_condition_holds_where_oxigraph_finds_that_it_holds(condition: str) -> None:
    query = f"SELECT $this {{ $this :load ?v FILTER ({condition}) }}"
    assert by_shape(query) == by_oxigraph(query)


@pytest.mark.parametrize(
    "query",
    [
        "SELECT $this { $this :load ?v } GROUP BY $this HAVING (SUM(?v) > 4)",
        "SELECT $this { $this :load ?v } GROUP BY $this HAVING (AVG(?v) > 4)",
        "SELECT $this { $this :load ?v . { SELECT $this (COUNT(?v) AS ?n) { $this :next ?v } GROUP BY $this } }",
        "SELECT $this { $this :next ?w . { SELECT $this (COUNT(?w) AS ?n) { $this :load ?w } GROUP BY $this } }",
        "SELECT $this { $this :next ?v } GROUP BY $this HAVING (MAX(?v) = :b)",
        "SELECT $this { $this :next ?v } GROUP BY $this HAVING (isIRI(MIN(?v)))",
        "SELECT $this { $this :load ?w . { SELECT $this (COUNT(?v) AS ?n) { $this :next ?v } GROUP BY $this } }",
    ],
)
def test_an_aggregate_is_that_of_oxigraph(query: str) -> None:
    assert by_shape(query) == by_oxigraph(query)


def test_nan_is_neither_less_nor_greater_which_is_no_error() -> None:
    """XPath, op:numeric-less-than; to Oxigraph it is an error."""
    assert by_shape("SELECT $this { $this :load ?v FILTER ( !(?v < 6) && !(?v >= 6) ) }") == {":nan"}


def test_a_negative_decimal_is_a_term() -> None:
    query = "SELECT $this { $this :load -2.5 }"
    assert by_shape(query) == by_oxigraph(query) == {":cold"}


def test_a_path_may_be_as_long_as_the_graph() -> None:
    chain = rdflib.Graph()
    step, nodes = rdflib.URIRef("urn:x:next"), [rdflib.URIRef(f"urn:x:{number}") for number in range(2_000)]
    for before, after in pairwise(nodes):
        chain.add((before, step, after))
    with prepared_queries(), sparql_corrections():
        assert chain.query("ASK { <urn:x:0> <urn:x:next>+ <urn:x:1999> }").askAnswer
        assert not chain.query("ASK { <urn:x:1> <urn:x:next>+ <urn:x:0> }").askAnswer
        assert len(chain.query("SELECT ?b { <urn:x:0> <urn:x:next>* ?b }")) == 2_000
        assert len(chain.query("SELECT ?a ?b { ?a <urn:x:next>? ?b }")) == 3_999


def test_each_pair_that_a_path_joins_is_found_once() -> None:
    circle = rdflib.Graph().parse(data="@prefix : <urn:x:> . :a :p :b . :b :p :a .", format="turtle")
    with prepared_queries(), sparql_corrections():
        assert len(circle.query("SELECT ?b { <urn:x:a> <urn:x:p>* ?b }")) == 2
        assert len(circle.query("SELECT ?a { ?a <urn:x:p>+ <urn:x:a> }")) == 2
        assert len(circle.query("SELECT ?a ?b { ?a <urn:x:p>* ?b }")) == 4
