"""The queries of shapes: their prefixes, and why one is not asked."""

from __future__ import annotations

import pytest
import rdflib
from hypothesis import given
from hypothesis import strategies as st
from rdflib import Graph, URIRef

from selfconf.model.term import IRI
from selfconf.rdf.pyshacl_corrections import corrected
from selfconf.rdf.shacl import refused_queries
from selfconf.rdf.turtle import parse
from selfconf.rdf.vocabulary import SH
from tests.lab import PREFIXES, iri

OWL = "@prefix owl: <http://www.w3.org/2002/07/owl#> .\n"


def refused(said: str, text: str = "") -> list[tuple[IRI, str]]:
    """The predicate of each statement of a constraint that keeps it from being asked, and why."""
    document = parse(f"{PREFIXES}{OWL}:c {said} .\n{text}", "r.ttl")
    return [(predicate, sentence) for (_, predicate, _), sentence in refused_queries(document, iri("c"))]


def of_condition(condition: str) -> list[str]:
    """Why a query with a condition is not asked."""
    return [reason for _, reason in refused(f'sh:select """SELECT $this {{ $this ?p ?o FILTER({condition}) }}"""')]


@pytest.mark.parametrize(
    ("condition", "sentence"),
    [
        (
            "REGEX(?o, '(x')",
            "The pattern of REGEX at 1:45 is no regular expression: missing ), unterminated subpattern",
        ),
        (
            "?o = ',' || ! regex (STR(?o),\n  '[z-a]', 'i')",
            "The pattern of REGEX at 2:3 is no regular expression: bad character range z-a at position 1.",
        ),
        (r"REGEX(?o, '\\\\p{L}+')", r"a letter of any language is [^\W\d_]."),
        ("REGEX(?o, '[a-z-[aeiou]]')", "it subtracts a class of characters"),
        ("REPLACE(REPLACE(?o, 'a', ')'), '(', 'b') = 'c'", "The pattern of REPLACE at 1:66 is no regular expression"),
        ("REPLACE(REPLACE(?o, '*', ')'), '.', 'b') = 'c'", "The pattern of REPLACE at 1:55 is no regular expression"),
        ("REGEX(?o, concat('(', CONCAT('x', \"y\")))", "The pattern of REGEX at 1:45 is no regular expression"),
        ("REGEX(?o, '(x', 'q')", "At 1:51 the flags of REGEX may be i, m and s alone."),
        ("REPLACE(?o, 'x', 'y', 'ix') = 'y'", "At 1:57 the flags of REPLACE may be i, m and s alone."),
    ],
)
def test_a_constant_by_which_a_query_would_find_nothing_is_told_with_its_place(condition: str, sentence: str) -> None:
    (found,) = of_condition(condition)
    assert sentence in found


@pytest.mark.parametrize(
    "condition",
    [
        "REGEX(?o, '^x$', 'ims')",
        "REGEX(?o, ?p)",
        "REGEX(?o, CONCAT('(', ?p))",
        "REGEX(?o, CONCAT('(') + 'x)')",
        "CONTAINS(?o, \"REGEX(?o, '(')\") # REGEX(?o, '(')\n",
        "<urn:REGEX(a,b)> = ?o",
        "?REGEX = 5",
        "REPLACE(?o, 'a', '(', 's') = ?p",
    ],
)
def test_what_is_a_pattern_or_is_not_known_beforehand_is_let_be(condition: str) -> None:
    assert of_condition(condition) == []


@given(st.text(alphabet="ab(){}[]*+?1,^$.|- #", max_size=6), st.sampled_from(("", ", 'i'", ", 'ms'")))
def test_a_pattern_is_told_where_no_query_with_it_would_find_anything(pattern: str, flags: str) -> None:
    query = f"SELECT $this {{ $this ?p ?o BIND(REGEX(?o, '{pattern}'{flags}) AS ?found) FILTER(BOUND(?found)) }}"
    graph = Graph().add((URIRef("urn:a"), URIRef("urn:p"), rdflib.Literal("aab")))
    with corrected():
        found = len(graph.query(query))
    assert bool(refused(f'sh:select "{query}"')) == (found == 0)


def test_prefixes_are_those_of_an_ontology_and_of_all_that_it_imports() -> None:
    said = "sh:prefixes :one ; sh:select 'SELECT $this { $this a:p b:q , c:r }'"
    text = """
        :one sh:declare [ sh:prefix "a" ; sh:namespace "urn:a:" ] ; owl:imports :two , :three .
        :two sh:declare [ sh:prefix "b" ; sh:namespace "urn:b:"^^xsd:anyURI ] ; owl:imports :one .
        :three owl:imports :four .
        :four sh:declare [ sh:prefix "c" ; sh:namespace "urn:c:" ] .
    """
    assert refused(said, text) == []
    ((predicate, sentence),) = refused(said, text.replace(":three owl:imports :four", ":four owl:imports :three"))
    assert predicate == SH.select
    assert "the prefix c: is not declared" in sentence


@pytest.mark.parametrize(
    "declaration",
    [
        '[ sh:prefix "a" ]',
        '[ sh:namespace "urn:a:" ]',
        '[ sh:prefix "a" ; sh:namespace "no iri" ]',
        '[ sh:prefix "a" ; sh:namespace "relative" ]',
        '[ sh:prefix "a b" ; sh:namespace "urn:a:" ]',
        '[ sh:prefix "a" ; sh:namespace <urn:a:> ]',
        '[ sh:prefix "a" ; sh:namespace "urn:a:" , "urn:b:" ]',
        '[ sh:prefix "a" , "b" ; sh:namespace "urn:a:" ]',
        '"a"',
    ],
)
def test_a_declaration_that_is_none_is_told_and_no_query_beside_it(declaration: str) -> None:
    ((predicate, sentence),) = refused(
        "sh:prefixes :one ; sh:select 'SELECT $this { $this a:p 1 }'", f":one sh:declare {declaration} ."
    )
    assert predicate == SH.declare
    assert sentence.startswith("The value of sh:declare has to be a node with one sh:prefix and one sh:namespace")


def test_a_prefix_stands_for_one_namespace() -> None:
    said = "sh:prefixes :one , :two ; sh:select 'SELECT $this { $this a:p 1 }'"
    text = ':one sh:declare [ sh:prefix "a" ; sh:namespace "urn:a:" ] .\n:two sh:declare [ sh:prefix "a" ; '
    assert refused(said, f'{text}sh:namespace "urn:a:" ] .') == []
    assert refused(said, f'{text}sh:namespace "urn:b:" ] .') == [
        (SH.declare, "The prefix a: stands for <urn:a:> in this query already.")
    ]
