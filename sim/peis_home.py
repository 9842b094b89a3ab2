"""The PEIS-Home as a program: the physics world, and the components that share it, in one process.

    python -m sim.peis_home --ecology NAME --connect ENDPOINT --seed 7 --speed 1 --record run.npz

One thread owns PyBullet and calls the components. Each control period of 0.1 s of simulated time the sensors look,
the components hear what has arrived, and the physics goes on. In real time the period ends by the clock. With
`--speed inf` it ends as soon as the drive has answered the newest pose, or after `PATIENCE` seconds of real time if
it does not answer or nothing tells poses, so that the run is fast while Astrid navigates and real time while the
configurator works.

It ends when Astrid has stood still at a place long enough to have arrived, when simulated time is up, or when
it is asked to. What happened goes to stdout, a line of JSON for each event, and in full to the record.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from selfconf.sdk import Host, Termination, add_connection_arguments, open_host
from sim.equipment import AbsolutePosition, MotorDrive, PersonTracker, SonarArray, WheelEncoder
from sim.eyes import UPPER, SpareEye, StereoEye, curtain
from sim.geometry import Pose
from sim.home.apartment import Apartment, ApartmentError, read_apartment
from sim.logbook import Logbook
from sim.physics.world import TIME_STEP, World
from sim.say import say

PERIOD = 0.1
"""Simulated seconds of a control period."""
PATIENCE = 0.1
"""Real seconds that a period waits for the drive's answer when it goes as fast as it can."""
AT_REST = 2.0
"""Simulated seconds without moving after which she has arrived."""
PROGRESS = 2.0
"""Simulated seconds between two words on how far she has come."""
COVERED_AT = 3.0
"""Simulated seconds of driving after which a cloth covers the first camera, where there are two."""
ON_ASTRID = (SonarArray, WheelEncoder, MotorDrive, AbsolutePosition)
"""The components that share the world, and its process, besides those that see the living room."""
REACH = 0.6
"""Metres from the place's standing point within which she is there."""


class PeisHome:
    """The world with its components, and the loop that lets time pass."""

    def __init__(
        self, host: Host, apartment: Apartment, seed: int, speed: float, place: str, gui: bool, eyes: bool = False
    ) -> None:
        """With `eyes` the living room has two cameras in place of its person tracker, and the first gets covered."""
        self.host, self.speed = host, speed
        self._goal = standing_point(apartment, place)
        self.world = World(apartment, seed, gui)
        self.logbook = Logbook()
        frame = str(apartment.iri)
        self.sonar = SonarArray(self.world, seed)
        self.encoder = WheelEncoder(self.world, seed)
        self.drive = MotorDrive(self.world)
        self.odometry = AbsolutePosition(self.world, self.encoder, self.world.start, frame)
        self.cameras: tuple[PersonTracker | StereoEye, ...] = (
            (StereoEye(self.world, seed), SpareEye(self.world, seed))
            if eyes
            else (PersonTracker(self.world, seed, frame),)
        )
        self._covered_at = COVERED_AT if eyes else float("inf")
        for component in (self.sonar, self.encoder, self.drive, self.odometry, *self.cameras):
            host.add(component)
        self.told = Termination(host.bus)
        self._drove = 0.0
        """Simulated seconds since she first moved."""
        self._moved, self._still_since, self._asked = False, 0.0, float("-inf")
        self._next_word = 0.0
        self._began = time.monotonic()

    def run(self, seconds: float) -> str:
        """Let time pass until she has arrived, time is up or it is asked to end; which of these."""
        while not self.told():
            self._sense()
            self._wait()
            self._tell_progress()
            self._move()
            if self._arrived():
                return "arrived"
            if self.world.time >= seconds:
                return "time is up"
        return "told to end"

    def _sense(self) -> None:
        """Sensors first, poses last: a pose is answered with what was sensed before it."""
        self.sonar.tick()
        self.encoder.tick()
        # Where cameras are components of their own, only the tracker knows what was found in an image.
        looking = [camera for camera in self.cameras if isinstance(camera, PersonTracker) and camera.active]
        for camera in self.cameras:
            camera.tick()
        self.odometry.tick()
        self._asked = max(self.odometry.told, *(camera.told for camera in self.cameras))
        for camera in looking:
            self.logbook.see(self.world.time, camera.frame, camera.pose)

    def _wait(self) -> None:
        """Let the components hear what has arrived, until this period is over."""
        self.host.poll()
        if self.speed == float("inf"):
            deadline = time.monotonic() + PATIENCE
            while not self.told() and (left := deadline - time.monotonic()) > 0:
                if self._source() and self.drive.active and self.drive.heard >= self._asked > float("-inf"):
                    break
                self.host.poll(left)
            return
        deadline = self._began + (self.world.time + PERIOD) / self.speed
        while (left := deadline - time.monotonic()) > 0 and not self.told():
            self.host.poll(left)
        if left <= -1.0:  # this machine cannot keep up: let the clock fall back instead of hurrying after it
            self._began -= left

    def _move(self) -> None:
        self.logbook.write(self.world.time, self.world.pose(), self._source())
        self.drive.tick()
        self._drove += PERIOD if self._moved else 0.0
        if self._drove >= self._covered_at:
            self._covered_at = float("inf")
            self.world.put(curtain(self.world.apartment, UPPER))
            say("covered", name=UPPER, time=self.world.time)
        for _ in range(round(PERIOD / TIME_STEP)):
            self.world.step()
            self.logbook.touched.update(touch.other for touch in self.world.contacts())

    def _source(self) -> str:
        """Whose poses count: `tracker` or `odometry`, or an empty string while nothing tells poses."""
        if any(camera.active for camera in self.cameras):
            return "tracker"
        return "odometry" if self.odometry.active else ""

    def _tell_progress(self) -> None:
        if self._moved and self.world.time >= self._next_word:
            self._next_word = self.world.time + PROGRESS
            say("progress", time=self.world.time, left=self.world.pose().distance(self._goal))

    def _arrived(self) -> bool:
        before, here = self.logbook.last_pose, self.world.pose()
        moving = before.distance(here) > 0.002
        if moving:
            self._moved, self._still_since = True, self.world.time
        if not self._moved or self.world.time - self._still_since < AT_REST or not self.drive.active:
            return False
        return here.distance(self._goal) < REACH


