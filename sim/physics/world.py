"""The physical PEIS-Home: the apartment, Astrid in it, and what her hardware and the camera can do and feel.

The world runs on simulated time in steps of 1/240 s, and the thread that made it owns it. The seed
decides all chance: where exactly she is put down, and, through `noise.stream`, what her sensors make of
the world. The same seed and the same commands give the same trajectory.
"""

from __future__ import annotations

import numpy as np

from sim.geometry import Pose
from sim.home.apartment import Apartment
from sim.home.floor_plan import Block, CameraMount, Furniture
from sim.physics.bullet import Bullet, heading, upright
from sim.physics.camera import Camera, look_at, perspective
from sim.physics.noise import stream
from sim.physics.shapes import Box, Contact, Cylinder, Picture
from sim.robot import astrid
from sim.robot.drive import STILL, Ramp, wheel_speeds
from sim.robot.sonar import Beams, Echoes
from sim.signals import Velocity2D

TIME_STEP = 1 / 240
FLOOR = "floor"
ROBOT = "Astrid"


class World:
    """The apartment with Astrid at her start pose, or at `start`, give or take 2 cm and a degree."""

    placement_error = 0.02

    def __init__(self, apartment: Apartment, seed: int, gui: bool = False, start: Pose | None = None) -> None:
        self.apartment, self.seed = apartment, seed
        self.bullet = Bullet(gui, TIME_STEP)
        self._steps = 0
        self._wanted, self._ramp = STILL, Ramp()
        self._build()
        self.start = start or apartment.robot(ROBOT).start
        dx, dy, turn = stream(seed, "placement").uniform(-1.0, 1.0, 3) * self.placement_error
        actual = Pose(self.start.x + float(dx), self.start.y + float(dy), self.start.theta + float(turn))
        self.bullet.add_urdf(ROBOT, astrid.URDF, (actual.x, actual.y, 0.0), upright(actual.theta))

    def _build(self) -> None:
        # What lies lowest comes last: pictures are drawn in this order, and what is hidden is not painted.
        for wall in self.apartment.walls:
            for panel in wall.panels():
                self.put(panel)
        for piece in self.apartment.furniture:
            self.put(piece)
        rooms = self.apartment.rooms
        west, east = min(r.x - r.width / 2 for r in rooms), max(r.x + r.width / 2 for r in rooms)
        south, north = min(r.y - r.depth / 2 for r in rooms), max(r.y + r.depth / 2 for r in rooms)
        for room in rooms:
            # A film of colour: thick enough to be drawn above the floor, and nothing to touch.
            film = Box((room.width, room.depth, 0.002))
            at = room.x, room.y, 0.001
            self.bullet.add(f"{FLOOR}/{room.name}", film, at, colour=room.colour, solid=False)
        size = east - west + 2.0, north - south + 2.0, 0.2
        self.bullet.add(FLOOR, Box(size), ((west + east) / 2, (south + north) / 2, -0.1))

    def put(self, block: Block) -> None:
        """Put a block into the world, such as an obstacle in her way; its name must be new."""
        box = Box((block.width, block.depth, block.height))
        shape = Cylinder(block.width / 2, block.height) if block.round else box
        at = block.x, block.y, block.z + block.height / 2
        solid = block.solid if isinstance(block, Furniture) else True
        self.bullet.add(block.name, shape, at, upright(block.theta), block.colour, solid=solid)

    def close(self) -> None:
        """End the world."""
        self.bullet.close()

    # Time

    @property
    def time(self) -> float:
        """Simulated time in seconds since the world began."""
        return self._steps * TIME_STEP

    def step(self) -> None:
        """Let 1/240 s pass."""
        self._ramp.follow(self._wanted, TIME_STEP)
        velocity: Velocity2D = {"linear": self._ramp.linear, "angular": self._ramp.angular}
        left, right = wheel_speeds(velocity, astrid.WHEEL_RADIUS, astrid.TRACK)
        self.bullet.turn_joints(ROBOT, {"left-axle": left, "right-axle": right}, astrid.WHEEL_TORQUE)
        self.bullet.step()
        self._steps += 1

    def advance(self, seconds: float) -> None:
        """Let some seconds pass, rounded to whole steps."""
        for _ in range(round(seconds / TIME_STEP)):
            self.step()

    # Astrid's hardware

    def drive(self, velocity: Velocity2D) -> None:
        """Set the velocity that her motors approach from now on, within the ramp's limits."""
        self._wanted = velocity

    def wheel_angles(self) -> tuple[float, float]:
        """Return the angles in radians of her left and right wheel; they count on past whole turns."""
        left, right = self.bullet.joint_angles(ROBOT, ("left-axle", "right-axle"))
        return left, right

    def echo(self, beams: Beams) -> Echoes:
        """Return what sound sent along beams, given in her frame, would meet."""
        pose = self.pose()
        turn = np.array(
            [
                [np.cos(pose.theta), np.sin(pose.theta), 0],
                [-np.sin(pose.theta), np.cos(pose.theta), 0],
                [0, 0, 1],
            ]
        )
        starts = beams.starts @ turn + (pose.x, pose.y, 0.0)
        directions = beams.directions @ turn
        hits = self.bullet.cast(starts, starts + beams.reach * directions)
        met = np.array([body is not None for body in hits.bodies])
        cosine = np.abs(np.sum(hits.normals * directions, axis=1))
        return Echoes(
            np.where(met, hits.fraction * beams.reach, np.inf),
            np.where(met, np.arccos(np.clip(cosine, 0.0, 1.0)), 0.0),
        )

    # The camera, and what only an onlooker knows

    def camera(self, name: str = "stereo-camera") -> Camera:
        """Return the calibration of one of the apartment's cameras."""
        return camera_of(self.apartment.camera(name))

    def capture(self, camera: Camera) -> Picture:
        """Return what a camera sees now, without noise."""
        return self.bullet.render(camera)

    def pose(self) -> Pose:
        """Return where Astrid truly is; no component may know."""
        position, orientation = self.bullet.pose(ROBOT)
        return Pose(position[0], position[1], heading(orientation))

    def contacts(self) -> list[Contact]:
        """Return what Astrid touched in the last step, apart from the floor."""
        # Bullet also lists pairs that are merely close; these exert no force.
        return [touch for touch in self.bullet.contacts(ROBOT) if touch.other != FLOOR and touch.force > 0.0]


def camera_of(mount: CameraMount) -> Camera:
    """Return the calibration of a camera that hangs where its mount says."""
    projection = perspective(mount.field_of_view, mount.width / mount.height)
    return Camera(mount.width, mount.height, look_at(mount.position, mount.look_at), projection)
