"""What holds for every answer of the server."""

from __future__ import annotations

import asyncio
import random
from urllib.parse import quote

import pytest
from starlette.responses import Response
from starlette.types import Message

from selfconf.serve.application import LOOPBACK, PIECE, Guard
from selfconf.serve.board import Board
from selfconf.serve.metrics import Metrics
from selfconf.serve.origins import Origins
from selfconf.serve.watching.change import EcologyChange
from tests.lab import iri
from tests.serve.asgi import ask, served


def test_the_page_is_there_and_nothing_behind_it(board: Board) -> None:
    answer = ask(served(board), "/")
    assert (answer.status, answer.media) == (200, "text/html")
    tag = answer.headers["etag"]
    for known, status in ((tag, 304), (f'"other", W/{tag}', 304), ("*", 304), ('"other"', 200), (tag[1:], 200)):
        assert ask(served(board), "/", if_none_match=known).status == status
    for path in ("/page/nothing.js", "/page/..%2Fserver.py", "/nothing"):
        answer = ask(served(board), path)
        assert answer.status == 404
        assert "/sparql" in answer.json["detail"], "it says what there is"


@pytest.mark.parametrize("path", ["/", "/state", "/nothing", "/metrics"])
def test_every_answer_forbids_what_a_stranger_might_slip_in(board: Board, path: str) -> None:
    policy = ask(served(board), path).headers["content-security-policy"]
    assert "default-src 'none'" in policy
    assert "unsafe" not in policy


@pytest.mark.parametrize("size", [0, 1, PIECE, PIECE + 1, 3 * PIECE])
def test_a_long_answer_is_sent_in_pieces_for_each_of_which_the_client_is_waited_for(size: int) -> None:
    whole, sent = random.Random(size).randbytes(size), []

    async def send(message: Message) -> None:
        sent.append(message)

    async def receive() -> Message:
        raise AssertionError("nothing is read")

    scope = {"type": "http", "method": "GET", "path": "/", "headers": [(b"host", b"localhost")]}
    asyncio.run(Guard(Response(whole), LOOPBACK, Origins(()))(scope, receive, send))
    pieces = [message["body"] for message in sent[1:]]
    assert b"".join(pieces) == whole
    assert max(map(len, pieces)) <= PIECE
    assert [message.get("more_body", False) for message in sent[1:]] == [True] * (len(pieces) - 1) + [False]


@pytest.mark.parametrize("path", ["/changes", "/events", f"/look?component={quote(iri('pippi-drive'))}"])
def test_a_stream_that_is_asked_for_its_head_alone_ends(board: Board, path: str) -> None:
    answer = ask(served(board), path, "HEAD")
    assert (answer.status, answer.media, answer.body) == (200, "text/event-stream", b"")
    assert board.stream.listeners == 0


@pytest.mark.parametrize("host", ["evil.example", "evil.example:8000", "", "localhost.evil.example"])
def test_a_name_that_is_not_of_this_machine_is_refused(board: Board, host: str) -> None:
    assert ask(served(board), "/state", host=host).status == 421
    assert ask(served(board, hosts=frozenset()), "/state", host=host).status == 200


@pytest.mark.parametrize("host", ["127.0.0.1:8000", "localhost", "[::1]", "[::1]:8000", "LOCALHOST:1"])
def test_a_name_of_this_machine_is_answered(board: Board, host: str) -> None:
    assert ask(served(board), "/state", host=host).status == 200


@pytest.mark.parametrize("target", ["http://localhost/healthz", "HTTP://127.0.0.1:8000/healthz?x=http://evil.example/"])
def test_a_target_with_the_host_in_it_is_answered_like_its_path(board: Board, target: str) -> None:
    for host in ("localhost", "evil.example"):
        assert ask(served(board), target, host=host).json == {"status": "ok"}, "the header counts for nothing"
    page = ask(served(board), "http://localhost")
    assert (page.status, page.media) == (200, "text/html")
    assert b"<http://localhost:1/sparql>" in ask(served(board), "http://localhost:1/sparql", accept="text/turtle").body


@pytest.mark.parametrize("host", ["evil.example", "evil.example@localhost", "localhost@evil.example", ""])
def test_a_target_with_another_host_in_it_is_refused(board: Board, host: str) -> None:
    assert ask(served(board), f"http://{host}/healthz").status == 421


def test_a_request_that_says_its_length_twice_is_refused_and_its_connection_closed(board: Board) -> None:
    headers = {"content_length": "6", "transfer_encoding": "chunked", "content_type": "application/sparql-query"}
    answer = ask(served(board), "/sparql", "POST", b"ASK {}", **headers)
    assert (answer.status, answer.headers["connection"]) == (400, "close")
    assert "Content-Length" in answer.json["detail"]


def test_a_request_without_a_host_learns_that_it_names_none(board: Board) -> None:
    assert ask(served(board), "/healthz", host="").json["detail"].startswith("the request names no host;")


@pytest.mark.parametrize("method", ["TRACE", "OPTIONS", "PUT", "PATCH", "DELETE", "FOO"])
def test_a_method_that_is_not_known_is_answered_with_those_that_are(board: Board, method: str) -> None:
    known = {"/sparql": "GET, HEAD, POST", "/sparql/": "GET, HEAD, POST", "/things": "GET, HEAD", "/": "GET, HEAD"}
    for path, methods in known.items():
        answer = ask(served(board), path, method)
        assert (answer.status, answer.media) == (405, "application/problem+json")
        assert answer.headers["allow"] == methods
        assert answer.json["detail"] == f"this is asked by one of {methods}"


def test_health_is_whether_the_ecology_is_heard(board: Board) -> None:
    assert ask(served(board), "/healthz").status == 200
    assert ask(served(board, link=""), "/healthz").status == 503


def test_health_is_good_again_only_once_everything_was_looked_at_over_a_new_link(board: Board) -> None:
    app = served(board, link="another")
    assert [ask(app, path).status for path in ("/healthz", "/things")] == [503, 503]
    board.apply(EcologyChange(link="another"))
    assert [ask(app, path).status for path in ("/healthz", "/things")] == [200, 200]


@pytest.mark.parametrize(
    "path", ["/things", "/things/urn:x", "/sparql?query=ASK%7B%7D", "/search/sparql?query=ASK%7B%7D"]
)
def test_what_lives_is_not_answered_while_the_ecology_is_not_heard(board: Board, path: str) -> None:
    for app in (served(board, link=""), served(Board("lab", Metrics()))):
        answer = ask(app, path)
        assert (answer.status, answer.media) == (503, "application/problem+json")
        assert answer.json["detail"] == "the ecology cannot be heard; ask again in a while"
    assert ask(served(board, link=""), "/.well-known/wot").status == 200


def test_the_state_and_the_metrics_are_served(board: Board) -> None:
    assert ask(served(board), "/state").json["ecology"] == "lab"
    answer = ask(served(board), "/metrics")
    assert b'selfconf_components{state="alive"} 7' in answer.body
    assert answer.headers["content-type"].startswith("text/plain; version=0.0.4")
