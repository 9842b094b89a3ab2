"""What a lint looks at: the words of the file itself, and the places of what it describes."""

from __future__ import annotations

import pytest
from rdflib import RDF, BNode, Graph, Literal, URIRef
from rdflib.term import Node

from selfconf.rdf.positions import parse_with_positions
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.term_index import TermIndex
from selfconf.rdf.vocabulary import SC, SH
from tests.lab import PREFIXES, iri


def linted(text: str, shapes: str = "") -> LintedFile:
    """A file with the prefixes of the tests, and shapes beside it."""
    graph, positions = parse_with_positions(PREFIXES + text, "a.ttl")
    always = Graph().parse(data=PREFIXES + shapes, format="turtle")
    return LintedFile(graph, positions, TermIndex(), {}, always)


@pytest.mark.parametrize(
    ("term", "written"),
    [
        (SC.Role, "sc:Role"),
        (iri("lamp"), ":lamp"),
        ("urn:x:lamp", "<urn:x:lamp>"),
        ("https://example.org/other#lamp", "<https://example.org/other#lamp>"),
    ],
)
def test_an_iri_is_written_with_the_prefix_that_the_file_has_for_it(term: str, written: str) -> None:
    assert linted("").short(term) == written


@pytest.mark.parametrize(
    ("value", "said"),
    [
        (URIRef(iri("hall")), ":p :hall"),
        (Literal(2), ":p 2"),
        (Literal("2"), ':p "2"'),
        (Literal(True), ":p true"),
        (BNode("nobody"), ":p"),
        (RDF.nil, ":p"),
    ],
)
def test_a_statement_is_shown_with_its_object_where_that_is_short(value: Node, said: str) -> None:
    assert linted("").said((URIRef(iri("a")), URIRef(iri("p")), value)) == said


def test_a_node_is_where_the_file_describes_it_and_at_the_start_if_nowhere() -> None:
    file = linted(":hall :p 1 .\n:lamp :p :hall .")
    assert file.offset(URIRef(iri("lamp"))) == len(PREFIXES) + len(":hall :p 1 .\n")
    assert file.offset(URIRef(iri("bell"))) == 0


def test_the_members_of_a_list_come_in_its_order() -> None:
    file = linted(":a :p ( 3 1 2 ) .")
    assert [str(member) for member in file.items(next(file.graph.objects(URIRef(iri("a")))))] == ["3", "1", "2"]


def test_a_list_that_comes_back_to_itself_ends_where_it_does() -> None:
    file = linted("@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> . :a rdf:first 1 ; rdf:rest :a .")
    assert [str(member) for member in file.items(URIRef(iri("a")))] == ["1"]
    assert list(file.items(RDF.nil)) == []


def test_shapes_that_always_hold_are_looked_at_beside_those_of_the_file() -> None:
    file = linted(":s sh:class :A .", ":s sh:class :B .")
    assert {str(value) for value in file.source.values(URIRef(iri("s")), URIRef(SH["class"]))} == {iri("A"), iri("B")}
