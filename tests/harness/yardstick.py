"""How much slower than alone a program is at a time, on a machine on which many others compute.

What is promised in seconds is promised of a machine that has a processor for it. A test that looks at such a promise
while others run multiplies it by how much longer than on such a processor a known piece of work takes meanwhile. The
work is the test's own, so that the program that is tested cannot be excused by its own slowness.
"""

from __future__ import annotations

import threading
import time
from types import TracebackType

WORK = 0.01
"""Seconds of a processor that a piece of work takes."""
REST = 0.05
"""Seconds between two pieces of work."""


class Yardstick:
    """Does a piece of work again and again in a thread, and notes when each began and ended, in Unix seconds."""

    def __init__(self) -> None:
        self._done: list[tuple[float, float]] = []
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._work, daemon=True)

    def __enter__(self) -> Yardstick:
        self._thread.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        self._thread.join()

    def slower(self, since: float, until: float) -> float:
        """How many times as long as alone the work took between two times; 1 if there was none in between."""
        taken = [end - begin for begin, end in self._done if end > since and begin < until]
        return max(1.0, sum(taken) / len(taken) / WORK) if taken else 1.0

    def _work(self) -> None:
        while not self._over.wait(REST):
            began, spent = time.time(), time.thread_time()
            while time.thread_time() < spent + WORK:
                pass
            self._done.append((began, time.time()))
