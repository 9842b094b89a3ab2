"""What may stand as the value of SHACL's own properties."""

from __future__ import annotations

import pytest
import rdflib
from rdflib import SH as SHACL

from selfconf.model.term import IRI
from selfconf.rdf.shacl import component_parameters, shapes_behind
from selfconf.rdf.shacl.shape_syntax import PATH_FORMS, STATED_ONCE, misfit, unfit
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.turtle import parse
from selfconf.rdf.validation.well_formedness import shape_of_shapes
from selfconf.rdf.vocabulary import SH
from tests.lab import PREFIXES, iri


@pytest.mark.parametrize(
    ("said", "predicate"),
    [
        ("sh:minCount 'one'", "minCount"),
        ("sh:closed 1", "closed"),
        ("sh:closed :always", "closed"),
        ("sh:in 5", "in"),
        ("sh:class 'A'", "class"),
        ("sh:class [ ]", "class"),
        ("sh:nodeKind :Kind", "nodeKind"),
        ("sh:property [ sh:class :A ]", "property"),
        ("sh:pattern 3", "pattern"),
        ("sh:pattern :p", "pattern"),
        ("sh:or ( )", "or"),
        ("sh:languageIn ( :en )", "languageIn"),
        ("sh:languageIn ( 'en' 5 )", "languageIn"),
        ("sh:languageIn ( 'de_AT' )", "languageIn"),
        ("sh:ignoredProperties ( :a 5 )", "ignoredProperties"),
        ("sh:node 'x'", "node"),
        ("sh:node [ sh:path :p ]", "node"),
        ("sh:path 'p'", "path"),
        ("sh:path ( )", "path"),
        ("sh:path ( :p )", "path"),
        ("sh:path ( :p 5 )", "path"),
        ("sh:path [ ]", "path"),
        ("sh:path [ rdfs:label :p ]", "path"),
        ("sh:path [ sh:inversePath 5 ]", "path"),
        ("sh:path [ sh:inversePath :p ; sh:zeroOrMorePath :q ]", "path"),
        ("sh:path [ sh:alternativePath ( :p ) ]", "path"),
    ],
)
def test_a_value_that_cannot_stand_there_is_named_with_its_statement(said: str, predicate: str) -> None:
    document = parse(f"{PREFIXES}:r {said} .", "r.ttl")
    found = misfit(document, list(document.triples()), frozenset())
    assert found is not None
    assert found[0][:2] == (iri("r"), SH[predicate])
    assert found[1] == unfit(SH[predicate]).rstrip(".")


@pytest.mark.parametrize(
    ("said", "sentence"),
    [
        ("sh:minCount 1", "sh:minCount is asked of the values of a property: write"),
        ("sh:not [ sh:lessThan :b ]", "sh:lessThan is asked of the values of a property: write"),
        ("sh:path :a ; sh:qualifiedMinCount 1", "Beside sh:qualifiedMinCount stands sh:qualifiedValueShape"),
        (
            "sh:path :a ; sh:qualifiedValueShape [ sh:class :A ]",
            "Beside sh:qualifiedValueShape stands sh:qualifiedMinCount or sh:qualifiedMaxCount",
        ),
        ("sh:ignoredProperties ( :a )", "Beside sh:ignoredProperties stands sh:closed"),
        ("sh:path :a ; sh:minCount 1 , 2", "A shape has one sh:minCount at most"),
        ("sh:not [ sh:in ( 1 2 ) ; sh:in ( 1 ) ]", "A shape has one sh:in at most"),
        ("sh:path :a ; sh:maxInclusive 0,5", "A shape has one sh:maxInclusive at most"),
        ("sh:path :a ; sh:pattern 'a', 'b'", "A shape has one sh:pattern at most"),
        ("sh:pattern '('", "This is no regular expression: missing ), unterminated subpattern at position 0"),
        ("sh:pattern 'a{99999999999}'", "This is no regular expression: it repeats something too often"),
    ],
)
def test_what_a_shape_has_to_say_beside_a_statement_is_named(said: str, sentence: str) -> None:
    document = parse(f"{PREFIXES}:r {said} .", "r.ttl")
    found = misfit(document, list(document.triples()), frozenset())
    assert found is not None
    assert found[1].startswith(sentence)


