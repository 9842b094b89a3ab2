"""The thread on which the code of components runs, apart from the thread of the bus.

What a component does with a signal may take its time; a call of a configurator, or the end of its life, may not wait
for that. So the bus has a thread of its own, and hands to the code's thread what is to be done there: calls before
signals, calls in their order, signals in the order in which their queues have begun to wait. A queue of signals is
bounded, so a slow component costs neither memory nor supervision.

`CodeThread.watch` is for the bus's thread: it names the code that has not returned within its deadline, without any
help of that code. On a bus in simulated time all of this happens at once, in the one thread there is.
"""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

Action = Callable[[], None]


@dataclass(frozen=True, slots=True)
class RunningCode:
    """The code that runs now: whose, what it does, since when, and how long it may take, in seconds."""

    owner: object
    what: str
    began: float
    limit: float


class CodeThread:
    """Runs the code of the components of one host, one piece after the other, in the thread that polls."""

    def __init__(self, inline: bool) -> None:
        """`inline`: everything is run at once by the thread that hands it over; there is no other."""
        self.inline = inline
        self.running: RunningCode | None = None
        self._calls: deque[Action] = deque()
        self._signals: deque[Action] = deque()
        self._more = threading.Condition()

    def call(self, action: Action) -> None:
        """Run what a call, a timer or the end of a supervision asks for; before any signal that waits."""
        self._put(self._calls, action)

    def signal(self, action: Action) -> None:
        """Run what a signal asks for. May be called from any thread."""
        self._put(self._signals, action)

    def _put(self, queue: deque[Action], action: Action) -> None:
        if self.inline:
            action()
            return
        with self._more:
            queue.append(action)
            self._more.notify()

    def wake_up(self) -> None:
        """Let the thread that polls look whether to go on. May be called from any thread."""
        with self._more:
            self._more.notify()

    def limited(self, owner: object, what: str, limit: float, action: Callable[[], object]) -> None:
        """Run code of a component that may take so many seconds; `watch` sees it meanwhile."""
        before, self.running = self.running, RunningCode(owner, what, time.monotonic(), limit)
        try:
            action()
        finally:
            self.running = before

    def overdue(self) -> RunningCode | None:
        """The code that runs for longer than it may; for another thread, which that code does not hold up."""
        running = self.running
        return running if running is not None and time.monotonic() - running.began > running.limit else None

    def poll(self, seconds: float = 0.0) -> None:
        """Run all that waits; if nothing does, wait up to that long for the first."""
        action = self._next(seconds)
        while action is not None:
            action()
            action = self._next(0.0)

    def run(self, until: Callable[[], bool]) -> None:
        """Run what comes, until `until` holds; it is asked after each piece."""
        while not until():
            action = self._next(0.5)
            if action is not None:
                action()

    def _next(self, seconds: float) -> Action | None:
        with self._more:
            if not self._calls and not self._signals and seconds > 0:
                self._more.wait(seconds)
            if self._calls:
                return self._calls.popleft()
            return self._signals.popleft() if self._signals else None
