"""Turtle in: terms as they were written, errors with their place."""

from __future__ import annotations

import pytest
import rdflib
from hypothesis import given
from hypothesis import strategies as st

from selfconf.errors import TurtleError
from selfconf.model.term import IRI, BlankNode, Literal
from selfconf.rdf import rdflib_terms
from selfconf.rdf.turtle import ListFault
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.vocabulary import NIL, TYPE
from tests.lab import PREFIXES, iri

XSD = "http://www.w3.org/2001/XMLSchema#"
LANGUAGE = IRI("http://www.w3.org/1999/02/22-rdf-syntax-ns#langString")


def objects(text: str) -> list[object]:
    """The objects of a statement `:s :p ...`."""
    return list(turtle.parse(f"{PREFIXES} :s :p {text} .", "t").values(iri("s"), iri("p")))


def test_the_blank_nodes_of_a_text_have_the_same_numbers_each_time() -> None:
    text = "@prefix : <x:> . :a :p [ :q 1 ] , [ :q _:z ] . _:z :p :a ."
    one, other = turtle.parse(text, "a"), turtle.parse(text, "a")
    assert list(one.triples()) != list(other.triples())
    assert one.numbered() == other.numbered()
    found = {str(term) for triple in one.numbered() for term in triple if isinstance(term, BlankNode)}
    assert found == {"_:0", "_:1", "_:2"}


def test_terms_are_read_as_they_are_written() -> None:
    assert objects(':o, <urn:x>, "a", "a"@en, 1, "01"^^xsd:integer, 1.0, true') == [
        iri("o"),
        IRI("urn:x"),
        Literal("a"),
        Literal("a", LANGUAGE, "en"),
        Literal("1", IRI(XSD + "integer")),
        Literal("01", IRI(XSD + "integer")),
        Literal("1.0", IRI(XSD + "decimal")),
        Literal("true", IRI(XSD + "boolean")),
    ]


def test_a_literal_that_is_no_iri_is_never_equal_to_one() -> None:
    assert Literal("urn:x") != IRI("urn:x")
    assert BlankNode("_:x") != IRI("x")


def test_blank_nodes_of_two_documents_are_never_the_same() -> None:
    one, other = (turtle.parse("_:x <urn:p> _:x .", "t") for _ in range(2))
    assert not set(one.statements) & set(other.statements)


def test_lists_are_read_in_order_and_end_where_they_break() -> None:
    document = turtle.parse(PREFIXES + ":s :p ( 1 :a ( 2 ) ) ; :q [ ] .", "t")
    (head,) = document.values(iri("s"), iri("p"))
    assert len(document.items(head)) == 3
    (blank,) = document.values(iri("s"), iri("q"))
    assert document.items(blank) == []


def test_a_list_that_runs_in_a_circle_ends() -> None:
    document = turtle.parse(
        "@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> . <urn:a> rdf:first 1 ; rdf:rest <urn:a> .", "t"
    )
    assert len(document.items(IRI("urn:a"))) == 1


@pytest.mark.parametrize(
    ("cells", "fault"),
    [
        ("<urn:l> rdf:first 1 ; rdf:rest () .", None),
        ("<urn:l> rdf:first 1 .", ListFault.CELL),
        ("<urn:l> rdf:rest () .", ListFault.CELL),
        ("<urn:l> rdf:first 1, 2 ; rdf:rest () .", ListFault.CELL),
        ("<urn:l> rdf:first 1 ; rdf:rest (), ( 2 ) .", ListFault.CELL),
        ("<urn:l> rdf:first 1 ; rdf:rest <urn:l> .", ListFault.ENDLESS),
        ("<urn:l> rdf:first 1 ; rdf:rest 2 .", ListFault.CELL),
        ("", ListFault.NO_LIST),
    ],
)
def test_a_list_has_one_member_and_one_rest_in_each_cell(cells: str, fault: ListFault | None) -> None:
    document = turtle.parse(f"@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> . {cells}", "t")
    assert document.list_fault(IRI("urn:l")) is fault
    assert document.list_fault(NIL) is None
    assert document.list_fault(Literal("r")) is ListFault.NO_LIST


def test_a_value_that_is_said_twice_counts_once() -> None:
    assert objects(":o, :o, :o") == [iri("o")]


def test_prefixes_are_kept() -> None:
    assert turtle.parse(PREFIXES, "t").prefixes[""] == "https://example.org/peis-home#"


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("nonsense", 1),
        ("<urn:a> <urn:b> <urn:c> .\n<urn:a> <urn:b>", 2),
        ("@prefix : <urn:x#> .\n\n:a :b <not an iri> .", 3),
        ("@prefix : <urn:x#> .\n:a :b 'unfinished .", 2),
        (":a :b :c .", 1),
    ],
)
def test_what_is_no_turtle_is_named_with_its_file_line_and_column(text: str, line: int) -> None:
    with pytest.raises(TurtleError) as caught:
        turtle.parse(text, "ads/lamp.ttl")
    assert caught.value.file == "ads/lamp.ttl"
    assert caught.value.line == line
    assert caught.value.column is not None
    assert str(caught.value).startswith(f"ads/lamp.ttl:{line}:")
    assert "not Turtle" in str(caught.value)


@given(st.binary(max_size=80))
def test_any_bytes_are_turtle_or_a_turtle_error(text: bytes) -> None:
    try:
        list(turtle.parse(text, "t").triples())
    except TurtleError:
        return


def test_deep_nesting_is_read_or_refused_not_stumbled_over() -> None:
    for text in ("<urn:a> <urn:b> " + "[ <urn:p> " * 20_000, "<urn:a> <urn:b> " + "( " * 20_000):
        with pytest.raises(TurtleError):
            turtle.parse(text, "t")


def test_terms_survive_the_way_through_rdflib() -> None:
    document = turtle.parse(PREFIXES + ':s :p :o, "a", "a"@en, "01"^^xsd:integer, 1.5 ; a :T .', "t")
    graph = rdflib_terms.to_rdflib(document.triples())
    back = {
        (rdflib_terms.from_rdflib(s), IRI(p), rdflib_terms.from_rdflib(o))
        for s, p, o in graph
        if isinstance(p, rdflib.URIRef)
    }
    assert back == set(document.triples())


def test_instances_are_those_that_the_document_itself_types() -> None:
    document = turtle.parse(PREFIXES + ":a a :T . :b a :U . :c :p :T .", "t")
    assert document.instances(iri("T")) == [iri("a")]
    assert (TYPE, iri("T")) in document.about(iri("a"))
    assert document.about(Literal("a")) == []


def test_a_relative_iri_in_a_text_that_is_in_no_file_asks_for_a_base() -> None:
    with pytest.raises(
        TurtleError, match=r"not Turtle: this IRI is relative, .* begin with @base <\.\.\.> \.$"
    ) as caught:
        turtle.parse("<urn:a> <urn:b> <c> .", "<text>")
    assert (caught.value.line, caught.value.column) == (1, 17)
    assert turtle.parse("@base <urn:x:> . <urn:a> <urn:b> <c> .", "<text>").statements