def test_what_a_shape_says_once_is_what_the_shape_of_shapes_wants_once() -> None:
    graph = shape_of_shapes()
    shapes = graph.subjects(SHACL.maxCount, rdflib.Literal(1))
    once = {IRI.unchecked(path) for shape in shapes for path in graph.objects(shape, SHACL.path)}
    assert {one for one in once if one in SH} - PATH_FORMS - {SH.alternativePath, SH.path} == STATED_ONCE


def test_what_a_pattern_means_depends_on_its_flags() -> None:
    document = parse(f"{PREFIXES}:r sh:pattern '(' ; sh:flags 'q' .", "r.ttl")
    assert misfit(document, list(document.triples()), frozenset()) is None


def test_of_a_constraint_in_sparql_the_query_is_named() -> None:
    document = parse(f"{PREFIXES}:r sh:sparql [ sh:select 'SELECT' ] .", "r.ttl")
    found = misfit(document, list(document.triples()), frozenset())
    assert found is not None
    assert found[0][1] == SH.select


@pytest.mark.parametrize(
    ("query", "sentence"),
    [
        ("SELECT $this { $this a sc:Component }", "This is not SPARQL: the prefix sc: is not declared"),
        ("SELECT $this { SERVICE <a:b> { $this a ?c } }", "leave out SERVICE"),
        ("SELECT ?x { ?x a ?c }", "has to be a SELECT query that selects $this"),
        ("CONSTRUCT WHERE { $this a ?c }", "has to be a SELECT query that selects $this"),
    ],
)
def test_of_a_query_that_is_not_asked_it_is_told_why(query: str, sentence: str) -> None:
    document = parse(f"{PREFIXES}:r sh:sparql [ sh:select '{query}' ] .", "r.ttl")
    found = misfit(document, document.triples(), frozenset())
    assert found is not None
    assert sentence in found[1]


def test_a_parameter_is_no_list() -> None:
    document = parse(f"{PREFIXES}:r sh:in :n .", "r.ttl")
    found = misfit(document, list(document.triples()), frozenset({iri("n")}))
    assert found is not None
    assert found[1] == "The value of sh:in has to be a list in parentheses"


def test_a_parameter_may_stand_wherever_no_list_has_to_be() -> None:
    document = parse(f"{PREFIXES}:r sh:minCount :n .", "r.ttl")
    assert misfit(document, list(document.triples()), frozenset({iri("n")})) is None
    assert misfit(document, list(document.triples()), frozenset({IRI("urn:other")})) is not None


def test_the_paths_of_the_parameters_of_all_components_are_found() -> None:
    text = """
        :One a sh:ConstraintComponent ; sh:parameter [ sh:path :low ] , [ sh:path :high ; sh:optional true ] .
        :Two a sh:ConstraintComponent ; sh:parameter [ sh:path _:odd ] .
        :other sh:parameter [ sh:path :nothing ] .
        :Own rdfs:subClassOf :Below . :Below rdfs:subClassOf sh:ConstraintComponent , :Own .
        :Three a :Own ; sh:parameter [ sh:path :own ] .
    """
    assert component_parameters(parse(PREFIXES + text, "shapes.ttl")) == {iri("low"), iri("high"), iri("own")}


def test_a_statement_leads_to_its_value_or_to_the_members_of_a_list_of_shapes() -> None:
    document = turtle.parse(PREFIXES + ":r sh:or ( :a :b ) ; sh:xone () ; sh:node :c ; sh:class :d .", "shapes.ttl")
    found = {predicate: [*shapes_behind(document, predicate, value)] for predicate, value in document.about(iri("r"))}
    assert found == {SH["or"]: [iri("a"), iri("b")], SH.xone: [], SH.node: [iri("c")], SH["class"]: []}


@pytest.mark.parametrize("kind", ["validator", "nodeValidator", "propertyValidator"])
def test_a_query_of_a_constraint_component_that_a_shape_uses_is_looked_at(kind: str) -> None:
    text = f"""
        :r :one :v . :s sh:class :Lamp .
        :One a sh:ConstraintComponent ; sh:parameter [ sh:path :one ] ;
            sh:{kind} [ sh:ask "ASK {{ $value foo:p $one }}" ] .
    """
    document = turtle.parse(PREFIXES + text, "shapes.ttl")
    used, unused = (
        misfit(document, [(subject, *said) for said in document.about(subject)], frozenset((iri("v"),)))
        for subject in (iri("r"), iri("s"))
    )
    assert used is not None
    assert used[0][1] == SH.ask
    assert "the prefix foo: is not declared" in used[1]
    assert unused is None
