"""The signals that components exchange, as robotics.ttl describes them: plain dictionaries, SI units."""

from __future__ import annotations

from typing import TypedDict

from sim.geometry import Pose


class PlanarPose2D(TypedDict):
    """A pose on the floor plan: x and y in metres, theta in radians, and the IRI of their frame."""

    x: float
    y: float
    theta: float
    frame: str


class Velocity2D(TypedDict):
    """A forward velocity in m/s and a turning velocity in rad/s, anticlockwise positive."""

    linear: float
    angular: float


class Odometry2D(TypedDict):
    """A pose relative to where the robot was switched on, and its velocity: metres, radians, seconds."""

    x: float
    y: float
    theta: float
    linear: float
    angular: float


class RangeScan(TypedDict):
    """Distances in metres at angles in radians from the robot's heading, measured from its axis.

    `max_range` stands for nothing seen.
    """

    angles: list[float]
    ranges: list[float]
    max_range: float


class Audio(TypedDict):
    """A stretch of sound on one channel: samples a second, and the samples as signed 16-bit integers."""

    rate: float
    samples: list[int]


def pose_of(message: PlanarPose2D | Odometry2D) -> Pose:
    """Return the pose that a message carries."""
    return Pose(message["x"], message["y"], message["theta"])
