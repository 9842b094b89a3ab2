"""The table of fields and the shape of an advertisement say the same, statement by statement and value by value."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from rdflib import RDF, SH, XSD, Graph, Literal, URIRef
from rdflib.collection import Collection
from rdflib.compare import isomorphic
from rdflib.term import Node

from selfconf import library
from selfconf.model import literal_values as numbers
from selfconf.model import term as model
from selfconf.model.profile import LONGEST_PORT_NAME, Profile
from selfconf.model.wording import STEERING_OR_BREAKING
from selfconf.rdf.advertisements import read_advertisements, reader
from selfconf.rdf.permitted_fields import (
    ACCEPTED_SHAPE,
    COMMAND_LINE,
    COMPONENT,
    COUNT,
    COUNT_FROM_ONE,
    DURATION,
    GROUNDING,
    HERTZ,
    INPUT,
    MOST,
    NAME_TEXT,
    NAMED_OR_TEXT,
    NEEDED_OPERATION,
    NODE,
    NUMBER,
    OF_COMPONENT,
    OPERATION,
    OUTPUT,
    PARAMETER,
    PORTS,
    POSITIVE,
    RATE,
    RESOURCE,
    SAID_BY,
    SECOND,
    SETTINGS,
    TRUE_OR_FALSE,
    Field,
    Subject,
    ValueKind,
)
from selfconf.rdf.positions import parse_with_positions
from selfconf.rdf.turtle import parse
from selfconf.rdf.validation.prefilter import prefilter
from selfconf.rdf.validation.shape_violations import Shapes, reported_violations
from selfconf.rdf.vocabulary import SC, SHAPES, UNIT
from tests.lab import PREFIXES

SHAPE = Graph().parse(next(path for path in library.shapes() if path.stem == "advertisement"))
SHAPES_NEEDED = Shapes.of(SHAPE)
TARGETS: dict[Node, tuple[Subject, ...]] = {
    URIRef(SC.Component): (COMPONENT,),
    URIRef(SC.hasInput): (INPUT,),
    URIRef(SC.hasOutput): (OUTPUT,),
    URIRef(SC.hasParameter): (PARAMETER,),
    URIRef(SC.rate): (RATE,),
    URIRef(SC.hasOperation): (OPERATION,),
    URIRef(SC.needsOperation): (NEEDED_OPERATION,),
    URIRef(SC.tolerates): (DURATION,),
    URIRef(SC.deadline): (DURATION,),
    URIRef(SC.grounding): (GROUNDING,),
}
"""What the node shapes of the file speak of, by the class or the property that makes it their target."""
ASKED: dict[int, set[tuple[str, object]]] = {
    id(RESOURCE): {("nodeKind", SH.IRI)},
    id(NAME_TEXT): {
        ("datatype", XSD.string),
        ("minLength", 1),
        ("maxLength", LONGEST_PORT_NAME),
        ("pattern", "([^)]|(^|[^(])[)])$"),
        ("not", frozenset((("pattern", f"[{STEERING_OR_BREAKING}]"),))),
    },
    id(COMMAND_LINE): {("datatype", XSD.string), ("pattern", r"\S")},
    id(NUMBER): {("node", URIRef(SHAPES.Number))},
    id(POSITIVE): {("node", URIRef(SHAPES.Number)), ("minExclusive", 0)},
    id(HERTZ): {("in", (URIRef(UNIT.HZ),))},
    id(SECOND): {("in", (URIRef(UNIT.SEC),))},
    id(COUNT): {
        ("datatype", XSD.integer),
        ("node", URIRef(SHAPES.Number)),
        ("minInclusive", 0),
        ("maxInclusive", MOST),
    },
    id(COUNT_FROM_ONE): {
        ("datatype", XSD.integer),
        ("node", URIRef(SHAPES.Number)),
        ("minInclusive", 1),
        ("maxInclusive", MOST),
    },
    id(TRUE_OR_FALSE): {("datatype", XSD.boolean)},
    id(NODE): {("nodeKind", SH.BlankNodeOrIRI)},
    id(ACCEPTED_SHAPE): {("nodeKind", SH.BlankNode)},
    id(NAMED_OR_TEXT): {
        (
            "or",
            frozenset(
                (frozenset((("nodeKind", SH.IRI),)), frozenset((("datatype", XSD.string), ("minLength", 1)))),
            ),
        )
    },
}
"""What a shape asks of a value of each kind."""
Asked = set[tuple[int, str, str, object]]


def in_the_table() -> Asked:
    """Subject, predicate and each constraint that the table amounts to."""
    found: Asked = set()
    for subject in {id(one): one for one in COMPONENT.walk()}.values():
        for field in subject.fields:
            said: set[tuple[str, object]] = {("minCount", field.least)} if field.least else set()
            said |= set() if field.most is None else {("maxCount", field.most)}
            if field.kind is not NODE and field.most != 0:
                said |= ASKED[id(field.kind)]
            found |= {(id(subject), field.predicate, *each) for each in said}
            if field.into.fields:  # the shape says it of the node, whatever leads to it
                found |= {(id(field.into), "", *each) for each in ASKED[id(field.kind)]}
    return found | {(id(COMPONENT), "", "nodeKind", SH.IRI)}


def in_the_shape() -> Asked:
    """Subject, predicate and each constraint of the property shapes and node kinds in the file."""
    found: Asked = set()
    for shape in SHAPE.subjects(RDF.type, SH.NodeShape):
        targets = [*SHAPE.objects(shape, SH.targetClass), *SHAPE.objects(shape, SH.targetObjectsOf)]
        for subject in (one for target in targets for one in TARGETS[target]):
            found |= {(id(subject), "", "nodeKind", kind) for kind in SHAPE.objects(shape, SH.nodeKind)}
            for each in SHAPE.objects(shape, SH.property):
                path = str(SHAPE.value(each, SH.path))
                found |= {(id(subject), path, *said) for said in constraints(each)}
    return found


def constraints(shape: Node) -> Iterator[tuple[str, object]]:
    """What a property shape asks of the values of its path."""
    for predicate, value in SHAPE.predicate_objects(shape):
        if predicate not in (RDF.type, SH.path, SH.message, URIRef(SHAPES.code)):
            word = str(predicate).removeprefix(str(SH))
            if word == "in":
                yield word, tuple(Collection(SHAPE, value))
            elif word == "not":
                yield word, frozenset(constraints(value))
            elif word == "or":
                yield word, frozenset(frozenset(constraints(each)) for each in Collection(SHAPE, value))
            else:
                yield word, value.toPython() if isinstance(value, Literal) else value


def test_the_table_and_the_shape_state_one_set_of_constraints() -> None:
    assert in_the_table() == in_the_shape()


def test_the_names_that_have_to_differ_are_those_of_the_shape() -> None:
    queries = [str(query) for query in SHAPE.objects(None, SH.select)]
    distinct = {link.predicate.short for link in COMPONENT.fields if any(field.distinct for field in link.into.fields)}
    assert distinct == {
        word
        for word in ("hasInput", "hasOutput", "hasParameter", "hasOperation", "needsOperation")
        if any(word in q for q in queries)
    }


def test_every_field_of_a_component_is_a_type_a_port_or_a_member_of_its_profile() -> None:
    assert {
        SC.hasOperation,
        SC.needsOperation,
        *(link.predicate for link in PORTS),
        *SETTINGS,
        SC.grounding,
    } == OF_COMPONENT
    assert {setting.member for setting in SETTINGS.values()} <= set(Profile.__dataclass_fields__)


@pytest.mark.parametrize("predicate", SETTINGS)
def test_a_field_of_one_value_is_read_as_its_member_by_the_careful_reader_and_by_the_fast_loader(
    predicate: model.IRI,
) -> None:
    field, member = COMPONENT[predicate], SETTINGS[predicate].member
    samples = {TRUE_OR_FALSE.words: "true"} | dict.fromkeys(
        (kind.words for kind in (NUMBER, POSITIVE, COUNT, COUNT_FROM_ONE)), "7"
    )
    value = "[ sc:value 7 ; sc:unit unit:SEC ]" if field.into.fields else samples[field.kind.words]
    text = f"{PREFIXES} :a a sc:Component , :Lamp ; <{predicate}> {value} ."
    (careful,), _ = reader.read_document(parse(text, "a.ttl"))
    (fast,), _ = read_advertisements(text.encode(), "a.ttl")
    assert getattr(careful.profile, member) == getattr(fast.profile, member) == (True if value == "true" else 7)


def test_what_says_what_only_a_component_says_has_to_be_declared_one() -> None:
    targets = {
        str(predicate)
        for shape in ("ComponentTyped", "PortsTyped")
        for predicate in SHAPE.objects(URIRef(SHAPES[shape]), SH.targetSubjectsOf)
    }
    assert targets == OF_COMPONENT


def test_what_an_advertisement_does_not_say_is_what_the_shapes_of_other_things_say() -> None:
    others = [Graph().parse(path) for path in library.shapes() if path.stem in ("template", "task", "configuration")]
    said = [
        (
            str(predicate),
            {str(owner) for one in (shape, *alternatives(graph, shape)) for owner in graph[one : SH["class"]]},
        )
        for graph in others
        for shape, predicate in graph.subject_objects(SH.targetSubjectsOf)
    ]
    found = {predicate: owners for predicate, owners in said if owners}
    assert found == {predicate: set(owners) for predicate, owners in SAID_BY.items()}


def alternatives(graph: Graph, shape: Node) -> Iterator[Node]:
    """The shapes to one of which a shape asks its nodes to conform."""
    for choice in graph[shape : SH["or"]]:
        yield from Collection(graph, choice)


@pytest.mark.parametrize("predicate", SAID_BY)
@pytest.mark.parametrize("place", ["", 'sc:hasOutput [ sc:name "a" ; sc:signalType :S ; VALUE ] ;'])
def test_what_only_something_else_says_keeps_a_component_out(predicate: model.IRI, place: str) -> None:
    said = f"<{predicate}> 1"
    text = f"{PREFIXES} :c a sc:Component, :L ; " + (place.replace("VALUE", said) if place else said) + " ."
    good, (bad,) = read_advertisements(text.encode(), "a.ttl")
    owners = " or ".join(f"a sc:{owner.short}" for owner in SAID_BY[predicate])
    assert not good
    but = ", and 'a' is an output" if place else ""
    assert bad.problems == (f"only {owners} has sc:{predicate.short}{but}",)
    assert not prefilter(text.encode()).clear


def test_a_component_that_is_also_a_template_may_have_a_priority() -> None:
    text = f"{PREFIXES} :c a sc:Component, sc:Template ; sc:priority 3 ."
    ((advertisement,), bad) = read_advertisements(text.encode(), "a.ttl")
    assert (advertisement.component.short, bad) == ("c", [])


def test_the_number_of_a_cost_is_the_number_of_an_advertisement() -> None:
    template = Graph().parse(next(path for path in library.shapes() if path.stem == "template"))
    one, other = SHAPE.cbd(URIRef(SHAPES.Number)), template.cbd(URIRef(SHAPES.CostNumber))
    renamed = Graph()
    for subject, predicate, value in other:
        renamed.add((URIRef(SHAPES.Number) if subject == URIRef(SHAPES.CostNumber) else subject, predicate, value))
    assert isomorphic(one, renamed)


TEXTS = (
    "5", "-5", "+5", "0", "-0", "05", "5.", "5.0", ".5", "1e3", "1E-3", "1e-400", "1e400", "INF", "-INF", "NaN", "inf",
    "infinity", "1_000", " 5", "5\n", "\u0663", "", "abc", "1,5", "0x5", "127", "128", "-129", "255", "256", "65536",
    "2147483648", "4294967296", "9223372036854775807", "9223372036854775808", "-9223372036854775808",
    "-9223372036854775809", "18446744073709551615", "18446744073709551616", "9" * 300, "9" * 301, "0." + "0" * 299,
)  # fmt: skip


def verdicts(text: str) -> tuple[set[str], set[str]]:
    """The components of a text that break the shape, and those in which the careful reader finds a problem."""
    graph, _ = parse_with_positions(text, "")
    found = reported_violations(graph, SHAPES_NEEDED.read, SHAPES_NEEDED.needed(graph))
    broken = {str(violation.focus) for violation in found}
    return broken, {str(component) for component, _, problems in reader.profiles(parse(text, "")) if problems}


def test_shape_reader_and_table_agree_on_every_form_of_number() -> None:
    literals = [
        model.Literal(text, model.IRI(datatype))
        for datatype in (*sorted(numbers.DATATYPES), str(XSD.boolean), model.STRING)
        for text in TEXTS
        if (datatype, text[:1].isdigit()) != (str(XSD.boolean), True)  # rdflib warns of them, one by one
    ]
    named = {f"urn:c{number}": literal.turtle("<{}>".format) for number, literal in enumerate(literals)}
    said = [f"<{one}> a sc:Component, :Lamp ; sc:preference {value} ." for one, value in named.items()]
    broken, refused = verdicts(PREFIXES + "\n".join(said))
    assert [named[one] for one in broken ^ refused] == []
    assert refused == {f"urn:c{number}" for number, literal in enumerate(literals) if not NUMBER.allows(literal)}


VALUES = st.sampled_from(
    (
        '"words"', '"call()"', '"()"', '")"', '"a)"', '" "', '""', '"mot"@fr', "7", "-2.5", "0", "1e3", "true",
        '"7"^^xsd:unsignedByte', '"INF"^^xsd:double',
        '"x"^^xsd:integer', "rob:Audio", "unit:HZ", "[]", "[ sc:value 5 ; sc:unit unit:HZ ]",
        "unit:SEC", "[ sc:value 5 ; sc:unit unit:SEC ]", "false", '"1"^^xsd:boolean', "1000000", "1000001", "+3", "-3",
        '[ sc:command "go" ]',
        '[ sc:name "in" ; sc:signalType rob:Audio ]', '"one", "two"', "rob:Audio, rob:Text", "1, 2",
    )
)  # fmt: skip
COMPONENTS = {
    ":c a sc:Component, :L ; VALUE .": COMPONENT,
    ':c a sc:Component, :L ; sc:hasInput [ sc:name "a" ; sc:signalType :S ; VALUE ] .': INPUT,
    ':c a sc:Component, :L ; sc:hasOutput [ sc:name "a" ; sc:signalType :S ; VALUE ] .': OUTPUT,
    ":c a sc:Component, :L ; sc:hasOutput [ sc:signalType :S ; VALUE ] .": OUTPUT,
    ":c a sc:Component, :L ; sc:hasParameter [ sc:parameterType :S ; VALUE ] .": PARAMETER,
    ':c a sc:Component, :L ; sc:hasParameter [ sc:name "a" ; VALUE ] .': PARAMETER,
    ':c a sc:Component, :L ; sc:hasOutput [ sc:name "a" ; sc:signalType :S ; sc:rate [ sc:value 5 ; VALUE ] ] .': RATE,
    ":c a sc:Component, :L ; sc:tolerates [ sc:value 5 ; VALUE ] .": DURATION,
    ":c a sc:Component, :L ; sc:deadline [ sc:unit unit:SEC ; VALUE ] .": DURATION,
    ":c a sc:Component, :L ; sc:grounding [ VALUE ] .": GROUNDING,
    ':c a sc:Component, :L ; sc:hasOperation [ sc:name "a" ; VALUE ] .': OPERATION,
    ':c a sc:Component, :L ; sc:needsOperation [ sc:name "a" ; VALUE ] .': NEEDED_OPERATION,
}
PLACES = [(field, text) for text, subject in COMPONENTS.items() for field in subject.fields]
SHAREABLE, OPTIONAL = (
    next(place for place in PLACES if place[0].predicate == field) for field in (SC.shareable, SC.optional)
)

PORT_NAME_PLACE = next(place for place in PLACES if place[0].predicate == SC.name)


@given(st.sampled_from(PLACES), VALUES)
@example(PLACES[4], '"1_000"^^xsd:integer')
@example(PLACES[4], '"true"^^xsd:boolean')
@example(SHAREABLE, '"1"^^xsd:boolean')
@example(SHAREABLE, '"TRUE"^^xsd:boolean')
@example(OPTIONAL, '"0"^^xsd:boolean')
@example(PORT_NAME_PLACE, r'"a\tb"')
@example(PORT_NAME_PLACE, r'"a\u202Eb"')
def test_shape_and_careful_reader_agree_on_any_value_anywhere(place: tuple[Field, str], value: str) -> None:
    text = PREFIXES + place[1].replace("VALUE", f"<{place[0].predicate}> {value}")
    broken, refused = verdicts(text)
    assert bool(broken) == bool(refused)
    assert not (broken and prefilter(text.encode()).clear)


@pytest.mark.parametrize(
    "kind",
    [RESOURCE, NAME_TEXT, COMMAND_LINE, NUMBER, POSITIVE, HERTZ, SECOND, COUNT, COUNT_FROM_ONE, TRUE_OR_FALSE],
    ids=lambda kind: str(kind.words),
)
def test_what_the_fast_loader_recognises_is_of_the_kind(kind: ValueKind) -> None:
    pattern = re.compile(kind.turtle)
    samples = [
        "<urn:a>", f"<{UNIT.HZ}>", f"<{UNIT.SEC}>", "<urn:selfconf:blank:x>", '"a"', '" "', '"a()"', '"a)"',
        '""', '"\\n"', '"a\u202eb"', '"a\u0085"',
        "0", "0.0", "00", "7",
        "-7", "+7",
        "2.5", "1e3", "1234567890", ".5", '"a"@en', "true",
    ]  # fmt: skip
    recognised = [sample for sample in samples if pattern.fullmatch(sample)]
    assert recognised
    for sample in recognised:
        ((_, _, value),) = parse(f"<urn:s> <urn:p> {sample} .", "").triples()
        assert kind.allows(value)
