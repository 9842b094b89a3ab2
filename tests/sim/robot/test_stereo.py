"""The stereo camera."""

from __future__ import annotations

import pytest

pytest.importorskip("numpy", reason="the world needs numpy: install the extra sim")

import numpy as np

from sim.physics.camera import Camera, perspective
from sim.physics.noise import stream
from sim.physics.shapes import Picture
from sim.robot.stereo import StereoCamera

CAMERA = Camera(200, 100, np.eye(4), perspective(1.0, 2.0, near=0.1, far=12.0))


def picture(distance: float) -> Picture:
    """A grey wall at a distance."""
    a, b = CAMERA.projection[2, 2], CAMERA.projection[2, 3]
    depth = np.full((100, 200), (b / distance - a + 1.0) / 2.0, dtype=np.float32)
    return Picture(np.full((100, 200, 3), 128, dtype=np.uint8), depth, np.full((100, 200), -1, dtype=np.int32), {})


@pytest.mark.parametrize("distance", [1.0, 2.0, 4.0])
def test_the_error_of_the_depth_grows_with_its_square(distance: float) -> None:
    depth = StereoCamera(CAMERA, stream(1, "stereo")).expose(picture(distance)).depth
    assert depth.mean() == pytest.approx(distance, rel=0.01)
    assert depth.std() == pytest.approx(0.01 * distance**2, rel=0.05)


def test_colours_are_noisy_too() -> None:
    rgb = StereoCamera(CAMERA, stream(1, "stereo")).expose(picture(2.0)).rgb
    assert rgb.dtype == np.uint8
    assert rgb.astype(float).std() == pytest.approx(StereoCamera.grey_noise, rel=0.05)
