"""Constraint components whose validators are queries: what is found wrong is what SHACL says."""

from __future__ import annotations

import pytest

from selfconf.model.term import IRI
from selfconf.rdf.conformance import violations
from selfconf.rdf.rdflib_terms import to_rdflib
from selfconf.rdf.turtle import document as turtle

HEAD = "@prefix : <http://e.org/> . @prefix sh: <http://www.w3.org/ns/shacl#> .\n"
SAID = ":none :note 1 . :zero :flow 0 . :low :flow 3 . :high :flow 7 . :both :flow 0 , 7 ."
NODES = ("none", "zero", "low", "high", "both")
COMPONENT = ":most a sh:ConstraintComponent ; sh:parameter [ sh:path :arg ] ; %s .\n"
HIGHER = "SELECT $this ?value WHERE { $this <http://e.org/flow> ?value FILTER (?value > $arg) }"
EQUAL = "SELECT $this WHERE { $this <http://e.org/flow> $arg }"
GREATER = "SELECT $this ?value WHERE { $this $PATH ?value FILTER (?value > $arg) }"
LACKING = "SELECT $this WHERE { FILTER NOT EXISTS { $this $PATH ?any } }"


@pytest.mark.parametrize(
    ("validator", "shape", "wrong"),
    [
        (f'sh:nodeValidator [ sh:select "{HIGHER}" ]', ":arg 4", {"high", "both"}),
        (f'sh:nodeValidator [ sh:select "{EQUAL}" ]', ":arg 3, 7", {"low", "high", "both"}),
        (f'sh:nodeValidator [ sh:select "{EQUAL}" ]', ":arg 0, 3, 7", {"zero", "low", "high", "both"}),
        (
            'sh:validator [ sh:ask "ASK { FILTER ($value != $arg) }" ]',
            "sh:property [ sh:path :flow ; :arg 3, 7 ]",
            {"low", "high", "both"},
        ),
        (f'sh:nodeValidator [ sh:select "{HIGHER}" ]', "sh:not [ :arg 4 ]", {"none", "zero", "low"}),
        (f'sh:propertyValidator [ sh:select "{LACKING}" ]', "sh:property [ sh:path :flow ; :arg 4 ]", {"none"}),
        (
            f'sh:propertyValidator [ sh:select "{GREATER}" ]',
            "sh:property [ sh:path :flow ; :arg 0 ]",
            {"low", "high", "both"},
        ),
        (
            'sh:validator [ sh:ask "ASK { FILTER ($value <= $arg) }" ]',
            "sh:property [ sh:path :flow ; :arg 4 ]",
            {"high", "both"},
        ),
    ],
)
def test_the_validator_of_a_component_finds_what_shacl_says(validator: str, shape: str, wrong: set[str]) -> None:
    text = HEAD + COMPONENT % validator + f":shape {shape} ."
    subjects, shapes = (to_rdflib(turtle.parse(each, "a.ttl").triples()) for each in (HEAD + SAID, text))
    focus = [IRI(f"http://e.org/{node}") for node in NODES]
    found = violations(subjects, shapes, IRI("http://e.org/shape"), focus, "a.ttl")
    assert {node.removeprefix("http://e.org/") for node in found} == wrong


def test_the_message_of_a_component_names_what_is_violated() -> None:
    text = HEAD + COMPONENT % f'sh:nodeValidator [ sh:select "{EQUAL}" ]' + ":shape :arg 3, 7 ."
    subjects, shapes = (to_rdflib(turtle.parse(each, "a.ttl").triples()) for each in (HEAD + SAID, text))
    (found,) = violations(subjects, shapes, IRI("http://e.org/shape"), [IRI("http://e.org/high")], "a.ttl").values()
    assert [each.message for each in found] == ["most, with arg 7"]


def test_a_query_has_the_prefixes_of_ontologies_that_others_import_and_of_no_others() -> None:
    text = (
        HEAD
        + """@prefix owl: <http://www.w3.org/2002/07/owl#> .
        :shape sh:sparql [ sh:prefixes :one ; sh:select "SELECT $this { $this a:flow 3 }" ] .
        :one a owl:Ontology ; owl:imports :two ; sh:declare [ sh:prefix "b" ; sh:namespace "urn:b:" ] .
        :two a owl:Ontology ; sh:declare [ sh:prefix "a" ; sh:namespace "http://e.org/" ] .
        :three a owl:Ontology ; sh:declare [ sh:prefix "a" ; sh:namespace "urn:other:" ] .
    """
    )
    subjects, shapes = (to_rdflib(turtle.parse(each, "a.ttl").triples()) for each in (HEAD + SAID, text))
    focus = [IRI(f"http://e.org/{node}") for node in NODES]
    assert [*violations(subjects, shapes, IRI("http://e.org/shape"), focus, "a.ttl")] == [IRI("http://e.org/low")]
