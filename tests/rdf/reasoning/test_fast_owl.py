"""The quick reasoner finds what owlrl finds, wherever it is used."""

from __future__ import annotations

from collections.abc import Callable, Iterable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from selfconf import library
from selfconf.model.hierarchy import Reasoning
from selfconf.model.term import IRI
from selfconf.rdf.reasoning import closure
from selfconf.rdf.reasoning import fast_owl as quick_owl
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.turtle.document import Document, Triple
from tests.harness.effort import examples

pytest.importorskip("reasonable")

PREFIXES = """
@prefix : <urn:x:> .
@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
"""
CLASSES, PROPERTIES, THINGS = (st.sampled_from(names.split()) for names in (":A :B :C :D", ":p :q :r", ":i :j"))
WIDE = st.sampled_from(["rdf:List", "rdfs:Literal", "rdfs:Resource", "owl:Thing"])
AXIOMS = st.one_of(
    st.builds("{} rdfs:subClassOf {} .".format, CLASSES, CLASSES),
    st.builds("{} rdfs:subClassOf owl:Thing .".format, CLASSES),
    st.builds("{} owl:equivalentClass {} .".format, CLASSES, CLASSES),
    st.builds("{} rdfs:subPropertyOf {} .".format, PROPERTIES, PROPERTIES),
    st.builds("{} owl:equivalentProperty {} .".format, PROPERTIES, PROPERTIES),
    st.builds("{} owl:unionOf ( {} {} ) .".format, CLASSES, CLASSES, CLASSES),
    st.builds("{} owl:intersectionOf ( {} {} ) .".format, CLASSES, CLASSES, CLASSES),
    st.builds("{} rdfs:subClassOf [ a owl:Class ; owl:unionOf ( {} {} ) ] .".format, CLASSES, CLASSES, CLASSES),
    st.builds("{} owl:equivalentClass [ owl:intersectionOf ( {} {} ) ] .".format, CLASSES, CLASSES, CLASSES),
    st.builds("{} owl:equivalentClass [ owl:unionOf ( {} {} ) ] .".format, CLASSES, CLASSES, CLASSES),
    st.builds("{} owl:unionOf ( [ owl:intersectionOf ( {} {} ) ] {} ) .".format, CLASSES, CLASSES, CLASSES, CLASSES),
    st.builds("{} owl:disjointWith {} .".format, CLASSES, CLASSES),
    st.builds("{} owl:complementOf {} .".format, CLASSES, CLASSES),
    st.builds("{} owl:oneOf ( {} {} ) .".format, CLASSES, THINGS, THINGS),
    st.builds("{} rdfs:domain {} .".format, PROPERTIES, CLASSES),
    st.builds("{} rdfs:range {} .".format, PROPERTIES, CLASSES),
    st.builds("{} rdfs:{} {} .".format, PROPERTIES, st.sampled_from(("domain", "range")), WIDE),
    st.builds("{} owl:inverseOf {} .".format, PROPERTIES, PROPERTIES),
    st.builds("{} owl:propertyChainAxiom ( {} {} ) .".format, PROPERTIES, PROPERTIES, PROPERTIES),
    st.builds("{} a {} .".format, CLASSES, st.sampled_from(("owl:Class", "rdfs:Class"))),
    st.builds(
        "{} a owl:{} .".format,
        PROPERTIES,
        st.sampled_from(
            ("ObjectProperty", "DatatypeProperty", "AnnotationProperty", "TransitiveProperty", "SymmetricProperty")
        ),
    ),
    st.builds("{} a {} .".format, THINGS, CLASSES),
    st.builds("{} {} {} .".format, THINGS, PROPERTIES, THINGS),
    st.builds("{} {} {} .".format, CLASSES, PROPERTIES, CLASSES),
    st.builds("{} rdfs:label 'x' ; owl:versionInfo '1' .".format, CLASSES),
)  # fmt: skip


