"""HTTP as a bridge speaks it: bounded in time and in bytes, without redirects, cookies, proxies or compression.

What a thing answers is judged here, so that a caller receives a value or a `ThingError`, whose text is a sentence.
"""

from __future__ import annotations

import asyncio
import json
import os
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any, NamedTuple

import aiohttp
from yarl import URL

from selfconf.bridging.wot.forms import ThingForm, bare, is_json
from selfconf.http_origin import http_origin
from selfconf.importing import LARGEST_SOURCE
from selfconf.model.immutable import immutable

CONNECTIONS = 32
"""How many connections to one host are open at once to read and write, and as many to call actions; outputs that are
followed keep one each besides."""
IDLE = 15.0
"""Seconds for which a connection on which nothing is asked is kept."""
IDLE_FOR_ACTIONS = 1.0
"""As long for actions: a thing may close it in the moment of the next request, and a call is not made a second time."""
MOST_EVENTS = 1000
"""How many server-sent events of one stream are read in a second; a thing that sends more is held up."""
NO_ANSWER = "does not answer"
"""How a sentence ends that goes on, after a colon, with why there is no connection."""
_EVENT_STREAM = "text/event-stream"
_ANY_BYTES = "application/octet-stream"
_LINE_END = b"\n"


@immutable
class ThingLimits:
    """How long a thing may take, in seconds, and how much it may answer, in bytes."""

    answer: float = 3.0
    """To read or write a property; less than four periods of the usual rate, so that silence has this reason."""
    action: float = 60.0
    """To carry out an action."""
    size: int = LARGEST_SOURCE


class ThingError(Exception):
    """A thing has not answered as its description says; the text is a sentence."""


class ThingRefusal(ThingError):
    """A thing has answered that it does not, or cannot, do what it was asked: by a status of HTTP from 400 on."""


class BrokenAnswerError(ThingError):
    """A connection was lost in the middle of an answer, or of the wait for it; the thing may be there still."""


class UnsendableValueError(ThingError):
    """What was to be sent is nothing that a thing takes; it was asked nothing, and is not to blame."""


class ThingAnswer(NamedTuple):
    """A value with the media type of what carried it; that is empty for JSON."""

    value: Any
    media: str = ""


