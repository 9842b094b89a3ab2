"""pySHACL behind one function: only the shape that is asked for judges, with all that it refers to."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace

import pyshacl
import pytest
import rdflib
from hypothesis import given
from hypothesis import strategies as st
from pyshacl.errors import ConstraintLoadError

from selfconf.errors import TemplateError
from selfconf.model.obstacle import NotJudged, ShapeViolated
from selfconf.model.term import IRI
from selfconf.rdf import conformance, rdflib_terms
from selfconf.rdf.conformance import judged, violations
from selfconf.rdf.deadline import ProcessorTimeUp
from selfconf.rdf.turtle import document as turtle

HEAD = "@prefix : <urn:x:> . @prefix sh: <http://www.w3.org/ns/shacl#> .\n"
SUBJECTS = ':good :size 5 . :bad :size "five" . :bare :note 1 .'
NODES = [IRI("urn:x:good"), IRI("urn:x:bad"), IRI("urn:x:bare")]

LINKED = [IRI(f"urn:x:c{number}") for number in range(4)]
PATHS = st.sampled_from((":p", ":q"))
ASKED = st.sampled_from(
    ("sh:minCount 1", "sh:maxCount 1", "sh:nodeKind sh:IRI", "sh:hasValue 1", "sh:in ( :c0 :c1 1 )")
)


def outside(shapes: str) -> set[str]:
    """The local names of those who do not conform to `:shape`."""
    graphs = [rdflib_terms.to_rdflib(turtle.parse(HEAD + text, "a.ttl").triples()) for text in (SUBJECTS, shapes)]
    return {
        node.removeprefix("urn:x:") for node in violations(graphs[0], graphs[1], IRI("urn:x:shape"), NODES, "a.ttl")
    }


@pytest.mark.parametrize("property_", ["[ {} ]", ":named . :named {}"], ids=["in brackets", "with an IRI"])
def test_a_property_shape_counts_whether_it_has_an_iri_or_not(property_: str) -> None:
    asked = "sh:path :size ; sh:minCount 1 ; sh:nodeKind sh:Literal ; sh:minInclusive 1"
    assert outside(f":shape sh:property {property_.format(asked)} .") == {"bad", "bare"}


def test_a_node_shape_with_an_iri_counts() -> None:
    assert outside(":shape sh:node :other . :other sh:property [ sh:path :size ; sh:minCount 1 ] .") == {"bare"}


@pytest.mark.parametrize(
    "target",
    ["sh:targetNode :good", "sh:targetSubjectsOf :size", "a <http://www.w3.org/2000/01/rdf-schema#Class>"],
)
def test_no_other_shape_judges_whatever_its_targets_are(target: str) -> None:
    assert outside(f":shape sh:nodeKind sh:IRI . :other a sh:NodeShape ; {target} ; sh:nodeKind sh:Literal .") == set()


def test_the_targets_of_the_shape_itself_do_not_matter() -> None:
    assert outside(":shape sh:targetNode :bad ; sh:property [ sh:path :size ; sh:minCount 1 ] .") == {"bare"}


def test_a_pattern_that_takes_years_for_long_names_judges_nodes_with_short_ones() -> None:
    assert outside(":shape sh:pattern '^(?=([a-z:-]+)+!)' .") == {"good", "bad", "bare"}


def test_a_query_that_matches_a_costly_pattern_against_its_own_text_is_blamed_for_the_pattern() -> None:
    asked = f"SELECT $this {{ BIND (STR('{'a' * 80}!') AS ?text) FILTER (REGEX(?text, '^(a+)+\\\\\\\\1+$')) }}"
    with pytest.raises(TemplateError, match=r"cannot be judged: matching the pattern .* takes too long"):
        outside(f':shape sh:sparql [ sh:select "{asked}" ] .')


def test_a_query_that_would_leave_is_not_evaluated() -> None:
    with pytest.raises(TemplateError, match="leave out SERVICE"):
        outside(":shape sh:sparql [ sh:select 'SELECT $this { SERVICE <http://127.0.0.1:1/> { ?s ?p ?o } }' ] .")


class Paced:
    """Judges nodes that take so many seconds each, by a clock that goes on with that alone."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.now = self.limit = 0.0
        monkeypatch.setattr(conformance, "time", SimpleNamespace(process_time=lambda: self.now))
        monkeypatch.setattr(conformance, "processor_limit", self.limited)
        self.shares = conformance._Shares(0.0)

    @contextmanager
    def limited(self, seconds: float) -> Iterator[None]:
        """Note the limit of what is judged."""
        self.limit = seconds
        yield

    def judge(self, size: int, seconds: float, conforms: bool) -> bool:
        """Judge a node; whether it was judged in time."""

        def judged() -> list[tuple[str, rdflib.BNode, list[object]]] | None:
            self.now += min(seconds, self.limit)
            if seconds > self.limit:
                raise ProcessorTimeUp
            return None if conforms else [("no", rdflib.BNode(), [])]

        try:
            return (self.shares.judged(size, judged) is None) is conforms
        except ProcessorTimeUp:
            return False


