"""Contradictions: what is called impossible is so, and what can be kept is left alone."""

from __future__ import annotations

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from rdflib import SH, Graph, URIRef

from selfconf.errors import TemplateError
from selfconf.model.term import IRI
from selfconf.rdf.conformance import violations
from selfconf.rdf.rdflib_terms import to_rdflib
from selfconf.rdf.turtle.document import parse
from selfconf.rdf.validation.lints.contradictions import contradictions
from selfconf.rdf.validation.lints.normal_form import NormalForm, ShapeSource
from selfconf.rdf.vocabulary import SC
from tests.harness.effort import examples, thorough
from tests.lab import PREFIXES, iri
from tests.rdf.eligibility.test_shape_compiler import CLASSES, COMPONENTS, CONSTRAINTS, PATHS, TERMS, ecology, predicate
from tests.shipped import shipped_shapes

TYPE = "<http://www.w3.org/1999/02/22-rdf-syntax-ns#type>"
ALWAYS = shipped_shapes().all


def impossible(shape: str) -> bool:
    """Whether a role of that shape is found to be impossible."""
    graph = Graph().parse(data=f"{PREFIXES}:role a sc:Role ; {shape} .", format="turtle")
    source = ShapeSource(graph, ALWAYS)
    shapes = (URIRef(iri("role")), *source.applied(SH.targetClass, URIRef(SC.Component)))
    return next(contradictions(NormalForm(source, shapes)), None) is not None


def along(path: str, *constraints: str) -> str:
    """A property shape of some constraints."""
    return f"[ sh:path {path} ; {' ; '.join(constraints)} ]"


CONFLICTING = st.one_of(
    CONSTRAINTS,
    st.builds("sh:in ( {} )".format, TERMS),
    st.builds(
        "sh:{} {}".format,
        st.sampled_from(("minInclusive", "minExclusive", "maxInclusive", "maxExclusive")),
        st.sampled_from(("5", "5.0", "'NaN'^^xsd:double", "'INF'^^xsd:float", "'x'", "'2026-01-31'^^xsd:date")),
    ),
    st.builds("sh:minCount {}".format, st.integers(1, 3)),
    st.builds("sh:node [ sh:nodeKind sh:{} ]".format, st.sampled_from(("IRI", "Literal"))),
    st.builds("sh:not [ sh:hasValue {} ]".format, TERMS),
    st.builds("sh:or ( [ sh:in ( {} ) ] [ sh:datatype xsd:string ] )".format, TERMS),
    st.just("sh:qualifiedMinCount 1 ; sh:qualifiedValueShape [ sh:nodeKind sh:IRI ]"),
    st.just("sh:property [ sh:path :q ; sh:minCount 1 ]"),
)
PROPERTY_SHAPES = st.builds(
    along, PATHS, st.lists(CONFLICTING, min_size=1, max_size=2, unique_by=predicate).map("; ".join)
)
PARTS = st.one_of(
    st.builds("sh:property {}".format, PROPERTY_SHAPES),
    st.builds("sh:property {}".format, PROPERTY_SHAPES),
    st.builds("sh:class {}".format, CLASSES),
    st.builds("sh:node [ sh:property {} ]".format, PROPERTY_SHAPES),
    st.builds("sh:not {}".format, PROPERTY_SHAPES),
    st.builds("sh:not [ sh:class {} ]".format, CLASSES),
    st.builds("sh:or ( {} {} )".format, PROPERTY_SHAPES, PROPERTY_SHAPES),
    st.builds("sh:and ( {} {} )".format, PROPERTY_SHAPES, PROPERTY_SHAPES),
    st.builds("sh:xone ( {} {} )".format, PROPERTY_SHAPES, PROPERTY_SHAPES),
    st.just(f"sh:closed true ; sh:ignoredProperties ( {TYPE} :q )"),
)
ROLES = st.lists(PARTS, min_size=2, max_size=5, unique=True).map(" ; ".join)


