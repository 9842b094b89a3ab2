"""Inlining: what is said of a blank node stands inside the statement that leads to it, or nothing is inlined."""

from __future__ import annotations

import pytest

from selfconf.errors import TurtleError
from selfconf.rdf.advertisements.inlining import inlined, labelled
from selfconf.rdf.advertisements.statement_table import StatementTable

HEAD = "@prefix : <urn:x:> .\n"


def statements(text: str, labels: bool = False) -> dict[str, list[str]] | None:
    """What a text says of each named subject, as text."""
    octets, table = (HEAD + text).encode(), StatementTable()
    found = labelled(octets, None, table) if labels else inlined(octets, "a.ttl", None, table)
    return found and {subject: [statement.text for statement in said] for subject, said in found.items()}


def test_each_named_subject_has_a_statement_for_each_predicate() -> None:
    assert statements(":a :p 1 ; :q :b , :c . :b :p 2 .") == {
        "<urn:x:a>": ["<urn:x:p> 1", "<urn:x:q> <urn:x:b> , <urn:x:c>"],
        "<urn:x:b>": ["<urn:x:p> 2"],
    }


@pytest.mark.parametrize(
    ("text", "statement"),
    [
        (':a :p [ :q "x" ; :r 1 ] .', '<urn:x:p> [ <urn:x:q> "x" ;\n\t<urn:x:r> 1 ]'),
        (":a :p [ :q [ :r 1 ] ] .", "<urn:x:p> [ <urn:x:q> [ <urn:x:r> 1 ] ]"),
        (":a :p ( 1 :b ) .", "<urn:x:p> ( 1 <urn:x:b> )"),
        (":a :p () .", "<urn:x:p> <http://www.w3.org/1999/02/22-rdf-syntax-ns#nil>"),
        (":a :p ( [ :q 1 ] ( 2 ) ) .", "<urn:x:p> ( [ <urn:x:q> 1 ] ( 2 ) )"),
    ],
)
def test_brackets_and_lists_become_part_of_the_statement_that_leads_to_them(text: str, statement: str) -> None:
    found = statements(text)
    assert found is not None
    (only,) = found["<urn:x:a>"]
    assert only.split() == statement.split()


def test_two_blank_nodes_of_one_predicate_become_two_statements() -> None:
    assert statements(":a :p [ :q 1 ] , [ :q 2 ] .") == {
        "<urn:x:a>": ["<urn:x:p> [ <urn:x:q> 1 ]", "<urn:x:p> [ <urn:x:q> 2 ]"]
    }


def test_what_looks_like_a_label_in_a_string_is_none() -> None:
    assert statements(':a :p "_:b" .') == {"<urn:x:a>": ['<urn:x:p> "_:b"']}


@pytest.mark.parametrize(
    "text",
    [
        "[] :p 1 .",
        ":a :p [ a <https://w3id.org/selfconf#Component> ] .",
        ":a :p " + "[ :p " * 40 + "1" + " ]" * 40 + " , :b .",
    ],
    ids=["nothing leads to it", "a component", "too deep"],
)
def test_what_cannot_be_inlined_is_left_to_the_careful_reader(text: str) -> None:
    assert statements(text) is None


def test_blank_nodes_with_labels_are_inlined_wherever_they_are_described() -> None:
    assert statements("_:n :q 1 . :a :p _:n .", labels=True) == {"<urn:x:a>": ["<urn:x:p> [ <urn:x:q> 1 ]"]}


TRIPLES = '<urn:x:a> <urn:x:p> _:b .\n_:b <urn:x:q> "1"^^<http://www.w3.org/2001/XMLSchema#integer> .\n'


@pytest.mark.parametrize(
    "more", ["", "<urn:x:c> <urn:x:p> 2 ; <urn:x:q> 3 .\n", "@prefix : <urn:x:> . :c :p 2 ; :q 3 ."]
)
def test_n_triples_are_turtle_and_turtle_may_begin_like_n_triples(more: str) -> None:
    found = labelled((TRIPLES + more).encode(), None, StatementTable())
    assert found is not None
    texts = {subject: [statement.text for statement in said] for subject, said in found.items()}
    rest = {"<urn:x:c>": ["<urn:x:p> 2", "<urn:x:q> 3"]} if more else {}
    assert texts == {"<urn:x:a>": ["<urn:x:p> [ <urn:x:q> 1 ]"]} | rest


def test_a_label_that_two_statements_lead_to_is_not_inlined() -> None:
    assert statements(":a :p _:n . :b :p _:n . _:n :q 1 .", labels=True) is None


def test_what_is_no_turtle_is_an_error_with_its_place() -> None:
    with pytest.raises(TurtleError, match=r"^a\.ttl:2:"):
        statements(":a :p .")
    assert statements(":a :p .", labels=True) is None
