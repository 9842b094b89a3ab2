"""How often a program that crashes is started again: soon at first, then later and later, and not forever.

The scheme is that of OTP's supervisors (restart intensity): more crashes within a window of time than are allowed, and
the program is given up, until so much time has passed that the window holds no more than allowed.
"""

from __future__ import annotations

from collections import deque

CRASH_WINDOW = 60.0
"""Seconds within which crashes are counted."""
DEFAULT_RESTARTS = 3
"""How often a program is started again within the window, if its components do not say otherwise."""
FIRST_PAUSE = 0.1
"""Seconds between a first crash and the start after it."""
PAUSE_FACTOR = 4.0
"""How much longer each further pause is."""
LONGEST_RESTART_PAUSE = 10.0
"""Seconds that a pause takes at most: a configurator that has woken a component waits for 15 seconds until it lives."""


class RestartLimit:
    """The crashes of one program."""

    def __init__(self) -> None:
        self._crashes: deque[float] = deque()

    def crashed(self, now: float) -> None:
        """Count a crash."""
        self._crashes.append(now)

    def pause(self, now: float, restarts: int) -> float | None:
        """Seconds until it is to be started again after its last crash; None if it has crashed too often for that."""
        crashes = self._recent(now)
        if crashes > restarts:
            return None
        pause = FIRST_PAUSE
        for _ in range(crashes - 1):  # no power: of many crashes that is no number any more
            pause = min(pause * PAUSE_FACTOR, LONGEST_RESTART_PAUSE)
        return pause if crashes == 0 else max(0.0, self._crashes[-1] + pause - now)

    def first(self, now: float) -> bool:
        """Whether it has crashed once at most within the window."""
        return self._recent(now) <= 1

    def wait(self, now: float, restarts: int) -> float:
        """Seconds until it may be started on request: none, unless it has crashed too often."""
        excess = self._recent(now) - restarts
        return 0.0 if excess <= 0 else self._crashes[excess - 1] + CRASH_WINDOW - now

    def _recent(self, now: float) -> int:
        """How many crashes lie in the window."""
        while self._crashes and self._crashes[0] <= now - CRASH_WINDOW:
            self._crashes.popleft()
        return len(self._crashes)
