"""Streaming makes of a document what the careful reader makes of it."""

from __future__ import annotations

import time
from collections import Counter

import pyoxigraph as ox
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from selfconf.errors import TurtleError
from selfconf.rdf.advertisements import loader, statement_table
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.advertisements.advertisement import Advertisement, MalformedAdvertisement
from selfconf.rdf.advertisements.loader import LoadedAdvertisement
from selfconf.rdf.advertisements.segments import SegmentCache
from selfconf.rdf.permitted_fields import SETTINGS
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.turtle.document import Triple
from selfconf.rdf.turtle.serialization import ntriples
from selfconf.rdf.vocabulary import SC, TYPE
from tests.lab import ADVERTISEMENTS, PREFIXES, iri

VALUES = st.sampled_from(
    (
        ":Astrid", ":kitchen", ":c1", '"words"', '"a , b ;\\n\\t.\\n <x> \\"q\\""', '"mot"@fr', "7", "-2.50", "1e3",
        "true", '"07"^^xsd:int', "[ :unit :m ; :value 2 ]", "[ :range [ :from 1 ; :to 2 ] ]", "[]", "( 1 2 )",
    )
)  # fmt: skip
NAMES = st.sampled_from(('"scan"', '"pose"', '""', '"a\\"b"', '"scan"@en', "3"))
SIGNALS = st.sampled_from(("rob:RangeScan", "rob:PlanarPose2D", '"text"'))
PORTS = st.one_of(
    st.builds("[ sc:name {} ; sc:signalType {} ]".format, NAMES, SIGNALS),
    st.builds("[ a sc:Output ; sc:name {} ; sc:signalType {} ]".format, NAMES, SIGNALS),
    st.builds("[ sc:signalType {1} ; sc:name {0} ; rdfs:label 'port' ]".format, NAMES, SIGNALS),
    st.builds(
        "[ sc:name {} ; sc:signalType {} ; sc:rate [ sc:value {} ; sc:unit unit:HZ ] ]".format,
        NAMES, SIGNALS, st.sampled_from(("5.0", "0", '"fast"')),
    ),
    st.builds(
        "[ sc:name {} ; sc:signalType {} ; sc:depth {} ]".format,
        NAMES, SIGNALS, st.sampled_from(("5", "0", "007", "1 , 2", "1.5")),
    ),
    st.sampled_from(("[]", "[ sc:name 'x' ]", ":shared-port", "'port'")),
)  # fmt: skip
CLAUSES = st.one_of(
    st.builds("a {}".format, st.sampled_from(("sc:Component", "rob:Encoder", "sc:Component, :T", "owl:Thing", "'x'"))),
    st.builds("sc:hasInput {}".format, PORTS),
    st.builds("sc:hasOutput {} , {}".format, PORTS, PORTS),
    st.builds(
        "sc:hasParameter [ sc:name {} ; sc:parameterType {} ]".format, NAMES, st.sampled_from((":Goal", "'Goal'"))
    ),
    st.builds("sc:preference {}".format, st.sampled_from(("1", "2.5", '"high"', "1 , 1", "1 , 2"))),
    st.builds(
        "sc:shareable {}".format,
        st.sampled_from(("true", "false", '"1"^^xsd:boolean', '"yes"', "true , false", "1")),
    ),
    st.builds("sc:restarts {}".format, st.sampled_from(("0", "5", "-1", "2.5", "1 , 2", "9999999"))),
    st.builds(
        "sc:{} [ sc:value {} ; sc:unit {} ]".format,
        st.sampled_from(("tolerates", "deadline")),
        st.sampled_from(("0.5", "2", "-1", "0")),
        st.sampled_from(("unit:SEC", "unit:SEC , unit:MIN", "unit:HZ")),
    ),
    st.sampled_from(("sc:deadline [ sc:unit unit:SEC ; sc:value 1 ]", "sc:deadline :kitchen", "sc:tolerates 2")),
    st.builds("sc:grounding [ sc:command {} ]".format, st.sampled_from(('"go --fast"', "5", '"a", "b"'))),
    st.sampled_from(("sc:grounding :kitchen", "sc:command 'go'", "sc:grounding 'go'")),
    st.builds("{} {}".format, st.sampled_from((":place", "rob:support", "rdfs:label", "rdfs:domain")), VALUES),
    st.builds(":near {} , {}".format, VALUES, VALUES),
    st.just(":with [ a sc:Component, :Inner ]"),
)
SUBJECTS = st.sampled_from((":c1", ":c2", ":c3", ":kitchen", ":shared-port", "[]"))
GOOD = "a sc:Component, rob:Encoder ; sc:hasOutput [ sc:name 'ticks' ; sc:signalType rob:Odometry2D ]"


