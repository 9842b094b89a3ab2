"""The stream of one who looks at a component: its events, its end, and how many there may be."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncGenerator
from typing import cast
from urllib.parse import quote

from starlette.requests import Request
from starlette.responses import StreamingResponse

from selfconf.bus.memory import Network
from selfconf.bus.port import Request as Question
from selfconf.bus.port import Urgency
from selfconf.serve.board import Board
from selfconf.serve.look_endpoint import MOST_LOOKS, Onlookers
from tests.lab import iri
from tests.serve.asgi import ask, served

QUERY = f"component={quote(iri('person-tracker'), safe='')}"
SCOPE = {"type": "http", "method": "GET", "query_string": QUERY.encode(), "headers": []}


async def look(onlookers: Onlookers) -> AsyncGenerator[bytes, None]:
    """The stream of one more who looks."""
    response = await onlookers.respond(Request(SCOPE))
    assert isinstance(response, StreamingResponse), response
    assert response.media_type == "text/event-stream"
    stream = cast(AsyncGenerator[bytes, None], response.body_iterator)
    assert (await anext(stream)).startswith(b"retry: ")
    return stream


def test_a_stream_tells_until_the_server_ends(board: Board) -> None:
    async def play() -> None:
        network = Network()
        onlookers = Onlookers(network.node(), board)
        stream = await look(onlookers)
        network.run(lambda: False, 5.0)
        kind, data = (await anext(stream)).decode().strip().split("\n")
        assert kind == "event: log"
        assert "does not tell" in json.loads(data.removeprefix("data: "))["trouble"]
        onlookers.close()
        assert [part async for part in stream if b"event: log" not in part] == []

    asyncio.run(play())


def test_who_goes_costs_the_ecology_nothing_any_more(board: Board) -> None:
    async def play() -> None:
        network, listened, asked = Network(), list[bool](), list[str]()
        other, tracker = network.node(), iri("person-tracker")
        other.publisher(board.keys.output(tracker, "pose"), Urgency.SIGNAL, listened.append)

        def answer(request: Question) -> None:
            asked.append(request.key)
            request.finish()

        other.serve(board.keys.log(board.advertised[tracker].site), answer)
        stream = await look(Onlookers(network.node(), board))
        network.run(lambda: False, 10.0)
        assert listened[-1]
        assert len(asked) > 2
        await stream.aclose()
        network.run(lambda: False, 1.0)
        asked.clear()
        network.run(lambda: False, 10.0)
        assert not listened[-1]
        assert asked == []

    asyncio.run(play())


def test_no_more_may_look_than_the_ecology_can_bear_and_those_who_go_make_room(board: Board) -> None:
    async def play() -> None:
        onlookers = Onlookers(Network().node(), board)
        streams = [await look(onlookers) for _ in range(MOST_LOOKS)]
        refused = await onlookers.respond(Request(SCOPE))
        assert refused.status_code == 503
        await streams[0].aclose()
        await look(onlookers)

    asyncio.run(play())


def test_of_many_that_come_at_the_same_moment_no_more_may_look_either(board: Board) -> None:
    async def play() -> None:
        onlookers = Onlookers(Network().node(), board)
        responses = [await onlookers.respond(Request(SCOPE)) for _ in range(MOST_LOOKS + 3)]
        streams = [cast(StreamingResponse, response).body_iterator for response in responses]
        firsts = [await anext(cast(AsyncGenerator[bytes, None], stream), b"") for stream in streams]
        assert firsts.count(b"") == 3

    asyncio.run(play())


def test_only_what_is_advertised_can_be_looked_at(board: Board) -> None:
    for path in ("/look", "/look?component=urn:nobody", "/fit", "/fit?component=urn:nobody"):
        answer = ask(served(board), path)
        assert (answer.status, answer.media) == (404, "application/problem+json")
