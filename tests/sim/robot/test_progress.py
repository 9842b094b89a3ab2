"""The stuck detector."""

from __future__ import annotations

import math

from sim.geometry import Pose
from sim.robot.progress import Progress


def test_a_robot_that_runs_in_circles_is_stuck_in_the_end() -> None:
    progress = Progress(patience=3.0, hope=25.0)
    reasons = [progress.judge(Pose(math.cos(k / 10), math.sin(k / 10), k / 10), 2.0, k / 10) for k in range(300)]
    assert not any(reasons[:250])
    assert reasons[252] == "2.0 m are left, and for 25 s that has not become less"


def test_a_robot_that_comes_nearer_all_the_time_is_not_stuck_however_long_it_takes() -> None:
    progress = Progress(patience=3.0, hope=25.0)
    assert not any(progress.judge(Pose(k / 100, 0.0), 10.0 - k / 100, k / 10) for k in range(900))


def test_a_pause_without_poses_is_not_held_against_the_robot() -> None:
    progress = Progress(patience=3.0, hope=25.0)
    assert not progress.judge(Pose(0.0, 0.0), 2.0, 0.0)
    assert not progress.judge(Pose(0.0, 0.0), 2.0, 30.0)


def test_a_robot_that_turns_on_the_spot_is_not_stuck_at_once() -> None:
    progress = Progress(patience=3.0, hope=25.0)
    assert not any(progress.judge(Pose(0.0, 0.0, k / 10), 2.0, k / 10) for k in range(200))
