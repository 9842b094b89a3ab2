"""What inputs accept: the verdict on each output is that of pySHACL, whether or not the shape can be compiled."""

from __future__ import annotations

import pytest
import rdflib
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from selfconf import configure, read, template
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement, ShapeNotAccepted, accepted_shape, read_advertisements
from selfconf.rdf.conformance import judged
from selfconf.rdf.eligibility.acceptance import OutputShape, SeenOutputs
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.rdflib_terms import rdflib_term, to_rdflib
from selfconf.rdf.turtle import Document, parse
from selfconf.rdf.vocabulary import SC, SH
from tests.effort import examples
from tests.lab import PREFIXES

OUTPUTS = """
:low a sc:Component, :Sensor ; :on :Pippi ; sc:hasOutput [ sc:name "o" ; sc:signalType :Pose ; sc:unit unit:M ; :age 2 ;
    sc:rate [ sc:value 3 ; sc:unit unit:HZ ] ; :quality 0.5 , 2 ; rdfs:label "slow"@en ] .
:high a sc:Component, :Sensor, :Good ; :on :Astrid ; sc:hasOutput [ sc:name "o" ; sc:signalType :Pose , :Scan ;
    :age 9 ; sc:rate [ sc:value 9 ; sc:unit unit:HZ ] ; :quality "best" ] ,
    [ a :Raw ; sc:name "p" ; sc:signalType :Scan ] .
:bare a sc:Component, :Sensor ; :on :Astrid , :Pippi ; sc:hasOutput [ sc:name "o" ] .
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
    st.one_of(PROPERTIES, st.just("sh:class :Raw"), st.just("sh:nodeKind sh:BlankNode")),
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


@settings(max_examples=examples(150), deadline=None)
@given(SHAPES, HIERARCHIES)
def test_an_output_conforms_where_pyshacl_says_so(text: str, hierarchy: Hierarchy) -> None:
    try:
        document, canonical = shape_of(text)
    except ShapeNotAccepted:
        assume(False)
    ecology = {a.component: a for a in read_advertisements((PREFIXES + OUTPUTS).encode(), "outputs")[0]}
    seen = {component: tuple(visible(advertisement, hierarchy)) for component, advertisement in ecology.items()}
    known = SeenOutputs(seen.__getitem__, hierarchy)
    outputs = {(home(c), name): known.node((home(c), name)) for c, name in NAMES}
    found = OutputShape(canonical, hierarchy).conforming(list(outputs), known)

    data = to_rdflib(triple for triples in seen.values() for triple in triples)
    (shape,) = document.values(home("input"), SC.accepts)
    for port, node in outputs.items():
        shapes = to_rdflib(document.triples())
        shapes.add((rdflib_term(shape), rdflib.RDF.type, rdflib.URIRef(SH.NodeShape)))
        shapes.add((rdflib_term(shape), rdflib.URIRef(SH.targetNode), rdflib_term(node)))
        _, report = judged(data, shapes)
        assert (port in found) == ("Conforms: True" in report), (canonical, port, report)


def visible(advertisement: Advertisement, hierarchy: Hierarchy) -> list[tuple[object, ...]]:
    """What shapes see of an advertisement, as roles do."""
    index = AdvertisementIndex.of([advertisement])
    task = template(f"{PREFIXES}:t a sc:Template ; sc:roles ( :r ) . :r a sc:Role ; sh:class :Sensor .")
    return list(Partitioner(task.document, hierarchy).judge.visible(list(index.values())))


TASK = f"""{PREFIXES}:t a sc:Template ; sc:roles ( :sensor :display ) .
:sensor a sc:Role ; sh:class :Sensor ; sc:feeds :display . :display a sc:Role ; sh:class :Display ."""


def answered(accepts: str) -> Configuration | Refusal | Undecided:
    """The answer to who feeds a display that accepts some outputs."""
    port = f'[ sc:name "i" ; sc:signalType :Pose ; sc:accepts [ {accepts} ] ]'
    display = f":show a sc:Component, :Display ; sc:hasInput {port} ."
    return configure(template(TASK), read(PREFIXES + OUTPUTS + display))


@pytest.mark.parametrize(
    ("accepts", "source"),
    [
        ("sh:property [ sh:path ( sc:rate sc:value ) ; sh:minInclusive 5 ]", "high"),
        ("sh:property [ sh:path sc:unit ; sh:hasValue unit:M ]", "low"),
        ("sh:property [ sh:path ( [ sh:inversePath sc:hasOutput ] :on ) ; sh:in ( :Astrid ) ]", "high"),
        ("sh:property [ sh:path ( sc:rate sc:value ) ; sh:lessThanOrEquals :age ]", "high"),
        ("sh:property [ sh:path [ sh:inversePath sc:hasOutput ] ; sh:node [ sh:class :Good ] ]", "high"),
    ],
)
def test_the_first_output_that_conforms_feeds_the_input(accepts: str, source: str) -> None:
    answer = answered(accepts)
    assert isinstance(answer, Configuration)
    assert [connection.source.short for connection in answer.connections] == [source]


def test_where_none_conforms_the_refusal_says_that_it_is_the_shape() -> None:
    answer = answered("sh:property [ sh:path sc:unit ; sh:hasValue unit:KiloM ]")
    assert isinstance(answer, Refusal)
    assert "conforms to its sc:accepts" in str(answer.reasons[0])


def test_a_shape_that_nests_too_deeply_keeps_out_the_component_that_states_it() -> None:
    deep = "sh:node [ " * 20 + "sh:nodeKind sh:Literal" + " ]" * 20
    answer = answered(f"sh:property [ sh:path sc:name ; {deep} ]")
    assert isinstance(answer, Refusal)
    assert "display" in str(answer.reasons[0])


def test_what_another_component_says_disqualifies_no_output() -> None:
    path = "( [ sh:inversePath sc:hasOutput ] :on [ sh:inversePath :on ] )"
    alone = f"sh:property [ sh:path {path} ; sh:maxCount 1 ]"
    judged_by_pyshacl = (
        f"{alone} , [ sh:path sc:name ; sh:qualifiedValueShape [ sh:nodeKind sh:Literal ] ; sh:qualifiedMinCount 1 ]"
    )
    for accepts in (alone, judged_by_pyshacl):
        answer = answered(accepts)
        assert isinstance(answer, Configuration)
        assert [connection.source.short for connection in answer.connections] == ["high"]


def test_stars_within_stars_are_walked_once() -> None:
    star = "[ sh:alternativePath ( sc:hasOutput [ sh:inversePath sc:hasOutput ] ) ]"
    for _ in range(5):
        star = f"[ sh:zeroOrMorePath {star} ]"
    assert isinstance(answered(f"sh:property [ sh:path {star} ; sh:minCount 1 ]"), Configuration)


def test_many_strangers_with_shapes_of_their_own_change_no_answer() -> None:
    strangers = "".join(
        f':s{k} a sc:Component, :Display ; sc:hasInput [ sc:name "i" ; sc:signalType :Pose ;'
        f" sc:accepts [ sh:property [ sh:path ( sc:rate sc:value ) ; sh:minInclusive {k} ] ] ] ;"
        f' sc:hasOutput [ sc:name "o" ; sc:signalType :Pose ] ; sc:preference -1 .\n'
        for k in range(100, 400)
    )
    display = ':show a sc:Component, :Display ; sc:hasInput [ sc:name "i" ; sc:signalType :Pose ] .\n'
    task = TASK.replace(":display a sc:Role ;", ":display a sc:Role ; sc:recruits true ;")
    alone, among = (
        configure(template(task), read(PREFIXES + OUTPUTS + display + others)) for others in ("", strangers)
    )
    assert isinstance(alone, Configuration)
    assert isinstance(among, Configuration)
    assert (alone.assignments, alone.recruits, alone.connections) == (
        among.assignments,
        among.recruits,
        among.connections,
    )


def test_an_output_that_takes_too_long_to_judge_feeds_nothing_and_is_named() -> None:
    port = 'sc:hasOutput [ sc:name "o" ; sc:signalType :Pose ]'
    accepts = 'sh:property [ sh:path ( [ sh:inversePath sc:hasOutput ] :model ) ; sh:pattern "^(?:(a|b|ab)+)\\\\1?$" ]'
    wants = f'sc:hasInput [ sc:name "i" ; sc:signalType :Pose ; sc:accepts [ {accepts} ] ]'
    ads = f""":slow a sc:Component, :Sensor ; :model "{"ab" * 40}!" ; {port} .
        :quick a sc:Component, :Sensor ; :model "aa" ; {port} . :show a sc:Component, :Display ; {wants} ."""
    ecology = AdvertisementIndex.of(read_advertisements((PREFIXES + ads).encode(), "ads")[0])
    partitioner = Partitioner(template(TASK).document, NOTHING_ABOVE)
    sensors, _ = partitioner.partition(ecology).candidates
    assert [bool(one.profile.outputs[0].conforms) for one in sensors] == [True, False]
    ((component, why),) = partitioner.not_judged.items()
    assert component == home("slow")
    assert why.reason.startswith(
        "its output 'o' feeds no input that accepts some outputs only: matching the sh:pattern"
    )
