"""Two cameras of one living room: each sees her, and a cloth covers the one and leaves the other free."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

pytest.importorskip("pybullet", reason="PyBullet is not installed: install the extra sim on Python 3.10 or 3.11")

from sim.eyes import COVERED, LOWER, UPPER, calibration, curtain
from sim.home.apartment import Apartment
from sim.physics.noise import stream
from sim.physics.world import World
from sim.robot import astrid
from sim.robot.stereo import StereoCamera, StereoFrame
from sim.robot.tracker import Tracker

pytestmark = pytest.mark.sim


@pytest.fixture
def world(apartment: Apartment) -> Iterator[World]:
    made = World(apartment, seed=3)
    yield made
    made.close()


def seen(world: World, name: str) -> StereoFrame:
    """What a camera sees now."""
    camera = calibration(world.apartment, name)
    return StereoCamera(camera, stream(3, name)).expose(world.capture(camera))


@pytest.mark.parametrize("name", [UPPER, LOWER])
def test_each_camera_sees_her_where_she_is(world: World, name: str) -> None:
    tracker = Tracker(calibration(world.apartment, name), astrid.PLATE_HEIGHT, "frame")
    pose = tracker.look(seen(world, name))
    assert pose is not None
    assert np.hypot(pose["x"] - world.pose().x, pose["y"] - world.pose().y) < 0.1


@pytest.mark.parametrize(("covered", "free"), [(UPPER, LOWER), (LOWER, UPPER)])
def test_a_cloth_covers_one_camera_and_leaves_the_other_free(world: World, covered: str, free: str) -> None:
    world.put(curtain(world.apartment, covered))
    assert float(np.median(seen(world, covered).depth)) < COVERED < float(np.median(seen(world, free).depth))
    tracker = Tracker(calibration(world.apartment, free), astrid.PLATE_HEIGHT, "frame")
    assert tracker.look(seen(world, free)) is not None
