"""Poses in the plane: a rigid motion is its own little group, and everything that moves here uses it.

Lengths are metres, angles radians, anticlockwise; an angle is kept in (-pi, pi].
"""

from __future__ import annotations

import math
from dataclasses import dataclass


def wrap(angle: float) -> float:
    """Return the angle in (-pi, pi] that differs from `angle` by whole turns."""
    return -((math.pi - angle) % math.tau - math.pi)


@dataclass(frozen=True)
class Pose:
    """A position and a heading in the plane: x and y in metres, theta in radians."""

    x: float
    y: float
    theta: float = 0.0

    def compose(self, motion: Pose) -> Pose:
        """Return this pose moved by `motion`, which is given in this pose's own frame."""
        cosine, sine = math.cos(self.theta), math.sin(self.theta)
        return Pose(
            self.x + cosine * motion.x - sine * motion.y,
            self.y + sine * motion.x + cosine * motion.y,
            wrap(self.theta + motion.theta),
        )

    def inverse(self) -> Pose:
        """Return the motion that leads from this pose back to the origin."""
        cosine, sine = math.cos(self.theta), math.sin(self.theta)
        return Pose(-cosine * self.x - sine * self.y, sine * self.x - cosine * self.y, wrap(-self.theta))

    def relative(self, later: Pose) -> Pose:
        """Return the motion that leads from this pose to `later`, in this pose's own frame."""
        return self.inverse().compose(later)

    def distance(self, other: Pose) -> float:
        """Return the distance in metres between the two positions."""
        return math.hypot(other.x - self.x, other.y - self.y)