def main() -> int:
    """Run the world; 0 if she has arrived, 2 if its record cannot be written."""
    parser = argparse.ArgumentParser(description="the PEIS-Home: a physics world and the components that share it")
    add_connection_arguments(parser)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--speed", type=float, default=1.0)
    parser.add_argument("--seconds", type=float, default=120.0, help="simulated seconds after which it ends")
    parser.add_argument("--place", default="bedroom", help="the run ends when she has come to rest there")
    parser.add_argument("--record", type=Path)
    parser.add_argument("--gui", action="store_true")
    parser.add_argument("--eyes", action="store_true", help="two cameras in place of the person tracker")
    given = parser.parse_args()
    try:
        apartment = read_apartment()
    except ApartmentError as error:
        parser.error(f"the apartment: {error}")
    if given.seed < 0 or not given.speed > 0:
        parser.error("--seed is a whole number from zero on, and --speed is more than zero")
    try:
        standing_point(apartment, given.place)
    except ApartmentError as error:
        parser.error(f"--place: {error}")
    seeing = (StereoEye, SpareEye) if given.eyes else (PersonTracker,)
    host = open_host(given.ecology, given.connect, given.keys, [*ON_ASTRID, *seeing])
    home = PeisHome(host, apartment, given.seed, given.speed, given.place, given.gui, given.eyes)
    say("ready", time=home.world.time)
    try:
        outcome = home.run(given.seconds)
        pose = home.world.pose()
        home.logbook.write(home.world.time, pose, "")
        if given.record is not None:
            try:
                home.logbook.save(given.record)
            except OSError as error:  # a full disk, for one
                print(f"the record {given.record} cannot be written: {error.strerror}", flush=True)
                return 2
        touched = sorted(home.logbook.touched)
        say("end", outcome=outcome, time=home.world.time, x=pose.x, y=pose.y, touched=touched)
        host.run(home.told)  # still there, so that the configuration can be taken down
    finally:
        host.close()
        home.world.close()
    return 0 if outcome == "arrived" else 1


def standing_point(apartment: Apartment, name: str) -> Pose:
    """Where a robot stands that has come to a place; raises ApartmentError if the place has none."""
    standing = apartment.place(name).standing
    if standing is None:
        raise ApartmentError(name, "home:standingPoint", "is missing")
    return standing


if __name__ == "__main__":
    raise SystemExit(main())
