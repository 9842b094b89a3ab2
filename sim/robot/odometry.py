"""Dead reckoning: from wheel angles to encoder ticks, to a pose since the start, to a pose on the map.

It drifts, because the program's idea of wheel radii and track is a little wrong, and because the robot
does not stand quite where it is said to start: an error of the heading grows into one of the position.
"""

from __future__ import annotations

import math

import numpy as np

from sim.geometry import Pose
from sim.signals import Odometry2D, PlanarPose2D, pose_of


class WheelOdometry:
    """The odometry of two driven wheels; radius and track, in metres, are calibrated badly by chance.

    Up to 0.2 % of each wheel's radius and 0.5 % of the track are wrong; an encoder counts 2000 ticks a
    turn.
    """

    ticks_per_turn = 2000
    radius_error, track_error = 0.002, 0.005

    def __init__(self, radius: float, track: float, chance: np.random.Generator) -> None:
        left, right, apart = chance.uniform(-1.0, 1.0, 3).tolist()
        self._left_radius = radius * (1 + self.radius_error * left)
        self._right_radius = radius * (1 + self.radius_error * right)
        self._track = track * (1 + self.track_error * apart)
        self._pose = Pose(0.0, 0.0)
        self._ticks: tuple[int, int] | None = None
        self._time = 0.0

    def update(self, left: float, right: float, time: float) -> Odometry2D:
        """Return the odometry for wheel angles in radians, counted on past whole turns, at a time."""
        scale = self.ticks_per_turn / math.tau
        ticks = round(left * scale), round(right * scale)
        before, self._ticks = self._ticks or ticks, ticks
        elapsed, self._time = time - self._time, time
        moved_left = (ticks[0] - before[0]) / scale * self._left_radius
        moved_right = (ticks[1] - before[1]) / scale * self._right_radius
        forward, turn = (moved_left + moved_right) / 2, (moved_right - moved_left) / self._track
        # The chord of an arc points half of the turn aside; its length is the arc, but for third order.
        chord = Pose(forward * math.cos(turn / 2), forward * math.sin(turn / 2), turn)
        self._pose = self._pose.compose(chord)
        rate = 1.0 / elapsed if elapsed > 0.0 else 0.0
        return {
            "x": self._pose.x,
            "y": self._pose.y,
            "theta": self._pose.theta,
            "linear": forward * rate,
            "angular": turn * rate,
        }


class AbsoluteOdometry:
    """Odometry on the floor plan: the pose at which the robot is said to start, moved on by the wheels."""

    def __init__(self, start: Pose, frame: str) -> None:
        self._start, self._frame = start, frame

    def locate(self, odometry: Odometry2D) -> PlanarPose2D:
        """Return the pose on the floor plan for an odometry that began at the start pose."""
        pose = self._start.compose(pose_of(odometry))
        return {"x": pose.x, "y": pose.y, "theta": pose.theta, "frame": self._frame}
