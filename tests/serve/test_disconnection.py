"""Work for clients that hang up: it is broken off, and counts as no fault of the server."""

from __future__ import annotations

import asyncio
from typing import Any
from urllib.parse import quote

import pytest
from starlette.requests import ClientDisconnect, Request
from starlette.types import ASGIApp, Message

from selfconf.protocol.messages import TaskRecord
from selfconf.query import StandingDataset
from selfconf.serve import explained_refusals, fits
from selfconf.serve.board import Board
from selfconf.serve.disconnection import unless_gone
from selfconf.serve.watching.change import EcologyChange
from tests.lab import iri
from tests.serve.asgi import asked, served

SCOPE: dict[str, Any] = {
    "type": "http",
    "method": "GET",
    "path": "/",
    "query_string": b"",
    "headers": [(b"host", b"localhost")],
}


QUESTION = "/sparql?query=ASK%7B%7D"


async def left() -> Message:
    """What is received of a client that has hung up."""
    return {"type": "http.disconnect"}


async def never() -> None:
    await asyncio.Event().wait()


def test_the_result_of_the_work_is_returned_unless_the_client_has_gone() -> None:
    async def stays() -> Message:
        await never()
        raise AssertionError

    async def seven() -> int:
        return 7

    async def play() -> None:
        assert await unless_gone(Request(SCOPE, stays), seven()) == 7
        with pytest.raises(ClientDisconnect):
            await unless_gone(Request(SCOPE, left), never())

    asyncio.run(play())


async def hang_up(app: ASGIApp, path: str) -> None:
    """Ask, and be gone before the answer."""
    where, _, query = path.partition("?")
    said: list[Message] = [{"type": "http.request", "body": b"", "more_body": False}]

    async def receive() -> Message:
        return said.pop() if said else await left()

    async def send(message: Message) -> None:
        pass

    scope = {**SCOPE, "path": where, "raw_path": where.encode(), "query_string": query.encode()}
    scope |= {"scheme": "http", "server": ("localhost", 80), "root_path": ""}
    await asyncio.wait_for(app(scope, receive, send), 5)


@pytest.mark.parametrize("path", ["/mend?task=t", f"/fit?component={quote(iri('person-tracker'), safe='')}"])
def test_what_is_searched_for_clients_that_hang_up_keeps_no_other_waiting(
    board: Board, monkeypatch: pytest.MonkeyPatch, path: str
) -> None:
    body = {"priority": 0, "beginning": 0.0, "over": False, "lost": {}}
    board.apply(EcologyChange(tasks={"t": body}, records={"t": TaskRecord("t~1", 1)}))

    async def judged(*_: object) -> None:
        await never()

    for module in (explained_refusals, fits):
        monkeypatch.setattr(module, "judged_apart", judged)

    async def play() -> None:
        app = served(board)
        await asyncio.gather(*(hang_up(app, path) for _ in range(3)))

    asyncio.run(play())


def test_a_query_whose_client_hangs_up_is_counted_as_no_fault(board: Board, dataset: StandingDataset) -> None:
    async def play() -> bytes:
        app = served(board, dataset)
        await hang_up(app, QUESTION)
        assert (await asked(app, QUESTION)).json["boolean"]
        return (await asked(app, "/metrics")).body

    counted = asyncio.run(play())
    assert b'selfconf_queries_total{status="200"} 1' in counted
    assert b'status="500"' not in counted
