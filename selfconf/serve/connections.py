"""Connections of HTTP that cannot be held forever: bounds on how many there are, and how long a request takes.

A client that sends a byte now and then, in the head of a request or in its body, would otherwise keep a connection for
as long as it likes, and some hundreds of them all that a process can have ("slowloris"); so would one that takes
nothing of what it is sent. uvicorn bounds the size of a head and the time between two requests, not the time of one.
"""

from __future__ import annotations

import asyncio
import errno
import logging
import math
from typing import Any

import h11
import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol

from selfconf.serve.application import HEADERS
from selfconf.serve.problems import problem

REQUEST_SECONDS = 15.0
"""Seconds from the opening of a connection, or the first byte of a further request, to the last byte of the request."""
UNREAD_SECONDS = 30.0
"""Seconds for which an answer waits that is not taken, beyond the buffers of 64 KiB here and those of the system."""
MOST_CONNECTIONS = 400
"""Connections at a time; a browser has up to six, one of them for the stream of events."""
NO_REQUEST = "this is no request of HTTP/1.1, or its head has more than 64 KiB; send a long query by POST"
REFUSED_AGAIN = 60.0
"""Seconds after which it is said again that the system lets no connection be taken."""

log = logging.getLogger(__name__)


def config_of(app: ASGIApp) -> uvicorn.Config:
    """How uvicorn is to serve an application: without warnings, as strangers would cause any number of them.

    One of them advises to install what this server does not use, whenever a client offers HTTP/2 (`Upgrade: h2c`).
    """
    return uvicorn.Config(app, log_level="error", access_log=False, lifespan="off", ws="none", http=BoundedConnection)


class LoopFaults:
    """Reports what goes wrong on a loop of asyncio: where no connection can be taken, once a minute.

    asyncio tries again and again, and would log thousands of times a second why it fails.
    """

    def __init__(self) -> None:
        self._refused = -math.inf

    def __call__(self, loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        """Take a fault in, as `asyncio.loop.set_exception_handler` has it."""
        error = context.get("exception")
        if not (isinstance(error, OSError) and error.errno in (errno.EMFILE, errno.ENFILE)):
            loop.default_exception_handler(context)
        elif loop.time() - self._refused >= REFUSED_AGAIN:
            self._refused = loop.time()
            log.error("no further connection can be taken: %s; allow more (`ulimit -n`)", error.strerror)


class BoundedConnection(H11Protocol):
    """One connection: closed if its request or its answer gets stuck, or if there are too many."""

    _late: asyncio.TimerHandle | None = None
    _unread: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Begin to wait for a request."""
        super().connection_made(transport)
        if len(self.connections) > MOST_CONNECTIONS:
            self.transport.close()
        else:
            self._wait()

    def data_received(self, data: bytes) -> None:
        """Wait for the rest of a request, if there is one."""
        self._wait()
        super().data_received(data)
        if self.conn.their_state not in (h11.IDLE, h11.SEND_BODY):
            self._wait_no_more()

    def pause_writing(self) -> None:
        """Begin to wait for the client to take what is there for it."""
        super().pause_writing()
        self._unread = self.loop.call_later(UNREAD_SECONDS, self.hang_up)

    def resume_writing(self) -> None:
        """Go on with an answer, as the client takes it."""
        self._taken()
        super().resume_writing()

    def connection_lost(self, exc: Exception | None) -> None:
        """Wait for nothing."""
        self._wait_no_more()
        self._taken()
        super().connection_lost(exc)

    def send_400_response(self, msg: str) -> None:
        """Say that what has come is no request, as all other answers are worded; uvicorn has plain text for it."""
        answer = problem(400, NO_REQUEST, {**HEADERS, "Connection": "close"})
        for event in (
            h11.Response(status_code=answer.status_code, headers=answer.raw_headers),
            h11.Data(data=bytes(answer.body)),
            h11.EndOfMessage(),
        ):
            self.transport.write(self.conn.send(event))
        self.transport.close()

    def hang_up(self) -> None:
        """End the connection: what serves it receives `http.disconnect`."""
        if not self.transport.is_closing():
            self.transport.abort()  # not `close`, which waits until what is to be sent has been taken

    def _wait(self) -> None:
        if self._late is None:
            self._late = self.loop.call_later(REQUEST_SECONDS, self.hang_up)

    def _wait_no_more(self) -> None:
        if self._late is not None:
            self._late.cancel()
            self._late = None

    def _taken(self) -> None:
        if self._unread is not None:
            self._unread.cancel()
            self._unread = None