class ThingClient:
    """Makes requests; all of its methods are called on one event loop."""

    def __init__(self, limits: ThingLimits) -> None:
        self._limits = limits
        self._requests = self._opened(CONNECTIONS)
        # A host of many things may be followed by many outputs, and take long for many actions: they would leave no
        # connection to ask anything else.
        self._followed, self._actions = self._opened(0), self._opened(CONNECTIONS, IDLE_FOR_ACTIONS)

    def _opened(self, connections: int, kept: float = IDLE) -> aiohttp.ClientSession:
        """A session with so many connections to a host at most, or without a limit if that is 0."""
        return aiohttp.ClientSession(
            connector=aiohttp.TCPConnector(limit=0, limit_per_host=connections, keepalive_timeout=kept),
            cookie_jar=aiohttp.DummyCookieJar(),  # what one thing sets, another one must not be sent
            auto_decompress=False,  # what is compressed may be a thousand times larger than it looks
            headers={"Accept-Encoding": "identity", "User-Agent": "selfconf"},
            trust_env=False,
        )

    async def close(self) -> None:
        """Close every connection."""
        for session in (self._requests, self._followed, self._actions):
            await session.close()

    async def fetch(self, form: ThingForm, seconds: float) -> tuple[bytes, list[str]]:
        """The bytes of an answer, and its `Link` headers, within so many seconds. Raises ThingError."""
        async with self._asked(self._requests, form, seconds) as answer:
            return await self._body(form, answer), answer.headers.getall("Link", [])

    async def read(self, form: ThingForm) -> ThingAnswer:
        """What a thing answers. Raises ThingError."""
        async with self._asked(self._requests, form, self._limits.answer) as answer:
            return _value(form, answer, await self._body(form, answer))

    async def send(self, form: ThingForm, value: Any, media: str = "", action: bool = False) -> None:
        """Write a value, or call an action with it, whatever is answered; None is sent as nothing. Raises ThingError.

        `media` is the media type of bytes, by default that of the form.
        """
        async with self._sent(form, value, media, action) as answer:
            await self._body(form, answer)

    async def call(self, form: ThingForm, value: Any, media: str = "") -> ThingAnswer:
        """What a thing answers to an action that is called with a value as by `send`. Raises ThingError."""
        async with self._sent(form, value, media, action=True) as answer:
            return _value(form, answer, await self._body(form, answer))

    async def wait(self, form: ThingForm) -> ThingAnswer | None:
        """The next value of a long poll, however long that takes; None if the thing has let go of it for now."""
        async with self._asked(self._followed, form, None) as answer:
            body = await self._body(form, answer)
            nothing = answer.status == 204 or (not body and "Content-Type" not in answer.headers)
            return None if nothing else _value(form, answer, body)

    @asynccontextmanager
    async def subscribed(self, form: ThingForm) -> AsyncIterator[AsyncIterator[ThingAnswer]]:
        """The values of a stream of server-sent events, inside the `async with` block. Raises ThingError.

        The block begins once the thing has begun to answer, so that it tells of what changes from then on.
        """
        async with self._asked(self._followed, form, None) as answer:
            if answer.content_type != _EVENT_STREAM:
                raise ThingError(f"{form} answers {answer.content_type}, where {_EVENT_STREAM} is expected")
            yield self._events(form, answer)

    async def _events(self, form: ThingForm, answer: aiohttp.ClientResponse) -> AsyncIterator[ThingAnswer]:
        """The values of server-sent events, until the thing ends the stream (HTML, section 9.2)."""
        loop, due = asyncio.get_running_loop(), 0.0
        lines: list[bytes] = []
        size = 0
        async for line in self._lines(form, answer):
            size += len(line)
            if size > self._limits.size:
                raise self._too_large(form)
            if line.startswith(b"data:"):
                lines.append(line[5:].removeprefix(b" "))
            elif not line:
                if any(lines):  # an event without data says that the thing is there
                    due = max(due + 1 / MOST_EVENTS, loop.time())
                    await asyncio.sleep(due - loop.time())
                    yield _said(form, b"\n".join(lines))
                lines, size = [], 0

    async def reach(self, form: ThingForm) -> None:
        """See whether something listens where a form leads. Raises ThingError."""
        try:
            url = URL(form.url)
            _, writer = await asyncio.wait_for(asyncio.open_connection(url.host, url.port), self._limits.answer)
            writer.close()
        except (OSError, ValueError, asyncio.TimeoutError) as error:  # ValueError for a host that no name can be
            raise ThingError(f"{http_origin(form.url)} {NO_ANSWER}: {_reason(error)}") from None

    @asynccontextmanager
    async def _sent(
        self, form: ThingForm, value: Any, media: str, action: bool
    ) -> AsyncIterator[aiohttp.ClientResponse]:
        """A request that carries a value, and was answered without an error. Raises ThingError."""
        body = _encoded(form, value, media)
        headers = {} if body is None else {"Content-Type": media if media and isinstance(value, bytes) else form.media}
        session, seconds = (self._actions, self._limits.action) if action else (self._requests, self._limits.answer)
        async with self._asked(session, form, seconds, body, headers) as answer:
            yield answer

    @asynccontextmanager
    async def _asked(
        self,
        session: aiohttp.ClientSession,
        form: ThingForm,
        seconds: float | None,
        body: bytes | None = None,
        more: dict[str, str] | None = None,
    ) -> AsyncIterator[aiohttp.ClientResponse]:
        """A request that was answered without an error; the body may not have come yet. Raises ThingError.

        Without `seconds` something is followed: it may take as long as it wants.
        """
        media = _EVENT_STREAM if form.subprotocol == "sse" else form.answered
        headers = {"Accept": media, **form.headers, **(more or {})}
        time = aiohttp.ClientTimeout(total=seconds, sock_connect=self._limits.answer)
        try:
            url = URL(form.url).update_query(form.query) if form.query else URL(form.url)
            async with session.request(
                form.method, url, data=body, headers=headers, allow_redirects=False, timeout=time
            ) as answer:
                self._check(form, answer)
                yield answer
        except asyncio.TimeoutError:
            raise ThingError(f"{form} has not answered in full within {seconds or self._limits.answer:g} s") from None
        except (aiohttp.ClientError, OSError, ValueError) as error:
            kind = BrokenAnswerError if _is_break(error) else ThingError
            raise kind(f"{form} {NO_ANSWER}: {_reason(error)}") from None

    def _check(self, form: ThingForm, answer: aiohttp.ClientResponse) -> None:
        where = answer.headers.get("Location")
        if where is not None and 300 <= answer.status < 400:
            raise ThingError(f"{form} answers {answer.status}, go to {where[:120]!r}; no redirect is followed")
        if answer.status >= 300:
            raise (ThingRefusal if answer.status >= 400 else ThingError)(f"{form} answers {answer.status}")
        if answer.headers.get("Content-Encoding", "identity") != "identity":
            raise ThingError(f"{form} answers in a compressed form, though it was asked not to")
        if (answer.content_length or 0) > self._limits.size:
            raise self._too_large(form)

    async def _body(self, form: ThingForm, answer: aiohttp.ClientResponse) -> bytes:
        """The body of an answer, piece by piece, so that a long one is not read to its end."""
        pieces, size = [], 0
        async for piece in answer.content.iter_any():
            size += len(piece)
            if size > self._limits.size:
                raise self._too_large(form)
            pieces.append(piece)
        return b"".join(pieces)

    async def _lines(self, form: ThingForm, answer: aiohttp.ClientResponse) -> AsyncIterator[bytes]:
        """The lines of an answer that has no end, each as it comes, without its end."""
        rest = bytearray()  # to which a piece is added without a copy: a long line may come in many
        async for piece in answer.content.iter_any():
            begun, *others = piece.split(_LINE_END)
            rest += begun
            for other in others:
                yield bytes(rest).removesuffix(b"\r")
                rest = bytearray(other)
            if len(rest) > self._limits.size:
                raise self._too_large(form)
            await asyncio.sleep(0)  # of a thing that sends without a pause, no piece would be waited for

    def _too_large(self, form: ThingForm) -> ThingError:
        return ThingError(f"{form} answers more than {self._limits.size >> 20} MiB, which is more than is read")


