"""The garbage collector of Python, kept from looking again and again at values that stay.

Values are not garbage, but looking at a million of them takes as long as making them.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def collector_at_rest() -> Iterator[None]:
    """No garbage collection while much is read that will stay; afterwards it counts as old, and is looked at rarely."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if not gc.get_freeze_count():  # a program that has frozen something itself does so for its own reasons
            gc.freeze()
            gc.unfreeze()  # moves everything to the oldest generation, without a look at it
        if collecting:
            gc.enable()


@contextmanager
def collector_looking_at_new() -> Iterator[None]:
    """Garbage collection of what is made meanwhile alone: what is there at the beginning is not looked at."""
    if gc.get_freeze_count():  # a program that has frozen something itself does so for its own reasons
        yield
        return
    gc.freeze()
    try:
        yield
    finally:
        gc.unfreeze()
