"""The motor drive: obeys set-points within limits, changes speed gently, and stops by itself when they cease.

Time is simulated time in seconds; nothing here knows a clock.
"""

from __future__ import annotations

from dataclasses import dataclass

from sim.signals import Velocity2D

STILL: Velocity2D = {"linear": 0.0, "angular": 0.0}


class Drive:
    """A drive with a watchdog: a set-point holds for `patience` seconds and no longer."""

    patience = 0.5
    fastest_linear, fastest_angular = 0.6, 1.8

    def __init__(self) -> None:
        self._wanted, self._since = STILL, 0.0

    def accept(self, velocity: Velocity2D, time: float) -> None:
        """Take a set-point, cut to what the motors can do: 0.6 m/s and 1.8 rad/s."""
        self._wanted = {
            "linear": _clip(velocity["linear"], self.fastest_linear),
            "angular": _clip(velocity["angular"], self.fastest_angular),
        }
        self._since = time

    def set_point(self, time: float) -> Velocity2D:
        """Return what the motors shall do at a time: the last set-point, or nothing if that is too old."""
        return self._wanted if time - self._since <= self.patience else STILL


@dataclass
class Ramp:
    """A velocity that follows its set-point by 0.8 m/s2 and 2.5 rad/s2 at most: wheels do not slip."""

    linear: float = 0.0
    angular: float = 0.0
    linear_rate: float = 0.8
    angular_rate: float = 2.5

    def follow(self, wanted: Velocity2D, seconds: float) -> None:
        """Approach a set-point for some seconds."""
        self.linear += _clip(wanted["linear"] - self.linear, self.linear_rate * seconds)
        self.angular += _clip(wanted["angular"] - self.angular, self.angular_rate * seconds)


def wheel_speeds(velocity: Velocity2D, radius: float, track: float) -> tuple[float, float]:
    """Return the speeds in rad/s of the left and the right wheel that make up a velocity."""
    turning = velocity["angular"] * track / 2
    return (velocity["linear"] - turning) / radius, (velocity["linear"] + turning) / radius


def _clip(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))
