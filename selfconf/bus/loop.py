"""The loop of a bus that lives in real time: a queue of things to say, and timers, on one thread."""

from __future__ import annotations

import heapq
import itertools
import logging
import queue
import time
from collections.abc import Callable

log = logging.getLogger(__name__)


class Loop:
    """Says one thing after the other, in the thread that calls `poll` or `run`."""

    def __init__(self) -> None:
        self._waiting: queue.SimpleQueue[Callable[[], None]] = queue.SimpleQueue()
        self._timers: list[tuple[float, int, Callable[[], None]]] = []
        self._undone: set[int] = set()
        self._count = itertools.count()

    def now(self) -> float:
        """Seconds of the machine's monotonic clock."""
        return time.monotonic()

    def wake_up(self, action: Callable[[], None]) -> None:
        """Call `action` on the loop's thread, soon; may be called from any thread."""
        self._waiting.put(action)

    def later(self, seconds: float, action: Callable[[], None]) -> Callable[[], None]:
        """Call `action` once, after that time; the result takes it back."""
        number = next(self._count)
        entry = (self.now() + seconds, number, action)
        heapq.heappush(self._timers, entry)

        def undo() -> None:
            if any(timer is entry for timer in self._timers):
                self._undone.add(number)

        return undo

    def poll(self, seconds: float = 0.0) -> None:
        """Say everything there is to say; wait up to that long for something if there is nothing."""
        deadline = self.now() + seconds
        said = self._say_due()
        while True:
            try:
                if said:
                    action = self._waiting.get_nowait()
                else:
                    action = self._waiting.get(timeout=self._pause(deadline))
            except queue.Empty:
                if self._say_due():
                    said = True
                    continue
                if said or self.now() >= deadline:
                    return
                continue
            self._say(action)
            said = True

    def run(self, until: Callable[[], bool]) -> None:
        """Say everything there is to say, until `until` holds; it is asked after each round."""
        while not until():
            self.poll(0.5)

    def _pause(self, deadline: float) -> float:
        soonest = min(deadline, self._timers[0][0]) if self._timers else deadline
        return max(0.0, soonest - self.now())

    def _say_due(self) -> bool:
        said = False
        while self._timers and self._timers[0][0] <= self.now():
            _, number, action = heapq.heappop(self._timers)
            if number in self._undone:
                self._undone.discard(number)
                continue
            self._say(action)
            said = True
        return said

    def _say(self, action: Callable[[], None]) -> None:
        """The outermost loop: what breaks in a callback is logged, and the loop goes on."""
        try:
            action()
        except Exception:
            log.exception("a callback broke; going on")
