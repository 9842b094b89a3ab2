"""A dataset in a process of its own: what it answers, and that whatever is asked comes to an end."""

from __future__ import annotations

import os
import signal
import socket
import time
from array import array
from collections.abc import Callable, Iterator
from fcntl import ioctl
from pathlib import Path
from termios import FIONREAD
from threading import Event, Thread

import pytest

from selfconf.errors import NotAcceptableError, ProgrammerError, QueryError, QueryTimeoutError
from selfconf.query.standing import StandingDataset, StandingQuestion, outcome

pytestmark = pytest.mark.process
JSON, TURTLE = "application/sparql-results+json", "text/turtle"
FIRST, SECOND = b"<urn:a> <urn:p> <urn:b> .\n", b"<urn:a> <urn:p> <urn:c> .\n<urn:a> <urn:p> <urn:d> .\n"
ENDLESS = "SELECT (COUNT(*) AS ?n) WHERE { " + " ".join(f"?a{n} ?b{n} ?c{n} ." for n in range(40)) + " }"


@pytest.fixture(scope="module")
def standing() -> Iterator[StandingDataset]:
    found = StandingDataset()
    found.replace("urn:first", FIRST)
    found.start()
    process = found._process
    assert process is not None
    found.replace("urn:second", SECOND)
    assert rows(found, "SELECT * { ?s ?p ?o }") == 3
    assert found._process is process  # it was there for the first question
    yield found
    found.close()


def rows(standing: StandingDataset, text: str, **chosen: list[str]) -> int:
    """How many solutions a query has."""
    _, body = standing.ask(StandingQuestion(text, ["text/csv"], **chosen))
    return body.count(b"\n") - 1


def test_each_kind_of_query_is_answered_in_the_media_type_that_is_wanted_most(standing: StandingDataset) -> None:
    assert standing.ask(StandingQuestion("ASK { ?s ?p <urn:d> }", [JSON])) == (JSON, b'{"head":{},"boolean":true}')
    media, body = standing.ask(StandingQuestion("DESCRIBE <urn:a>", [JSON, TURTLE]))
    assert media == TURTLE
    assert b"<urn:d>" in body
    with pytest.raises(NotAcceptableError):
        standing.ask(StandingQuestion("SELECT * { ?s ?p ?o }", [TURTLE]))


def test_what_a_media_type_cannot_write_comes_in_the_next_or_is_named(standing: StandingDataset) -> None:
    for query, xml, other in (
        (r'SELECT ("\u0001" AS ?y) {}', "application/sparql-results+xml", JSON),
        ('CONSTRUCT { <urn:s> <http://x/1> "v" } {}', "application/rdf+xml", TURTLE),
    ):
        media, body = standing.ask(StandingQuestion(query, [xml, other]))
        assert media == other
        assert b"http://x/1" in body or rb"\u0001" in body
        with pytest.raises(NotAcceptableError, match=r"'\\x01'|<http://x/1>"):
            standing.ask(StandingQuestion(query, [xml]))


def test_the_dataset_is_all_graphs_or_those_that_are_named(standing: StandingDataset) -> None:
    everything = "SELECT * { ?s ?p ?o }"
    assert rows(standing, everything) == 3
    assert rows(standing, everything, default_graphs=["urn:first"]) == 1
    assert rows(standing, "SELECT * FROM <urn:first> { ?s ?p ?o }", default_graphs=["urn:second"]) == 2
    assert rows(standing, everything, named_graphs=["urn:second"]) == 0
    assert rows(standing, "SELECT * { GRAPH ?g { ?s ?p ?o } }", named_graphs=["urn:second"]) == 2


def test_what_is_no_query_or_asks_others_is_refused_with_a_sentence(standing: StandingDataset) -> None:
    with pytest.raises(QueryError, match="not a SPARQL query"):
        standing.ask(StandingQuestion("SELEKT", [JSON]))
    with pytest.raises(QueryError, match="SERVICE is not allowed"):
        standing.ask(StandingQuestion("SELECT * { SERVICE <http://127.0.0.1/> { ?s ?p ?o } }", [JSON]))
    with pytest.raises(QueryError, match="brings its engine down"):
        standing.ask(StandingQuestion("ASK " + "{" * 100_000 + "}" * 100_000, [JSON]))


