"""The physical PEIS-Home."""

from __future__ import annotations

import math
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator

import pytest
from rdflib import Graph, Literal

pytest.importorskip("pybullet", reason="PyBullet is not installed: install the extra sim on Python 3.10 or 3.11")

import numpy as np

from sim.geometry import Pose
from sim.home.apartment import HOME, Apartment, read_apartment
from sim.home.floor_plan import Block
from sim.physics.noise import stream
from sim.physics.world import World
from sim.robot import astrid
from sim.robot.drive import STILL, Drive
from sim.robot.sonar import Beams, Sonar
from sim.robot.stereo import StereoCamera
from sim.robot.tracker import Tracker

pytestmark = pytest.mark.sim

OPEN_FLOOR = Pose(2.2, 1.4, 0.0)


@pytest.fixture
def world(apartment: Apartment) -> Iterator[World]:
    world = World(apartment, seed=1, start=OPEN_FLOOR)
    yield world
    world.close()


def test_the_measures_are_those_of_the_robot_file() -> None:
    robot = ElementTree.parse(astrid.URDF).getroot()

    def numbers(path: str, attribute: str) -> list[float]:
        found = robot.find(path)
        assert found is not None
        return [float(value) for value in found.attrib[attribute].split()]

    assert numbers("link[@name='left-wheel']/collision/geometry/sphere", "radius") == [astrid.WHEEL_RADIUS]
    _, aside, height = numbers("joint[@name='left-axle']/origin", "xyz")
    assert (2 * aside, height) == (astrid.TRACK, astrid.WHEEL_RADIUS)
    (hull,) = numbers("link[@name='hull']/collision/geometry/cylinder", "radius")
    assert hull + 0.01 == pytest.approx(astrid.SONAR_RING)
    assert aside + astrid.WHEEL_RADIUS <= astrid.RADIUS
    plate = numbers("link[@name='plate-front']/visual/origin", "xyz")[2]
    thick = numbers("link[@name='plate-front']/visual/geometry/box", "size")[2]
    assert plate + thick / 2 == pytest.approx(astrid.PLATE_HEIGHT)


def test_she_stands_upright_on_the_floor_where_she_was_put(world: World) -> None:
    world.advance(1.0)
    assert world.time == pytest.approx(1.0)
    assert world.pose().distance(OPEN_FLOOR) < 0.03
    assert world.contacts() == []
    assert world.bullet.pose("Astrid")[0][2] == pytest.approx(0.25, abs=0.002)


def test_she_drives_as_far_and_as_straight_as_she_is_told(world: World) -> None:
    begin = world.pose()
    world.drive({"linear": 0.25, "angular": 0.0})
    world.advance(4.0)
    world.drive(STILL)
    world.advance(1.0)
    motion = begin.relative(world.pose())
    assert motion.x == pytest.approx(1.0, abs=0.02)
    assert abs(motion.y) < 0.002
    assert abs(motion.theta) < 0.002


def test_she_turns_on_the_spot_as_far_as_she_is_told(world: World) -> None:
    begin = world.pose()
    world.drive({"linear": 0.0, "angular": 1.0})
    world.advance(1.5)
    world.drive(STILL)
    world.advance(1.0)
    motion = begin.relative(world.pose())
    assert motion.theta == pytest.approx(1.5, abs=0.03)
    assert math.hypot(motion.x, motion.y) < 0.005
    left, right = world.wheel_angles()
    assert (right - left) * astrid.WHEEL_RADIUS / astrid.TRACK == pytest.approx(motion.theta, abs=0.03)


def test_speed_grows_no_faster_than_the_ramp(world: World) -> None:
    begin = world.pose()
    world.drive({"linear": 0.6, "angular": 0.0})
    world.advance(0.5)
    assert begin.distance(world.pose()) == pytest.approx(0.5 * 0.8 * 0.5**2, rel=0.1)


def test_the_drive_stops_her_when_set_points_cease(world: World) -> None:
    drive = Drive()
    drive.accept({"linear": 0.3, "angular": 0.0}, world.time)
    places = []
    for _ in range(20):
        world.drive(drive.set_point(world.time))
        world.advance(0.1)
        places.append(world.pose())
    assert places[4].distance(places[0]) > 0.05
    assert places[-1].distance(places[-6]) < 0.001


