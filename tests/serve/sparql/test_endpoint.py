"""SPARQL over HTTP: formats, errors, limits, and many clients at once."""

from __future__ import annotations

import asyncio
import time
from urllib.parse import quote

import pytest

from selfconf.query import StandingDataset
from selfconf.serve.board import Board
from selfconf.serve.sparql import endpoint
from tests.lab import ADVERTISEMENTS
from tests.serve.asgi import ask, asked, served

pytestmark = pytest.mark.process
EVERYBODY = "/sparql?query=" + quote("SELECT ?c { ?c a sc:Component }")
CROSS = "/sparql?query=" + quote(
    "SELECT (COUNT(*) AS ?n) { " + " ".join(f"?a{n} ?b{n} ?c{n} ." for n in range(9)) + "}"
)


@pytest.mark.parametrize(
    ("accept", "media"),
    [
        ("", "application/sparql-results+json"),
        ("application/sparql-results+xml", "application/sparql-results+xml"),
        ("application/json", "application/json"),
        ("application/xml", "application/xml"),
        ("application/xml, application/sparql-results+xml", "application/sparql-results+xml"),
        ("text/csv", "text/csv"),
        ("text/tab-separated-values", "text/tab-separated-values"),
        ("text/html, */*;q=0.1", "application/sparql-results+json"),
    ],
)
def test_solutions_come_in_the_format_that_is_wanted(
    board: Board, dataset: StandingDataset, accept: str, media: str
) -> None:
    answer = ask(served(board, dataset), EVERYBODY, accept=accept)
    assert (answer.status, answer.media) == (200, media)
    assert answer.body.count(b"person-tracker") == 1


@pytest.mark.parametrize(
    ("accept", "media"),
    [("", "text/turtle"), ("application/n-triples", "application/n-triples"), ("image/png", "text/turtle")],
)
def test_the_service_description_comes_in_the_format_that_is_wanted_or_as_turtle(
    board: Board, dataset: StandingDataset, accept: str, media: str
) -> None:
    answer = ask(served(board, dataset), "/sparql", accept=accept)
    assert (answer.status, answer.media) == (200, media)


@pytest.mark.parametrize(
    "media", ["text/turtle", "application/n-triples", "application/rdf+xml", "application/ld+json"]
)
def test_triples_come_in_the_format_that_is_wanted(board: Board, dataset: StandingDataset, media: str) -> None:
    path = "/search/sparql?query=" + quote("CONSTRUCT { ?c a sc:Component } { ?c a sc:Component }")
    answer = ask(served(board, dataset), path, accept=media)
    assert (answer.status, answer.media) == (200, media)


def test_errors_are_problems_with_the_status_of_the_protocol(board: Board, dataset: StandingDataset) -> None:
    app = served(board, dataset)
    for answer, status in (
        (ask(app, "/sparql?query=SELEKT"), 400),
        (ask(app, "/sparql", "POST", b"ASK {}", content_type="text/plain"), 415),
        (ask(app, "/sparql?query=ASK+%7B%7D", "DELETE"), 405),
        (ask(app, EVERYBODY, accept="text/turtle"), 406),
        (ask(app, "/sparql", "POST", b"x" * (2 << 20), content_type="application/sparql-query"), 413),
    ):
        assert (answer.status, answer.media) == (status, "application/problem+json")
        assert answer.json["detail"]


@pytest.mark.parametrize("coding", ["gzip", "br", "identity, gzip", "zstd"])
def test_a_body_that_is_compressed_is_refused_as_such(board: Board, dataset: StandingDataset, coding: str) -> None:
    headers = {"content_type": "application/sparql-query", "content_encoding": coding}
    answer = ask(served(board, dataset), "/sparql", "POST", b"ASK {}", **headers)
    assert answer.status == 415
    assert coding in answer.json["detail"]
    assert ask(served(board, dataset), "/sparql", "POST", b"ASK {}", **headers | {"content_encoding": "identity"}).json


def test_a_body_that_is_announced_too_large_is_refused_before_it_comes(board: Board, dataset: StandingDataset) -> None:
    headers = {"content_type": "application/sparql-query", "content_length": str(2 << 20)}
    assert ask(served(board, dataset), "/sparql", "POST", b"ASK {}", **headers).status == 413


def test_a_query_that_takes_too_long_is_really_ended(board: Board, dataset: StandingDataset) -> None:
    began = time.monotonic()
    answer = ask(served(board, dataset, seconds=0.5), CROSS)
    assert answer.status == 503
    assert "0.5 s" in answer.json["detail"]
    assert time.monotonic() - began < 20


def test_an_answer_counts_among_those_at_once_until_its_client_has_taken_it(
    board: Board, dataset: StandingDataset, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(endpoint, "AT_ONCE", 2)
    app = served(board, dataset)

    async def play() -> None:
        reads = asyncio.Event()
        unread = [asyncio.create_task(asked(app, EVERYBODY, reads=reads)) for _ in range(2)]
        await asyncio.wait(unread, timeout=0.5)
        waiting = asyncio.create_task(asked(app, EVERYBODY))
        assert not (await asyncio.wait([waiting], timeout=0.5))[0]
        unread.pop().cancel()  # its client has gone
        assert (await waiting).status == 200
        reads.set()
        assert [(await one).status for one in unread] == [200]

    asyncio.run(play())


def test_many_clients_are_answered_while_one_asks_for_a_cross_product(board: Board, dataset: StandingDataset) -> None:
    app = served(board, dataset, seconds=1.5)

    async def play() -> tuple[list[int], int, float]:
        began = time.monotonic()
        greedy = asyncio.create_task(asked(app, CROSS))
        answers = await asyncio.gather(*(asked(app, EVERYBODY) for _ in range(50)))
        seconds = time.monotonic() - began
        assert not greedy.done() or seconds >= 1.5
        return [len(answer.json["results"]["bindings"]) for answer in answers], (await greedy).status, seconds

    counts, status, _ = asyncio.run(play())
    assert counts == [len(ADVERTISEMENTS)] * 50
    assert status == 503
