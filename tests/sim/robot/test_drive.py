"""The motor drive."""

from __future__ import annotations

import pytest

from sim.robot.drive import STILL, Drive, Ramp, wheel_speeds


def test_a_set_point_holds_for_half_a_second_and_no_longer() -> None:
    drive = Drive()
    drive.accept({"linear": 0.3, "angular": 0.1}, time=10.0)
    assert drive.set_point(10.5) == {"linear": 0.3, "angular": 0.1}
    assert drive.set_point(10.51) == STILL


def test_a_drive_without_set_points_stands_still() -> None:
    assert Drive().set_point(0.0) == STILL


def test_set_points_are_cut_to_what_the_motors_can_do() -> None:
    drive = Drive()
    drive.accept({"linear": 5.0, "angular": -9.0}, time=0.0)
    assert drive.set_point(0.0) == {"linear": 0.6, "angular": -1.8}


def test_a_ramp_follows_no_faster_than_its_rates_and_then_stays() -> None:
    ramp = Ramp()
    ramp.follow({"linear": 0.4, "angular": -1.0}, 0.1)
    assert (ramp.linear, ramp.angular) == pytest.approx((0.08, -0.25))
    ramp.follow({"linear": 0.4, "angular": -1.0}, 10.0)
    assert (ramp.linear, ramp.angular) == pytest.approx((0.4, -1.0))


def test_wheels_turn_alike_ahead_and_against_each_other_on_the_spot() -> None:
    assert wheel_speeds({"linear": 0.2, "angular": 0.0}, 0.1, 0.3) == pytest.approx((2.0, 2.0))
    assert wheel_speeds({"linear": 0.0, "angular": 1.0}, 0.1, 0.3) == pytest.approx((-1.5, 1.5))