@thorough
@settings(max_examples=examples(300), deadline=None)
@given(ROLES, COMPONENTS)
@example(
    "sh:property [ sh:path :p ; sh:hasValue 1 , 2 ] , [ sh:path :p ; sh:maxCount 1 ]", [(":A", [(":p", "1")], False)]
)
def test_no_component_conforms_to_what_is_called_impossible(
    shape: str, components: list[tuple[str, list[tuple[str, str]], bool]]
) -> None:
    if not impossible(shape):
        return
    advertisements = ecology(components)
    subjects = to_rdflib(triple for advertisement in advertisements for triple in advertisement.triples)
    shapes = to_rdflib(parse(f"{PREFIXES}:role a sc:Role ; {shape} .", "t.ttl").triples())
    everybody = [advertisement.component for advertisement in advertisements]
    try:
        refused = violations(subjects, shapes, IRI(iri("role")), everybody, "t.ttl")
    except TemplateError:
        return  # not well-formed, which is another finding
    assert refused.keys() == set(everybody)


@pytest.mark.parametrize(
    "shape",
    [
        "sh:property [ sh:path :p ; sh:minCount 2 ] , [ sh:path :p ; sh:maxCount 1 ]",
        "sh:property [ sh:path :p ; sh:hasValue :x ] , [ sh:path :p ; sh:in ( :y :z ) ]",
        "sh:property [ sh:path :p ; sh:hasValue :x , :y ] , [ sh:path :p ; sh:maxCount 1 ]",
        "sh:property [ sh:path :p ; sh:hasValue :x ] , [ sh:path :p ; sh:datatype xsd:string ]",
        "sh:property [ sh:path :p ; sh:hasValue 5 ] , [ sh:path :p ; sh:datatype xsd:string ]",
        "sh:property [ sh:path :p ; sh:datatype xsd:string ] , [ sh:path :p ; sh:datatype :own ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:nodeKind sh:IRI ] , [ sh:path :p ; sh:datatype xsd:string ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:nodeKind sh:Literal ] , [ sh:path :p ; sh:class :C ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minInclusive 5 ; sh:minCount 1 ] , [ sh:path :p ; sh:maxInclusive 4.5 ]",
        "sh:property [ sh:path :p ; sh:minExclusive 5 ; sh:minCount 1 ] , [ sh:path :p ; sh:maxInclusive 5 ]",
        "sh:property [ sh:path :p ; sh:minInclusive 'NaN'^^xsd:double ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minExclusive 'INF'^^xsd:double ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:maxExclusive '-INF'^^xsd:float ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minInclusive '5' ; sh:datatype xsd:integer ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minInclusive '2026-01-31'^^xsd:date ; sh:maxExclusive 7 ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minInclusive '2026-01-31'^^xsd:date ; sh:minExclusive 7 ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ; sh:datatype xsd:time ; sh:maxInclusive '2026-01-31'^^xsd:date ]",
        "sh:property [ sh:path :p ; sh:minLength 5 ; sh:minCount 1 ] , [ sh:path :p ; sh:maxLength 4 ]",
        "sh:property [ sh:path :p ; sh:in ( :x :y ) ; sh:minCount 1 ] , [ sh:path :p ; sh:in ( :z ) ]",
        "sh:property [ sh:path :p ; sh:in ( 1 2 ) ; sh:minCount 1 ] , [ sh:path :p ; sh:minInclusive 3 ]",
        "sh:property [ sh:path ( :p :q ) ; sh:minCount 1 ] , [ sh:path ( :p :q ) ; sh:maxCount 0 ]",
        "sh:and ( [ sh:path :p ; sh:minCount 1 ] [ sh:node [ sh:property [ sh:path :p ; sh:maxCount 0 ] ] ] )",
        "sh:property [ sh:path :p ; sh:minCount 1 ; sh:property [ sh:path :q ; sh:minCount 1 ; sh:maxCount 0 ] ]",
        "sh:property [ sh:path :p ; sh:hasValue 5 ; sh:property [ sh:path :q ; sh:minCount 1 ] ]",
        "sh:closed true ; sh:property [ sh:path :p ; sh:minCount 1 ]",
        f"sh:node [ sh:closed true ; sh:ignoredProperties ( {TYPE} ) ] ; sh:property [ sh:path :p ; sh:minCount 1 ]",
        "sh:class :A ; sh:not [ sh:class :A ]",
        "sh:property [ sh:path :p ; sh:minCount 2 ] ; sh:not [ sh:path :p ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:in ( :x ) ] ; sh:not [ sh:property [ sh:path :p ; sh:in ( :x ) ] ]",
        "sh:or ( [ sh:nodeKind sh:Literal ] [ sh:hasValue :a ] ) ; sh:hasValue :b",
        "sh:nodeKind sh:BlankNode",
        "sh:datatype xsd:string",
        "sh:property [ sh:path sc:preference ; sh:hasValue :high ]",
        "sh:property [ sh:path sc:hasInput ; sh:hasValue 5 ]",
        "sh:property [ sh:path :p ; sh:qualifiedValueShape [] ; sh:qualifiedMinCount 1 ; sh:qualifiedMaxCount 0 ]",
        "sh:property [ sh:path :p ; sh:lessThan :p ; sh:minCount 1 ]",
    ],
)
def test_a_contradiction_is_found_wherever_its_two_sides_stand(shape: str) -> None:
    assert impossible(shape)