@st.composite
def documents(draw: st.DrawFn) -> str:
    """Turtle about a few subjects, mostly advertisements, some of it wrong."""
    statements = []
    for _ in range(draw(st.integers(1, 5))):
        said = [GOOD] if draw(st.booleans()) else []
        said += draw(st.lists(CLAUSES, max_size=4))
        if said:
            statements.append(f"{draw(SUBJECTS)} {' ; '.join(said)} .")
    return PREFIXES + "@prefix owl: <http://www.w3.org/2002/07/owl#> .\n" + "\n".join(statements)


def shape_of(triples: tuple[Triple, ...]) -> list[str]:
    """Triples, whatever their blank nodes are called."""
    dataset = ox.Dataset(
        ox.Quad(t.subject, t.predicate, t.object) for t in ox.parse(ntriples(triples), format=ox.RdfFormat.N_TRIPLES)
    )
    dataset.canonicalize(ox.CanonicalizationAlgorithm.UNSTABLE)
    return sorted(map(str, dataset))


def told(found: tuple[list[Advertisement], list[MalformedAdvertisement]]) -> tuple[object, object]:
    """All that is to be the same, whatever blank nodes are called."""
    good, bad = found
    return (
        [
            (
                a.component,
                a.types,
                Counter((p, "[]" if type(v).__name__ == "BlankNode" else v) for p, v in a.profile.properties),
                (a.profile.inputs, a.profile.outputs, a.profile.parameters),
                [getattr(a.profile, setting.member) for setting in SETTINGS.values()],
                (a.profile.command, a.profile.inside),
                str(a.profile.place),
                shape_of(a.triples),
            )
            for a in good
        ],
        [("[]" if m.component.startswith("_:") else m.component, m.problems, m.place) for m in bad],
    )


@given(documents())
@example(PREFIXES + f":c1 {GOOD} ; :place ( 1 2 ) .")
@example(PREFIXES + f":c1 {GOOD} ; sc:hasInput [ sc:signalType :S ; sc:name 'in' ; rdfs:label 'port' ] .")
@example(PREFIXES + f":c1 {GOOD} ; :near [] , [] .")
@example(PREFIXES + f":c1 {GOOD} ; :size [ :of [ :unit 'm' ] ; :by 'hand' ] , [] , [ :by 'eye' ] .")
@example(PREFIXES + f":c1 {GOOD} . [] {GOOD} . :c1 rob:support :c2 . :c2 {GOOD} ; sc:hasInput :shared-port .")
@example(PREFIXES + f":c1 {GOOD} . _:b {GOOD} .")
@example(PREFIXES + f":c1 {GOOD} . :c2 sc:preference 1 . [] sc:preference 1 . :c3 a sc:Template ; sc:preference 1 .")
@example(PREFIXES + f":c1 {GOOD} ; :place :kitchen . :c2 {GOOD} ; :place :kitchen . :kitchen :size [ :value 3 ] .")
def test_the_fast_loader_reads_what_the_careful_reader_reads(text: str) -> None:
    careful = advertisements.read_document(turtle.parse(text, "a.ttl", "file:///a.ttl"))
    fast = loader.read_advertisements(text.encode(), "a.ttl", "file:///a.ttl")
    assert told(fast) == told(careful)
    for one, other in zip(fast[0], careful[0], strict=True):
        assert one.breadth >= other.breadth
        assert other.self_contained or not one.self_contained
        assert (str(one.place), str(other.place)) == ("a.ttl", "a.ttl")


def test_a_document_longer_than_a_window_is_read_as_one() -> None:
    text = PREFIXES + "\n".join(f":c{k} {GOOD} ; rob:support :robot{k % 7} ." for k in range(500))
    good, bad = loader.read_advertisements(text.encode(), "a.ttl")
    assert (len(good), bad) == (500, [])
    assert told((good, bad)) == told(advertisements.read_document(turtle.parse(text, "a.ttl")))


def test_documents_may_share_their_segments() -> None:
    shared = SegmentCache()
    found = [
        loader.read_advertisements((PREFIXES + text).encode(), name, None, shared)[0][0]
        for name, text in ADVERTISEMENTS.items()
    ]
    assert [a.profile.place and a.profile.place.source for a in found] == list(ADVERTISEMENTS)
    assert found[2].profile.preference == 10


