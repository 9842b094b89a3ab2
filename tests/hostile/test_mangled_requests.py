"""Mangled HTTP requests over a real socket: each is answered with what is wrong with it, or its connection closed."""

from __future__ import annotations

import logging
import socket
import threading
from collections.abc import Iterator
from random import Random

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.harness.effort import examples
from tests.hostile.bounded import bounded
from tests.hostile.mangling import in_time, mangled
from tests.lab import ADVERTISEMENTS

uvicorn = pytest.importorskip("uvicorn")
pytest.importorskip("starlette")

QUERY = b"SELECT ?s WHERE { ?s a <https://w3id.org/selfconf#Component> }"
HEAD = b"Host: localhost\r\nAccept: application/json;q=0.5, */*;q=0.1\r\n"
REQUESTS = (
    *(
        b"GET " + path + b" HTTP/1.1\r\n" + HEAD + b"\r\n"
        for path in (
            b"/",
            b"/page/app.js",
            b"/state",
            b"/changes?last=1",
            b"/events/thing_created",
            b"/things?limit=2&offset=1",
            b"/things/urn:x",
            b"/.well-known/wot",
            b"/metrics",
            b"/healthz",
            b"/sparql?query=ASK%20%7B%7D&default-graph-uri=urn:x",
        )
    ),
    b"POST /sparql HTTP/1.1\r\n" + HEAD + b"Content-Type: application/sparql-query; charset=utf-8\r\n"
    b"Content-Length: " + str(len(QUERY)).encode() + b"\r\n\r\n" + QUERY,
    b"POST /sparql HTTP/1.1\r\n" + HEAD + b"Content-Type: application/x-www-form-urlencoded\r\n"
    b"Transfer-Encoding: chunked\r\n\r\n11\r\nquery=ASK+%7B%7D&\r\n0\r\n\r\n",
)
PATIENCE = 20.0
"""Seconds of real time for an answer, on a machine that does something else."""


@pytest.fixture(scope="module")
def port() -> Iterator[int]:
    """Where a server listens that shows the ecology of the tests."""
    from selfconf.query import StandingDataset
    from selfconf.serve.board import Board
    from selfconf.serve.metrics import Metrics
    from selfconf.serve.server import bound
    from tests.serve.asgi import served
    from tests.serve.shown import advertised

    dataset = StandingDataset()
    board = Board("lab", Metrics())
    board.apply(advertised(*ADVERTISEMENTS))
    config = uvicorn.Config(
        served(board, dataset, 2.0), log_level="warning", access_log=False, lifespan="off", ws="none"
    )
    config.timeout_graceful_shutdown = 1
    server = uvicorn.Server(config)
    with bound("127.0.0.1", 0) as place:
        thread = threading.Thread(target=server.run, args=([place],))
        thread.start()
        yield place.getsockname()[1]
        server.should_exit = True
        thread.join()
    dataset.close()


def said(port: int, request: bytes, end: bool = True) -> bytes:
    """The beginning of the answer to some bytes, the last or not; empty if the connection is closed without one."""
    with socket.create_connection(("127.0.0.1", port), PATIENCE) as connection:
        try:
            connection.sendall(request)
            if end:
                connection.shutdown(socket.SHUT_WR)
            return connection.recv(1 << 16)
        except (ConnectionError, BrokenPipeError):
            return b""


def check(port: int, request: bytes) -> None:
    """Make a request, which is answered, and not by a fault of the server."""
    answer = said(port, request)
    assert answer == b"" or (answer.startswith(b"HTTP/1.1 ") and answer[9:12] != b"500"), answer[:200]


def test_requests_that_are_not_mangled_are_answered(port: int) -> None:
    for request in REQUESTS:
        assert said(port, request, end=False)[9:12] in (b"200", b"404"), request


@settings(max_examples=examples(500))
@given(st.sampled_from(REQUESTS), st.randoms(use_true_random=False))
def test_a_mangled_request_is_answered_or_its_connection_closed(port: int, request_: bytes, random: Random) -> None:
    with in_time():
        check(port, mangled(request_, random))


def test_nothing_stays_of_mangled_requests(port: int, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.CRITICAL)
    random = Random(1)
    for _ in range(200):
        check(port, mangled(random.choice(REQUESTS), random))
    with bounded(60.0, peak=30.0, left=1.0):
        for _ in range(200):
            check(port, mangled(random.choice(REQUESTS), random))