@pytest.mark.parametrize(
    "shape",
    [
        "sh:property [ sh:path :p ; sh:minCount 2 ] , [ sh:path :q ; sh:maxCount 1 ]",
        "sh:property [ sh:path :p ; sh:datatype xsd:string ] , [ sh:path :p ; sh:datatype xsd:integer ]",
        "sh:property [ sh:path :p ; sh:in ( :x ) ] , [ sh:path :p ; sh:in ( :y ) ]",
        "sh:property [ sh:path :p ; sh:minCount 2 ; sh:deactivated true ] , [ sh:path :p ; sh:maxCount 1 ]",
        "sh:property [ sh:path :p ; sh:hasValue :x ] , [ sh:path :p ; sh:hasValue :y ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ] , [ sh:path [ sh:inversePath :p ] ; sh:maxCount 0 ]",
        "sh:property [ sh:path :p ; sh:minInclusive 5 ; sh:maxInclusive 5 ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minInclusive 'NaN'^^xsd:double ]",
        "sh:property [ sh:path :p ; sh:maxInclusive 'INF'^^xsd:double ; sh:minInclusive 8 ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minInclusive 5 ; sh:maxExclusive 6.5 ; sh:datatype xsd:float ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minInclusive 5 ; sh:datatype :own ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ; sh:minInclusive 'P1M'^^xsd:duration ; sh:datatype xsd:duration ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ] ; sh:not [ sh:path :p ; sh:minCount 2 ]",
        "sh:property [ sh:path :p ; sh:in ( 1 01 ) ; sh:minCount 2 ]",
        "sh:property [ sh:path :p ; sh:hasValue 01 ; sh:pattern '^0' ]",
        f"sh:property [ sh:path :p ; sh:hasValue '{'a' * 60}!' ; sh:pattern '^(?=([a-z]+)+$)' ]",
        "sh:or ( [ sh:nodeKind sh:Literal ] [ sh:class :A ] )",
        f"sh:closed true ; sh:ignoredProperties ( {TYPE} sc:hasInput )",
        "sh:property [ sh:path sc:preference ; sh:hasValue 5 ]",
        "sh:property [ sh:path ( sc:hasInput sc:signalType ) ; sh:hasValue :X , :Y ]",
        "sh:node :role ; sh:property [ sh:path :p ; sh:node :role ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ] ; sh:not [ sh:path :p ; sh:minCount 1 ; sh:not [ sh:class :A ] ]",
        "sh:property [ sh:path :p ; sh:minCount 1 ] ; sh:not [ sh:path :p ; sh:minCount 1 ; sh:or ( [ sh:in () ] ) ]",
        "sh:not [ sh:path ( :p :q ) ]",
        "sh:property [ sh:path :p ; sh:qualifiedValueShape [] ; sh:qualifiedMinCount 1 ; sh:qualifiedMaxCount 1 ]",
        "sh:property [ sh:path :p ; sh:lessThanOrEquals :p ; sh:minCount 1 ]",
        "sh:property [ sh:path :p ; sh:lessThan :p ]",
        "sh:property [ sh:path :p ; sh:lessThan :q ; sh:minCount 1 ]",
    ],
)
def test_what_a_component_could_conform_to_is_left_alone(shape: str) -> None:
    assert not impossible(shape)


@pytest.mark.parametrize("asked", ["sh:hasValue :v", "sh:in ( :v )", "sh:hasValue :v , :x"])
def test_what_depends_on_a_parameter_is_not_called_impossible(asked: str) -> None:
    shape = f"sh:property [ sh:path :p ; {asked} ] , [ sh:path :p ; sh:in ( :x ) ; sh:minCount 1 ; sh:maxCount 1 ]"
    assert not impossible(f"{shape} . :v a sc:Parameter")