def test_blank_nodes_of_two_advertisements_are_never_the_same() -> None:
    text = PREFIXES + f":c1 {GOOD} ; :size [ :value 3 ] . :c2 {GOOD} ; :size [ :value 3 ] ."
    (one, other), _ = loader.read_advertisements(text.encode(), "a.ttl")
    assert one.profile.values(iri("size")) != other.profile.values(iri("size"))
    assert one != other


def test_what_is_no_turtle_is_blamed_by_line_and_column() -> None:
    with pytest.raises(TurtleError, match=r"a\.ttl:2:5: not Turtle"):
        loader.read_advertisements(b"<urn:a> <urn:b> <urn:c> .\n<x> ; .", "a.ttl", "file:///")


@pytest.mark.parametrize("form", [':c1 rdfs:label "{}" .', ":c1 a sc:Component, :A ; rdfs:label '''{}''' ."])
def test_a_literal_that_is_too_long_for_the_parser_is_blamed_on_its_file(form: str) -> None:
    text = (PREFIXES + form.format("a" * (17 << 20))).encode()
    with pytest.raises(TurtleError, match=r"big\.ttl: a literal in it is over 16 MiB"):
        loader.read_advertisements(text, "big.ttl")
    with pytest.raises(TurtleError, match="over 16 MiB"):
        turtle.parse(text, "big.ttl")


def test_ports_with_names_take_time_as_there_are_ports(monkeypatch: pytest.MonkeyPatch) -> None:
    port = "sc:name 'in' ; sc:signalType :S"
    text = PREFIXES + "".join(f":c{k} {GOOD} ; sc:hasInput :in{k} . :in{k} {port} .\n" for k in range(50))
    careful = told(advertisements.read_document(turtle.parse(text, "a.ttl")))
    monkeypatch.setattr(advertisements, "profiles", None)  # nobody looks at one by one
    found = loader.read_advertisements(text.encode(), "a.ttl")
    assert told(found) == careful
    assert iri("in7") in {value for _, _, value in found[0][7].triples}


def test_blank_nodes_with_labels_are_the_same_in_one_document_and_others_in_another() -> None:
    text = PREFIXES + f":c1 {GOOD} ; :near _:x . :c2 {GOOD} ; :near _:x . _:x :near _:y ; rdfs:label 'x' ."
    one, other = loader.read_advertisements(text.encode(), "a.ttl")[0]
    again, _ = loader.read_advertisements(text.encode(), "a.ttl")[0]
    assert one.profile.values(iri("near")) == other.profile.values(iri("near")) != again.profile.values(iri("near"))
    assert one.profile.values(iri("near"))[0] in {subject for subject, _, _ in one.triples}


def test_a_component_that_is_a_blank_node_is_left_out_with_a_label_and_without() -> None:
    for subject in ("[]", "_:b"):
        good, bad = loader.read_advertisements(f"{PREFIXES} :c1 {GOOD} . {subject} {GOOD} .".encode(), "a.ttl")
        assert [one.component for one in good] == [iri("c1")]
        assert [one.problems for one in bad] == [("a component needs an IRI, so that others can speak of it",)]


def test_a_component_whose_iri_turns_the_direction_of_writing_is_left_out() -> None:
    others = " ".join(f"<urn:x:b{number}> {GOOD} ." for number in range(6))
    good, bad = loader.read_advertisements(f"{PREFIXES} {others} <urn:x:b\u202e> {GOOD} .".encode(), "a.ttl")
    assert len(good) == 6
    assert [one.problems for one in bad] == [
        ("the IRI of a component has no characters that turn the direction of writing",)
    ]


def test_oxigraph_writes_a_subject_as_the_fast_loader_expects_it() -> None:
    text = "<s:a> a <s:T> , <s:U> ; <s:p> 'x\ty ;\\n\\t' , [ <s:q> 1 ; <s:r> [ <s:q> 2 ] ] ."
    parser = ox.parse(text, format=ox.RdfFormat.TURTLE)
    written = (ox.serialize(parser, format=ox.RdfFormat.TURTLE) or b"").decode()
    lines = [
        block.partition(" ")[2].split(statement_table.NEXT)
        for block in written[: -len(statement_table.END)].split(statement_table.END)
    ]
    assert lines[0] == ["a <s:T> , <s:U>", '<s:p> "x\\ty ;\\n\\t"']
    assert [line[0].partition(" ")[0] for line in lines[1:]] == ["<s:q>", "<s:q>", "<s:r>", "<s:p>"]


