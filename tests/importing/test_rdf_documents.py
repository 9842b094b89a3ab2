"""Advertisements in other formats of RDF: what is written says what was read, which rdflib judges."""

from __future__ import annotations

from pathlib import Path

import pyoxigraph as ox
import pytest
from rdflib import Graph
from rdflib.compare import isomorphic

import selfconf as sc
from selfconf.importing.rdf_documents import described
from selfconf.rdf.turtle import parse
from tests.importing.imports import Workshop, left_out

ROOT = Path(__file__).resolve().parents[2]
HOME = sorted((ROOT / "examples").rglob("*.ttl"))
HEAD = """@prefix rdf: <http://www.w3.org/1999/02/22-rdf-syntax-ns#> .
@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix : <https://example.org/#> .
"""
LAMP = ':lamp a sc:Component, rob:Lamp ; sc:hasInput [ sc:name "on" ; sc:signalType rob:Switch ] .'
FORMATS = {
    "nt": ox.RdfFormat.N_TRIPLES,
    "nq": ox.RdfFormat.N_QUADS,
    "rdf": ox.RdfFormat.RDF_XML,
    "trig": ox.RdfFormat.TRIG,
    "jsonld": ox.RdfFormat.JSON_LD,
}


def converted(text: bytes, base: str, ending: str) -> str:
    """A Turtle text in another format."""
    triples = (quad.triple for quad in ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri=base))
    found = ox.serialize(triples, format=FORMATS[ending])
    assert found is not None
    return found.decode()


@pytest.mark.parametrize("ending", FORMATS)
def test_the_examples_say_the_same_after_an_import_from_any_format(workshop: Workshop, ending: str) -> None:
    texts = {f"{path.stem}.{ending}": converted(path.read_bytes(), path.as_uri(), ending) for path in HOME}
    report = workshop.imported("rdf", texts)
    assert report.unreadable == ()
    assert len(report.files) > 6
    for file in report.files:
        (original,) = (path for path in HOME if path.stem == file.path.stem)
        assert isomorphic(Graph().parse(file.path), Graph().parse(original)), file.path
    assert sc.validate([workshop.out], ontologies=[ROOT / "ontology"]).errors == 0


@pytest.mark.parametrize(
    "text",
    [
        ":a :p _:x . :b :p _:x . _:x :q ( 1 [ :r :s ] ( ) ) .",
        ":a :p _:x . _:x :p _:y . _:y :p _:x .",
        "_:x :p _:y . _:y :p _:x .",
        ":a :p _:l . _:l rdf:first 1 ; :also 2 ; rdf:rest () .",
        f":a {':p [ ' * 60} :q 1 {']' * 60} .",
        f":a :p {'( ' * 60} 1 {' )' * 60} .",
        f":a :p ( {'1 ' * 50} ) .",
        ":a :p [ ] , [ ] .",
    ],
    ids=range(8),
)
def test_blank_nodes_are_written_where_they_are_used_and_mean_the_same(workshop: Workshop, text: str) -> None:
    report = workshop.imported("rdf", {"x.ttl": f"{HEAD}{LAMP}\n{text}\n"})
    assert len(report.files) == 1
    written = Graph().parse(workshop.out / "x.ttl")
    assert isomorphic(written, Graph().parse(workshop.sources / "x.ttl"))


def test_a_long_list_stays_one(workshop: Workshop) -> None:
    workshop.imported("rdf", {"x.ttl": f"{HEAD}{LAMP}\n:a :p ( {'1 ' * 20_000} ) .\n"})
    assert f":a :p\n    ( {'1 ' * 20_000}) .\n" in workshop.texts()["x.ttl"].replace("        ", "    ")


def test_a_blank_node_that_is_used_once_has_no_label(workshop: Workshop) -> None:
    workshop.imported("rdf", {"x.nt": converted((HEAD + LAMP).encode(), "urn:x", "nt")})
    assert "_:" not in workshop.texts()["x.ttl"]


def test_everything_is_described_once() -> None:
    document = parse(f"{HEAD}:a :p [ :q [ :r 1 ] ] . :b :p ( 1 2 ) .", "x")
    assert [each.subject.short for each in described(document) if hasattr(each.subject, "short")] == ["a", "b"]


def test_a_component_that_does_not_conform_is_left_out_and_the_others_are_kept(workshop: Workshop) -> None:
    bad = ':bad a sc:Component, rob:Lamp ; sc:hasInput [ sc:name "" ] . [] a sc:Component, rob:Lamp .'
    report = workshop.imported("rdf", {"x.ttl": f"{HEAD}{LAMP}\n{bad}"})
    assert left_out(report) == {"components that do not conform": 2}
    text = workshop.texts()["x.ttl"]
    assert "lamp" in text
    assert "bad" not in text
    assert sc.validate([workshop.out]).conforms


@pytest.mark.parametrize("uses", [1, 2])
def test_a_component_without_an_iri_is_left_out_where_it_is_used_too(workshop: Workshop, uses: int) -> None:
    text = """@prefix : <urn:> . @prefix sc: <https://w3id.org/selfconf#> .
        :lamp a sc:Component , :Lamp ; :near _:it . :shelf :holds {} .
        _:it a sc:Component , :Dimmer ; sc:hasInput [ sc:name "x" ; sc:signalType :Level ] ."""
    report = workshop.imported("rdf", {"x.ttl": text.format("_:it" if uses > 1 else "5")})
    assert left_out(report) == {"components that do not conform": 1}
    assert not any(word in workshop.texts()["x.ttl"] for word in ("Dimmer", "Level"))
    assert sc.validate([workshop.out]).conforms


def test_a_component_that_an_earlier_source_advertises_is_left_out(workshop: Workshop) -> None:
    report = workshop.imported("rdf", {"a.ttl": HEAD + LAMP, "b.ttl": HEAD + LAMP})
    assert list(workshop.texts()) == ["a.ttl"]
    assert left_out(report) == {"components": 1}


def test_a_component_that_an_earlier_source_advertises_ill_is_that_of_a_later_one(workshop: Workshop) -> None:
    report = workshop.imported("rdf", {"a.ttl": f"{HEAD}:lamp a sc:Component .", "b.ttl": HEAD + LAMP})
    assert list(workshop.texts()) == ["b.ttl"]
    assert left_out(report) == {"components that do not conform": 1}


def test_what_advertises_nothing_is_named_and_what_is_no_rdf_is_unreadable(workshop: Workshop) -> None:
    report = workshop.imported("rdf", {"a.ttl": ":a", "b.nt": "", "c.jsonld": '{"@context": "https://x.example/c"}'})
    assert left_out(report) == {"documents without components": 1}
    assert "a.ttl:1:1: not Turtle" in str(report.unreadable[0])
    assert "its @context is on the web, and is not fetched" in str(report.unreadable[1])


def test_relative_iris_do_not_depend_on_where_a_document_lies(workshop: Workshop) -> None:
    workshop.imported("rdf", {"room/x.ttl": "<#lamp> a <https://w3id.org/selfconf#Component>, <urn:Lamp> ."})
    assert "<urn:selfconf:rdf:room/x#lamp> a sc:Component, <urn:Lamp> ." in workshop.texts()["room/x.ttl"]


def test_what_an_import_has_written_is_no_source(workshop: Workshop) -> None:
    workshop.out = workshop.sources / "ads"
    for _ in range(2):
        report = workshop.imported("rdf", {"x.ttl": HEAD + LAMP})
        assert [file.path.name for file in report.files] == ["x.ttl"]
