"""Obstacle avoidance: what the sonars have heard lately, and the free direction that deviates least.

Echoes are kept for a second in the frame of the odometry, which never jumps, as points on the axes of
their cones. A direction is free as far as a strip of the robot's width, laid out in it, holds none of
them (compare the vector field histogram of Borenstein and Koren, 1991, which asks the same of a grid).
"""

from __future__ import annotations

import math
from collections import deque

import numpy as np

from sim.geometry import Pose, wrap
from sim.physics.camera import Array
from sim.signals import RangeScan

DIRECTIONS = np.radians(np.arange(-180.0, 180.0, 5.0))


class Surroundings:
    """Echoes around a robot of some `radius`; it looks `horizon` metres ahead. All lengths are metres."""

    memory = 1.0
    horizon = 0.9

    def __init__(self, radius: float) -> None:
        self._radius = radius
        self._echoes: deque[tuple[float, Array]] = deque()
        self._last = 0.0

    def hear(self, scan: RangeScan, here: Pose, time: float) -> None:
        """Take in a scan made at a pose of the odometry's frame; forget what is older than a second."""
        angles, ranges = np.asarray(scan["angles"]), np.asarray(scan["ranges"])
        heard = ranges < scan["max_range"]
        bearing = angles[heard] + here.theta
        points = ranges[heard, None] * np.stack([np.cos(bearing), np.sin(bearing)], axis=1)
        self._echoes.append((time, np.add(points, (here.x, here.y))))
        while time - self._echoes[0][0] > self.memory:
            self._echoes.popleft()

    def free(self, here: Pose, directions: Array) -> Array:
        """Return how far (n,) the robot could drive in directions (n,) relative to its heading."""
        points = np.concatenate([points for _, points in self._echoes]) - (here.x, here.y)
        bearing = directions + here.theta
        along = points @ np.stack([np.cos(bearing), np.sin(bearing)])
        aside = points @ np.stack([-np.sin(bearing), np.cos(bearing)])
        touching = np.sqrt(np.maximum(self._radius**2 - aside**2, 0.0))
        in_the_way = (along > 0.0) & (np.abs(aside) < self._radius)
        reach = np.where(in_the_way, along - touching, self.horizon)
        nearest: Array = reach.min(axis=0, initial=self.horizon)
        return np.maximum(nearest, 0.0)

    def steer(self, here: Pose, wanted: float) -> float:
        """Return the direction, relative to the heading, that is free and deviates least from the wanted one.

        It prefers the side it took last, so that it does not waver before an obstacle.
        """
        candidates = np.append(DIRECTIONS, wanted)
        closed = 1.0 - self.free(here, candidates) / self.horizon
        last = self._last - here.theta
        cost = 2.0 * closed + _apart(candidates, wanted) + 0.3 * _apart(candidates, last)
        best = wrap(float(candidates[np.argmin(cost)]))
        self._last = best + here.theta
        return best


def _apart(angles: Array, other: float) -> Array:
    return np.abs((angles - other + math.pi) % math.tau - math.pi)
