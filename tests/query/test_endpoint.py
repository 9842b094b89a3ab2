"""An ecology behind a SPARQL endpoint: `query` asks a real server, and no server is anything worse than a sentence."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path

import pyoxigraph as ox
import pytest

from selfconf.errors import NetworkError
from selfconf.query.endpoint import asked
from selfconf.rdf.eligibility.remote import ANY_COMPONENT
from tests.cli.command import Outcome, run
from tests.cli.endpoints import Scripted, http, oxigraph
from tests.lab import ADVERTISEMENTS, NAVIGATE, PREFIXES, write_advertisements

pytestmark = [pytest.mark.process, pytest.mark.usefixtures("asked_here")]

SENSORS = "SELECT ?c WHERE { ?c a rob:PositionSensor } ORDER BY ?c"
TASK = ("--bind", "robot=:Astrid", "--bind", "goal=x")
TYPES = '{"head":{"vars":["type"]},"results":{"bindings":[{"type":{"type":"uri","value":"urn:a"}}]}}'
EMPTY = '{"head":{"vars":["type"]},"results":{"bindings":[]}}'


@pytest.fixture(scope="module")
def server() -> Iterator[str]:
    """The paper's ecology, each advertisement in a graph of its own."""
    with oxigraph("", {f"urn:{name}": PREFIXES + text for name, text in ADVERTISEMENTS.items()}) as url:
        yield url


@pytest.mark.parametrize(
    ("text", "form"),
    [
        *((SENSORS, form) for form in ("table", "json", "csv", "tsv")),
        ("PREFIX rob: <urn:none#> SELECT ?c WHERE { ?c a rob:PositionSensor }", "csv"),
        ('SELECT ?c ?p (STRLANG("ä\\t", "de") AS ?x) ?no WHERE { ?c sc:preference ?p }', "json"),
        ("ASK { ?c a rob:Tuner }", "table"),
        ("SELECT ?c WHERE { GRAPH ?g { ?c a rob:MotorDrive } } ORDER BY ?c", "csv"),
    ],
)
def test_a_server_gives_the_same_answers_as_files(
    server: str, text: str, form: str, tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str]
) -> None:
    ads = write_advertisements(tmp_path_factory.mktemp("ads"))
    there = run(capsys, "query", text, "--endpoint", f"{server}?union-default-graph", "--format", form)
    here = run(capsys, "query", text, "--ads", str(ads), "--format", form)
    assert there == here
    assert (there.code, there.err) == (0, "")


@pytest.mark.parametrize("form", ["turtle", "json"])
def test_triples_come_from_a_server_too(server: str, form: str, capsys: pytest.CaptureFixture[str]) -> None:
    text = "CONSTRUCT { ?c a ?t } WHERE { GRAPH ?g { ?c a ?t , rob:MotorDrive } }"
    outcome = run(capsys, "query", text, "--endpoint", server, "--format", form)
    assert outcome.code == 0
    assert outcome.out.count("astrid-drive") == outcome.out.count("pippi-drive") == 1


def test_rows_beyond_the_limit_are_left_out_and_said_to_be(server: str, capsys: pytest.CaptureFixture[str]) -> None:
    for text, form in (
        ("SELECT * { GRAPH ?g { ?s ?p ?o } }", "csv"),
        ("CONSTRUCT { ?s ?p ?o } { GRAPH ?g { ?s ?p ?o } }", "json"),
    ):
        outcome = run(capsys, "query", text, "--endpoint", server, "--rows", "2", "--format", form)
        assert outcome.code == 0
        assert "more than 2 rows" in outcome.err
        assert len(outcome.out.split() if form == "csv" else json.loads(outcome.out)) <= 3


def test_an_empty_default_graph_is_explained(server: str, capsys: pytest.CaptureFixture[str]) -> None:
    outcome = run(capsys, "query", SENSORS, "--endpoint", server, "--format", "csv")
    assert (outcome.code, outcome.out.split()) == (0, ["c"])
    assert "ask for GRAPH ?g { ... }" in outcome.err


