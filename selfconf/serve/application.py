"""The routes of the server, and what holds for every one of them: who may ask, and what a browser may do."""

from __future__ import annotations

import hashlib
import json
import mimetypes
from collections.abc import Awaitable, Callable, Collection, Mapping
from importlib.resources import files
from urllib.parse import unquote

from starlette.applications import Starlette
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect, Request
from starlette.responses import Response
from starlette.routing import Route
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from selfconf.serve.board import CHANGE, Board
from selfconf.serve.directory import Directory
from selfconf.serve.event_stream import streamed
from selfconf.serve.explained_refusals import ExplainedRefusals
from selfconf.serve.fits import Fits
from selfconf.serve.look_endpoint import Onlookers
from selfconf.serve.metrics import PROMETHEUS, Metrics
from selfconf.serve.origins import Origins
from selfconf.serve.problems import problem
from selfconf.serve.sparql.endpoint import SparqlEndpoint

LOOPBACK = frozenset({"127.0.0.1", "localhost", "[::1]"})
"""The names under which a server on this machine may be asked: a page elsewhere may know it under another one."""
SPARQL_METHODS = ("GET", "HEAD", "POST")
"""The methods by which the SPARQL endpoint is asked; everything else is asked by the first two alone."""
NOTHING_THERE = "there is no such page; / is the page, /sparql, /things and /metrics are for programs"
TWO_LENGTHS = "the request says its length twice, by Transfer-Encoding and by Content-Length; leave out one"
PIECE = 1 << 16
"""Bytes of an answer that are sent before the client has taken those before, so that what waits for it is no more."""
ABSOLUTE = b"http://"
"""What the target of a request begins with that names the host as well."""
HEADERS = {
    "Content-Security-Policy": "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:;"
    " connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
}
"""What every answer says to a browser: load nothing from elsewhere, run nothing that is not a file of the page."""


def application(
    board: Board,
    metrics: Metrics,
    sparql: SparqlEndpoint,
    onlookers: Onlookers,
    fits: Fits,
    explained: ExplainedRefusals,
    link: Callable[[], str],
    hosts: Collection[str],
    origins: Collection[str],
) -> ASGIApp:
    """The server as an ASGI application; `link` tells by what the ecology can be heard, if it can be.

    `hosts` are the names under which it may be asked; empty for any. Pages of the `origins` may ask what is standard.
    """
    directory = Directory(board)
    page = {name: _file(name) for name in _names()}

    async def file(request: Request) -> Response:
        found = page.get(request.path_params.get("name", "index.html"))
        if found is None:
            return problem(404, NOTHING_THERE)
        text, media, tag = found
        if _names_tag(request.headers.get("if-none-match", ""), tag):
            return Response(status_code=304, headers={"ETag": tag})
        return Response(text, media_type=media, headers={"ETag": tag, "Cache-Control": "no-cache"})

    async def state(_: Request) -> Response:
        text = board.shared("/state", lambda: json.dumps(board.state(), ensure_ascii=False))
        return Response(text, media_type="application/json")

    async def changes(request: Request) -> Response:
        last = request.headers.get("last-event-id") or request.query_params.get("last", "")
        return streamed(request, board.stream.lines((CHANGE,), last))

    async def counted(_: Request) -> Response:
        return Response(metrics.text(board.gauges(bool(link()))), media_type=PROMETHEUS)

    async def health(_: Request) -> Response:
        return Response('{"status": "ok"}', media_type="application/json")

    def once_heard(respond: Callable[[Request], Awaitable[Response]]) -> Callable[[Request], Awaitable[Response]]:
        """Have a route answer only while the ecology can be heard: what is known of it then is not what there is."""

        async def answer(request: Request) -> Response:
            if board.link and link() == board.link:
                return await respond(request)
            return problem(503, "the ecology cannot be heard; ask again in a while", {"Retry-After": "1"})

        return answer

    query = once_heard(sparql.respond)
    routes = [
        Route("/", file),
        Route("/page/{name}", file),
        Route("/state", state),
        Route("/changes", changes),
        Route("/look", onlookers.respond),
        Route("/fit", fits.respond),
        Route("/mend", explained.respond),
        *(Route(path, query, methods=SPARQL_METHODS) for path in ("/sparql", "/sparql/", "/search/sparql")),
        Route("/.well-known/wot", directory.itself),
        Route("/things", once_heard(directory.things)),
        Route("/things/{id:path}", once_heard(directory.thing)),
        Route("/events", directory.events),
        Route("/events/{kind}", directory.events),
        Route("/metrics", counted),
        Route("/healthz", once_heard(health)),
    ]
    refusals = {HTTPException: _refused, ClientDisconnect: _client_gone}
    return Guard(Starlette(routes=routes, exception_handlers=refusals), hosts, Origins(origins))


