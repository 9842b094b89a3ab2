"""The verdict on an output is that of pySHACL, whether or not the shape can be compiled."""

from __future__ import annotations

import pytest
import rdflib
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from selfconf import template
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement, ShapeNotAccepted, accepted_shape, read_advertisements
from selfconf.rdf.conformance import judged
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.output_shapes import OutputShape, SeenOutputs
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.pyshacl_corrections import only_ordered
from selfconf.rdf.rdflib_terms import rdflib_term, to_rdflib
from selfconf.rdf.turtle import Document, parse
from selfconf.rdf.vocabulary import SC, SH
from tests.harness.effort import examples, thorough
from tests.lab import PREFIXES

OUTPUTS = """
:low a sc:Component, :Sensor ; :on :Pippi ; sc:hasOutput [ sc:name "o" ; sc:signalType :Pose ; sc:unit unit:M ; :age 2 ;
    sc:rate [ sc:value 3 ; sc:unit unit:HZ ] ; :quality 0.5 , 2 ; rdfs:label "slow"@en ] .
:high a sc:Component, :Sensor, :Good ; :on :Astrid ; sc:hasOutput [ sc:name "o" ; sc:signalType :Pose , :Scan ;
    :age 9 ; sc:rate [ sc:value 9 ; sc:unit unit:HZ ] ; :quality "best" ] ,
    [ a :Raw ; sc:name "p" ; sc:signalType :Scan ] .
:bare a sc:Component, :Sensor ; :on :Astrid , :Pippi ; sc:hasOutput :out .
:out sc:name "o" .
"""
PATHS = st.sampled_from(
    (
        "sc:unit", "sc:frame", "sc:signalType", "sc:name", ":quality", ":age", "rdfs:label", "( sc:rate sc:value )",
        "( [ sh:inversePath sc:hasOutput ] :on )", "[ sh:alternativePath ( sc:unit :quality ) ]",
        "( [ sh:inversePath sc:hasOutput ] sc:hasOutput sc:name )", "[ sh:zeroOrMorePath sc:rate ]",
        "( sc:signalType [ sh:zeroOrMorePath rdfs:subClassOf ] )",
    )
)  # fmt: skip
CONSTRAINTS = st.sampled_from(
    (
        "sh:minCount 1", "sh:maxCount 1", "sh:minCount 2", "sh:hasValue unit:M", "sh:in ( :Astrid :Pippi )",
        "sh:in ( :Astrid )", "sh:minInclusive 5", "sh:maxExclusive 5", "sh:datatype xsd:integer", "sh:nodeKind sh:IRI",
        'sh:pattern "^o"', "sh:hasValue :Data", "sh:hasValue :Scan", "sh:node [ sh:nodeKind sh:IRI ]",
        'sh:languageIn ( "en" )', "sh:minLength 2", "sh:class :Raw", "sh:not [ sh:hasValue 3 ]",
        "sh:lessThan :age", "sh:lessThanOrEquals :age", "sh:equals :age", "sh:disjoint :age",
        "sh:qualifiedValueShape [ sh:nodeKind sh:IRI ] ; sh:qualifiedMinCount 1",
        'sh:qualifiedValueShape [ sh:minLength 2 ; sh:pattern "^o" ] ; sh:qualifiedMaxCount 0',
        "sh:qualifiedValueShape [ sh:in ( :Astrid unit:M 9 ) ] ; sh:qualifiedMinCount 1 ; sh:qualifiedMaxCount 1",
    )
)  # fmt: skip
PROPERTIES = st.builds(
    lambda path, said: f"sh:property [ sh:path {path} ; {' ; '.join({one.split()[0]: one for one in said}.values())} ]",
    PATHS,
    st.lists(CONSTRAINTS, min_size=1, max_size=2),
)
SHAPES = st.recursive(
    st.one_of(
        PROPERTIES,
        st.sampled_from(
            ("sh:class :Raw", "sh:nodeKind sh:BlankNode", "sh:node [ sh:in ( :out ) ]", "sh:hasValue :out")
        ),
    ),
    lambda inner: st.one_of(
        st.builds("sh:not [ {} ]".format, inner),
        st.lists(inner, min_size=1, max_size=2).map(
            lambda some: "sh:or ( " + " ".join(f"[ {s} ]" for s in some) + " )"
        ),
        st.lists(inner, min_size=1, max_size=2).map(" ; ".join),
    ),
    max_leaves=4,
)
HIERARCHIES = st.sampled_from(
    (NOTHING_ABOVE, Hierarchy([(IRI("https://example.org/peis-home#Scan"), IRI("https://example.org/peis-home#Data"))]))
)
NAMES = [("low", "o"), ("high", "o"), ("high", "p"), ("bare", "o")]


def home(name: str) -> IRI:
    """A name in the namespace of the test."""
    return IRI(f"https://example.org/peis-home#{name}")


def shape_of(text: str) -> tuple[Document, str]:
    """A shape as a document in which it is `:shape`, and as the reader reads it."""
    document = parse(f"{PREFIXES}:input sc:accepts [ {text} ] .", "test")
    return document, accepted_shape(document, document.values(home("input"), SC.accepts)[0])


@pytest.mark.parametrize("said", ["sh:defaultValue 3", "rdfs:comment 'c'", "rdfs:seeAlso <urn:x>", "sh:order 1"])
def test_annotations_are_no_reason_to_ask_pyshacl(said: str) -> None:
    document = parse(f"{PREFIXES}:i sc:accepts [ sh:property [ sh:path sc:name ; sh:minCount 1 ; {said} ] ] .", "test")
    ((_, _, shape),) = (one for one in document.triples() if one[1] == SC.accepts)
    assert OutputShape(accepted_shape(document, shape), NOTHING_ABOVE)._tests.complete


@thorough
@settings(max_examples=examples(150), deadline=None)
@given(SHAPES, HIERARCHIES)
def test_an_output_conforms_where_pyshacl_says_so(text: str, hierarchy: Hierarchy) -> None:
    try:
        document, canonical = shape_of(text)
    except ShapeNotAccepted:
        assume(False)
    ecology = {a.component: a for a in read_advertisements((PREFIXES + OUTPUTS).encode(), "outputs")[0]}
    seen = {component: tuple(visible(advertisement, hierarchy)) for component, advertisement in ecology.items()}
    known = SeenOutputs(seen.__getitem__)
    outputs = {(home(c), name): known.node((home(c), name)) for c, name in NAMES}
    found = OutputShape(canonical, hierarchy).conforming(list(outputs), known)

    data = to_rdflib(triple for triples in seen.values() for triple in triples)
    (shape,) = document.values(home("input"), SC.accepts)
    for port, node in outputs.items():
        shapes = to_rdflib(document.triples())
        shapes.add((rdflib_term(shape), rdflib.RDF.type, rdflib.URIRef(SH.NodeShape)))
        shapes.add((rdflib_term(shape), rdflib.URIRef(SH.targetNode), rdflib_term(node)))
        with only_ordered():  # by itself pySHACL fails beside a blank node
            _, report = judged(data, shapes)
        assert (port in found) == ("Conforms: True" in report), (canonical, port, report)


def visible(advertisement: Advertisement, hierarchy: Hierarchy) -> list[tuple[object, ...]]:
    """What shapes see of an advertisement, as roles do."""
    index = AdvertisementIndex.of([advertisement])
    task = template(f"{PREFIXES}:t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Sensor .")
    return list(Partitioner(task.document, hierarchy).judge.visible(list(index.values())))
