"""`/sparql`: each query is answered in a process that can be ended, and in the media type that the client wants."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import time

from starlette.requests import Request
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from selfconf.errors import NetworkError, NotAcceptableError, ProgrammerError, QueryError, QueryTimeoutError
from selfconf.query import RESULT_TYPES, TRIPLE_TYPES, StandingDataset, StandingQuestion, outcome
from selfconf.serve.disconnection import unless_gone
from selfconf.serve.metrics import Metrics
from selfconf.serve.negotiation import acceptable, accepted_by
from selfconf.serve.problems import problem
from selfconf.serve.sparql.requests import LARGEST_REQUEST, QueryRequest, RequestRefusedError, query_request
from selfconf.serve.sparql.service_description import service_description

LARGEST_ANSWER = 64 << 20
"""An answer of more bytes than this is refused."""
AT_ONCE = 24
"""How many queries are answered at once, until their clients have the answers; others wait."""
BROADER = {"application/json": "application/sparql-results+json", "application/xml": "application/sparql-results+xml"}
"""Clients that know JSON or XML alone, as those of Things do, ask for the broader type and read the results."""
_STATUS: dict[type[Exception], int] = {
    QueryTimeoutError: 503,
    NotAcceptableError: 406,
    QueryError: 400,
    NetworkError: 503,
    ProgrammerError: 500,
}


class AnswerTooLargeError(QueryError):
    """An answer has more bytes than a server holds."""


class _HeldResponse(Response):
    """An answer that holds what it was given until it is sent, or its client has gone."""

    def __init__(self, answer: bytes, media: str, held: contextlib.AsyncExitStack) -> None:
        super().__init__(answer, media_type=media, headers={"Vary": "Accept"})
        self._held = held

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send it."""
        async with self._held:
            await super().__call__(scope, receive, send)


class SparqlEndpoint:
    """Answers SPARQL over HTTP from a standing dataset."""

    def __init__(self, dataset: StandingDataset, metrics: Metrics, seconds: float) -> None:
        self._dataset, self._metrics, self._seconds = dataset, metrics, seconds
        self._free = asyncio.Semaphore(AT_ONCE)

    async def respond(self, request: Request) -> Response:
        """The response to a request."""
        try:
            body = await body_of(request)
            method = "POST" if request.method == "POST" else "GET"
            query = query_request(method, request.url.query, request.headers.get("content-type", ""), body)
        except RequestRefusedError as error:
            return problem(error.status, error.detail)
        accept = accepted_by(request)
        if query is None:
            return self._description(request, accept)
        return await self._answer(query, accept, request)

    def _description(self, request: Request, accept: str) -> Response:
        media = acceptable(accept, list(TRIPLE_TYPES)) or ["text/turtle"]
        return Response(
            service_description(_endpoint(request), media[0]), media_type=media[0], headers={"Vary": "Accept"}
        )

    async def _answer(self, query: QueryRequest, accept: str, request: Request) -> Response:
        media = acceptable(accept, [*RESULT_TYPES, *TRIPLE_TYPES, *BROADER])
        known = list(dict.fromkeys(BROADER.get(one, one) for one in media))
        question = StandingQuestion(
            query.text, known, query.default_graphs, query.named_graphs, self._seconds, base=_endpoint(request)
        )
        began = time.monotonic()
        try:
            async with contextlib.AsyncExitStack() as held:
                await held.enter_async_context(self._free)
                received = await unless_gone(request, self._received(question))
                kind, answer = outcome(received, question)
                until_sent = held.pop_all()
        except (QueryError, NetworkError, ProgrammerError) as error:
            status = next(status for known, status in _STATUS.items() if isinstance(error, known))
            self._metrics.queried(str(status), time.monotonic() - began)
            return problem(status, str(error))
        self._metrics.queried("200", time.monotonic() - began)
        told = next((broad for broad in media if BROADER.get(broad) == kind and kind not in media), kind)
        return _HeldResponse(answer, told, until_sent)

    async def _received(self, question: StandingQuestion) -> bytes:
        """All that comes on the socket of a question; a client that hangs up ends the query."""
        begun = asyncio.ensure_future(asyncio.to_thread(self._dataset.begin, question))
        try:
            line = await asyncio.shield(begun)
        except asyncio.CancelledError:
            begun.add_done_callback(_close_line)  # a thread cannot be cancelled: its socket has no owner
            raise
        try:
            line.setblocking(False)
            return await _read(line)
        finally:
            line.close()


def _close_line(begun: asyncio.Future[socket.socket]) -> None:
    """Close the socket of a question that was begun in vain, which ends the query."""
    if not begun.cancelled() and begun.exception() is None:  # the server may have ended meanwhile
        begun.result().close()


def _endpoint(request: Request) -> str:
    """The URL at which a request found the endpoint."""
    return str(request.url.replace(query="", fragment=""))


async def _read(line: socket.socket) -> bytes:
    loop, parts, size = asyncio.get_running_loop(), [], 0
    while part := await loop.sock_recv(line, 1 << 18):
        parts.append(part)
        size += len(part)
        if size > LARGEST_ANSWER:
            raise AnswerTooLargeError(f"the answer has more than {LARGEST_ANSWER >> 20} MiB; ask for less, by LIMIT")
    return b"".join(parts)


async def body_of(request: Request) -> bytes:
    """The body of a request.

    Raises RequestRefusedError for one that is compressed, and for one that is too large, before it comes where it says
    so.
    """
    if (coding := request.headers.get("content-encoding", "identity").strip().lower()) not in ("", "identity"):
        raise RequestRefusedError(415, f"a body is taken as it is, and not in {coding}; leave out Content-Encoding")
    too_large = RequestRefusedError(413, f"the request has more than {LARGEST_REQUEST >> 20} MiB")
    announced = request.headers.get("content-length", "")
    if announced.isascii() and announced.isdigit() and int(announced) > LARGEST_REQUEST:
        raise too_large
    parts, size = [], 0
    async for part in request.stream():
        parts.append(part)
        size += len(part)
        if size > LARGEST_REQUEST:
            raise too_large
    return b"".join(parts)
