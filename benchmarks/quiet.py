"""When all has arrived that was sent where some of it may be lost: no last one can be waited for."""

from __future__ import annotations

import time
from collections.abc import Callable

QUIET = 0.5
"""Seconds in which nothing arrives any more once all has."""
PATIENCE = 60.0
"""Seconds after which what still arrives is not waited for."""


def until_quiet(arrived: Callable[[], object]) -> None:
    """Wait until what has arrived, as a number or several, stays the same for `QUIET` seconds."""
    deadline, known = time.monotonic() + PATIENCE, arrived()
    since = time.monotonic()
    while (now := time.monotonic()) - since < QUIET and now < deadline:
        time.sleep(QUIET / 20)  # until the next look
        if (new := arrived()) != known:
            known, since = new, time.monotonic()
