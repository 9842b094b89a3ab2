"""The ontologies: every term is declared, named, defined, shown by example, and used as it is declared."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from rdflib import DCTERMS, OWL, RDF, RDFS, SH, SKOS, XSD, Graph, Literal, Namespace, URIRef
from rdflib.collection import Collection

from selfconf import library
from tests.shipped import ontology_graphs

SC = Namespace("https://w3id.org/selfconf#")
ROB = Namespace("https://w3id.org/selfconf/robotics#")
ROS2 = Namespace("https://w3id.org/selfconf/ros2#")
VANN = Namespace("http://purl.org/vocab/vann/")
ROOT = Path(__file__).resolve().parents[2]
GRAPHS = ontology_graphs()
KINDS = {OWL.Class, OWL.ObjectProperty, OWL.DatatypeProperty, RDF.Property}
OURS = "https://w3id.org/selfconf"
DECLARED = sum(GRAPHS.values(), Graph())
TERMS = sorted({term for kind in KINDS for term in DECLARED.subjects(RDF.type, kind) if isinstance(term, URIRef)})
PREFIXES = "".join(
    f"@prefix {prefix}: <{iri}> .\n"
    for prefix, iri in {
        "": "https://example.org/#",
        "sc": SC,
        "rob": ROB,
        "home": f"{OURS}/peis-home#",
        "ros2": f"{OURS}/ros2#",
        "rdfs": RDFS,
        "sh": SH,
        "xsd": XSD,
        "unit": "http://qudt.org/vocab/unit/",
    }.items()
)

PROMISED = re.findall(
    r"\w+",
    """
    Component Input Output Template Role Interaction Parameter Task Configuration Connection Failure hasInput
    hasOutput hasParameter name signalType parameterType preference grounding parameter roles feeds from to output
    input sets value minCount maxCount
    """,
)
"""The terms that selfconf began with, which keep their names forever."""
NO_TERMS = {"hasOuput", "mass"}
"""What the manual names as a mistake, and as a term that somebody adds."""


@pytest.mark.parametrize(("stem", "namespace"), [("selfconf", SC), ("robotics", ROB), ("ros2", ROS2)])
def test_every_term_is_declared_labelled_and_defined(stem: str, namespace: Namespace) -> None:
    graph = GRAPHS[stem]
    terms = {term for term in graph.subjects() if isinstance(term, URIRef) and term.startswith(namespace)}
    assert terms
    for term in terms:
        assert set(graph.objects(term, RDF.type)) & KINDS, term
        for predicate in (RDFS.label, SKOS.definition):
            (words,) = graph.objects(term, predicate)
            assert isinstance(words, Literal)
            assert words.language == "en", term
        assert str(graph.value(term, SKOS.definition)).endswith("."), term
        assert list(graph.objects(term, RDFS.isDefinedBy)) == [URIRef(str(namespace).rstrip("#"))]


@pytest.mark.parametrize(("stem", "prefix"), [("selfconf", "sc"), ("robotics", "rob"), ("ros2", "ros2")])
def test_an_ontology_says_who_made_it_and_how_to_speak_of_it(stem: str, prefix: str) -> None:
    graph = GRAPHS[stem]
    (ontology,) = graph.subjects(RDF.type, OWL.Ontology)
    for predicate in (DCTERMS.title, DCTERMS.creator, DCTERMS.license, OWL.versionIRI, OWL.versionInfo):
        assert graph.value(ontology, predicate) is not None, predicate
    assert str(graph.value(ontology, VANN.preferredNamespacePrefix)) == prefix


def test_the_ontology_has_every_term_that_was_promised_and_every_term_that_the_manual_names() -> None:
    declared = {str(term)[len(SC) :] for term in GRAPHS["selfconf"].subjects() if str(term).startswith(SC)}
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    named = {term for page in pages for term in re.findall(r"\bsc:(\w+)", page.read_text("utf-8"))}
    assert named > {"feeds", "grounding"}
    assert {*PROMISED, *named} - NO_TERMS <= declared


@pytest.mark.parametrize("path", [*library.ontologies(), *library.shapes()], ids=lambda path: path.stem)
def test_every_term_of_ours_that_is_used_is_declared(path: Path) -> None:
    declared = {subject for graph in GRAPHS.values() for subject in graph.subjects()}
    for term in {part for triple in Graph().parse(path) for part in triple}:
        if isinstance(term, URIRef) and term.startswith((SC, ROB)):
            assert term in declared, term


@pytest.mark.parametrize("term", TERMS, ids=lambda term: term.removeprefix(OURS))
def test_every_class_and_property_has_examples_that_are_turtle_and_mention_it(term: URIRef) -> None:
    examples = list(DECLARED.objects(term, SKOS.example))
    assert examples
    for example in examples:
        text = str(example)
        if not text.endswith("."):
            text = f":x :y {text} ." if text.startswith("[") else f":x {text} ."
        graph = Graph().parse(data=PREFIXES + text, format="turtle")
        assert term in {part for triple in graph for part in triple}, text
        for mentioned in {part for triple in graph for part in triple if str(part).startswith(OURS)}:
            assert mentioned in TERMS, mentioned


def test_every_signal_type_lists_fields_with_a_datatype_and_known_units() -> None:
    graph = GRAPHS["robotics"]
    signals = set(graph.subjects(RDFS.subClassOf, ROB.Signal))
    assert len(signals) > 5
    for signal in signals:
        fields = graph.value(signal, ROB.field)
        assert fields is not None
        names = [str(graph.value(field, ROB.fieldName)) for field in Collection(graph, fields)]
        assert len(names) == len(set(names))
        for field in Collection(graph, fields):
            assert str(graph.value(field, ROB.datatype)).startswith(str(XSD))
            unit = graph.value(field, ROB.unit)
            assert unit is None or re.fullmatch(r"http://qudt.org/vocab/unit/[A-Z_-]+", str(unit))


@pytest.mark.parametrize(
    ("signal", "names"),
    [
        (ROB.PlanarPose2D, ["x", "y", "theta", "frame"]),
        (ROB.Velocity2D, ["linear", "angular"]),
        (ROB.Odometry2D, ["x", "y", "theta", "linear", "angular"]),
        (ROB.RangeScan, ["angles", "ranges", "max_range"]),
        (ROB.Audio, ["rate", "samples"]),
    ],
)
def test_the_signals_of_the_experiment_have_their_fields(signal: URIRef, names: list[str]) -> None:
    graph = GRAPHS["robotics"]
    fields = graph.value(signal, ROB.field)
    assert fields is not None
    assert [str(graph.value(field, ROB.fieldName)) for field in Collection(graph, fields)] == names


def test_component_types_lie_below_component() -> None:
    graph = GRAPHS["robotics"]
    for kind in (ROB.SonarArray, ROB.Encoder, ROB.PersonTracker, ROB.AbsoluteOdometry, ROB.NavigationControl,
                 ROB.MotorDrive, ROB.Tuner, ROB.Speaker, ROB.StereoCamera):  # fmt: skip
        assert SC.Component in graph.transitive_objects(kind, RDFS.subClassOf)
    for kind in (ROB.PersonTracker, ROB.AbsoluteOdometry):
        assert (kind, RDFS.subClassOf, ROB.PositionSensor) in graph
