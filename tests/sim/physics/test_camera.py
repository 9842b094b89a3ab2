"""The pinhole camera."""

from __future__ import annotations

import pytest

pytest.importorskip("numpy", reason="the world needs numpy: install the extra sim")

import numpy as np

from sim.physics.camera import Camera, look_at, perspective

EYE, TARGET = (3.6, 3.9, 2.3), (1.7, 1.9, 0.5)


@pytest.fixture
def camera() -> Camera:
    return Camera(320, 240, look_at(EYE, TARGET), perspective(1.08, 320 / 240))


def test_what_a_camera_looks_at_is_in_the_middle_of_its_image(camera: Camera) -> None:
    assert camera.project(np.array([TARGET]))[0] == pytest.approx((160.0, 120.0))


def test_a_camera_knows_where_it_is(camera: Camera) -> None:
    assert camera.position == pytest.approx(EYE)


def test_what_is_higher_in_the_world_is_higher_in_the_image(camera: Camera) -> None:
    low, high = camera.project(np.array([TARGET, (1.7, 1.9, 1.0)]))
    assert high[1] < low[1]


def test_what_is_behind_a_camera_has_no_pixel(camera: Camera) -> None:
    assert np.isnan(camera.project(np.array([(6.0, 6.0, 4.0)]))).all()


def test_a_located_pixel_is_projected_back_to_itself(camera: Camera) -> None:
    columns, rows = np.array([3, 160, 317]), np.array([5, 120, 230])
    points = camera.locate(columns, rows, np.array([1.0, 2.0, 5.0]))
    expected = np.stack([columns + 0.5, rows + 0.5], axis=1)
    assert camera.project(points) == pytest.approx(expected)


def test_a_sight_line_meets_a_plane_at_its_height(camera: Camera) -> None:
    columns, rows = np.array([100, 200]), np.array([150, 230])
    points = camera.meet_plane(columns, rows, 1.12)
    assert points[:, 2] == pytest.approx(1.12)
    assert camera.project(points)[:, 0] == pytest.approx(columns + 0.5)


def test_the_ends_of_the_depth_buffer_are_the_clipping_planes() -> None:
    camera = Camera(4, 3, np.eye(4), perspective(1.0, 4 / 3, near=0.1, far=12.0))
    assert camera.distance(np.array([0.0, 1.0])) == pytest.approx([0.1, 12.0])
