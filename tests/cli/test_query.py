"""`query` over files and over the living ecology: what is asked, what may be asked, and a sentence for the rest."""

from __future__ import annotations

import io
import os
from pathlib import Path

import pytest

from selfconf.cli.main import main
from tests.cli.command import Outcome, run
from tests.cli.processes import Home
from tests.lab import PREFIXES, iri, write_advertisements

pytestmark = [pytest.mark.process, pytest.mark.usefixtures("asked_here")]

SENSORS = "SELECT ?c WHERE { ?c a rob:PositionSensor } ORDER BY ?c"


class Desk:
    """Advertisements on files, and the command over them."""

    def __init__(self, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
        self.folder, self.capsys = folder, capsys
        self.ads = write_advertisements(folder / "ads")

    def query(self, text: str, *arguments: str) -> Outcome:
        """Run `query` over the files."""
        return run(self.capsys, "query", text, "--ads", str(self.ads), *arguments)


@pytest.fixture
def desk(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> Desk:
    """The paper's advertisements."""
    return Desk(tmp_path, capsys)


def test_the_position_sensors_of_the_paper_are_two(desk: Desk) -> None:
    assert desk.query(SENSORS).err == ""
    body = desk.query(SENSORS, "--format", "json").body
    found = [row["c"]["value"] for row in body["results"]["bindings"]]
    assert found == [iri("absolute-odometry"), iri("person-tracker")]


def test_each_advertisement_is_a_graph_that_its_component_names(desk: Desk) -> None:
    outcome = desk.query("SELECT ?g WHERE { GRAPH ?g { ?c a rob:MotorDrive } } ORDER BY ?g", "--format", "csv")
    assert outcome.out.split() == ["g", iri("astrid-drive"), iri("pippi-drive")]


def test_a_query_may_join_what_several_advertisements_say(desk: Desk) -> None:
    text = "SELECT (COUNT(*) AS ?n) WHERE { ?a rob:support ?r . ?b rob:support ?r FILTER (?a != ?b) }"
    assert desk.query(text, "--format", "csv").out.split() == ["n", "6"]


def test_no_is_an_answer_and_so_is_nothing(desk: Desk) -> None:
    outcome = desk.query("ASK { ?c a rob:Tuner }")
    assert (outcome.code, outcome.out.strip()) == (0, "false")
    outcome = desk.query("SELECT ?c WHERE { ?c a rob:Tuner }", "--format", "csv")
    assert (outcome.code, outcome.out.strip()) == (0, "c")


def test_a_query_may_lie_in_a_file_or_come_from_stdin(desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    path = desk.folder / "sensors.rq"
    path.write_text(SENSORS)
    expected = desk.query(SENSORS).out
    assert desk.query(str(path)).out == expected
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(SENSORS.encode())))
    assert desk.query("-").out == expected


def test_a_query_may_come_from_a_pipe_that_has_a_name(desk: Desk) -> None:
    reading, writing = os.pipe()
    try:
        os.write(writing, SENSORS.encode())
        os.close(writing)
        assert desk.query(f"/dev/fd/{reading}").out == desk.query(SENSORS).out
    finally:
        os.close(reading)


def test_a_query_may_have_more_bytes_than_the_name_of_a_file(desk: Desk) -> None:
    text = f"SELECT ?c WHERE {{ ?c rdfs:label ?label FILTER(CONTAINS(?label, '{80 * chr(0x706F)}')) }}"
    outcome = desk.query(text, "--format", "csv")
    assert (outcome.code, outcome.out.strip()) == (0, "c")


def test_an_ontology_can_be_asked_along(desk: Desk) -> None:
    own = desk.folder / "own.ttl"
    own.write_text(PREFIXES + "rob:MotorDrive rdfs:subClassOf :Actuator .")
    text = "SELECT ?c WHERE { ?c a/rdfs:subClassOf <https://example.org/peis-home#Actuator> } ORDER BY ?c"
    outcome = desk.query(text, "--ontology", str(own), "--format", "csv")
    assert outcome.out.split()[1:] == [iri("astrid-drive"), iri("pippi-drive")]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("SELECT WHERE", "not a SPARQL query"),
        ("DELETE WHERE { ?s ?p ?o }", "not a SPARQL query"),
        ("SELECT ?x WHERE { SERVICE <http://127.0.0.1:9/> { ?x ?y ?z } }", "SERVICE"),
        ("nothing.rq", "no file or folder nothing.rq"),
    ],
)
def test_a_query_that_cannot_be_read_or_is_not_allowed_is_one_sentence(desk: Desk, text: str, words: str) -> None:
    assert desk.query(text).is_one_sentence(words)


