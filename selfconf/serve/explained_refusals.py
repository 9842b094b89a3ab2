"""`/mend`: near misses and relaxations of a task without a configuration, found for the clients that look at it.

The configurator of a task that waits tells what nearly fits and which change would help itself, mostly within a second
or two: that is waited for, as it takes a search, and two would find the same. But it has to listen, and tells that only
when nothing else is to be done; one that has been refused has ended, and the inside of a composite tells why it is
refused alone. For the client that asks about these the search is made in a process of its own that has not long.
"""

from __future__ import annotations

import asyncio
import json
import time

from starlette.requests import Request
from starlette.responses import Response

from selfconf.protocol.codec import encode
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf import turtle
from selfconf.serve.board import Board
from selfconf.serve.disconnection import unless_gone
from selfconf.serve.judging_process import judged_apart
from selfconf.serve.problems import problem
from selfconf.serve.watching.change import Body
from selfconf.serve.watching.checked import checked_refusal

EXPLAINED_WITHIN = 20.0
"""Seconds that the search may take."""
TOLD_WITHIN = 3.0
"""Seconds within which the configurator of a task that waits has mostly told its near misses and relaxations."""
TOLD_CHECK = 0.1
"""How often, in seconds, it is checked whether it has."""


class ExplainedRefusals:
    """Finds near misses and relaxations of refusals, one at a time; used on the thread that serves."""

    def __init__(self, board: Board) -> None:
        self._board = board
        self._one = asyncio.Semaphore(1)

    async def respond(self, request: Request) -> Response:
        """`/mend?task=IDENTITY`: the refusal with near misses and relaxations, or the detail of why there is none."""
        task = request.query_params.get("task", "")
        if not self._board.knows(task):
            return problem(404, "there is no task of this identity; /mend?task=IDENTITY takes one of /state")
        body = await unless_gone(request, self._explained(task))
        return Response(json.dumps(body, ensure_ascii=False), media_type="application/json")

    async def _explained(self, task: str) -> Body | None:
        """The refusal of a task, as its configurator explains it or as is found here; or why there is none."""
        body = await self._told(task)
        if body is None:
            record = self._board.record(task)
            told = {"detail": "its configurator has not told its task"}
            body = told if record is None else await self._found(task, record)
        return body

    async def _told(self, task: str) -> Body | None:
        """The refusal as the configurator of a task explains it, which it may do soon; None if it does not."""
        until = time.monotonic() + TOLD_WITHIN
        while True:
            body = self._board.task(task)
            refusal = body.get("refusal") or {}
            if refusal.get("repairs"):
                return refusal
            if not refusal or body["over"] or body["inside_of"] or time.monotonic() > until:
                return None
            await asyncio.sleep(TOLD_CHECK)

    async def _found(self, task: str, record: TaskRecord) -> Body | None:
        """The refusal of a task, as the page shows it, or the detail of why there is none."""
        question = {
            "record": encode(record).decode(),
            "advertisements": [
                turtle.ntriples(found.advertisement.triples).decode() for found in self._board.advertised.values()
            ],
            "lost": sorted(self._board.lost(task)),
        }
        try:
            async with self._one:
                told = await judged_apart("selfconf.api.tasks.explaining", question, EXPLAINED_WITHIN)
        except asyncio.TimeoutError:
            told = {"detail": f"what would mend it was not found in {EXPLAINED_WITHIN:g} s"}
        except ValueError:
            told = {"detail": "what would mend it cannot be found"}
        return told if "detail" in told else checked_refusal(told)
