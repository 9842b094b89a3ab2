"""The garbage collector of Python, kept from looking again and again at values that stay.

Values are not garbage, but looking at a million of them takes as long as making them. A program that has frozen
something itself does so for its own reasons, and keeps what it has frozen.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

MANY_VALUES = 10_000
"""From how many new values on it is worth asking what is frozen, which takes longer the more that is."""
MANY_COMPONENTS = 1_000
"""From how many components on it is worth asking what is frozen."""
FROZEN_BY_PYTHON = 1_000
"""How many values may be frozen that no program has frozen: Python 3.12 does so with 375 as it starts."""
SELDOM = 100_000
"""After how many new values there is a look at them, while many are made of which most are kept."""


@contextmanager
def collector_at_rest() -> Iterator[None]:
    """No garbage collection while much is read that will stay; afterwards it counts as old, and is looked at rarely."""
    collecting = gc.isenabled()
    gc.disable()
    before = gc.get_count()[0]
    try:
        yield
    finally:
        if gc.get_count()[0] - before >= MANY_VALUES and not _program_has_frozen():
            gc.freeze()
            gc.unfreeze()  # moves everything to the oldest generation, without a look at it
        if collecting:
            gc.enable()


@contextmanager
def collector_looking_at_new(components: int) -> Iterator[None]:
    """Garbage collection of what is made meanwhile alone, and seldom, where many components are there."""
    if components < MANY_COMPONENTS or _program_has_frozen():
        yield
        return
    often, *rounds = gc.get_threshold()
    gc.set_threshold(max(often, SELDOM) if often else often, *rounds)  # 0 says never
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()
        gc.set_threshold(often, *rounds)


def _program_has_frozen() -> bool:
    return gc.get_freeze_count() > FROZEN_BY_PYTHON
