"""The stereo cameras of the living room as components of their own: one at its mount, and one below it.

What a camera sees goes out as two signals of one time, the image and the depths. A camera whose lens is covered sees
nothing but what covers it, and raises FAIL.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from selfconf.sdk import Component
from sim.home.apartment import Apartment
from sim.home.floor_plan import Block, CameraMount
from sim.physics.camera import Camera
from sim.physics.noise import stream
from sim.physics.world import World, camera_of
from sim.robot.stereo import StereoCamera
from sim.say import say

MOUNT = "stereo-camera"
"""What the description of the apartment calls the place of the upper camera."""
UPPER, LOWER = "upper-camera", "lower-camera"
BELOW = 0.5
"""Metres from the upper camera down to the lower one."""
COVERED = 0.45
"""A lens is covered when half of what it sees is nearer than this, in metres."""
CURTAIN = 0.25
"""Metres from the lens to what covers it."""


def mount_of(apartment: Apartment, name: str) -> CameraMount:
    """Return where one of the two cameras hangs."""
    mount = apartment.camera(MOUNT)
    if name == UPPER:
        return mount
    x, y, z = mount.position
    return replace(mount, name=name, position=(x, y, z - BELOW))


def calibration(apartment: Apartment, name: str) -> Camera:
    """Return the calibration of one of the two cameras."""
    return camera_of(mount_of(apartment, name))


def curtain(apartment: Apartment, name: str) -> Block:
    """Return a cloth that covers the lens of a camera, and leaves the other one free."""
    mount = mount_of(apartment, name)
    (x, y, z), to = mount.position, mount.look_at
    length = math.dist(mount.position, to)
    ahead = [(there - here) / length * CURTAIN for here, there in zip(mount.position, to, strict=True)]
    turn = math.atan2(to[1] - y, to[0] - x)
    return Block(
        f"curtain/{name}", x + ahead[0], y + ahead[1], z + ahead[2] - 0.25, turn, 0.02, 0.45, 0.5, (0.3, 0.3, 0.3)
    )


class StereoEye(Component):
    """A stereo camera: five exposures a second."""

    advertisement = f"../examples/eyes/{UPPER}.ttl"
    name = UPPER
    every_ticks = 2
    """It looks at every second period."""

    def __init__(self, world: World, seed: int) -> None:
        self._world, self._ticks = world, 0
        chance = stream(seed, "stereo" if self.name == UPPER else self.name)
        self._stereo = StereoCamera(calibration(world.apartment, self.name), chance)
        self.told = float("-inf")
        """The simulated time of the newest exposure that it issued."""

    def started(self) -> None:
        """Say which camera looks: outside of the living room only this line shows it."""
        say("eye", name=self.name, time=self._world.time)

    def tick(self) -> None:
        """Take an exposure, and fail if the lens is covered."""
        self._ticks += 1
        if not self.active or self._ticks % self.every_ticks:
            return
        frame = self._stereo.expose(self._world.capture(self._stereo.camera))
        if float(np.median(frame.depth)) < COVERED:
            self.fail("something covers the lens")
            return
        self.told = self._world.time
        self.emit("depth", frame.depth.astype(np.float32), self.told)
        self.emit("image", frame.rgb, self.told)


class SpareEye(StereoEye):
    """The camera below the upper one."""

    advertisement = f"../examples/eyes/{LOWER}.ttl"
    name = LOWER
