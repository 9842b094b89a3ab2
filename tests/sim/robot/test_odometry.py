"""Dead reckoning."""

from __future__ import annotations

import math

import pytest

pytest.importorskip("numpy", reason="the world needs numpy: install the extra sim")

import numpy as np

from sim.geometry import Pose
from sim.physics.noise import stream
from sim.robot import astrid
from sim.robot.odometry import AbsoluteOdometry, WheelOdometry
from sim.signals import Odometry2D


def odometry(seed: int = 1) -> WheelOdometry:
    return WheelOdometry(astrid.WHEEL_RADIUS, astrid.TRACK, stream(seed, "encoder"))


def drive(wheels: WheelOdometry, left: float, right: float, steps: int = 100) -> Odometry2D:
    """Turn the wheels by angles in equal steps of a tenth of a second."""
    reading = wheels.update(0.0, 0.0, 0.0)
    for k in range(1, steps + 1):
        reading = wheels.update(left * k / steps, right * k / steps, k / 10)
    return reading


def test_straight_ahead_is_right_to_a_few_per_mille() -> None:
    angle = 4.0 / astrid.WHEEL_RADIUS
    for seed in range(20):
        reading = drive(odometry(seed), angle, angle)
        assert reading["x"] == pytest.approx(4.0, abs=0.03)
        assert abs(reading["y"]) < 0.1
        assert reading["linear"] == pytest.approx(0.4, abs=0.01)


def test_it_drifts_and_how_depends_on_the_seed() -> None:
    angle = 4.0 / astrid.WHEEL_RADIUS
    aside = [drive(odometry(seed), angle, angle)["y"] for seed in range(20)]
    assert np.std(aside) > 0.01


def test_a_turn_on_the_spot_changes_the_heading_alone() -> None:
    angle = math.pi / 2 * astrid.TRACK / 2 / astrid.WHEEL_RADIUS
    reading = drive(odometry(), -angle, angle)
    assert reading["theta"] == pytest.approx(math.pi / 2, abs=0.02)
    assert math.hypot(reading["x"], reading["y"]) < 0.005


def test_odometry_begins_at_nought_wherever_the_wheels_stand() -> None:
    reading = odometry().update(123.0, -45.0, 7.0)
    assert [reading[key] for key in ("x", "y", "theta", "linear", "angular")] == [0.0] * 5


def test_absolute_odometry_moves_the_start_pose() -> None:
    sensor = AbsoluteOdometry(Pose(1.0, 2.0, math.pi / 2), "home")
    moved: Odometry2D = {"x": 3.0, "y": 0.0, "theta": 0.5, "linear": 0.0, "angular": 0.0}
    pose = sensor.locate(moved)
    assert (pose["x"], pose["y"], pose["theta"]) == pytest.approx((1.0, 5.0, math.pi / 2 + 0.5))
    assert pose["frame"] == "home"