@pytest.mark.parametrize("growth", [0.0, 0.5, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("first", [0.003, 0.02, 0.09])
def test_what_does_not_conform_takes_little_however_its_times_are_chosen(
    monkeypatch: pytest.MonkeyPatch, growth: float, first: float
) -> None:
    pace = Paced(monkeypatch)
    assert all(pace.judge(1, 0.001, True) for _ in range(5))
    for number in range(1000):
        pace.judge(2 + number // 10, first * (1 + number / 10) ** growth, False)
    assert pace.now < 1000 * conformance.SHARE_SECONDS + conformance.SLOW_SECONDS + 2 * conformance.FAILURE_SECONDS
    assert pace.judge(1, 0.001, True)


def test_a_shape_that_is_slow_to_judge_is_judged_of_all_that_conform(monkeypatch: pytest.MonkeyPatch) -> None:
    pace = Paced(monkeypatch)
    assert all(pace.judge(1 + number % 7, 0.03, number % 3 == 0) for number in range(1000))


def test_an_error_of_the_wording_is_not_taken_for_one_of_the_component(monkeypatch: pytest.MonkeyPatch) -> None:
    def mistaken(*_: object) -> str:
        raise KeyError("wording")

    monkeypatch.setattr(conformance, "violation_words", mistaken)
    subjects, shapes = rdflib.Graph(), rdflib.Graph().parse(data="<urn:s> <http://www.w3.org/ns/shacl#class> <urn:T> .")
    with pytest.raises(KeyError, match="wording"):
        violations(subjects, shapes, IRI("urn:s"), [IRI("urn:a")], "a.ttl")


def asking(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    """Property shapes that ask the values of a path to conform to others."""
    within = st.sampled_from(
        (
            "sh:property [ {} ]",
            "sh:node [ sh:property [ {} ] ]",
            "sh:or ( [ {} ] [ sh:in ( :c1 ) ] )",
            "sh:not [ {} ]",
            "sh:qualifiedValueShape [ {} ] ; sh:qualifiedMinCount 1",
            "sh:qualifiedValueShape [ {} ] ; sh:qualifiedMaxCount 1",
        )
    )
    return st.builds(lambda path, form, shape: f"sh:path {path} ; {form.format(shape)}", PATHS, within, inner)


PLAIN = st.builds("sh:path {} ; {}".format, PATHS, ASKED)
LINKS = st.lists(st.tuples(st.integers(0, 3), PATHS, st.sampled_from((":c0", ":c1", ":c2", ":c3", ":other", "1"))))


@given(asking(st.one_of(PLAIN, asking(PLAIN))), LINKS)
def test_each_of_many_is_judged_as_it_is_alone(shape: str, links: list[tuple[int, str, str]]) -> None:
    said = "".join(f" :c{number} {path} {value} ." for number, path, value in links)
    texts = (f":other :p :c0 .{said}", f":shape sh:property [ {shape} ] .")
    subjects, shapes = (rdflib_terms.to_rdflib(turtle.parse(HEAD + text, "a.ttl").triples()) for text in texts)
    alone = set()
    for node in LINKED:
        asked = rdflib.Graph() + shapes
        asked.add((rdflib.URIRef("urn:x:shape"), rdflib.SH.targetNode, rdflib.URIRef(node)))
        if not pyshacl.validate(subjects, shacl_graph=asked)[0]:
            alone.add(node)
    assert violations(subjects, shapes, IRI("urn:x:shape"), LINKED, "a.ttl").keys() == alone


def test_a_value_that_is_a_candidate_is_not_blamed_for_what_links_to_it() -> None:
    graphs = [
        rdflib_terms.to_rdflib(turtle.parse(HEAD + text, "a.ttl").triples())
        for text in (
            ":good :link :bad . :bad :link :thing .",
            ":shape sh:property [ sh:path :link ; sh:property :named ] . :named sh:path :n ; sh:minCount 1 .",
        )
    ]
    found = violations(graphs[0], graphs[1], IRI("urn:x:shape"), NODES, "a.ttl")
    assert found.keys() == {"urn:x:good", "urn:x:bad"}
    assert {str(violation) for (violation,) in found.values()} == {
        "violates: there is no n of thing",
        "violates: there is no n of bad",
    }


@pytest.mark.parametrize(
    ("messages", "told"),
    [
        ("'zu klein'@de , 'too small'@en-GB", "too small"),
        ("'too small'@en , 'small'", "small"),
        ("'zu klein'@de , 'small'", "small"),
        ("'zu klein'@de , 'trop petit'@fr", "zu klein"),
    ],
)
def test_of_a_message_in_several_languages_that_in_english_is_told(messages: str, told: str) -> None:
    graphs = [
        rdflib_terms.to_rdflib(turtle.parse(HEAD + text, "a.ttl").triples())
        for text in (
            ":good :link :bad .",
            f":shape sh:property [ sh:path :n ; sh:minCount 1 ; sh:message {messages} ] .",
        )
    ]
    found = violations(graphs[0], graphs[1], IRI("urn:x:shape"), NODES, "a.ttl")
    assert {violation.message for some in found.values() for violation in some} == {told}


def test_a_violation_of_a_shape_within_a_shape_is_told_by_its_details() -> None:
    graphs = [
        rdflib_terms.to_rdflib(turtle.parse(HEAD + text, "a.ttl").triples())
        for text in (
            ":good :link :bad .",
            ":shape sh:property [ sh:path :link ; sh:node [ sh:nodeKind sh:Literal ] ] .",
        )
    ]
    ((violation,),) = violations(graphs[0], graphs[1], IRI("urn:x:shape"), NODES, "a.ttl").values()
    assert isinstance(violation, ShapeViolated)
    assert violation.message == "link is bad, not a Literal"


def test_a_shape_that_comes_back_to_itself_is_judged_in_silence(capfd: pytest.CaptureFixture[str]) -> None:
    assert outside(":shape sh:node :shape ; sh:property [ sh:path :size ; sh:minCount 1 ] .") == {"bare"}
    assert capfd.readouterr() == ("", "")


def test_what_is_wrong_with_a_shape_is_raised_and_not_logged_besides(
    capfd: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    asked = ":shape a sh:NodeShape ; sh:sparql [ sh:message 'no query' ] ."
    with pytest.raises(TemplateError, match="at least one sh:select"):
        outside(asked)
    graph = rdflib_terms.to_rdflib(turtle.parse(HEAD + asked + ":shape sh:targetNode :x .", "a.ttl").triples())
    with pytest.raises(ConstraintLoadError):
        judged(graph, graph)
    assert not caplog.records
    assert capfd.readouterr().err == ""


def test_an_error_without_words_is_at_least_named() -> None:
    with pytest.raises(TemplateError, match=r"well-formed: \w+"):
        outside(":shape sh:property [ sh:path :size ; sh:minInclusive :x ] .")


@pytest.mark.parametrize(
    "asked",
    [
        "sh:path ( " + ":next " * 12 + ") ; sh:minCount 1",
        "sh:path :next ; sh:property [ " * 17 + "sh:path :next" + " ]" * 17,
    ],
    ids=["steps of a path", "shapes within shapes"],
)
def test_what_lies_deeper_than_pyshacl_follows_is_not_judged(asked: str) -> None:
    chain = ":good :next :n0 . " + "".join(f":n{number} :next :n{number + 1} . " for number in range(30))
    graphs = [
        rdflib_terms.to_rdflib(turtle.parse(HEAD + text, "a.ttl").triples())
        for text in (chain, f":shape sh:property [ {asked} ] .")
    ]
    found = violations(graphs[0], graphs[1], IRI("urn:x:shape"), [IRI("urn:x:good")], "a.ttl")
    assert found == {NODES[0]: [NotJudged("the shape leads deeper into what it says than pySHACL follows")]}
