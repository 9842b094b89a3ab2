"""The stuck detector: tells a robot that works at it from one that gets nowhere."""

from __future__ import annotations

import math

from sim.geometry import Pose, wrap


class Progress:
    """Watches whether driving gets anywhere: `patience` and `hope` are seconds.

    A robot is stuck that does not move for as long as the patience lasts, or moves, but comes no nearer for
    as long as the hope lasts. A pause without poses starts both anew.
    """

    def __init__(self, patience: float, hope: float) -> None:
        self._patience, self._hope = patience, hope
        self._still_since: tuple[float, Pose] | None = None
        self._nearest: tuple[float, float] = (0.0, math.inf)
        self._last = -math.inf

    def judge(self, wheels: Pose, left: float, time: float) -> str:
        """Return why the robot is stuck, given its odometry and the metres left, or an empty string."""
        if time - self._last > 1.0:
            self._still_since, self._nearest = None, (time, math.inf)
        self._last = time
        if self._still_since is None or _moved(self._still_since[1], wheels):
            self._still_since = time, wheels
        if left < self._nearest[1] - 0.05:
            self._nearest = time, left
        if time - self._still_since[0] > self._patience:
            return f"{left:.1f} m are left, and the wheels have not moved for {self._patience:g} s"
        if time - self._nearest[0] > self._hope:
            return f"{left:.1f} m are left, and for {self._hope:g} s that has not become less"
        return ""


def _moved(before: Pose, now: Pose) -> bool:
    return before.distance(now) > 0.05 or abs(wrap(now.theta - before.theta)) > 0.15