def hierarchy_of(documents: list[Document], entail: Callable[[list[Triple]], Iterable[Triple]]) -> set[tuple[IRI, IRI]]:
    """Each term that the documents speak of with each that lies above it."""
    found = closure.hierarchy(documents, Reasoning.OWL_RL, lambda triples: entail(list(triples)))
    names = {
        term for document in documents for triple in document.triples() for term in triple if isinstance(term, IRI)
    }
    classes = {(name, above) for name in names for above in found.superclasses(name)}
    return classes | {(name, above) for name in names for above in found.superproperties(name)}


@settings(max_examples=examples(150))
@given(st.lists(AXIOMS, min_size=1, max_size=8))
def test_of_any_ontology_that_suits_both_reasoners_infer_one_hierarchy(axioms: list[str]) -> None:
    document = turtle.parse(PREFIXES + "\n".join(axioms), "o.ttl")
    assert quick_owl.suits(list(document.triples()))
    assert hierarchy_of([document], quick_owl.reasonable_owl_rl) == hierarchy_of([document], closure.owlrl_owl_rl)


def test_the_ontologies_of_selfconf_suit_and_both_reasoners_infer_one_hierarchy() -> None:
    documents = [turtle.parse(path.read_bytes(), str(path)) for path in library.ontologies()]
    assert quick_owl.suits([triple for document in documents for triple in document.triples()])
    assert hierarchy_of(documents, quick_owl.reasonable_owl_rl) == hierarchy_of(documents, closure.owlrl_owl_rl)


@pytest.mark.parametrize(
    ("ontology", "lower", "higher"),
    [
        (":p rdfs:subPropertyOf [ rdfs:subPropertyOf :q ] .", "p", "q"),
        (":A owl:intersectionOf ( :C [ rdfs:subClassOf :B ] ) .", "A", "B"),
    ],
)
def test_what_has_no_name_leads_on_to_what_has_one(ontology: str, lower: str, higher: str) -> None:
    document = turtle.parse(PREFIXES + ontology, "o.ttl")
    assert quick_owl.suits(list(document.triples()))
    assert (IRI("urn:x:" + lower), IRI("urn:x:" + higher)) in hierarchy_of([document], quick_owl.reasonable_owl_rl)


@pytest.mark.parametrize(
    "axiom",
    [
        ":p owl:sameAs :q .",
        ":p a owl:FunctionalProperty .",
        ":A owl:onProperty :p ; owl:maxCardinality 1 .",
        ":A owl:hasKey ( :p ) .",
        ":A owl:onProperty :p ; owl:someValuesFrom :B .",
        ":p rdfs:subPropertyOf rdfs:subClassOf .",
        "rdf:type rdfs:subPropertyOf :p .",
        "owl:Thing rdfs:subClassOf :A .",
        ":A owl:equivalentClass owl:Thing .",
        ":A owl:unionOf ( :B owl:Thing ) .",
        ":A rdfs:subClassOf owl:Nothing .",
        ":l rdf:first :A , :B .",
    ],
)
def test_an_ontology_that_uses_anything_else_is_left_to_owlrl(axiom: str) -> None:
    assert not quick_owl.suits(list(turtle.parse(PREFIXES + axiom, "o.ttl").triples()))


@pytest.mark.parametrize(
    ("ontology", "lower", "higher"),
    [
        (":p owl:sameAs :q . :q a owl:ObjectProperty .", "p", "q"),
        (":B owl:equivalentClass owl:Thing . :A a owl:Class .", "A", "B"),
        (":B owl:unionOf ( owl:Thing ) . :A a owl:Class .", "A", "B"),
        (
            ":p rdfs:subPropertyOf :q . :A owl:onProperty :p ; owl:hasValue 1 .:B owl:onProperty :q ; owl:hasValue 1 .",
            "A",
            "B",
        ),
    ],
)
def test_what_is_left_to_owlrl_the_quick_reasoner_would_miss(ontology: str, lower: str, higher: str) -> None:
    document = turtle.parse(PREFIXES + ontology, "o.ttl")
    missed = hierarchy_of([document], closure.owlrl_owl_rl) - hierarchy_of([document], quick_owl.reasonable_owl_rl)
    assert (IRI("urn:x:" + lower), IRI("urn:x:" + higher)) in missed
