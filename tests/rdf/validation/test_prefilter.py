"""The first look: what it clears conforms, and what is plainly right it clears."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rdflib import Graph

from selfconf.rdf.validation.prefilter import prefilter
from selfconf.rdf.validation.shape_violations import reported_violations
from tests.harness.effort import examples
from tests.shipped import shipped_shapes

HEAD = """\
@prefix : <https://example.org/home#> .
@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix unit: <http://qudt.org/vocab/unit/> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
"""
GOOD = """
:cap a sc:Component, rob:NavigationControl ;
    rdfs:label "Thinking Cap"@en ;
    sc:hasInput [ a sc:Input ; sc:name "sonar" ; sc:signalType rob:RangeScan ] ,
        [ sc:name "position" ; sc:signalType rob:PlanarPose2D ] ;
    sc:hasOutput [ sc:name "sonar" ; sc:signalType rob:Velocity2D ; sc:rate [ sc:value 5.0 ; sc:unit unit:HZ ] ] ;
    sc:hasParameter [ sc:name "goal" ; sc:parameterType rob:BehaviouralGoal ] ;
    sc:grounding [ a sc:Grounding ; sc:command "thinking-cap" ] ;
    rob:support :Astrid ; :weight 2.5 ; sc:preference 10 .
:Astrid a rob:Robot ; rdfs:label "Astrid" .
"""
SHAPES = shipped_shapes()

TERMS = st.sampled_from(
    (
        '"sound"', '"music"', '""', '"sound"@en', "1", "2.5", "-3", "0", "1e3", "true", '"INF"^^xsd:double', ":thing",
        '"7"^^xsd:int', '"x"^^xsd:integer', "[]", "rob:Audio", "rob:Text", "unit:HZ", "sc:Role", "sc:Component",
        "[ sc:value 5 ; sc:unit unit:HZ ]", "[ sc:value 0 ; sc:unit unit:HZ ]", '[ sc:command "go" ]', "()", "( 1 )",
    )
)  # fmt: skip
NAMES = st.sampled_from(('"sound"', '"music"', '"sound", "music"', '""', '"sound"@en', ":sound"))
KINDS = st.sampled_from(("rob:Audio", "rob:Audio, rob:Text", '"Audio"', "[]"))
PROPERTIES = st.sampled_from(
    ("a", "sc:name", "sc:signalType", "sc:parameterType", "sc:preference", "sc:rate", "sc:grounding", "sc:command",
     "sc:hasInput", "sc:hasOutput", "sc:hasParameter", "sc:value", "sc:unit", "sc:feeds", "sc:minCount", "sc:roles",
     "rdfs:label", "rdfs:subClassOf", "sh:class", "rob:place")
)  # fmt: skip


@st.composite
def ports(draw: st.DrawFn) -> str:
    link, kind = draw(
        st.sampled_from(
            (
                ("sc:hasInput", "sc:signalType"),
                ("sc:hasOutput", "sc:signalType"),
                ("sc:hasParameter", "sc:parameterType"),
                ("sc:hasOutput", "sc:parameterType"),
            )
        )
    )
    parts = [f"sc:name {draw(NAMES)}"] if draw(st.integers(0, 9)) else []
    parts += [f"{kind} {draw(KINDS)}"] if draw(st.integers(0, 9)) else []
    parts += [f"sc:rate {draw(TERMS)}"] if not draw(st.integers(0, 5)) else []
    return f"{link} [ {' ; '.join(parts)} ]"


@st.composite
def advertisements(draw: st.DrawFn) -> str:
    subject = draw(st.sampled_from((":tuner", ":tuner", ":tuner", "[]")))
    types = draw(st.sampled_from(("sc:Component, rob:Tuner", "sc:Component, rob:Tuner", "sc:Component", "rob:Tuner")))
    said = [f"a {types}", *draw(st.lists(ports(), max_size=3))]
    said += [f"{draw(PROPERTIES)} {draw(TERMS)}" for _ in range(draw(st.integers(0, 2)))]
    others = [f"\n:thing {draw(PROPERTIES)} {draw(TERMS)} ." for _ in range(draw(st.integers(0, 1)))]
    return f"{HEAD}{subject} {' ; '.join(said)} .{''.join(others)}"


@settings(max_examples=examples(150), deadline=None)
@given(advertisements())
def test_no_bad_file_is_cleared_and_no_query_is_missed(text: str) -> None:
    graph = Graph().parse(data=text, format="turtle")
    found = set(reported_violations(graph, SHAPES.read))
    if prefilter(text.encode()).clear:
        assert not found
    assert found == set(reported_violations(graph, SHAPES.read, SHAPES.needed(graph)))


def test_a_good_advertisement_is_cleared() -> None:
    screened = prefilter((HEAD + GOOD).encode())
    assert screened.clear
    assert screened.components == ["https://example.org/home#cap"]


def test_an_input_that_accepts_what_says_nothing_is_not_cleared() -> None:
    nothing = ':b a sc:Component, :Cap ; sc:hasInput [ sc:name "i" ; sc:signalType :T ; sc:accepts [ ] ] .'
    assert prefilter((HEAD + nothing.replace(" ; sc:accepts [ ]", "")).encode()).clear
    assert not prefilter((HEAD + nothing).encode()).clear


@pytest.mark.parametrize("path", sorted((Path(__file__).parents[2] / "bad").glob("*.ttl")), ids=lambda path: path.stem)
def test_no_file_that_breaks_a_shape_is_cleared(path: Path) -> None:
    if any(f"[SC-{letter}" in path.read_text("utf-8").partition("\n")[0] for letter in "STAKCO"):
        assert not prefilter(path.read_bytes(), "file:///").clear


def test_reading_goes_on_after_a_syntax_error() -> None:
    text = HEAD + ":a :b , .\n:c :d :e .\n:f x:g :h .\n"
    assert [(problem.line, problem.column) for problem in prefilter(text.encode()).problems] == [(8, 7), (10, 4)]


def test_triples_of_turtle_1_2_are_not_cleared() -> None:
    assert not prefilter((HEAD + ":a :b <<( :c :d :e )>> .").encode()).clear