_REASONS: dict[type[Exception], str] = {
    asyncio.TimeoutError: "nothing has come in time",
    aiohttp.ClientResponseError: "what it sends is not HTTP",
    aiohttp.ClientPayloadError: "what it sends breaks off",
}


def _value(form: ThingForm, answer: aiohttp.ClientResponse, body: bytes) -> ThingAnswer:
    """What a body says, by the media type that it has, or else by that of the form. Raises ThingError."""
    wanted = bare(form.answered)
    media = answer.content_type if "Content-Type" in answer.headers else wanted
    if is_json(media):
        return ThingAnswer(_json(form, body))
    if media != wanted:
        raise ThingError(f"{form} answers {media}, where {wanted} is expected")
    return ThingAnswer(body, media)


def _said(form: ThingForm, data: bytes) -> ThingAnswer:
    """What an event says: JSON, unless its form has another media type; that of a stream says nothing of its events."""
    media = bare(form.answered)
    return ThingAnswer(_json(form, data)) if is_json(media) or media == _EVENT_STREAM else ThingAnswer(data, media)


def _json(form: ThingForm, body: bytes) -> Any:
    def no_number(name: str) -> None:
        raise ValueError(f"{name} is no number of JSON")

    try:
        return json.loads(body, parse_constant=no_number)
    except (ValueError, RecursionError):
        raise ThingError(f"{form} answers what is not JSON: {body[:40]!r}") from None


def _encoded(form: ThingForm, value: Any, media: str) -> bytes | None:
    """A value as a body; `media` is that of bytes. Raises UnsendableValueError where the form takes something else."""
    if value is None:
        return None
    wanted = bare(form.media)
    try:
        if isinstance(value, bytes):
            if bare(media) in ("", wanted) or wanted == _ANY_BYTES:
                return value
        elif is_json(wanted):
            return json.dumps(value, separators=(",", ":"), allow_nan=False, default=_elements).encode()
        elif wanted.startswith("text/") and isinstance(value, str | float | int):
            return (value if isinstance(value, str) else json.dumps(value)).encode()
    except (AttributeError, ValueError, RecursionError):
        # An array that is no list either, NaN and infinity, half of a surrogate pair, what is nested too deeply.
        raise UnsendableValueError(f"{form} takes {wanted}, which cannot say what was received") from None
    given = media if isinstance(value, bytes) else "a value of JSON"
    raise UnsendableValueError(f"{form} takes {wanted}, which cannot be made of {given}")


def _elements(array: Any) -> Any:
    """The elements of an array, for JSON."""
    return array.tolist()


def _is_break(error: Exception) -> bool:
    """Whether there was a connection, which was lost."""
    if isinstance(error, aiohttp.ClientConnectorError):
        return False
    return isinstance(error, aiohttp.ClientOSError | aiohttp.ServerDisconnectedError | aiohttp.ClientPayloadError)


def _reason(error: Exception) -> str:
    """Why there is no connection, in a few words."""
    for kind, reason in _REASONS.items():
        if isinstance(error, kind):
            return reason
    if isinstance(error, aiohttp.ClientConnectorCertificateError):
        why = getattr(error.certificate_error, "verify_message", "")  # such as "self-signed certificate"
        return f"its certificate is not trusted: {why}; SSL_CERT_FILE names a file of the authorities that are"
    if isinstance(error, aiohttp.ClientSSLError):  # an OSError, whose number is one of TLS
        return "there is no TLS to speak with it"
    number = getattr(error, "errno", None)
    return os.strerror(number) if number and number > 0 else (str(error) or type(error).__name__)[:120]
