"""Queries of shapes are read once, however many components are judged by them."""

from __future__ import annotations

from rdflib import Graph
from rdflib.plugins.sparql import processor

from selfconf.rdf.pyshacl_corrections.prepared_queries import prepared_queries


def test_a_query_is_prepared_once_however_often_it_is_asked() -> None:
    with prepared_queries():
        first, second = (processor.prepareQuery("ASK { :a :p ?o }", initNs={"": "urn:x:"}) for _ in range(2))
        other = processor.prepareQuery("ASK { :a :p ?o }", initNs={"": "urn:y:"})
    assert first is second
    assert first is not other


def test_a_string_of_a_query_is_one_with_or_without_its_datatype() -> None:
    stated = Graph().parse(data='<urn:a> <urn:p> "x" .', format="turtle")
    query = 'ASK { ?a ?p "x"^^<http://www.w3.org/2001/XMLSchema#string> }'
    with prepared_queries():
        assert stated.query(query).askAnswer