def test_a_query_without_end_is_ended_and_others_are_answered_meanwhile(standing: StandingDataset) -> None:
    ended: list[str] = []

    def ask_in_vain() -> None:
        try:
            standing.ask(StandingQuestion(ENDLESS, [JSON], seconds=1.0))
        except QueryTimeoutError as error:
            ended.append(str(error))

    thread = Thread(target=ask_in_vain)
    thread.start()
    assert rows(standing, "SELECT * { ?s ?p ?o }") == 3
    thread.join()
    assert ended == ["the query takes more than 1 s; ask for less"]


def test_a_query_that_takes_too_much_memory_is_ended_and_leaves_no_line(capfd: pytest.CaptureFixture[str]) -> None:
    own = StandingDataset()
    own.replace("urn:second", b"".join(b"<urn:a> <urn:p> <urn:%d> .\n" % number for number in range(100)))
    own.start()
    joined = " ".join(f"?a{n} ?b{n} ?c{n} ." for n in range(4))
    try:
        with pytest.raises(QueryTimeoutError, match="of memory"):
            own.ask(StandingQuestion(f"SELECT * {{ {joined} }} ORDER BY ?c3", [JSON], memory=1 << 29))
    finally:
        own.close()
    assert capfd.readouterr().err == ""


def test_a_query_whose_asker_hangs_up_is_ended(standing: StandingDataset) -> None:
    before = copies(standing)
    line = standing.begin(StandingQuestion(ENDLESS, [JSON], seconds=300.0))
    assert until(lambda: len(copies(standing)) == len(before) + 1)
    line.close()
    assert until(lambda: copies(standing) == before)


def test_an_asker_that_reads_slowly_receives_the_whole_answer(standing: StandingDataset) -> None:
    product = " ".join(f"?a{n} ?b{n} ?c{n} ." for n in range(8))
    question = StandingQuestion(f"SELECT * {{ {product} }}", ["text/csv"])
    with standing.begin(question) as line:
        wait_until_full(line)
        received = b"".join(iter(lambda: line.recv(1 << 16), b""))
    _, body = outcome(received, question)
    assert body.count(b"\n") - 1 == 3**8


def wait_until_full(line: socket.socket) -> None:
    """Wait until no more fits into the buffers of a socket that is not read: what waits in it grows no more."""
    grown, waits = 0, array("i", [-1])
    while waits[0] != grown or not grown:
        grown = waits[0]
        Event().wait(0.1)
        ioctl(line, FIONREAD, waits)


def test_no_answer_sees_half_a_graph(standing: StandingDataset) -> None:
    text = "SELECT * { GRAPH <urn:torn> { ?s ?p ?o } }"
    whole = [b"".join(b'<urn:x> <urn:v%d> "%d" .\n' % (version, number) for number in range(200)) for version in (1, 2)]
    standing.replace("urn:torn", whole[0])
    changing = Thread(target=lambda: [standing.replace("urn:torn", whole[number % 2]) for number in range(300)])
    changing.start()
    found = {rows(standing, text)}
    while changing.is_alive():
        found.add(rows(standing, text))
    assert found == {200}
    standing.replace("urn:torn", b"")
    assert rows(standing, text) == 0


def test_a_process_that_was_killed_is_started_again_with_all_graphs(standing: StandingDataset) -> None:
    assert standing._process is not None
    os.kill(standing._process.pid, signal.SIGKILL)
    standing._process.wait()
    assert rows(standing, "SELECT * { ?s ?p ?o }") == 3


def test_an_answer_that_breaks_off_is_no_answer() -> None:
    with pytest.raises(ProgrammerError):
        outcome(b"", StandingQuestion("ASK {}", [JSON]))


def copies(standing: StandingDataset) -> list[str]:
    """The processes that answer a question now."""
    assert standing._process is not None
    process = standing._process.pid
    return Path(f"/proc/{process}/task/{process}/children").read_text().split()


def until(condition: Callable[[], bool], seconds: float = 20.0) -> bool:
    """Wait for a condition, until a deadline."""
    deadline, moment = time.monotonic() + seconds, Event()
    while not condition() and time.monotonic() < deadline:
        moment.wait(0.01)
    return condition()
