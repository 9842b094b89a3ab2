"""The W3C SHACL tests as roles: tests compiled from a shape, then pySHACL, give the verdicts of pySHACL alone.

Of the core and the SPARQL part each IRI that a test describes stands as a component, each node shape with an IRI as a
role. What the suite expects of targets, literals and reports does not apply: a role has no targets, and a component is
an IRI.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from pyshacl import validate
from rdflib import RDF, RDFS, SH, Graph, URIRef

from selfconf.errors import TemplateError
from selfconf.model.hierarchy import Reasoning
from selfconf.model.profile import Profile
from selfconf.model.template import Role, Task, Template
from selfconf.model.term import IRI
from selfconf.rdf import rdflib_terms
from selfconf.rdf.advertisements.advertisement import ParsedAdvertisement
from selfconf.rdf.eligibility.partitioner import Partitioner
from selfconf.rdf.permitted_fields import STRUCTURE
from selfconf.rdf.reasoning.closure import hierarchy
from selfconf.rdf.tasks.templates import TaskDocument
from selfconf.rdf.turtle import document as turtle
from selfconf.rdf.turtle.document import Document
from selfconf.rdf.vocabulary import SC, TYPE
from selfconf.rdf.vocabulary import SH as SHACL

BESIDE = Path(__file__).parents[3] / "shared" / "data" / "w3c-shacl-tests"
SUITE = Path(os.environ.get("SELFCONF_W3C_SHACL", BESIDE))
pytestmark = [
    pytest.mark.w3c,
    pytest.mark.skipif(not SUITE.is_dir(), reason="the W3C SHACL tests are not here; SELFCONF_W3C_SHACL names them"),
]
MANIFEST = "http://www.w3.org/2001/sw/DataAccess/tests/test-manifest#"
TEST = "http://www.w3.org/ns/shacl-test#"
EXCEPTIONS = {
    "pre-binding-002": "pySHACL alone does not pre-bind $this in a FILTER that stands alone in a branch of a UNION",
}
"""The tests in which the two ways differ, and why."""
UNJUDGED = {
    "prefixes-001": "pySHACL alone does not follow owl:imports to the prefixes",
    "shapesGraph-001": "pySHACL alone does not support $shapesGraph, which SHACL leaves to the processor (5.3.1)",
    "unsupported-sparql-006": "pySHACL judges an ASK validator that assigns to ?value, as selfconf does",
}
"""The tests in which pySHACL alone gives no verdict, or one where the suite expects a failure, and why."""


def cases() -> Iterator[Path]:
    """Every test of the suite that has at least one node shape with an IRI."""
    for path in sorted((*(SUITE / "core").rglob("*.ttl"), *(SUITE / "sparql").rglob("*.ttl"))):
        text = path.read_text("utf-8")
        if "sht:Validate" in text and "mf:entries" in text and path.name != "manifest.ttl":
            yield path


def graphs(path: Path) -> tuple[Document, Document]:
    """The data and the shapes of a test."""
    manifest = turtle.parse(path.read_bytes(), path.name, path.as_uri())

    def named(role: str) -> Document:
        (graph,) = {value for _, predicate, value in manifest.triples() if predicate == TEST + role}
        if graph == path.as_uri():
            return manifest
        file = path.parent / str(graph).rpartition("/")[2]
        return turtle.parse(file.read_bytes(), file.name, file.as_uri())

    return named("dataGraph"), named("shapesGraph")


def roles(shapes: Document) -> list[IRI]:
    """The node shapes of a test that have an IRI."""
    targets = {SHACL[name] for name in ("targetClass", "targetNode", "targetSubjectsOf", "targetObjectsOf")}
    return [
        subject
        for subject, statements in shapes.statements.items()
        if isinstance(subject, IRI)
        and not any(predicate == SHACL.path for predicate, _ in statements)
        and ((TYPE, SHACL.NodeShape) in statements or any(predicate in targets for predicate, _ in statements))
    ]


def advertised(data: Document) -> list[ParsedAdvertisement]:
    """Each IRI that is described, as a component; what is said of blank nodes goes along with each."""
    nodes = [subject for subject in data.statements if isinstance(subject, IRI)]
    rest = [triple for triple in data.triples() if not isinstance(triple[0], IRI)]
    found = []
    for node in nodes:
        said = data.statements[node]
        profile = Profile(
            node,
            frozenset(value for predicate, value in said if predicate == TYPE and isinstance(value, IRI)),
            tuple((predicate, value) for predicate, value in dict.fromkeys(said) if predicate not in STRUCTURE),
        )
        found.append(ParsedAdvertisement(profile, (*((node, *statement) for statement in said), *rest)))
    return found


def alone(data: Graph, shapes: Graph, role: IRI, nodes: list[str]) -> set[str]:
    """Which nodes conform, as pySHACL tells when the shape has one of them as its target and no other shape has any.

    One at a time: a result may name another node as its focus, that of a property shape in a property shape does.
    """
    for target in (SH.targetClass, SH.targetNode, SH.targetSubjectsOf, SH.targetObjectsOf):
        shapes.remove((None, target, None))
    shapes.remove((None, RDF.type, RDFS.Class))
    found = set()
    for node in nodes:
        shapes.set((URIRef(role), SH.targetNode, URIRef(node)))
        conforms, _, _ = validate(data, shacl_graph=shapes, inference="none")
        if conforms:
            found.add(node)
    return found


def judged(*, refused: bool) -> list[Path]:
    """The tests with roles in which the suite expects a failure to be reported, or those with verdicts."""
    return [
        path
        for path in (cases() if SUITE.is_dir() else ())
        if path.stem not in UNJUDGED
        and roles(graphs(path)[1])
        and ("mf:result sht:Failure" in path.read_text("utf-8")) is refused
    ]


def partitioner_of(data: Document, shapes: Document) -> Partitioner:
    """The partitioner of a template whose roles are the node shapes."""
    wanted = roles(shapes)
    for role in wanted:
        shapes.statements[role].append((TYPE, SC.Role))
    template = Template(IRI("urn:template"), tuple(Role(role) for role in wanted))
    return Partitioner(TaskDocument(Task(template), shapes), hierarchy([data], Reasoning.SUBCLASS))


@pytest.mark.parametrize("path", judged(refused=False), ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_a_role_has_the_verdicts_of_pyshacl(path: Path) -> None:
    data, shapes = graphs(path)
    partitioner = partitioner_of(data, shapes)
    everything = advertised(data)
    nodes = [str(one.component) for one in everything]
    graph = rdflib_terms.to_rdflib(data.triples())
    expected = [alone(graph, rdflib_terms.to_rdflib(shapes.triples()), role, nodes) for role in roles(shapes)]
    found = partitioner.partition(everything)
    same = [{str(one.profile.component) for one in role} for role in found.candidates] == expected
    assert same is (path.stem not in EXCEPTIONS)


@pytest.mark.parametrize("path", judged(refused=True), ids=lambda path: path.stem)
def test_a_query_that_shacl_forbids_is_refused(path: Path) -> None:
    data, shapes = graphs(path)
    with pytest.raises(TemplateError, match=path.name):
        partitioner_of(data, shapes).partition(advertised(data))


def test_the_suite_is_used() -> None:
    used = judged(refused=False)
    assert len(used) > 60
    assert len(judged(refused=True)) > 5
    assert EXCEPTIONS.keys() <= {path.stem for path in used}
    assert UNJUDGED.keys() <= {path.stem for path in cases()}
