"""`/look`: what a component issues and prints, as server-sent events, as long as a browser looks at it."""

from __future__ import annotations

import asyncio
import contextlib
import json
from collections.abc import AsyncIterator

from starlette.requests import Request
from starlette.responses import Response

from selfconf.bus.port import Bus
from selfconf.discovery import FoundAdvertisement
from selfconf.model.term import IRI
from selfconf.serve.board import Board
from selfconf.serve.event_stream import STILL_THERE, streamed
from selfconf.serve.onlooker import Onlooker
from selfconf.serve.problems import problem
from selfconf.serve.watching.change import Body

MOST_LOOKS = 32
"""How many may look at a component at the same time."""
MOST_UNREAD = 100
"""How many events may wait for a client that reads slowly; then its stream ends, and it may begin anew."""
_Told = tuple[str, Body] | None


class Onlookers:
    """The clients that look at components; used on the thread that serves, its onlookers on that of the bus."""

    def __init__(self, bus: Bus, board: Board, may_hear: bool = True) -> None:
        """`may_hear` is whether the keys of the server, if there are any, let it hear signals and ask for logs."""
        self._bus, self._board, self._may_hear = bus, board, may_hear
        self._queues: set[asyncio.Queue[_Told]] = set()

    def close(self) -> None:
        """End every stream."""
        for queue in self._queues:
            queue.put_nowait(None)

    async def respond(self, request: Request) -> Response:
        """`/look?component=IRI`: a stream with the events `signals` and `log`."""
        found = self._board.advertised.get(IRI.unchecked(request.query_params.get("component", "")))
        if found is None:
            return problem(404, "no component of this IRI is advertised; /look?component=IRI takes one of /things")
        if len(self._queues) >= MOST_LOOKS:
            return problem(503, f"{MOST_LOOKS} look at a component already", {"Retry-After": "10"})
        return streamed(request, self._stream(found))

    async def _stream(self, found: FoundAdvertisement) -> AsyncIterator[bytes]:
        if len(self._queues) >= MOST_LOOKS:
            return  # of many that came at the same moment this is one too many; its browser asks again
        loop, queue = asyncio.get_running_loop(), asyncio.Queue[_Told]()

        def put(told: _Told) -> None:
            queue.put_nowait(told if queue.qsize() < MOST_UNREAD else None)

        def tell(kind: str, body: Body) -> None:
            with contextlib.suppress(RuntimeError):  # the loop has ended: so has the server
                loop.call_soon_threadsafe(put, (kind, body))

        onlooker = Onlooker(self._bus, self._board.keys, found, tell)
        self._queues.add(queue)
        self._bus.wake_up(onlooker.begin if self._may_hear else onlooker.excuse)
        try:
            yield b"retry: 2000\n\n"
            while True:
                told: _Told = ("", {})
                with contextlib.suppress(asyncio.TimeoutError):
                    told = await asyncio.wait_for(queue.get(), STILL_THERE)
                if told is None:
                    return
                kind, body = told
                text = (
                    f"event: {kind}\ndata: {json.dumps(body, ensure_ascii=False)}\n\n" if kind else ": still there\n\n"
                )
                yield text.encode()
        finally:
            self._queues.discard(queue)
            self._bus.wake_up(onlooker.end)
