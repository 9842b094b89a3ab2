"""How what comes from Zenoh by the thousand is read: from a channel, many at a time, on a thread that does only that.

Each callback takes Python's lock, so Zenoh's thread would wait for it, a thousand times, while Python works.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import zenoh
from zenoh.handlers import FifoChannel

from selfconf.bus.zenoh.receivers import callback

_CHANNEL = 1 << 17
"""How much a channel holds that Python has not read yet, before Zenoh's thread waits."""
READ_TOGETHER = 200
"""How many of them are handed over together: what is urgent waits for as many lives at most."""


def open_channel() -> Any:
    """A channel that is to be read on a thread of its own."""
    return FifoChannel(_CHANNEL)


def each(take: Callable[[Sequence[Any]], object], end: Callable[[], None] = lambda: None) -> Any:
    """A callback for each that comes, and one for the end."""
    return callback(lambda one: take((one,)), end)


def may_be_many(key: str) -> bool:
    """Whether there may be thousands under a key; of one component there are few lives, and few outputs."""
    return "*" in key.removesuffix("/*")


def read_together(channel: Any) -> list[Any]:
    """Wait for what a channel receives, and return it with what else is there; nothing if the channel has ended."""
    some: list[Any] = []
    try:
        some.append(channel.recv())
        while len(some) < READ_TOGETHER and (one := channel.try_recv()) is not None:
            some.append(one)
    except zenoh.ZError:
        pass
    return some


def at_hand(channel: Any) -> tuple[list[Any], bool]:
    """What has been received by now, the first of very many; and whether the channel is known not to have ended."""
    some: list[Any] = []
    try:
        while len(some) < READ_TOGETHER:
            one = channel.try_recv()
            if one is None:
                return some, True
            some.append(one)
    except zenoh.ZError:
        pass
    return some, False
