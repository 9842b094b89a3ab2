"""The Thinking Cap: a navigator that takes a behavioural goal and lives on pose messages.

Each pose message is answered with one decision, so that without poses there are no set-points. The
pose is smoothed with the odometry; the way to the goal is planned from there through the apartment; the
navigator heads for a point a little ahead on that way (pure pursuit), turned aside by what the sonars
hear.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from sim.geometry import Pose, wrap
from sim.home.apartment import Apartment
from sim.home.goal import read_goal
from sim.home.route import RouteError, RouteMap, Spot
from sim.robot import astrid
from sim.robot.avoidance import Surroundings
from sim.robot.drive import STILL
from sim.robot.progress import Progress
from sim.signals import Odometry2D, PlanarPose2D, RangeScan, Velocity2D, pose_of

State = Literal["driving", "arrived", "stuck"]


@dataclass(frozen=True)
class Decision:
    """What the navigator makes of a pose: a set-point while driving; when stuck, a sentence that says why."""

    state: State
    velocity: Velocity2D
    reason: str = ""


class Navigator:
    """Drives to the place that a goal names, or raises GoalError; metres and seconds throughout."""

    fastest, look_ahead = 0.4, 0.45
    near, aligned = 0.06, 0.1
    patience, hope = 3.0, 25.0

    def __init__(self, apartment: Apartment, goal: str) -> None:
        self.place, self.goal = read_goal(goal, apartment)
        self._frame = apartment.iri
        self._routes = RouteMap(apartment, clearance=0.38)
        self._surroundings = Surroundings(astrid.RADIUS + 0.03)
        self._belief = Belief()
        self._progress = Progress(self.patience, self.hope)
        self._is_there = False

    def update(self, pose: PlanarPose2D, sonar: RangeScan, odometry: Odometry2D, time: float) -> Decision:
        """Answer a pose message, with the latest sonar scan and odometry, at a time in seconds."""
        if pose["frame"] != self._frame:
            raise ValueError(f"the pose is given in the frame {pose['frame']!r}, and the map in {self._frame!r}")
        wheels = pose_of(odometry)
        here = self._belief.update(pose_of(pose), wheels)
        self._surroundings.hear(sonar, wheels, time)
        try:
            way = self._routes.way((here.x, here.y), (self.goal.x, self.goal.y))
        except RouteError as error:
            return Decision("stuck", STILL, str(error))
        left = sum(math.dist(a, b) for a, b in pairwise(way))
        self._is_there = left < self.near or (self._is_there and left < 3 * self.near)
        turn = wrap(self.goal.theta - here.theta)
        if self._is_there and abs(turn) < self.aligned:
            return Decision("arrived", STILL)
        reason = self._progress.judge(wheels, left, time)
        if reason:
            return Decision("stuck", STILL, reason)
        if self._is_there:
            return Decision("driving", {"linear": 0.0, "angular": _clip(1.5 * turn, 0.8)})
        return Decision("driving", self._pursue(here, wheels, _ahead(way, self.look_ahead), left))

    def _pursue(self, here: Pose, wheels: Pose, target: Spot, left: float) -> Velocity2D:
        wanted = wrap(math.atan2(target[1] - here.y, target[0] - here.x) - here.theta)
        direction = self._surroundings.steer(wheels, wanted)
        free = float(self._surroundings.free(wheels, np.zeros(1))[0])
        # Slower with a turn ahead, an obstacle ahead, or the goal close by.
        pace = max(0.0, math.cos(direction)) ** 2 * min(1.0, free / 0.5) * min(1.0, left / 0.5 + 0.1)
        return {"linear": self.fastest * pace, "angular": _clip(1.8 * direction, 1.0)}


class Belief:
    """Where the navigator believes it is: odometry carries the belief on, pose messages pull it after them.

    Poses from a camera are noisy but do not drift; the odometry between two of them is nearly exact. So
    each message pulls by a third of the difference, and one that is far off replaces the belief.
    """

    gain, far = 0.35, 0.5

    def __init__(self) -> None:
        self._here: Pose | None = None
        self._wheels = Pose(0.0, 0.0)

    def update(self, pose: Pose, wheels: Pose) -> Pose:
        """Return the belief after a pose message and the odometry of the same moment."""
        before, self._wheels = self._wheels, wheels
        if self._here is None or self._here.compose(before.relative(wheels)).distance(pose) > self.far:
            self._here = pose
        else:
            carried = self._here.compose(before.relative(wheels))
            self._here = Pose(
                carried.x + self.gain * (pose.x - carried.x),
                carried.y + self.gain * (pose.y - carried.y),
                wrap(carried.theta + self.gain * wrap(pose.theta - carried.theta)),
            )
        return self._here


def _ahead(way: list[Spot], distance: float) -> Spot:
    """Return the point of a way that lies some metres from its beginning, or its end if it is shorter."""
    for (ax, ay), (bx, by) in pairwise(way):
        length = math.dist((ax, ay), (bx, by))
        if length > distance:
            part = distance / length
            return ax + part * (bx - ax), ay + part * (by - ay)
        distance -= length
    return way[-1]


def _clip(value: float, limit: float) -> float:
    return max(-limit, min(limit, value))
