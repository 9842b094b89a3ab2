"""Which tasks run, as their configurators tell: with the template, the bindings, and how each is searched for."""

from __future__ import annotations

import asyncio
import contextlib

from selfconf.bus.port import Bus, Replies
from selfconf.errors import PeerError
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import TaskRecord

TASKS_PATIENCE = 2.0
"""Seconds that the configurators may take to say which tasks they run."""


async def running_tasks(bus: Bus, keys: Keys) -> list[TaskRecord]:
    """The tasks that run, in their order; asked from the thread that serves, answered on that of the bus."""
    loop = asyncio.get_running_loop()
    told: asyncio.Future[Replies] = loop.create_future()

    def take(replies: Replies) -> None:
        if not told.done():
            told.set_result(replies)

    def done(replies: Replies) -> None:
        with contextlib.suppress(RuntimeError):  # the loop has ended: so has the server
            loop.call_soon_threadsafe(take, replies)

    bus.wake_up(lambda: bus.ask(keys.configurator_call("*", "task"), b"", TASKS_PATIENCE, done))
    found: dict[str, TaskRecord] = {}
    with contextlib.suppress(asyncio.TimeoutError):
        for sample in (await asyncio.wait_for(told, 2 * TASKS_PATIENCE)).samples:
            with contextlib.suppress(PeerError):
                record = decode(sample.payload, TaskRecord)
                found[record.task] = record
    return sorted(found.values(), key=lambda record: (-record.priority, record.beginning))
