"""What a program hands from the thread of its bus to the one that does what takes long, so that the bus never waits."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from selfconf.model.run_event import RunEvent


class WorkQueue:
    """What a run hands from the thread of its bus to the thread that reads its events: work first, then events."""

    def __init__(self) -> None:
        self._works: deque[Callable[[], None]] = deque()
        self._events: deque[RunEvent] = deque()
        self._more = threading.Condition()
        self._woken = False

    def work(self, work: Callable[[], None]) -> None:
        """Have something done that takes long."""
        with self._more:
            self._works.append(work)
            self._more.notify()

    def report(self, event: RunEvent) -> None:
        """Hand an event over."""
        with self._more:
            self._events.append(event)
            self._more.notify()

    def wake_up(self) -> None:
        """Let `next` return at once."""
        with self._more:
            self._woken = True
            self._more.notify()

    def next(self, seconds: float) -> RunEvent | None:
        """Do all the work there is, and return the next event; None if none has come after that long."""
        with self._more:
            if not (self._works or self._events or self._woken) and seconds > 0:
                self._more.wait(seconds)
            self._woken = False
            waiting = len(self._works)
        for _ in range(waiting):
            self._works.popleft()()  # one at a time: where one breaks, the others wait for the next call
        with self._more:
            return self._events.popleft() if self._events else None
