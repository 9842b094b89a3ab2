"""Asks an ASGI application in this process, without a socket."""

from __future__ import annotations

import asyncio
import json
from collections.abc import Collection, Coroutine
from typing import Any, NamedTuple, TypeVar
from urllib.parse import unquote

from starlette.types import ASGIApp, Message

from selfconf.bus.memory import Network
from selfconf.bus.port import Bus
from selfconf.query import StandingDataset
from selfconf.serve.application import LOOPBACK, application
from selfconf.serve.board import Board
from selfconf.serve.explained_refusals import ExplainedRefusals
from selfconf.serve.fits import Fits
from selfconf.serve.look_endpoint import Onlookers
from selfconf.serve.metrics import Metrics
from selfconf.serve.sparql.endpoint import SparqlEndpoint
from selfconf.serve.watching.watcher import EcologyWatcher
from tests.lab import Lab

Result = TypeVar("Result")


class Answer(NamedTuple):
    """What came back."""

    status: int
    headers: dict[str, str]
    body: bytes

    @property
    def json(self) -> Any:
        return json.loads(self.body)

    @property
    def media(self) -> str:
        return self.headers.get("content-type", "").partition(";")[0]


def served(
    board: Board,
    dataset: StandingDataset | None = None,
    seconds: float = 5.0,
    link: str | None = None,
    hosts: Collection[str] = LOOPBACK,
    bus: Bus | None = None,
    origins: Collection[str] = (),
) -> ASGIApp:
    """The application over a board, a dataset, and a bus on which nobody else is, unless one is given.

    `link` is that of the bus; by default the one over which the board was filled.
    """
    metrics = Metrics()
    sparql = SparqlEndpoint(StandingDataset() if dataset is None else dataset, metrics, seconds)
    bus = bus or Network().node()
    return application(
        board,
        metrics,
        sparql,
        Onlookers(bus, board),
        Fits(board),
        ExplainedRefusals(board),
        lambda: board.link if link is None else link,
        hosts,
        origins,
    )


def watched(lab: Lab, board: Board) -> None:
    """Have a board follow a simulated ecology, and wait until it knows what there is."""
    EcologyWatcher(lab.network.node(), "lab", board.apply, lambda: lab.network.time).begin()
    lab.let_pass(1.0)


def ask(
    app: ASGIApp, path: str, method: str = "GET", body: bytes = b"", host: str = "localhost:8000", **headers: str
) -> Answer:
    """The answer to one request; an underscore in the name of a header is a hyphen."""
    return asyncio.run(asked(app, path, method, body, host, **headers))


def meanwhile(lab: Lab, work: Coroutine[Any, Any, Result]) -> Result:
    """The result of some work of a server, while a simulated ecology goes on."""

    async def play() -> Result:
        doing = asyncio.create_task(work)
        while not doing.done():
            lab.let_pass(0.05)
            await asyncio.wait([doing], timeout=0.01)
        return doing.result()

    return asyncio.run(play())


async def asked(
    app: ASGIApp,
    path: str,
    method: str = "GET",
    body: bytes = b"",
    host: str = "localhost:8000",
    reads: asyncio.Event | None = None,
    **headers: str,
) -> Answer:
    """The answer to one request, within a running loop; of which the client takes nothing before the event `reads`."""
    where, _, query = path.partition("?")
    answered = asyncio.Event()
    sent: list[Message] = []
    waiting: list[Message] = [{"type": "http.request", "body": body, "more_body": False}]

    async def receive() -> Message:
        if waiting:
            return waiting.pop()
        await answered.wait()  # a client that waits for the answer says nothing
        return {"type": "http.disconnect"}

    async def send(message: Message) -> None:
        if reads is not None:
            await reads.wait()
        sent.append(message)

    named = {name.replace("_", "-"): value for name, value in headers.items()}
    scope = {
        "type": "http",
        "method": method,
        "path": unquote(where),
        "raw_path": where.encode(),
        "query_string": query.encode(),
        "headers": [(name.encode(), value.encode()) for name, value in {"host": host, **named}.items()],
        "scheme": "http",
        "server": ("localhost", 8000),
        "root_path": "",
    }
    await app(scope, receive, send)
    answered.set()
    begin = next(message for message in sent if message["type"] == "http.response.start")
    got = {name.decode(): value.decode() for name, value in begin["headers"]}
    text = b"".join(message.get("body", b"") for message in sent if message["type"] == "http.response.body")
    return Answer(begin["status"], got, text)
