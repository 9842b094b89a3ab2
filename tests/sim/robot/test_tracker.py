"""The person tracker, on frames that are drawn here pixel by pixel."""

from __future__ import annotations

import math

import pytest

pytest.importorskip("numpy", reason="the world needs numpy: install the extra sim")

import numpy as np

from sim.geometry import Pose, wrap
from sim.physics.camera import Camera, look_at, perspective
from sim.physics.noise import stream
from sim.robot.astrid import PLATE_HEIGHT
from sim.robot.stereo import StereoFrame
from sim.robot.tracker import Tracker

CAMERA = Camera(320, 240, look_at((3.62, 3.88, 2.35), (1.72, 1.91, 0.55)), perspective(1.0821, 4 / 3))
MAGENTA, CYAN, BLUE = (220, 0, 220), (0, 210, 210), (60, 100, 170)
IN_VIEW = Pose(2.0, 1.5, 0.7)


def frame(pose: Pose | None, sigma: float = 0.0, height: float = PLATE_HEIGHT) -> StereoFrame:
    """Draw what the camera sees of a plate of 0.34 x 0.30 m carried at a pose, before a bluish nowhere."""
    rows, columns = (grid.ravel() for grid in np.mgrid[0:240, 0:320])
    rgb, depth = np.full((240 * 320, 3), BLUE, dtype=np.uint8), np.full(240 * 320, 6.0)
    if pose is not None:
        points = CAMERA.meet_plane(columns, rows, height)
        cosine, sine = math.cos(pose.theta), math.sin(pose.theta)
        x, y = points[:, 0] - pose.x, points[:, 1] - pose.y
        ahead, aside = cosine * x + sine * y, cosine * y - sine * x
        distance = -(points @ CAMERA.view[2, :3] + CAMERA.view[2, 3])
        on_plate = (np.abs(ahead) < 0.17) & (np.abs(aside) < 0.15) & (distance > 0.0)
        rgb[on_plate & (ahead > 0)], rgb[on_plate & (ahead <= 0)] = MAGENTA, CYAN
        depth[on_plate] = distance[on_plate]
    depth += stream(1, "stereo").normal(0.0, 1.0, depth.shape) * sigma * depth**2
    return StereoFrame(rgb.reshape(240, 320, 3), depth.reshape(240, 320))


@pytest.fixture
def tracker() -> Tracker:
    return Tracker(CAMERA, PLATE_HEIGHT, "home")


@pytest.mark.parametrize("pose", [IN_VIEW, Pose(1.0, 1.7, 3.0), Pose(2.8, 2.0, -1.5), Pose(0.5, 1.0, 0.0)])
@pytest.mark.parametrize("sigma", [0.0, 0.01])
def test_the_pose_is_right_to_centimetres_and_degrees(tracker: Tracker, pose: Pose, sigma: float) -> None:
    seen = tracker.look(frame(pose, sigma))
    assert seen is not None
    assert math.hypot(seen["x"] - pose.x, seen["y"] - pose.y) < 0.05
    assert abs(wrap(seen["theta"] - pose.theta)) < math.radians(4.0)
    assert seen["frame"] == "home"


def test_shade_does_not_matter(tracker: Tracker) -> None:
    bright = frame(IN_VIEW)
    seen = tracker.look(StereoFrame((bright.rgb * 0.6).astype(np.uint8), bright.depth))
    assert seen is not None
    assert seen["x"] == pytest.approx(IN_VIEW.x, abs=0.02)


def test_she_is_lost_after_two_frames_without_her_and_found_again(tracker: Tracker) -> None:
    assert tracker.look(frame(IN_VIEW)) is not None
    assert tracker.look(frame(None)) is None
    assert not tracker.lost
    assert tracker.look(frame(None)) is None
    assert tracker.lost
    assert tracker.look(frame(IN_VIEW)) is not None
    assert not tracker.lost


def test_one_missed_frame_now_and_then_is_not_a_loss(tracker: Tracker) -> None:
    for _ in range(5):
        tracker.look(frame(IN_VIEW))
        tracker.look(frame(None))
        assert not tracker.lost


@pytest.mark.parametrize("colour", [MAGENTA, CYAN], ids=["its front", "its back"])
def test_a_plate_of_which_the_border_of_the_image_cuts_one_colour_gives_no_pose(
    tracker: Tracker, colour: tuple[int, int, int]
) -> None:
    turned = math.pi if colour == CYAN else 0.0
    places = (Pose(x, 0.99, turned) for x in np.arange(3.3, 4.0, 0.01))
    edge = next(pose for pose in places if colours_at_border(frame(pose).rgb))
    assert colours_at_border(frame(edge).rgb) == {colour}
    assert tracker.look(frame(edge)) is None


def colours_at_border(rgb: np.ndarray) -> set[tuple[int, int, int]]:
    """The colours of the plate that touch the border of an image."""
    border = np.concatenate([rgb[0], rgb[-1], rgb[:, 0], rgb[:, -1]])
    return {colour for colour in (MAGENTA, CYAN) if np.any(np.all(border == colour, axis=1))}


def test_a_magenta_rug_on_the_floor_is_not_her(tracker: Tracker) -> None:
    assert tracker.look(frame(IN_VIEW, height=0.0)) is None