def _seconds(text: str) -> float:
    """Processor time of loading a text, the least of three."""
    found = []
    for _ in range(3):
        began = time.process_time()
        loader.read_advertisements(text.encode(), "a.ttl")
        found.append(time.process_time() - began)
    return min(found)


@pytest.mark.slow
@pytest.mark.parametrize("block", [":c a sc:Component, :C ; :p {} .\n", ":c a sc:Component, :C{0} ; :p {0} .\n"])
def test_a_block_repeated_for_one_subject_costs_as_much_each_time(block: str) -> None:
    few, many = ("".join([PREFIXES, *(block.format(number) for number in range(size))]) for size in (1_000, 8_000))
    assert _seconds(many) < 30 * _seconds(few) + 0.1  # 8 times, or 64 if it were quadratic


def test_a_subject_of_many_types_makes_one_statement_of_them_each_time_it_is_read() -> None:
    text = PREFIXES + ":c a sc:Component . " + "".join(f":c a :C{number} ; :p {number} . " for number in range(3_000))
    segments = SegmentCache()
    for _ in range(3):
        (one,), _ = loader.read_advertisements(text.encode(), "a.ttl", segments=segments)
        assert len(one.types) == 3_001
    assert sum(statement.slot is TYPE for statement in segments.values()) <= 3_003


def test_a_list_in_the_place_of_a_type_keeps_out_its_component_alone() -> None:
    text = PREFIXES + ":c a ( :X :Y ), sc:Component, :K . :d a sc:Component, :K ."
    good, bad = loader.read_advertisements(text.encode(), "a.ttl")
    assert [one.component for one in good] == [iri("d")]
    assert [one.component for one in bad] == [iri("c")]


@pytest.mark.parametrize("kind", ["owl:Class", "sh:NodeShape", "rdfs:Class", "rdf:Property", "rdf:Bag", ":owl"])
def test_types_that_an_advertisement_may_not_give_are_left_out(kind: str) -> None:
    text = PREFIXES + "@prefix owl: <http://www.w3.org/2002/07/owl#> . "
    text += "@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> . "
    text += f":c a sc:Component, {kind}, :C ; :p [ a {kind} ] ."
    good, _ = loader.read_advertisements(text.encode(), "a.ttl")
    careful, _ = advertisements.read_document(turtle.parse(text, "a.ttl"))
    assert [one.types for one in good] == [one.types for one in careful]
    assert len(good[0].types) == (3 if kind in ("rdf:Bag", ":owl") else 2)


def test_labels_of_blank_nodes_are_read_as_brackets_wherever_they_are_described() -> None:
    lines = [
        f"<urn:c> a <{SC.Component}> .",
        "<urn:c> a <urn:Kind> .",
        f"<urn:c> <{SC.hasOutput}> _:o .",
        f'_:o <{SC.name}> "out" .',
        f"_:o <{SC.signalType}> <urn:Signal> .",
        "<urn:c> <urn:list> _:l .",
        "_:l <http://www.w3.org/1999/02/22-rdf-syntax-ns#first> _:m .",
        "_:l <http://www.w3.org/1999/02/22-rdf-syntax-ns#rest> <http://www.w3.org/1999/02/22-rdf-syntax-ns#nil> .",
        '_:m <urn:p> "_:o" .',
    ]
    for order in (lines, lines[::-1], [*lines[4:], *lines[:4]]):
        text = "\n".join(order).encode()
        (one,), _ = loader.read_advertisements(text, "a.nt.ttl")
        (other,), _ = advertisements.read_document(turtle.parse(text, "a.nt.ttl"))
        assert isinstance(one, LoadedAdvertisement)
        assert one.profile.outputs == other.profile.outputs != ()
        assert len(one.triples) == len(other.triples) == len(lines)


def test_a_blank_node_that_two_components_share_stays_one_node() -> None:
    shared = f"<urn:{{}}> a <{SC.Component}>, <urn:Kind> ; <urn:room> _:room . "
    text = "".join(map(shared.format, "ab")) + '_:room <urn:name> "hall" .'
    found, _ = loader.read_advertisements(text.encode(), "a.ttl")
    rooms = {value for one in found for predicate, value in one.profile.properties if predicate == "urn:room"}
    assert len(found) == 2
    assert len(rooms) == 1
