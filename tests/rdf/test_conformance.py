"""pySHACL behind one function: only the shape that is asked for judges, with all that it refers to."""

from __future__ import annotations

import pyshacl
import pytest
import rdflib
from hypothesis import given
from hypothesis import strategies as st
from pyshacl.constraints import constraint_component

from selfconf.errors import TemplateError
from selfconf.model.term import IRI
from selfconf.rdf import rdflib_terms
from selfconf.rdf.conformance import violations
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


def test_a_query_that_would_leave_is_not_evaluated() -> None:
    with pytest.raises(TemplateError, match="leave out SERVICE"):
        outside(":shape sh:sparql [ sh:select 'SELECT $this { SERVICE <http://127.0.0.1:1/> { ?s ?p ?o } }' ] .")


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
    assert all("Less than 1 values" in violation.message for (violation,) in found.values())


def test_a_shape_that_comes_back_to_itself_is_judged_in_silence(capfd: pytest.CaptureFixture[str]) -> None:
    assert outside(":shape sh:node :shape ; sh:property [ sh:path :size ; sh:minCount 1 ] .") == {"bare"}
    assert capfd.readouterr() == ("", "")


def test_an_error_without_words_is_at_least_named() -> None:
    with pytest.raises(TemplateError, match=r"well-formed: \w+"):
        outside(":shape sh:property [ sh:path :size ; sh:minInclusive :x ] .")


def test_the_text_of_a_report_that_nothing_reads_is_not_written(monkeypatch: pytest.MonkeyPatch) -> None:
    def written(graph: object, node: object) -> str:
        raise AssertionError("a term was written into a report")

    monkeypatch.setattr(constraint_component, "stringify_node", written)
    shape = ":shape a sh:NodeShape ; sh:property [ sh:path :size ; sh:in ( 7 ) ; sh:minCount 2 ] ."
    texts = SUBJECTS, shape
    graphs = [rdflib_terms.to_rdflib(turtle.parse(HEAD + text, "a.ttl").triples()) for text in texts]
    found = violations(graphs[0], graphs[1], IRI("urn:x:shape"), NODES, "a.ttl")
    assert found.keys() == set(NODES)
    assert vars(constraint_component)["stringify_node"] is written  # put back where it was
