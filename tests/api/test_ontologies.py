"""A reasoning mode takes its hierarchy from the ontologies of selfconf and of the user."""

from __future__ import annotations

from io import BytesIO, TextIOWrapper
from pathlib import Path

import pyoxigraph as ox
import pytest

from selfconf import configure, partition, read, template, validate
from selfconf.api.ontologies import hierarchy_of, ontology_texts, with_ontologies
from selfconf.errors import AuthorError
from selfconf.model.hierarchy import Reasoning
from selfconf.model.term import IRI
from selfconf.query import Question, answer
from selfconf.rdf.sparql import Dataset
from selfconf.rdf.vocabulary import ROB
from tests.cli.command import run
from tests.lab import PREFIXES, iri

OWN = (
    "@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .\n@prefix mine: <x:> .\nmine:lamp rdfs:subClassOf <{}> .\n"
)


def test_syntactic_sees_nothing_and_subclass_sees_the_users_own(tmp_path: Path) -> None:
    (tmp_path / "own.ttl").write_text(OWN.format(ROB.Sensor))
    lamp = type(ROB.Sensor)("x:lamp")
    for ontologies in ([tmp_path], [tmp_path / "own.ttl"]):
        assert ROB.Sensor not in hierarchy_of(Reasoning.SYNTACTIC, ontology_texts(ontologies)).superclasses(lamp)
        assert ROB.Sensor in hierarchy_of(Reasoning.SUBCLASS, ontology_texts(ontologies)).superclasses(lamp)


@pytest.mark.parametrize("mode", ["syntactic", "subclass", "owl-rl"])
def test_what_an_ontology_says_of_an_individual_is_shown_to_no_shape(tmp_path: Path, mode: str) -> None:
    (tmp_path / "own.ttl").write_text(PREFIXES + ":desk :in :room .\n")
    task = template(
        PREFIXES
        + ":watch a sc:Template ; sc:roles ( :eye ) .\n"
        + ":eye a sc:Role ; sh:property [ sh:path ( :at :in ) ; sh:hasValue :room ] .\n"
    )
    home = read(
        PREFIXES + ":a a sc:Component, :Camera ; :at :shelf . :shelf :in :room .\n",
        PREFIXES + ":b a sc:Component, :Camera ; :at :desk .\n",
    )
    assert partition(task, home, reasoning=mode, ontologies=[tmp_path])["eye"].eligible == (iri("a"),)


def test_an_ontology_that_is_not_there_is_named() -> None:
    with pytest.raises(AuthorError, match="no file or folder nowhere"):
        ontology_texts([Path("nowhere.ttl")])


def test_a_question_may_use_the_prefixes_of_an_ontology(tmp_path: Path) -> None:
    (tmp_path / "own.ttl").write_text(OWN.format(ROB.Sensor))
    question = Question("ASK { mine:lamp rdfs:subClassOf rob:Sensor }", "table", 10)
    assert answer(*with_ontologies(Dataset(), question, [tmp_path])).text == "true"


ONTOLOGY = (
    PREFIXES
    + """@prefix owl: <http://www.w3.org/2002/07/owl#> .
:CeilingCamera a owl:Class ; rdfs:label "ceiling camera"@en ; rdfs:subClassOf :Camera .
:Camera a owl:Class ; rdfs:label "camera"@en ; rdfs:subClassOf :Sensor .
:Sensor a owl:Class ; rdfs:label "sensor"@en .
:above a owl:ObjectProperty ; rdfs:label "above"@en ; rdfs:subPropertyOf :near .
:near a owl:ObjectProperty ; rdfs:label "near"@en .
"""
)


FORMATS = {
    "ttl": ox.RdfFormat.TURTLE,
    "rdf": ox.RdfFormat.RDF_XML,
    "owl": ox.RdfFormat.RDF_XML,
    "jsonld": ox.RdfFormat.JSON_LD,
    "nt": ox.RdfFormat.N_TRIPLES,
    "nq": ox.RdfFormat.N_QUADS,
    "trig": ox.RdfFormat.TRIG,
}


TEMPLATE = PREFIXES + ":watch a sc:Template ; sc:roles ( :eye ) .\n:eye a sc:Role ; sh:class :Sensor .\n"


CAMERA = PREFIXES + ":cam a sc:Component, :CeilingCamera ; :above :bed .\n"


def write(folder: Path, ending: str) -> Path:
    """A folder with the ontology in a format, below another folder."""
    (folder / "deep").mkdir(parents=True)
    quads = ox.parse(ONTOLOGY.encode(), format=ox.RdfFormat.TURTLE)
    ox.serialize(quads, folder / "deep" / f"words.{ending}", format=FORMATS[ending])
    return folder


@pytest.fixture(autouse=True)
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A cache of the test's own."""
    monkeypatch.setenv("SELFCONF_CACHE_DIR", str(tmp_path / "cache"))


