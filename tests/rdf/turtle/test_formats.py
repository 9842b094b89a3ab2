"""Ontologies are read in any format of RDF; what has to be Turtle and is not is refused with the way out."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pyoxigraph as ox
import pytest

from selfconf import library
from selfconf.errors import TurtleError
from selfconf.model.term import IRI
from selfconf.rdf import advertisements, turtle
from selfconf.rdf.turtle.formats import (
    FORMATS,
    JSON_LD,
    RDF_XML,
    TRIG,
    RdfFormat,
    conversion,
    format_of,
    in_turtle,
    read_ontology,
)
from selfconf.rdf.validation import SourceText, validate_texts
from selfconf.rdf.vocabulary import RDFS
from tests.lab import PREFIXES

TEXT = """@prefix : <https://example.org/home#> . @prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix owl: <http://www.w3.org/2002/07/owl#> .
:Lamp a owl:Class ; rdfs:label "Lampe"@de , "lamp { } [" ; rdfs:subClassOf :Light , [ a owl:Restriction ] .
:Light a owl:Class ."""

XML = '<?xml version="1.0"?>\n<rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">'


def written(found: RdfFormat) -> bytes:
    """The ontology in a format."""
    triples = [quad.triple for quad in ox.parse(TEXT, format=ox.RdfFormat.TURTLE)]
    if not found.parser.supports_datasets or found is JSON_LD:
        return ox.serialize(triples, format=found.parser) or b""
    quads = [ox.Quad(*triple, ox.NamedNode("urn:g")) for triple in triples]
    return ox.serialize(quads, format=found.parser) or b""


@pytest.mark.parametrize("found", FORMATS, ids=lambda found: found.name)
@pytest.mark.parametrize("named", [True, False], ids=["by name", "by content"])
def test_an_ontology_is_read_in_any_format(found: RdfFormat, named: bool) -> None:
    name = f"lamps.{found.endings[0]}" if named else "lamps.owl"
    document = read_ontology(written(found), name, "file:///lamps")
    expected = turtle.parse(TEXT, name)
    assert len(list(document.triples())) == len(list(expected.triples()))
    lamp = IRI("https://example.org/home#Lamp")
    assert set(document.values(lamp, RDFS.label)) == set(expected.values(lamp, RDFS.label))
    assert set(read_ontology(written(found), name, None, [RDFS.label]).statements) == {lamp}


@pytest.mark.parametrize("found", FORMATS, ids=lambda found: found.name)
def test_an_ontology_in_turtle_says_what_it_said(found: RdfFormat) -> None:
    name = f"lamps.{found.endings[0]}"
    text = in_turtle(written(found), name, "file:///lamps")
    expected = read_ontology(written(found), name, "file:///lamps")
    assert len(list(turtle.parse(text, "").triples())) == len(list(expected.triples()))
    assert list(turtle.parse(in_turtle(b"<#a> <p> <> .", "a.ttl", "file:///a.ttl"), "").triples()) == [
        (IRI("file:///a.ttl#a"), IRI("file:///p"), IRI("file:///a.ttl"))
    ]


def test_the_triples_of_every_graph_of_an_ontology_count() -> None:
    document = read_ontology(b"@prefix : <urn:x#> . :g { :a :b :c } :d :e :f .", "x.trig")
    assert len(list(document.triples())) == 2
    assert format_of("x", b"@prefix : <urn:x#> . :g\n{ :a :b :c } :d :e :f .") is TRIG


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        (
            "a.rdf",
            '<?xml version="1.0"?>\n<rdf:RDF xmlns:rdf="http://x#">\n<b></c>\n</rdf:RDF>\n',
            "a.rdf:3: not RDF/XML",
        ),
        (
            "a.ttl",
            XML + "</rdf:RDF>",
            "a.ttl: this is RDF/XML, and its name ends as that of Turtle; rename it, as to a.rdf",
        ),
        ("a.nt", '[ { "@id": "urn:a" } ]', "a.nt: this is JSON-LD, and its name ends as that of N-Triples"),
        (
            "a.rdf",
            '{"@graph": []}',
            "a.rdf: this is JSON-LD, and its name ends as that of RDF/XML; rename it, as to a.jsonld",
        ),
        (
            "a.JSONLD",
            "# lamps\nPREFIX : <urn:a> :a :b :c .",
            "a.JSONLD: this is Turtle, and its name ends as that of JSON-LD; rename it, as to a.ttl",
        ),
        ("a.rdf", "plain\ntext\n", "a.rdf:2: not RDF/XML: Unexpected text event: 'plain text"),
        ("a.nt", "<urn:a> <urn:b> <urn:c> .\n<urn:a> <urn:b> .\n", "a.nt:2:17: not N-Triples"),
        ("a.jsonld", '{\n"@id": "urn:a",}', "a.jsonld:2:"),
        ("a.jsonld", '{"@context": "https://example.org/context", "a": 1}', "not fetched"),
        ("a.trig", ":g { }", "a.trig:1:1: not TriG: The prefix"),
        ("a.trig", "@prefix : <urn:a> . :g { :a :b }", "a.trig:1:32: not TriG"),
        ("a.ttl", "<urn:a> <urn:b> .", "a.ttl:1:"),
        *(
            (f"a.{form}", "\n# \udce9", f"a.{form}:2:3: this is not UTF-8: the byte 0xE9")
            for form in ("ttl", "nt", "rdf")
        ),
        *(
            ("a.xml", f'<!DOCTYPE a [<!ENTITY a "aa"><!ENTITY b {value}>]><rdf:RDF/>', "an entity within an entity")
            for value in ('"&a;&a;"', "'&a;'", '"it\'s &amp; &a;"', "'a \"b\" &a;'", '"a > &a;"')
        ),
    ],
)
def test_what_is_wrong_in_an_ontology_is_told_with_its_file_and_line(name: str, text: str, said: str) -> None:
    with pytest.raises(TurtleError) as caught:
        read_ontology(text.encode(errors="surrogateescape"), name, "file:///a")
    assert said in str(caught.value)


def test_entities_are_expanded_up_to_a_bound() -> None:
    head = XML.replace("\n", '<!DOCTYPE a [<!ENTITY a "urn:x:' + "x" * 100_000 + '">]>\n')
    lamp = '<rdf:Description><a:p xmlns:a="urn:a:" rdf:resource="&a;"/></rdf:Description>'
    assert len(list(read_ontology(f"{head}{lamp * 2}</rdf:RDF>".encode(), "a.rdf").triples())) == 2
    with pytest.raises(TurtleError, match=r"a.rdf: its entities stand for over 64 MiB of text"):
        read_ontology(f"{head}{lamp * 700}</rdf:RDF>".encode(), "a.rdf")


@pytest.mark.parametrize(
    "found", [each for each in FORMATS if each.name not in ("Turtle", "N-Triples")], ids=lambda f: f.name
)
def test_an_advertisement_in_another_format_is_refused_with_the_command_that_converts_it(found: RdfFormat) -> None:
    name = f"my lamps.{found.endings[0]}"
    for read in (advertisements.read_advertisements, turtle.parse):
        with pytest.raises(TurtleError, match=f"this is {found.name}, where Turtle is read") as caught:
            read(written(found), name)
        assert f"rdfpipe -i {found.rdfpipe} -o turtle 'my lamps.{found.endings[0]}' > 'my lamps.ttl'" in str(
            caught.value
        )
    (problem,) = validate_texts([SourceText(name, written(found))], [], []).diagnostics
    assert (problem.code, problem.line) == ("SC-S01", 1)
    assert problem.message == f"This is {found.name}, and what is validated is Turtle."
    assert problem.hint == f"Convert it: {conversion(name, found)}"


@pytest.mark.parametrize("found", [RDF_XML, JSON_LD, TRIG], ids=lambda found: found.name)
def test_the_command_that_is_advised_makes_turtle(found: RdfFormat, tmp_path: Path) -> None:
    name = f"lamps.{found.endings[0]}"
    (tmp_path / name).write_bytes(written(found))
    _, *arguments = conversion(name, found).partition(" > ")[0].split()
    command = [sys.executable, "-W", "ignore", "-m", "rdflib.tools.rdfpipe", *arguments]
    made = subprocess.run(command, cwd=tmp_path, capture_output=True, check=True).stdout
    assert len(list(turtle.parse(made, "lamps.ttl").triples())) == len(list(turtle.parse(TEXT, "").triples()))


def test_the_command_that_is_advised_never_writes_to_the_file_that_it_reads() -> None:
    assert conversion("lamps.ttl", TRIG) == "rdfpipe -i trig -o turtle lamps.ttl > lamps-turtle.ttl"


def test_what_came_by_a_pipe_is_converted_by_a_pipe() -> None:
    assert conversion("<stdin>", RDF_XML) == "rdfpipe -i xml -o turtle -"


@pytest.mark.parametrize(
    "text", [PREFIXES, "[] a <urn:x> .", '<urn:a> <urn:b> "{" .', "# { \n<urn:a> <urn:b> <urn:c> ."]
)
def test_turtle_is_taken_for_nothing_else(text: str) -> None:
    assert turtle.other_format("a.ttl", text.encode()) is None


@pytest.mark.parametrize(
    "text",
    [b"# " * 30_000 + b"\n:a :b .", b":a\n" + b"\n" * 60_000 + b".", b":a\n" + b" " * 60_000, b"GRAPH\n" * 10_000],
    ids=["comment", "blank lines", "spaces", "names"],
)
def test_the_format_of_no_text_takes_long_to_tell(text: bytes) -> None:
    """Each of these took minutes, or forever, where white space could be taken by two parts of a pattern."""
    assert turtle.other_format("a.ttl", text) is None


def test_terms_of_an_ontology_in_another_format_are_known_to_validation() -> None:
    lamp = PREFIXES.replace("peis-home", "home") + ":l a sc:Component, :Lamp ."
    known = [SourceText(path.name, path.read_bytes()) for path in library.ontologies()]
    known.append(SourceText("lamps.rdf", written(RDF_XML)))
    assert not validate_texts([SourceText("l.ttl", lamp.encode())], [], known).diagnostics
    misspelt = SourceText("l.ttl", lamp.replace(":Lamp", ":Lmap").encode())
    assert [found.message for found in validate_texts([misspelt], [], known).diagnostics] == [
        "No loaded ontology declares :Lmap."
    ]
