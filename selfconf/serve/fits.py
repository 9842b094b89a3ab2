"""`/fit`: which roles of the tasks that run a component could play, and what keeps it out of those that it nearly fits.

The configurators say which tasks they run. Each is judged in a process of its own that has not long, and an answer is
kept: it holds as long as the task and the advertisement do.
"""

from __future__ import annotations

import asyncio
import json
from collections import OrderedDict
from typing import Any

from starlette.requests import Request
from starlette.responses import Response

from selfconf.model.term import IRI
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import task_name
from selfconf.protocol.messages import TaskRecord
from selfconf.rdf import turtle
from selfconf.rdf.advertisements import Advertisement
from selfconf.serve.board import Board
from selfconf.serve.disconnection import unless_gone
from selfconf.serve.judging_process import judged_apart
from selfconf.serve.problems import problem

JUDGING = 15.0
"""Seconds that one task may take to be judged."""
MOST_JUDGED = 20
"""How many tasks are judged for one answer."""
VERDICTS_KEPT = 500
"""How many verdicts are kept."""


class Fits:
    """Judges components by the roles of the tasks that run, one task at a time; used on the thread that serves."""

    def __init__(self, board: Board) -> None:
        self._board = board
        self._one = asyncio.Semaphore(1)
        self._verdicts: OrderedDict[tuple[bytes, IRI], tuple[Advertisement, Any]] = OrderedDict()

    async def respond(self, request: Request) -> Response:
        """`/fit?component=IRI`: for each task that runs, by its identity, the roles; or why they are not known."""
        found = self._board.advertised.get(IRI.unchecked(request.query_params.get("component", "")))
        if found is None:
            return problem(404, "no component of this IRI is advertised; /fit?component=IRI takes one of /things")
        tasks = await unless_gone(request, self._verdicts_on(found.advertisement))
        return Response(json.dumps({"tasks": tasks}, ensure_ascii=False), media_type="application/json")

    async def _verdicts_on(self, advertisement: Advertisement) -> dict[str, Any]:
        """For each task that runs, by its identity, what its roles say of a component."""
        tasks = {}
        for task in self._board.running()[:MOST_JUDGED]:
            record = self._board.record(task)
            if record is not None:
                verdict = await self._verdict(record, advertisement)
                body = {"roles": verdict} if isinstance(verdict, list) else verdict
                tasks[task] = {"name": task_name(task), **body}
        return tasks

    async def _verdict(self, record: TaskRecord, advertisement: Advertisement) -> Any:
        """A list of roles, or an object that says why there is none."""
        asked = encode(record), advertisement.profile.component
        async with self._one:
            judged, verdict = self._verdicts.pop(asked, (None, None))
            if judged is not advertisement:  # it is another object where the site tells another one
                try:
                    verdict = await _judged(asked[0], turtle.ntriples(advertisement.triples))
                except asyncio.TimeoutError:  # not kept: the machine may have been busy
                    return {"detail": f"what its roles ask for was not judged in {JUDGING:g} s"}
            self._verdicts[asked] = advertisement, verdict
            while len(self._verdicts) > VERDICTS_KEPT:
                self._verdicts.popitem(last=False)
            return verdict


async def _judged(record: bytes, advertisement: bytes) -> Any:
    question = {"record": record.decode(), "advertisement": advertisement.decode()}
    try:
        return await judged_apart("selfconf.api.tasks.role_fits", question, JUDGING)
    except ValueError:
        return {"detail": "what its roles ask for cannot be judged"}
