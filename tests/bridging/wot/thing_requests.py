"""Requests by the client of Things, and what is wrong with the answers."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Coroutine
from typing import Any, TypeVar

import pytest

from selfconf.bridging.wot.forms import ThingForm
from selfconf.bridging.wot.thing_client import (
    ThingClient,
    ThingError,
    ThingLimits,
)
from tests.bridging.thing_server import ThingServer

Answer = TypeVar("Answer")
LIMITS = ThingLimits(answer=0.5, action=0.5, size=1 << 20)
PATIENT = ThingLimits(answer=30.0, size=1 << 20)
"""For what is found out at once, however busy the machine is."""
Start = Callable[[], ThingServer]


def asked(work: Callable[[ThingClient], Coroutine[Any, Any, Answer]], limits: ThingLimits = PATIENT) -> Answer:
    """What comes of some requests."""

    async def ask() -> Answer:
        client = ThingClient(limits)
        try:
            return await work(client)
        finally:
            await client.close()

    return asyncio.run(ask())


def trouble(server: ThingServer, path: str, limits: ThingLimits = PATIENT) -> str:
    """What is wrong with an answer; it is found out at once."""
    began = time.monotonic()
    with pytest.raises(ThingError) as raised:
        asked(lambda client: client.read(ThingForm(server.url + path, "GET")), limits)
    assert time.monotonic() - began < 20.0
    return str(raised.value).replace(server.url, "")