def test_a_wall_stops_her_and_is_named(apartment: Apartment) -> None:
    world = World(apartment, seed=1, start=Pose(0.8, 1.2, math.pi))
    world.drive({"linear": 0.3, "angular": 0.0})
    world.advance(4.0)
    assert {touch.other for touch in world.contacts()} == {"west-wall/0"}
    assert all(touch.force > 0.0 for touch in world.contacts()), "what is merely close is not touched"
    assert world.pose().x > 0.19
    world.close()


def test_furniture_that_is_moved_in_turtle_is_moved_in_the_world(plan: Graph) -> None:
    plan.set((HOME.sofa, HOME.y, Literal("3.2")))
    world = World(read_apartment(plan), seed=1)
    assert world.bullet.pose("sofa")[0] == pytest.approx((1.29, 3.2, 0.4))
    world.close()


def test_furniture_that_is_turned_in_turtle_is_turned_in_the_world(plan: Graph) -> None:
    beam = Beams(np.array([[0.0, 0.0, 0.3]]), np.array([[0.0, 1.0, 0.0]]), 4.0)
    distances = []
    for theta in ("0.0", "1.5707963"):
        plan.set((HOME["coffee-table"], HOME.theta, Literal(theta)))
        world = World(read_apartment(plan), seed=1, start=Pose(1.3, 1.0, 0.0))
        distances.append(float(world.echo(beam).distance[0]))
        world.close()
    assert distances[0] - distances[1] == pytest.approx(0.22, abs=0.02)


def test_the_rug_is_seen_but_driven_over(apartment: Apartment) -> None:
    world = World(apartment, seed=1, start=Pose(2.6, 2.55, math.pi))
    assert world.capture(world.camera()).mask("rug").any()
    world.drive({"linear": 0.3, "angular": 0.0})
    world.advance(1.5)
    assert world.pose().x < 2.3
    assert world.contacts() == []
    world.close()


def test_sonars_hear_the_wall_behind_her_and_an_obstacle_before_her(world: World) -> None:
    world.put(Block("crate", 3.2, 1.4, 0.0, 0.0, 0.4, 0.4, 0.6, (1.0, 0.5, 0.0)))
    sonar = Sonar(astrid.SONAR_ANGLES, astrid.SONAR_RING, astrid.SONAR_HEIGHT, stream(4, "sonar"))
    scans = [sonar.hear(world.echo(sonar.beams))["ranges"] for _ in range(9)]
    ahead, behind = astrid.SONAR_ANGLES.index(0.0), len(astrid.SONAR_ANGLES) - 1
    assert np.median([scan[ahead] for scan in scans]) == pytest.approx(0.8, abs=0.05)
    assert np.median([scan[behind] for scan in scans]) == pytest.approx(2.2, abs=0.08)


def test_the_tracker_does_not_fail_while_she_stays_in_view(apartment: Apartment) -> None:
    world = World(apartment, seed=5, start=Pose(1.2, 1.3, 0.0))
    stereo = StereoCamera(world.camera(), stream(5, "stereo"))
    tracker = Tracker(stereo.camera, astrid.PLATE_HEIGHT, apartment.iri)
    world.drive({"linear": 0.3, "angular": 0.6})
    for _ in range(40):
        world.advance(0.25)
        seen, truth = tracker.look(stereo.expose(world.capture(stereo.camera))), world.pose()
        assert seen is not None
        assert math.hypot(seen["x"] - truth.x, seen["y"] - truth.y) < 0.06
        assert abs(math.remainder(seen["theta"] - truth.theta, math.tau)) < math.radians(8.0)
        assert not tracker.lost
    world.close()


def test_the_camera_does_not_see_her_in_the_bedroom(apartment: Apartment) -> None:
    world = World(apartment, seed=1, start=Pose(4.6, 1.0, 0.0))
    assert not world.capture(world.camera()).mask("Astrid").any()
    world.close()


def test_the_same_seed_and_commands_give_the_same_trajectory(apartment: Apartment) -> None:
    def trajectory(seed: int) -> list[Pose]:
        world = World(apartment, seed)
        world.drive({"linear": 0.3, "angular": -0.2})
        poses = []
        for _ in range(20):
            world.advance(0.1)
            poses.append(world.pose())
        world.close()
        return poses

    assert trajectory(1) == trajectory(1)
    assert trajectory(1) != trajectory(2)
