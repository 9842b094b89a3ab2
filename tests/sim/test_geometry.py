"""Poses in the plane."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.geometry import Pose, wrap

lengths = st.floats(-10.0, 10.0)
angles = st.floats(-20.0, 20.0)
poses = st.builds(Pose, lengths, lengths, angles)


@given(angles)
def test_a_wrapped_angle_points_the_same_way_and_lies_within_half_a_turn(angle: float) -> None:
    wrapped = wrap(angle)
    assert -math.pi < wrapped <= math.pi
    assert math.cos(wrapped) == pytest.approx(math.cos(angle), abs=1e-9)
    assert math.sin(wrapped) == pytest.approx(math.sin(angle), abs=1e-9)


@given(poses, poses)
def test_the_motion_between_two_poses_leads_from_one_to_the_other(first: Pose, second: Pose) -> None:
    reached = first.compose(first.relative(second))
    assert reached.distance(second) == pytest.approx(0.0, abs=1e-9)
    assert wrap(reached.theta - second.theta) == pytest.approx(0.0, abs=1e-9)


def test_a_motion_is_made_in_the_frame_of_the_pose() -> None:
    reached = Pose(1.0, 2.0, math.pi / 2).compose(Pose(3.0, 0.0, 0.0))
    assert (reached.x, reached.y) == pytest.approx((1.0, 5.0))
