"""Streams of events and long polls of a real server: they are followed within their bounds, however they come."""

from __future__ import annotations

import asyncio
import json
import time
from collections.abc import AsyncIterator
from http.server import BaseHTTPRequestHandler
from typing import Any

import pytest

from selfconf.bridging.wot.forms import ThingForm
from selfconf.bridging.wot.thing_client import (
    MOST_EVENTS,
    ThingAnswer,
    ThingClient,
    ThingError,
    ThingLimits,
)
from tests.bridging.thing_server import ThingServer, reply
from tests.bridging.wot.thing_requests import LIMITS, Start, asked


async def streamed(client: ThingClient, server: ThingServer, media: str = "application/json") -> list[ThingAnswer]:
    """What a thing streams to its end."""
    async with client.subscribed(ThingForm(server.url + "/on", "GET", media, "sse")) as answers:
        return [answer async for answer in answers]


def begin_stream(handler: BaseHTTPRequestHandler) -> None:
    """Answer with server-sent events, which are to follow."""
    handler.send_response(200)
    handler.send_header("Content-Type", "text/event-stream")
    handler.send_header("Connection", "close")
    handler.end_headers()


def test_server_sent_events_come_one_by_one(thing_server: Start) -> None:
    server = thing_server()

    def stream(handler: BaseHTTPRequestHandler) -> None:
        begin_stream(handler)
        handler.wfile.write(b": hello\n\nid: 1\nda")
        handler.wfile.flush()
        handler.wfile.write(b"ta: 1\r\n\r\ndata: {\ndata: }\n\nevent: ping\ndata:\n\nevent: x\ndata:true\n\n")
        handler.close_connection = True

    server.answers["/on"] = stream

    async def work(client: ThingClient) -> list[Any]:
        return [answer.value for answer in await streamed(client, server)]

    assert asked(work) == [1, {}, True]
    assert server.received[0].headers["Accept"] == "text/event-stream"


@pytest.mark.parametrize(
    ("media", "value"),
    [
        ("application/json", ThingAnswer(1)),
        ("text/event-stream", ThingAnswer(1)),
        ("text/plain; charset=utf-8", ThingAnswer(b"1", "text/plain")),
    ],
)
def test_an_event_is_of_the_media_type_of_its_form(thing_server: Start, media: str, value: ThingAnswer) -> None:
    server = thing_server()

    def stream(handler: BaseHTTPRequestHandler) -> None:
        begin_stream(handler)
        handler.wfile.write(b"data: 1\n\n")
        handler.close_connection = True

    server.answers["/on"] = stream
    assert asked(lambda client: streamed(client, server, media)) == [value]


@pytest.mark.parametrize("text", [b"data: 1", b"data: 1\n"])
def test_a_stream_without_end_of_line_or_of_event_is_bounded(thing_server: Start, text: bytes) -> None:
    server = thing_server()

    def stream(handler: BaseHTTPRequestHandler) -> None:
        begin_stream(handler)
        while not server.released.is_set():
            handler.wfile.write(text * 10_000)

    server.answers["/on"] = stream

    async def work(client: ThingClient) -> list[ThingAnswer]:
        return await streamed(client, server)

    with pytest.raises(ThingError, match="more than 1 MiB"):
        asked(work, LIMITS)


class InPieces:
    """An answer of one line that comes in many pieces."""

    def __init__(self, pieces: int) -> None:
        self.content, self._pieces = self, pieces

    async def iter_any(self) -> AsyncIterator[bytes]:
        """The pieces."""
        for _ in range(self._pieces):
            yield b"x" * 500
        yield b"\r\n"


def test_a_long_line_that_comes_in_many_pieces_costs_no_time() -> None:
    """As long as it took to copy what had come by each of them, a slow thing held up all others."""

    async def work(client: ThingClient) -> list[int]:
        answer: Any = InPieces(8_000)
        return [len(line) async for line in client._lines(ThingForm("http://x/", "GET"), answer)]

    began = time.process_time()
    assert asked(work, ThingLimits(size=1 << 24)) == [4_000_000]
    assert time.process_time() - began < 3.0


def test_a_thing_that_streams_without_a_pause_is_read_as_fast_as_is_allowed_and_disturbs_no_other(
    thing_server: Start,
) -> None:
    server = thing_server()

    def stream(handler: BaseHTTPRequestHandler) -> None:
        begin_stream(handler)
        while not server.released.is_set():
            handler.wfile.write(b"data: 1\n\n" * 10_000)

    server.answers["/on"] = stream
    server.answers["/other"] = lambda handler: reply(handler, b"true")

    async def work(client: ThingClient) -> tuple[float, int]:
        read: list[ThingAnswer] = []

        async def follow() -> None:
            form = ThingForm(server.url + "/on", "GET", subprotocol="sse")
            async with client.subscribed(form) as answers:
                async for answer in answers:
                    read.append(answer)

        began, following = time.monotonic(), asyncio.ensure_future(follow())
        for _ in range(10):
            assert (await client.read(ThingForm(server.url + "/other", "GET"))).value is True
        while not read:
            await asyncio.sleep(0.01)
        following.cancel()
        return time.monotonic() - began, len(read)

    seconds, events = asked(work)
    assert events <= seconds * MOST_EVENTS + 1


def test_a_long_poll_waits_for_longer_than_an_answer_may_take(thing_server: Start) -> None:
    server = thing_server()
    turns: list[int] = []

    def poll(handler: BaseHTTPRequestHandler) -> None:
        turns.append(1)
        if len(turns) == 1:
            server.released.wait(0.8)
        reply(handler, b"" if len(turns) == 2 else json.dumps(len(turns)).encode(), 204 if len(turns) == 2 else 200)

    server.answers["/on"] = poll

    async def work(client: ThingClient) -> list[ThingAnswer | None]:
        form = ThingForm(server.url + "/on", "GET", subprotocol="longpoll")
        return [await client.wait(form) for _ in range(3)]

    assert asked(work, LIMITS) == [ThingAnswer(1), None, ThingAnswer(3)]


def test_a_long_poll_that_is_answered_with_nothing_is_let_go_of(thing_server: Start) -> None:
    server = thing_server()

    def nothing(handler: BaseHTTPRequestHandler) -> None:
        handler.send_response(200)
        handler.send_header("Content-Length", "0")
        handler.end_headers()

    server.answers["/on"] = nothing
    assert asked(lambda client: client.wait(ThingForm(server.url + "/on", "GET", subprotocol="longpoll"))) is None