@pytest.mark.parametrize(
    ("text", "arguments", "words"),
    [
        ("SELECT WHERE", (), "answers 400: "),
        ("DELETE WHERE { ?s ?p ?o }", (), "answers 400: "),
        ("SELECT ?s { SERVICE <http://127.0.0.1:9/> { ?s ?p ?o } }", (), "SERVICE is not allowed"),
        ("SELECT ?s { ser\\u0076ice <http://127.0.0.1:9/> { ?s ?p ?o } }", (), "SERVICE is not allowed"),
        (SENSORS, ("--format", "turtle"), "--format turtle is for CONSTRUCT"),
        (SENSORS, ("--ontology", "words.ttl"), "an endpoint holds what it holds"),
        (SENSORS, ("--ads", "ads"), "give one of them"),
    ],
)
def test_a_query_that_cannot_be_asked_there_is_one_sentence(
    server: str, text: str, arguments: tuple[str, ...], words: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(capsys, "query", text, "--endpoint", server, *arguments).is_one_sentence(words)


def test_a_project_file_may_name_an_endpoint_and_what_other_commands_and_questions_are_asked_with(
    server: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "words.ttl").touch()
    (tmp_path / "selfconf.toml").write_text(f'endpoint = "{server}?union-default-graph"\nontology = "words.ttl"\n')
    monkeypatch.chdir(tmp_path)
    outcome = run(capsys, "query", SENSORS, "--format", "csv")
    assert (outcome.code, outcome.err) == (0, "")
    assert outcome.out.count("\n") > 1
    assert run(capsys, "query", SENSORS, "--history", "past").is_one_sentence("past holds no history")


@pytest.mark.parametrize(
    ("url", "words"),
    [
        ("http://127.0.0.1:9/query", "Connection refused"),
        ("file:///etc/passwd", "takes an http or https URL"),
        ("127.0.0.1:7878", "takes an http or https URL"),
        ("http://[/", "is no URL"),
        ("http://127.0.0.1:port/", "is no URL"),
        ("http://two words/", "is no URL"),
        ("http://a..b/", "is no URL"),
    ],
)
def test_a_url_that_leads_nowhere_is_one_sentence(url: str, words: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(capsys, "query", SENSORS, "--endpoint", url).is_one_sentence(words)


def test_a_wrong_path_on_the_right_server_is_one_sentence(server: str, capsys: pytest.CaptureFixture[str]) -> None:
    wrong = server.replace("/query", "/nothing")
    assert run(capsys, "query", SENSORS, "--endpoint", wrong).is_one_sentence(f"{wrong} answers 404")


CHUNKED = "HTTP/1.1 200 OK\r\nContent-Type: {kind}\r\nTransfer-Encoding: chunked\r\n\r\n"
TRIPLES = "application/n-triples"
BAD = {
    "a page for people": (http("<html>welcome</html>", "text/html"), "answers in text/html"),
    "a refusal": (http("not\n today", status="403 Forbidden"), "answers 403: not today"),
    "a refusal without a word": (http("", status="500 Oh"), "answers 500: Oh"),
    "a refusal that paints the terminal": (http("\x1b[2J\x1b]0;gone\x07", status="400 Bad"), "answers 400: [2J]0;gone"),
    "a redirect": (http("", status="302 Found", more="Location: file:///etc/passwd\r\n"), "302: Found, go to file:"),
    "a redirect of a POST": (http("", status="307 Other", more="Location: http://127.0.0.1:9/\r\n"), "no redirect"),
    "JSON that breaks off": (http(TYPES[:-9]), "breaks off"),
    "JSON with its length missed": (http(TYPES)[:-9], "breaks off"),
    "JSON of another kind": (http('["nothing", 1, {"deep": [[[[]]]]}]'), "breaks off, or is not the"),
    "JSON nested deep": (http("[" * 200_000), "breaks off, or is not the"),
    "a chunk that breaks off": (
        CHUNKED.format(kind=TRIPLES).encode() + b"ff\r\n<urn:a> <urn:b> <urn:c> .\n",
        "breaks off",
    ),
    "triples with their length missed": (http("<urn:a> <urn:b> <urn:c> .\n" * 3, TRIPLES)[:-26], "breaks off"),
    "triples that are none": (http("<urn:a> <urn:b>", TRIPLES), "breaks off, or is not the"),
    "no HTTP": (b"220 mail.example.org ESMTP\r\n", "cannot ask"),
    "nothing": (b"", "cannot ask"),
}


def partition(capsys: pytest.CaptureFixture[str], folder: Path, url: str) -> Outcome:
    """What `partition` makes of an endpoint."""
    (folder / "navigate.ttl").write_text(NAVIGATE)
    return run(capsys, "partition", str(folder / "navigate.ttl"), *TASK, "--endpoint", url)


@pytest.mark.parametrize("how", BAD)
def test_a_server_that_misbehaves_is_one_sentence(how: str, capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    answer, words = BAD[how]
    with Scripted(answer) as server:
        with pytest.raises(NetworkError, match=re.escape(words)), asked(server.url, "ASK {}") as found:
            list(() if isinstance(found, ox.QueryBoolean) else found)
        assert partition(capsys, tmp_path, server.url).is_one_sentence(server.url)
    assert [request.split(b" HTTP")[0] for request in server.requests] == [b"POST /query"] * 2


def test_query_says_the_same_sentence(capsys: pytest.CaptureFixture[str], asked_here: pytest.MonkeyPatch) -> None:
    asked_here.undo()  # the sentence comes from a process of its own
    with Scripted(BAD["JSON that breaks off"][0]) as server:
        assert run(capsys, "query", SENSORS, "--endpoint", server.url).is_one_sentence("breaks off", server.url)


@pytest.mark.parametrize("how", ["nothing at all", "an answer without end"])
def test_a_server_that_holds_the_line_meets_the_time_limit(
    how: str, capsys: pytest.CaptureFixture[str], asked_here: pytest.MonkeyPatch
) -> None:
    asked_here.undo()  # it is the process that is ended
    answer = b"" if how == "nothing at all" else http(TYPES).replace(b": 105", b": 9999")[:-9]
    with Scripted(answer, hold=True) as server:
        outcome = run(capsys, "query", SENSORS, "--endpoint", server.url, "--seconds", "1.5")
    assert outcome.is_one_sentence("more than 1.5 s")


def test_more_rows_than_asked_for_are_not_waited_for(capsys: pytest.CaptureFixture[str]) -> None:
    row = '{"type":{"type":"uri","value":"urn:a"}}'
    body = f'{{"head":{{"vars":["type"]}},"results":{{"bindings":[{",".join([row] * 2000)},'
    with Scripted(http(body).replace(f": {len(body)}".encode(), b": 999999999"), hold=True) as server:
        outcome = run(
            capsys, "query", "SELECT ?type { GRAPH ?g { ?s a ?type } }", "--endpoint", server.url, "--rows", "5"
        )
    assert (outcome.code, outcome.out.count("urn:a")) == (0, 5)
    assert "more than 5 rows" in outcome.err


def test_solutions_without_the_variable_asked_for_are_one_sentence(
    capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    for body in (EMPTY.replace("type", "kind"), '{"head":{},"boolean":true}'):
        with Scripted(http(body)) as server:
            assert partition(capsys, tmp_path, server.url).is_one_sentence("does not answer a SELECT")


def test_what_the_server_is_sent_is_the_query_and_the_prefixes_it_uses(capsys: pytest.CaptureFixture[str]) -> None:
    with Scripted(http(EMPTY)) as server:
        run(capsys, "query", SENSORS, "--endpoint", server.url)
    sent = f"PREFIX rob: <https://w3id.org/selfconf/robotics#> {SENSORS}".encode()
    assert server.requests[0].endswith(b"\r\n\r\n" + sent)


def test_the_urls_on_the_page_are_those_that_are_tried(server: str) -> None:
    page = (Path(__file__).parents[2] / "docs" / "endpoint.md").read_text()
    assert "/query?union-default-graph`" in page
    with asked(f"{server}?union-default-graph", ANY_COMPONENT) as found:
        assert found
    with asked(server, ANY_COMPONENT) as found:
        assert not found
