"""pySHACL behind one function: only the shape that is asked for judges, with all that it refers to."""

from __future__ import annotations

import pytest

from selfconf.errors import TemplateError
from selfconf.model.term import IRI
from selfconf.rdf import turtle
from selfconf.rdf.shacl import violations

HEAD = "@prefix : <urn:x:> . @prefix sh: <http://www.w3.org/ns/shacl#> .\n"
SUBJECTS = ':good :size 5 . :bad :size "five" . :bare :note 1 .'
NODES = [IRI("urn:x:good"), IRI("urn:x:bad"), IRI("urn:x:bare")]


def outside(shapes: str) -> set[str]:
    """The local names of those who do not conform to `:shape`."""
    graphs = [turtle.to_rdflib(turtle.parse(HEAD + text, "a.ttl").triples()) for text in (SUBJECTS, shapes)]
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
