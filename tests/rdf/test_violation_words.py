"""What pySHACL finds violated, in words."""

from __future__ import annotations

import pytest

from selfconf.rdf import rdflib_terms
from selfconf.rdf.conformance import violations
from selfconf.rdf.turtle import parse
from tests.lab import PREFIXES, iri

SAID = ":a a :T ; :link :b ; :q 5 ; :text 'one'@en , 'two'@en . :b a :T ; :n 7 ; :m 7 ; :k 'far' ."
FAR = "sh:property [ sh:path ( :link :n ) ; %s ]"


def told(shape: str) -> list[str]:
    """What `:a` is told of a shape."""
    subjects, shapes = (
        rdflib_terms.to_rdflib(parse(PREFIXES + text, "a.ttl").triples()) for text in (SAID, f":shape {shape} .")
    )
    found = violations(subjects, shapes, iri("shape"), [iri("a")], "a.ttl")
    return [str(one).removeprefix("violates: ") for one in found.get(iri("a"), ())]


@pytest.mark.parametrize(
    ("asked", "words"),
    [
        ("sh:minCount 1", None),
        ("sh:minCount 2", "there are fewer than 2 of link/n"),
        ("sh:maxCount 0", "there are more than 0 of link/n"),
        ("sh:in ( 8 9 )", "link/n is 7, not 8 or 9"),
        ("sh:hasValue 8", "no link/n is 8"),
        ("sh:class :T", "link/n is 7, not a T"),
        ("sh:datatype xsd:decimal", "link/n is 7, an integer, not a decimal"),
        ("sh:nodeKind sh:IRI", "link/n is 7, not an IRI"),
        ("sh:minInclusive 8", "link/n is 7, not at least 8"),
        ("sh:maxExclusive 7", "link/n is 7, not less than 7"),
        ("sh:minLength 2", "link/n is 7, not at least 2 characters long"),
        ("sh:pattern '^a'", "link/n is 7, not like /^a/"),
        ("sh:languageIn ( 'de' )", 'link/n is 7, in none of the languages "de"'),
        ("sh:equals :q", "link/n and q differ by 5"),
        ("sh:not [ sh:in ( 7 'x' true ) ]", 'link/n is 7, and must not conform to shape [ sh:in ( 7 "x" true ) ]'),
        (
            "sh:or ( [ sh:minInclusive 8.5 ] [ sh:class :T ] )",
            "link/n is 7, and must conform to one or more shapes in [ sh:minInclusive 8.5 ] , [ sh:class T ]",
        ),
        ("sh:qualifiedValueShape [ sh:in ( 8 ) ] ; sh:qualifiedMinCount 1", "fewer than 1 of link/n are as asked for"),
        ("sh:qualifiedValueShape [ sh:in ( 7 ) ] ; sh:qualifiedMaxCount 0", "more than 0 of link/n are as asked for"),
        ("sh:node [ sh:maxExclusive 7 ; sh:datatype xsd:integer ]", "link/n is 7, not less than 7"),
        ("sh:in ( 8 ) ; sh:message 'too far'@en , 'zu weit'@de", "too far"),
    ],
)
def test_a_constraint_of_a_path_is_told_as_the_compiled_tests_tell_those_of_a_property(
    asked: str, words: str | None
) -> None:
    assert told(FAR % asked) == ([] if words is None else [words])


@pytest.mark.parametrize(
    ("shape", "words"),
    [
        ("sh:class :Lamp", "it is a, not a Lamp"),
        ("sh:not [ sh:class :T ]", "it must not conform to shape [ sh:class T ]"),
        ("sh:hasValue :b", "it is not b"),
        (
            "sh:closed true ; sh:ignoredProperties ( <http://www.w3.org/1999/02/22-rdf-syntax-ns#type> :link :text )",
            "q may not be stated",
        ),
        ("sh:property [ sh:path :text ; sh:uniqueLang true ]", "several of text have one language"),
        ("sh:property [ sh:path :link ; sh:disjoint :link ]", "link and link are both b"),
        ("sh:property [ sh:path :link ; sh:property [ sh:path :away ; sh:minCount 1 ] ]", "there is no away of b"),
        (
            "sh:property [ sh:path :link ; sh:node [ sh:property [ sh:path :n ; sh:in ( 1 ) ] ; sh:class :K ] ]",
            "link is b, not a K and link/n is 7, not 1",
        ),
        ("sh:property [ sh:path [ sh:inversePath :link ] ; sh:minCount 1 ]", "there is no ^link"),
        (
            "sh:property [ sh:path ( [ sh:alternativePath ( :x :y ) ] [ sh:zeroOrOnePath :z ] ) ; sh:minCount 1 ]",
            "there is no (x|y)/z?",
        ),
        ("sh:property [ sh:path ( :link :n ) ; sh:hasValue 8 , 7 ]", "not all of 7 and 8 are link/n"),
    ],
)
def test_a_node_another_node_and_a_path_are_told_by_name(shape: str, words: str) -> None:
    assert told(shape) == [words]


@pytest.mark.parametrize(
    ("query", "found"),
    [
        ("SELECT $this ?value WHERE { $this <https://example.org/peis-home#q> ?value }", "5"),
        ("SELECT $this WHERE { $this <https://example.org/peis-home#q> 5 }", "it"),
    ],
)
def test_a_query_without_a_message_tells_what_it_finds(query: str, found: str) -> None:
    words = f"the query of the shape finds {found}, and no sh:message says what is wrong"
    assert told(f"sh:sparql [ sh:select '{query}' ]") == [words]
