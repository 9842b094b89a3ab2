"""A time limit for work that strangers may make long, such as matching `^(a+)+$` against what they wrote.

SHACL and SPARQL on rdflib are Python, and Python's regular expressions look for signals as they go, so an alarm
(`setitimer`, POSIX) ends both without a process or a thread of its own. An alarm reaches only the main thread, in which
every program of selfconf does its work; elsewhere there is no limit. What is raised inside a destructor or a callback
of the garbage collector is lost, so the alarm goes on ringing until the block is left.
"""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

RINGING = 0.05
"""Seconds between one ring of the alarm and the next."""


class TimeUp(BaseException):
    """The time is up; no `Exception`, because libraries on the way catch those."""


@contextmanager
def deadline(seconds: float) -> Iterator[None]:
    """Raise TimeUp in the block if it takes longer; an alarm that was set outside of it still counts, and goes on."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    began = time.monotonic()
    handler = signal.signal(signal.SIGALRM, _raise)
    outside, _ = signal.getitimer(signal.ITIMER_REAL)
    signal.setitimer(signal.ITIMER_REAL, min(seconds, outside or seconds), RINGING)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, handler)
        if outside:
            signal.setitimer(signal.ITIMER_REAL, max(outside - (time.monotonic() - began), 1e-6), RINGING)


def _raise(number: int, frame: FrameType | None) -> None:
    raise TimeUp
