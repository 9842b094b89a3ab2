"""The Thinking Cap, driving a point that moves exactly as it is told."""

from __future__ import annotations

from dataclasses import dataclass

import pytest

pytest.importorskip("numpy", reason="the world needs numpy: install the extra sim")

from sim.geometry import Pose
from sim.home.apartment import Apartment
from sim.home.goal import GoalError
from sim.robot.astrid import SONAR_ANGLES
from sim.robot.drive import STILL
from sim.robot.navigator import Belief, Decision, Navigator
from sim.signals import Odometry2D, PlanarPose2D, RangeScan, Velocity2D

NOTHING_HEARD: RangeScan = {"angles": list(SONAR_ANGLES), "ranges": [4.2] * 16, "max_range": 4.2}


@dataclass
class Puppet:
    """A robot without mass: its odometry is exact and begins at its start pose."""

    pose: Pose
    frame: str
    time: float = 0.0

    def message(self) -> PlanarPose2D:
        return {"x": self.pose.x, "y": self.pose.y, "theta": self.pose.theta, "frame": self.frame}

    def odometry(self) -> Odometry2D:
        return {"x": self.pose.x, "y": self.pose.y, "theta": self.pose.theta, "linear": 0.0, "angular": 0.0}

    def move(self, velocity: Velocity2D, seconds: float = 0.1) -> None:
        self.pose = self.pose.compose(Pose(velocity["linear"] * seconds, 0.0, velocity["angular"] * seconds))
        self.time += seconds


@pytest.fixture
def puppet(apartment: Apartment) -> Puppet:
    return Puppet(apartment.robots[0].start, apartment.iri)


def drive(navigator: Navigator, puppet: Puppet, seconds: float) -> list[Decision]:
    decisions = []
    while puppet.time < seconds:
        decision = navigator.update(puppet.message(), NOTHING_HEARD, puppet.odometry(), puppet.time)
        decisions.append(decision)
        if decision.state != "driving":
            break
        puppet.move(decision.velocity)
    return decisions


@pytest.mark.parametrize("goal", ["(AT BEDROOM)", "(AT KITCHEN)", "(AT LIVING-ROOM)"])
def test_it_arrives_at_each_place_and_faces_as_it_should(apartment: Apartment, puppet: Puppet, goal: str) -> None:
    navigator = Navigator(apartment, goal)
    decisions = drive(navigator, puppet, 40.0)
    assert decisions[-1] == Decision("arrived", STILL)
    assert puppet.pose.distance(navigator.goal) < 0.2
    assert abs(puppet.pose.theta - navigator.goal.theta) < 0.2


def test_once_arrived_it_stays_arrived(apartment: Apartment, puppet: Puppet) -> None:
    navigator = Navigator(apartment, "(AT BEDROOM)")
    drive(navigator, puppet, 40.0)
    again = navigator.update(puppet.message(), NOTHING_HEARD, puppet.odometry(), puppet.time + 1)
    assert again.state == "arrived"
    puppet.pose = Pose(navigator.goal.x + 2 * navigator.near, navigator.goal.y, navigator.goal.theta)
    noisy = navigator.update(puppet.message(), NOTHING_HEARD, puppet.odometry(), puppet.time + 2)
    assert noisy.state == "arrived", "a pose that is a little off sends it nowhere"
    puppet.pose = Pose(navigator.goal.x + 4 * navigator.near, navigator.goal.y, navigator.goal.theta)
    moved = navigator.update(puppet.message(), NOTHING_HEARD, puppet.odometry(), puppet.time + 3)
    assert moved.state == "driving"


def test_it_turns_aside_for_what_the_sonars_hear(apartment: Apartment, puppet: Puppet) -> None:
    ranges = [4.2] * 16
    ranges[SONAR_ANGLES.index(0.0)] = ranges[SONAR_ANGLES.index(0.0) - 1] = 0.7
    blocked: RangeScan = {"angles": list(SONAR_ANGLES), "ranges": ranges, "max_range": 4.2}
    free, turned = (
        Navigator(apartment, "(AT BEDROOM)").update(puppet.message(), scan, puppet.odometry(), 0.0).velocity
        for scan in (NOTHING_HEARD, blocked)
    )
    assert abs(turned["angular"] - free["angular"]) > 0.3
    assert turned["linear"] < free["linear"]


def test_a_robot_that_is_told_to_move_and_does_not_is_stuck_after_three_seconds(
    apartment: Apartment, puppet: Puppet
) -> None:
    navigator = Navigator(apartment, "(AT BEDROOM)")
    states = [navigator.update(puppet.message(), NOTHING_HEARD, puppet.odometry(), k / 10) for k in range(40)]
    assert {decision.state for decision in states[:30]} == {"driving"}
    assert states[32].state == "stuck"
    assert states[32].velocity == STILL
    assert states[32].reason.endswith("m are left, and the wheels have not moved for 3 s")


def test_where_no_way_leads_it_is_stuck_and_says_so(apartment: Apartment, puppet: Puppet) -> None:
    puppet.pose = Pose(-3.0, 2.0)
    (decision,) = drive(Navigator(apartment, "(AT BEDROOM)"), puppet, 1.0)
    assert decision.state == "stuck"
    assert decision.reason.startswith("no way leads from (-3.00, 2.00)")


def test_a_pose_in_another_frame_is_refused(apartment: Apartment, puppet: Puppet) -> None:
    puppet.frame = "the neighbours"
    with pytest.raises(ValueError, match="the neighbours"):
        drive(Navigator(apartment, "(AT BEDROOM)"), puppet, 1.0)


def test_an_unknown_place_is_refused_at_once(apartment: Apartment) -> None:
    with pytest.raises(GoalError, match="CELLAR"):
        Navigator(apartment, "(AT CELLAR)")


def test_the_belief_follows_the_wheels_and_is_pulled_by_poses() -> None:
    belief = Belief()
    assert belief.update(Pose(1.0, 1.0), Pose(0.0, 0.0)) == Pose(1.0, 1.0)
    moved = belief.update(Pose(1.3, 1.0), Pose(0.2, 0.0))
    assert moved.x == pytest.approx(1.2 + Belief.gain * 0.1)


def test_a_pose_far_off_replaces_the_belief() -> None:
    belief = Belief()
    belief.update(Pose(1.0, 1.0), Pose(0.0, 0.0))
    assert belief.update(Pose(4.0, 1.0), Pose(0.0, 0.0)) == Pose(4.0, 1.0)