class Guard:
    """Refuses requests for another host or of another origin, and gives every answer the headers of the house."""

    def __init__(self, inner: ASGIApp, hosts: Collection[str], origins: Origins) -> None:
        self._inner, self._hosts, self._origins = inner, frozenset(hosts), origins

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """One request, whose answer is sent as fast as the client takes it."""
        if scope["type"] != "http":
            return
        scope = _in_origin_form(scope)
        asked = {name.decode("latin-1"): value.decode("latin-1") for name, value in scope["headers"]}

        async def sent(message: Message) -> None:
            if message["type"] == "http.response.start":
                said = HEADERS | self._origins.headers(asked)
                headers = [(name.lower().encode(), value.encode("latin-1")) for name, value in said.items()]
                message["headers"] = [*message.get("headers", ()), *headers]
            elif message["type"] == "http.response.body":
                rest = memoryview(message.get("body", b""))
                while len(rest) > PIECE:
                    await send({**message, "body": bytes(rest[:PIECE]), "more_body": True})
                    rest = rest[PIECE:]
                message["body"] = bytes(rest)
            await send(message)

        await (self._answered_here(scope, asked) or self._inner)(scope, receive, sent)

    def _answered_here(self, scope: Scope, asked: Mapping[str, str]) -> Response | None:
        """The answer to a request that does not come any further."""
        host = asked.get("host", "")
        if self._hosts and _without_port(host) not in self._hosts:
            wrong = f"this server is not {host!r}" if host else "the request names no host"
            return problem(421, f"{wrong}; ask it under the address at which it listens")
        if "transfer-encoding" in asked and "content-length" in asked:
            # A proxy that believes the length would take for the next request what is the body here, or the reverse.
            return problem(400, TWO_LENGTHS, {"Connection": "close"})
        if refused := self._origins.refusal(asked, scope["path"]):
            return problem(403, refused)
        allowed = self._origins.preflight(scope["method"], asked)
        return None if allowed is None else Response(status_code=204, headers=allowed)


def _in_origin_form(scope: Scope) -> Scope:
    """A request as one for a path of a host, also where the client has named both at once (`GET http://host/path`).

    What it says in the header Host counts for nothing then (RFC 9112, section 3.2.2).
    """
    target = bytes(scope.get("raw_path") or b"")
    if target[: len(ABSOLUTE)].lower() != ABSOLUTE:
        return scope
    host, slash, rest = target[len(ABSOLUTE) :].partition(b"/")
    path = slash + rest or b"/"
    headers = [(b"host", host), *(one for one in scope["headers"] if one[0] != b"host")]
    return {**scope, "path": unquote(path.decode("ascii")), "raw_path": path, "headers": headers}


def _names_tag(known: str, tag: str) -> bool:
    """Whether a client has what a tag stands for, by the header If-None-Match (RFC 9110, section 13.1.2).

    A proxy that compresses makes a tag weak (`W/`), which says the same here.
    """
    return known.strip() == "*" or tag in (one.strip().removeprefix("W/") for one in known.split(","))


def _without_port(host: str) -> str:
    head, _, port = host.rpartition(":")
    return (head if head and port.isdecimal() else host).lower()


async def _client_gone(_: Request, error: Exception) -> Response:
    """The client has gone before it was answered, which is no fault of this server: the answer is not read."""
    return problem(400, "the client has not waited for the answer")


async def _refused(_: Request, error: Exception) -> Response:
    assert isinstance(error, HTTPException)
    if error.status_code == 405:
        # Starlette has the methods in the order of a set, which is another one in each process.
        allowed = ", ".join(sorted((error.headers or {})["Allow"].split(", ")))
        return problem(405, f"this is asked by one of {allowed}", {"Allow": allowed})
    if error.status_code == 404:
        return problem(404, NOTHING_THERE)
    return problem(error.status_code, error.detail, error.headers)


def _names() -> list[str]:
    return [entry.name for entry in (files("selfconf.serve") / "page").iterdir() if entry.is_file()]


def _file(name: str) -> tuple[bytes, str, str]:
    """A file of the page, its media type and its tag."""
    text = (files("selfconf.serve") / "page" / name).read_bytes()
    media = "text/javascript" if name.endswith(".js") else mimetypes.guess_type(name)[0] or "application/octet-stream"
    return text, media, f'"{hashlib.blake2s(text, digest_size=8).hexdigest()}"'
