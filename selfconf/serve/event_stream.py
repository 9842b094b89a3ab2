"""Server-sent events: each has a number, so that a client that was away hears what it has missed.

A client that reads too slowly is left behind: its stream ends, and when it comes back it receives what it missed, or,
if that is too much, the word to begin anew.
"""

from __future__ import annotations

import asyncio
import json
import secrets
import time
from collections import deque
from collections.abc import AsyncIterator, Callable, Collection
from typing import NamedTuple

from starlette.requests import Request
from starlette.responses import Response, StreamingResponse

_EVENT_STREAM = "text/event-stream"
EVENTS_KEPT = 2000
"""How many events are kept for clients that were away."""
WAITING = 500
"""How many events may wait for a client that reads slowly."""
STILL_THERE = 15.0
"""Seconds after which a line is sent that says nothing, so that a connection that is gone is noticed."""
RESET = "reset"
"""The event that says: what you know is too old; begin anew."""
_LONGEST_NUMBER = 18
"""Digits of the number of an event; a longer one is none of this server."""


class ServerEvent(NamedTuple):
    """One event, as it stands in the stream."""

    number: int
    kind: str
    data: object


class EventStream:
    """The events of a server, and its listeners; used on one thread."""

    def __init__(self) -> None:
        self.life = secrets.token_hex(3)
        """Tells the numbers of this server from those of one before it."""
        self._number = 0
        self._kept: deque[ServerEvent] = deque(maxlen=EVENTS_KEPT)
        self._listeners: set[asyncio.Queue[ServerEvent | None]] = set()

    @property
    def last(self) -> str:
        """The identifier of the last event."""
        return f"{self.life}-{self._number}"

    @property
    def listeners(self) -> int:
        """How many clients listen."""
        return len(self._listeners)

    def put(self, kind: str, data: object) -> None:
        """Send an event to all listeners."""
        self._number += 1
        event = ServerEvent(self._number, kind, data)
        self._kept.append(event)
        for queue in list(self._listeners):
            if queue.qsize() >= WAITING:
                self._listeners.discard(queue)
                while not queue.empty():
                    queue.get_nowait()
                queue.put_nowait(None)
            else:
                queue.put_nowait(event)

    def close(self) -> None:
        """End every stream."""
        for queue in self._listeners:
            queue.put_nowait(None)
        self._listeners.clear()

    def missed(self, last: str) -> list[ServerEvent] | None:
        """What came after the event of an identifier; None where that is not known any more."""
        life, _, number = last.partition("-")
        if life != self.life or not number.isdecimal() or len(number) > _LONGEST_NUMBER or int(number) > self._number:
            return None
        if self._kept and int(number) + 1 < self._kept[0].number:
            return None
        return [event for event in self._kept if event.number > int(number)]

    async def lines(
        self, kinds: Collection[str], last: str, worded: Callable[[object], object] = lambda data: data
    ) -> AsyncIterator[bytes]:
        """The stream of a client that wants events of some kinds; `last` identifies the last that it has heard.

        `worded` makes of the data of an event what this client is sent.
        """
        queue: asyncio.Queue[ServerEvent | None] = asyncio.Queue()
        missed = self.missed(last) if last else []
        self._listeners.add(queue)
        try:
            yield b": selfconf\nretry: 1000\n\n"
            if missed is None:
                yield self._text(ServerEvent(self._number, RESET, {}))
            for event in missed or ():
                if event.kind in kinds:
                    yield self._text(event._replace(data=worded(event.data)))
            due = time.monotonic() + STILL_THERE
            while True:
                try:
                    heard = await asyncio.wait_for(queue.get(), max(0.0, due - time.monotonic()))
                except asyncio.TimeoutError:
                    yield b": still there\n\n"
                else:
                    if heard is None:
                        return
                    if heard.kind not in kinds:
                        continue
                    yield self._text(heard._replace(data=worded(heard.data)))
                due = time.monotonic() + STILL_THERE
        finally:
            self._listeners.discard(queue)

    def _text(self, event: ServerEvent) -> bytes:
        data = json.dumps(event.data, ensure_ascii=False)  # one line: JSON writes no line break
        return f"id: {self.life}-{event.number}\nevent: {event.kind}\ndata: {data}\n\n".encode()


def streamed(request: Request, lines: AsyncIterator[bytes]) -> Response:
    """The response with the lines of a stream; to HEAD, for which they would be read without an end, without any."""
    wanted = lines if request.method != "HEAD" else iter(())
    return StreamingResponse(wanted, media_type=_EVENT_STREAM, headers={"Cache-Control": "no-store"})