@pytest.mark.parametrize("ending", FORMATS)
def test_a_folder_gives_the_hierarchy_that_its_file_gives_in_any_format(ending: str, tmp_path: Path) -> None:
    (tmp_path / "plain.ttl").write_text(ONTOLOGY)
    plain = hierarchy_of(Reasoning.SUBCLASS, ontology_texts([tmp_path / "plain.ttl"]))
    found = hierarchy_of(Reasoning.SUBCLASS, ontology_texts([write(tmp_path / ending, ending)]))
    for name in ("CeilingCamera", "Camera", "Sensor"):
        assert found.superclasses(iri(name)) == plain.superclasses(iri(name))
    assert found.superclasses(iri("CeilingCamera")) == {iri("CeilingCamera"), iri("Camera"), iri("Sensor")}
    assert found.superproperties(iri("above")) == {iri("above"), iri("near")}


def test_the_ontologies_of_selfconf_count_always() -> None:
    robotics = "https://w3id.org/selfconf/robotics#"
    above = hierarchy_of(Reasoning.SUBCLASS).superclasses(IRI(robotics + "PersonTracker"))
    assert robotics + "PositionSensor" in above


def test_the_mode_syntactic_has_no_hierarchy(tmp_path: Path) -> None:
    (tmp_path / "words.ttl").write_text(ONTOLOGY)
    assert hierarchy_of(Reasoning.SYNTACTIC, ontology_texts([tmp_path / "words.ttl"])).flat


@pytest.mark.parametrize("reasoning", list(Reasoning))
def test_an_ontology_that_cannot_be_read_is_named(reasoning: Reasoning, tmp_path: Path) -> None:
    (tmp_path / "words.rdf").write_text("<rdf:RDF")
    with pytest.raises(AuthorError, match=r"words\.rdf"):
        hierarchy_of(reasoning, ontology_texts([tmp_path]))


def test_an_ontology_on_standard_input_counts_for_the_explanation_too(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "watch.ttl").write_text(TEMPLATE)
    (tmp_path / "cam.ttl").write_text(CAMERA)
    monkeypatch.setattr("sys.stdin", TextIOWrapper(BytesIO(ONTOLOGY.encode())))
    outcome = run(
        capsys, "configure", str(tmp_path / "watch.ttl"), "--ads", str(tmp_path / "cam.ttl"), "--ontology", "-"
    )
    assert outcome.code == 1
    assert "with --reasoning subclass there is a configuration" in outcome.out


def test_an_ontology_is_a_graph_of_the_dataset_that_is_asked_and_lends_its_prefixes(tmp_path: Path) -> None:
    path = tmp_path / "words.ttl"
    path.write_text(ONTOLOGY.replace("@prefix : ", "@prefix own: ").replace(" :", " own:").replace("\n:", "\nown:"))
    question = Question("SELECT ?g { GRAPH ?g { own:Camera rdfs:subClassOf own:Sensor } }", "csv")
    assert answer(*with_ontologies(Dataset(), question, [tmp_path])).text.split() == ["g", path.resolve().as_uri()]


def test_the_library_takes_folders(tmp_path: Path) -> None:
    words = write(tmp_path / "words", "jsonld")
    task, home = template(TEMPLATE), read(CAMERA)
    assert not configure(task, home, reasoning="subclass")
    assert configure(task, home, reasoning="subclass", ontologies=[words])["eye"] == (iri("cam"),)
    assert partition(task, home, reasoning="subclass", ontologies=[words])["eye"].eligible == (iri("cam"),)


@pytest.mark.usefixtures("asked_here")
@pytest.mark.parametrize("ending", FORMATS)
def test_every_command_takes_a_folder(ending: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = str(write(tmp_path / "words", ending))
    (tmp_path / "ads").mkdir()
    (tmp_path / "ads" / "cam.ttl").write_text(CAMERA)
    (tmp_path / "watch.ttl").write_text(TEMPLATE)
    given = (str(tmp_path / "watch.ttl"), "--ads", str(tmp_path / "ads"), "--reasoning", "subclass")
    for command in ("configure", "partition"):
        assert run(capsys, command, *given).code == 1
        assert run(capsys, command, *given, "--ontology", words).code == 0
    asked = ("query", f"ASK {{ <{iri('CeilingCamera')}> rdfs:subClassOf+ <{iri('Sensor')}> }}", "--ads", given[2])
    assert run(capsys, *asked).out == "false\n"
    assert run(capsys, *asked, "--ontology", words).out == "true\n"
    # The ontologies are read before the ecology is looked for.
    outcome = run(capsys, "site", given[2], "--ontology", words)
    assert outcome.is_one_sentence("a site is part of an ecology")


@pytest.mark.parametrize("ending", FORMATS)
def test_validation_knows_the_terms_of_a_folder(ending: str, tmp_path: Path) -> None:
    unknown = PREFIXES + ':cam a sc:Component, :CeilingCamera ; sc:hasOutput [ sc:name "x" ; sc:signalType :Camera ] .'
    (tmp_path / "cam.ttl").write_text(unknown)
    assert [found.code for found in validate([tmp_path / "cam.ttl"]).diagnostics] == ["SC-L03"]
    words = write(tmp_path / "words", ending)
    assert not validate([tmp_path / "cam.ttl"], ontologies=[words]).diagnostics