def test_no_file_of_this_machine_is_read(desk: Desk) -> None:
    secret = desk.folder / "secret.ttl"
    secret.write_text(PREFIXES + ":secret a :Secret .")
    for text in (
        f"SELECT ?s FROM <{secret.as_uri()}> WHERE {{ ?s a <https://example.org/peis-home#Secret> }}",
        f"SELECT ?s FROM NAMED <{secret.as_uri()}> WHERE {{ GRAPH ?g {{ ?s ?p ?o }} }}",
    ):
        outcome = desk.query(text, "--format", "csv")
        assert (outcome.code, outcome.out.split()) == (0, ["s"])


def test_bytes_that_are_no_text_and_a_closed_stdin_are_one_sentence(
    desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"SELECT \xff"), encoding="utf-8"))
    assert desk.query("-").is_one_sentence("stdin")
    monkeypatch.setattr("sys.stdin", None)
    assert desk.query("-").is_one_sentence("standard input is closed")
    path = desk.folder / "bytes.rq"
    path.write_bytes(b"\xff\xfe")
    assert desk.query(str(path)).is_one_sentence("bytes.rq")


def test_the_living_ecology_is_asked_without_files(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    text = "SELECT (COUNT(?c) AS ?n) WHERE { ?c a rob:PositionSensor }"
    outcome = run(capsys, "query", text, "--format", "csv", *inhabited.arguments())
    assert (outcome.code, outcome.out.split()) == (0, ["n", "2"])


def test_what_is_deployed_lies_in_the_dataset(inhabited: Home, capsys: pytest.CaptureFixture[str]) -> None:
    program = inhabited.run()
    program.act("running")
    text = "SELECT ?c WHERE { ?x a sc:Configuration ; sc:assignment/sc:component ?c . ?c a rob:PositionSensor }"
    outcome = run(capsys, "query", text, "--format", "csv", *inhabited.arguments())
    assert outcome.out.split() == ["c", iri("person-tracker")]
    assert program.end() == 0
    outcome = run(capsys, "query", text, "--format", "csv", *inhabited.arguments())
    assert outcome.out.split() == ["c"]


def test_a_byte_order_mark_before_a_query_is_no_part_of_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "a.ttl").write_text("<urn:a> a <https://w3id.org/selfconf#Component> , <urn:Kind> .")
    (tmp_path / "b.rq").write_bytes(b"\xef\xbb\xbfASK { ?s a <urn:Kind> }")
    outcome = run(capsys, "query", str(tmp_path / "b.rq"), "--ads", str(tmp_path))
    assert (outcome.code, outcome.out) == (0, "true\n")
    assert run(capsys, "query", "-", "--ads", "-").is_one_sentence("- is standard input")


@pytest.mark.parametrize("rows", ["0", "-1", "1.5", "many"])
def test_rows_that_are_no_whole_number_above_zero_are_one_sentence(
    rows: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outcome = run(capsys, "query", "ASK {}", "--ads", str(tmp_path), f"--rows={rows}")
    assert outcome.is_one_sentence("--rows", repr(rows), "is no number of rows; it takes a whole number above zero")


@pytest.mark.parametrize("seconds", ["0", "-1", "inf", "nan", "2e6", "soon"])
def test_a_limit_that_is_no_time_is_one_sentence(
    seconds: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    outcome = run(capsys, "query", "ASK {}", "--ads", str(tmp_path), f"--seconds={seconds}")
    assert outcome.is_one_sentence("--seconds", repr(seconds), "above zero and at most 1,000,000")


def test_what_was_cut_is_said_on_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    example = Path(__file__).parents[2] / "examples" / "peis-home"
    assert main(["query", "SELECT ?c { ?c a sc:Component }", "--ads", str(example), "--rows", "1"]) == 0
    said = capsys.readouterr()
    assert len(said.out.splitlines()) == 3
    assert "more than 1 row;" in said.err
