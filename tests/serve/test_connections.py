"""Who sends a request byte by byte, or opens connections without an end, keeps nobody else from being served."""

from __future__ import annotations

import asyncio
import errno
import json
import socket
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest
import uvicorn

from selfconf.serve import connections
from selfconf.serve.connections import LoopFaults, config_of

SHORT = 0.3
LARGE = 400
"""How often 64 KiB are sent of an answer that no buffer holds."""
HEAD = b"POST /x HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\n\r\n"


async def app(scope: Any, receive: Any, send: Any) -> None:
    """Answers with the body of the request, once it is there."""
    if scope["path"] == "/large":
        await send({"type": "http.response.start", "status": 200, "headers": []})
        for number in range(LARGE):
            await send({"type": "http.response.body", "body": bytes(1 << 16), "more_body": number < LARGE - 1})
        return
    body, more = b"", True
    while more:
        event = await receive()
        if event["type"] == "http.disconnect":
            return
        body, more = body + event.get("body", b""), event.get("more_body", False)
    await send({"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"%d" % len(body))]})
    if scope["path"] == "/slow":
        await asyncio.sleep(3 * SHORT)  # an answer that takes its time
    await send({"type": "http.response.body", "body": body})


@pytest.fixture
def place(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[str, int]]:
    """A server that has little patience and few connections."""
    monkeypatch.setattr(connections, "REQUEST_SECONDS", SHORT)
    monkeypatch.setattr(connections, "UNREAD_SECONDS", SHORT)
    monkeypatch.setattr(connections, "MOST_CONNECTIONS", 20)
    listening = socket.create_server(("127.0.0.1", 0))
    server = uvicorn.Server(config_of(app))
    thread = threading.Thread(target=lambda: asyncio.run(server.serve(sockets=[listening])))
    thread.start()
    yield listening.getsockname()
    server.should_exit = True
    thread.join()
    listening.close()


def connected(place: tuple[str, int]) -> socket.socket:
    """A connection."""
    return socket.create_connection(place, 5.0)


def closed(link: socket.socket) -> bool:
    """Whether the other end closes a connection, without an answer."""
    try:
        return link.recv(100) == b""
    except ConnectionResetError:
        return True


def taken(link: socket.socket) -> int:
    """How many bytes come next; zero once the other end has closed the connection."""
    try:
        return len(link.recv(1 << 16))
    except ConnectionResetError:
        return 0


def sends(link: socket.socket) -> bool:
    """Whether one more byte can be sent."""
    try:
        link.sendall(b"G")
    except OSError:
        return False
    return True


def answered(place: tuple[str, int], path: bytes = b"/x") -> bool:
    """Whether an honest request is answered."""
    with connected(place) as link:
        link.sendall(HEAD.replace(b"/x", path) + b"hello")
        said = b""
        while b"hello" not in said and (more := link.recv(1000)):
            said += more
        return said.startswith(b"HTTP/1.1 200") and said.endswith(b"hello")


@pytest.mark.parametrize("sent", [b"", b"GET /", HEAD, HEAD + b"hel"], ids=["nothing", "head", "no body", "body"])
def test_a_request_that_does_not_arrive_in_time_is_not_waited_for(sent: bytes, place: tuple[str, int]) -> None:
    with connected(place) as link:
        link.sendall(sent)
        assert closed(link)


@pytest.mark.parametrize(
    "sent", [b"nonsense\r\n\r\n", b"GET /x HTTP/1.1\r\n\r\n", b"GET /" + b"x" * (1 << 16)], ids=["text", "host", "long"]
)
def test_what_is_no_request_is_answered_like_all_else(sent: bytes, place: tuple[str, int]) -> None:
    with connected(place) as link:
        link.sendall(sent)
        said = b""
        while not said.endswith(b"}") and (more := link.recv(10_000)):
            said += more
    head, _, body = said.partition(b"\r\n\r\n")
    assert head.startswith(b"HTTP/1.1 400 ")
    assert b"content-type: application/problem+json" in head.lower()
    assert b"content-security-policy: default-src 'none';" in head.lower()
    assert json.loads(body)["detail"] == connections.NO_REQUEST


def test_a_further_request_of_a_connection_is_waited_for_no_longer_than_the_first(place: tuple[str, int]) -> None:
    with connected(place) as link:
        link.sendall(HEAD + b"hello")
        said = b""
        while not said.endswith(b"hello"):
            said += link.recv(1000)
        link.sendall(HEAD)
        assert closed(link)


def test_a_byte_now_and_then_does_not_help(place: tuple[str, int]) -> None:
    began = time.monotonic()
    with connected(place) as link:
        while sends(link) and time.monotonic() < began + 20 * SHORT:
            threading.Event().wait(SHORT / 10)
    assert time.monotonic() < began + 20 * SHORT


def test_an_answer_may_take_longer(place: tuple[str, int]) -> None:
    assert answered(place, b"/slow")


@pytest.mark.parametrize("pause", [0.0, 3 * SHORT], ids=["at once", "late"])
def test_an_answer_that_is_not_taken_is_not_kept_for_ever(place: tuple[str, int], pause: float) -> None:
    size = 0
    with connected(place) as link:
        link.sendall(b"GET /large HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
        threading.Event().wait(pause)
        while more := taken(link):
            size += more
    assert (size > LARGE << 16) == (not pause)


def test_a_client_that_offers_http_2_is_answered_and_costs_no_line_of_the_log(
    capsys: pytest.CaptureFixture[str], place: tuple[str, int]
) -> None:
    offer = b"Connection: Upgrade, HTTP2-Settings\r\nUpgrade: h2c\r\nHTTP2-Settings: AAMAAABkAAQAAP__\r\n"
    with socket.create_connection(place) as connection:
        connection.sendall(HEAD[:-2] + offer + b"\r\nhello")
        assert connection.recv(1 << 12).startswith(b"HTTP/1.1 200 ")
    assert capsys.readouterr().err == ""


def test_who_opens_connections_without_an_end_is_served_no_longer_than_the_others(place: tuple[str, int]) -> None:
    held = [connected(place) for _ in range(40)]
    assert sum(map(closed, held)) == 40
    assert answered(place)
    for link in held:
        link.close()


def test_a_connection_too_many_is_closed_at_once_and_those_before_stay(
    place: tuple[str, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connections, "REQUEST_SECONDS", 60.0)
    held = [connected(place) for _ in range(connections.MOST_CONNECTIONS)]
    with connected(place) as another:
        assert closed(another)
    for link in held:
        link.sendall(HEAD + b"hello")
        assert link.recv(1000).startswith(b"HTTP/1.1 200 ")
        link.close()
    assert answered(place), "there is room again"


def test_that_no_file_is_left_for_a_connection_is_said_once_and_other_faults_as_always(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    refused = {"message": "socket.accept() out of system resource", "exception": OSError(errno.EMFILE, "Too many")}
    monkeypatch.setattr(connections, "REFUSED_AGAIN", 60.0)

    async def play() -> None:
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(LoopFaults())
        for context in (refused, refused, {"message": "broken", "exception": ValueError("x")}):
            loop.call_exception_handler(context)
        monkeypatch.setattr(connections, "REFUSED_AGAIN", 0.0)
        loop.call_exception_handler(refused)

    asyncio.run(play())
    sentence = "no further connection can be taken: Too many; allow more (`ulimit -n`)"
    assert [record.getMessage().splitlines()[0] for record in caplog.records] == [sentence, "broken", sentence]
