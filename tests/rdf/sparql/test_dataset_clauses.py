"""Which graphs a query chooses by its dataset clauses."""

from __future__ import annotations

import pytest

from selfconf.rdf.sparql.dataset_clauses import chosen_graphs


@pytest.mark.parametrize(
    ("query", "default", "named"),
    [
        ("SELECT * { ?s ?p ?o }", [], []),
        ("SELECT * FROM <urn:a> FROM NAMED <urn:b> FROM <urn:c> { ?s ?p ?o }", ["urn:a", "urn:c"], ["urn:b"]),
        ("PREFIX y: <urn:y/> SELECT * from x:a from named y:b WHERE { ?s ?p ?o }", ["urn:x/a"], ["urn:y/b"]),
        ("BASE <http://h/> ASK FROM <a>FROM<b#c>{ ?s ?p ?o }", ["http://h/a", "http://h/b#c"], []),
        ("ASK FROM # FROM <urn:b>\n<urn:a> { ?from ?p 'FROM <urn:c>' }", ["urn:a"], []),
        ("SELECT ?from { ?from x:FROM <urn:from> }", [], []),
        ("PREFIX FROM: <urn:f/> PREFIX NAMED: <urn:n/> ASK FROM NAMED:a { FROM:b ?p ?o }", ["urn:n/a"], []),
        ("ASK FROM 1 FROM UNDEF {}", [], []),
        ("SELECT * FROM nowhere:a { ?s ?p ?o }", [], []),
    ],
)
def test_a_query_chooses_graphs(query: str, default: list[str], named: list[str]) -> None:
    assert chosen_graphs(query, {"x": "urn:x/"}, None) == (default, named)


def test_a_relative_iri_of_a_graph_is_relative_to_the_base_that_is_given() -> None:
    assert chosen_graphs("ASK FROM <a> {}", {}, "http://h/q") == (["http://h/a"], [])
    assert chosen_graphs("ASK FROM <a> {}", {}, "no base") == ([], [])
