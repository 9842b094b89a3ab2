"""Obstacle avoidance."""

from __future__ import annotations

import math

import pytest

pytest.importorskip("numpy", reason="the world needs numpy: install the extra sim")

import numpy as np

from sim.geometry import Pose
from sim.robot.astrid import SONAR_ANGLES
from sim.robot.avoidance import Surroundings
from sim.signals import RangeScan

HERE = Pose(0.0, 0.0, 0.0)


def scan(**heard: float) -> RangeScan:
    """A scan of nothing, but for ranges by sonar: `s0=0.5` is half a metre ahead, `s90` to the left."""
    ranges = [4.2] * 16
    for sonar, distance in heard.items():
        bearing = math.radians(float(sonar[1:].replace("_", "-")))
        ranges[int(np.argmin([abs(angle - bearing) for angle in SONAR_ANGLES]))] = distance
    return {"angles": list(SONAR_ANGLES), "ranges": ranges, "max_range": 4.2}


def test_with_nothing_heard_the_wanted_direction_is_taken() -> None:
    around = Surroundings(0.3)
    around.hear(scan(), HERE, 0.0)
    assert around.steer(HERE, 0.3) == pytest.approx(0.3)


def test_an_obstacle_ahead_is_passed_on_the_freer_side() -> None:
    around = Surroundings(0.3)
    around.hear(scan(s0=0.6, s22=0.7), HERE, 0.0)
    assert around.steer(HERE, 0.0) < -0.2


def test_an_obstacle_aside_is_ignored() -> None:
    around = Surroundings(0.3)
    around.hear(scan(s90=0.4), HERE, 0.0)
    assert around.steer(HERE, 0.0) == pytest.approx(0.0)


def test_the_free_distance_ends_where_the_robot_would_touch() -> None:
    around = Surroundings(0.3)
    around.hear(scan(s0=0.8), HERE, 0.0)
    ahead, back = around.free(HERE, np.array([0.0, math.pi]))
    assert ahead == pytest.approx(0.5)
    assert back == around.horizon


def test_what_was_heard_stays_where_it_was_while_the_robot_moves_and_turns() -> None:
    around = Surroundings(0.3)
    around.hear(scan(s0=0.8), HERE, 0.0)
    turned = Pose(0.2, 0.0, math.pi / 2)
    around.hear(scan(), turned, 0.5)
    assert around.free(turned, np.array([-math.pi / 2])) == pytest.approx(0.3)


def test_what_was_heard_is_forgotten_after_a_second() -> None:
    around = Surroundings(0.3)
    around.hear(scan(s0=0.8), HERE, 0.0)
    around.hear(scan(), HERE, 1.1)
    assert around.free(HERE, np.zeros(1)) == pytest.approx(around.horizon)
