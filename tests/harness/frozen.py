"""What the garbage collector need not look at in a process that runs tests.

All the tests and what they import are a million objects that stay. They are frozen once they are collected, or every
full collection looks at them again, which is a sixth of the processor time of all tests.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager

import pytest


def freeze_what_is_there() -> None:
    """Have the collector look from now on only at what is made later."""
    gc.freeze()


@contextmanager
def nothing_frozen() -> Iterator[None]:
    """Let a command freeze nothing: it leaves what it has read to the end of its process, which is not this one."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(gc, "freeze", lambda: None)
        yield
