"""The components that share the physics world: what is screwed to Astrid, and the tracker behind the camera.

Each comes into the ecology only through the SDK, by its advertisement. The world's program calls `tick` on each of
them once per control period, on the one thread that owns PyBullet; signals carry simulated time.
"""

from __future__ import annotations

from selfconf.sdk import Component, Signal
from sim.geometry import Pose
from sim.physics.noise import stream
from sim.physics.world import World
from sim.robot import astrid
from sim.robot.drive import Drive
from sim.robot.odometry import AbsoluteOdometry, WheelOdometry
from sim.robot.sonar import Sonar
from sim.robot.stereo import StereoCamera, StereoFrame
from sim.robot.tracker import Tracker
from sim.signals import Odometry2D, PlanarPose2D, Velocity2D

ADVERTISEMENTS = "../examples/peis-home"


class SonarArray(Component):
    """The sixteen sonars: one scan a period."""

    advertisement = f"{ADVERTISEMENTS}/sonar-array.ttl"

    def __init__(self, world: World, seed: int) -> None:
        self._world = world
        chance = stream(seed, "sonar")
        self._sonar = Sonar(astrid.SONAR_ANGLES, astrid.SONAR_RING, astrid.SONAR_HEIGHT, chance)

    def tick(self) -> None:
        """Listen for echoes."""
        if self.active:
            self.emit("ranges", self._sonar.hear(self._world.echo(self._sonar.beams)), self._world.time)


class WheelEncoder(Component):
    """The wheel encoders; they count from the moment she is switched on, active or not."""

    advertisement = f"{ADVERTISEMENTS}/wheel-encoder.ttl"

    def __init__(self, world: World, seed: int) -> None:
        self._world = world
        self._odometry = WheelOdometry(astrid.WHEEL_RADIUS, astrid.TRACK, stream(seed, "encoder"))
        self.reading: Odometry2D = self._read()

    def tick(self) -> None:
        """Count the wheels' turns."""
        self.reading = self._read()
        self.emit("odometry", self.reading, self._world.time)

    def _read(self) -> Odometry2D:
        return self._odometry.update(*self._world.wheel_angles(), self._world.time)


class MotorDrive(Component):
    """The motor drive: it follows set-points, and stops by itself when they cease."""

    advertisement = f"{ADVERTISEMENTS}/motor-drive.ttl"

    def __init__(self, world: World) -> None:
        self._world, self._drive = world, Drive()
        self.heard = float("-inf")
        """The simulated time of the newest set-point."""

    def received(self, port: str, signal: Signal) -> None:
        """A set-point has arrived."""
        velocity: Velocity2D = {"linear": float(signal["linear"]), "angular": float(signal["angular"])}
        self._drive.accept(velocity, self._world.time)
        self.heard = signal.time

    def stopped(self) -> None:
        """Turned off: forget the last set-point."""
        self._drive = Drive()
        self.heard = float("-inf")

    def tick(self) -> None:
        """Turn the wheels as told, if told recently."""
        self._world.drive(self._drive.set_point(self._world.time))


class AbsolutePosition(Component):
    """Absolute odometry: the wheels' odometry in the coordinates of the apartment."""

    advertisement = f"{ADVERTISEMENTS}/absolute-odometry.ttl"

    def __init__(self, world: World, encoder: WheelEncoder, start: Pose, frame: str) -> None:
        self._world, self._encoder = world, encoder
        self._odometry = AbsoluteOdometry(start, frame)
        self.told = float("-inf")
        """The simulated time of the newest pose it told."""

    def started(self) -> None:
        """A pose at once: an input that follows need not wait for the next period."""
        self.tick()

    def tick(self) -> None:
        """Tell where the wheels say she is."""
        if self.active:
            self.told = self._world.time
            self.emit("pose", self._odometry.locate(self._encoder.reading), self.told)


class PersonTracker(Component):
    """The person tracker: looks at camera images, and fails when it really loses her."""

    advertisement = f"{ADVERTISEMENTS}/person-tracker.ttl"
    every_ticks = 2
    """It looks at every second period: five images a second."""

    def __init__(self, world: World, seed: int, frame: str) -> None:
        self._world, self._frame = world, frame
        self._stereo = StereoCamera(world.camera(), stream(seed, "stereo"))
        self._ticks = 0
        self.told = float("-inf")
        """The simulated time of the newest pose it told."""
        self._tracker = self._new_tracker()
        self.frame: StereoFrame | None = None
        """The newest image, and in `pose` what was found in it."""
        self.pose: PlanarPose2D | None = None

    def started(self) -> None:
        """Begin anew: what was lost before may be in view again."""
        self._tracker = self._new_tracker()
        self.frame = self.pose = None

    def tick(self) -> None:
        """Take an image and look for her."""
        self._ticks += 1
        if not self.active or self._ticks % self.every_ticks:
            return
        self.frame = self._stereo.expose(self._world.capture(self._stereo.camera))
        self.pose = self._tracker.look(self.frame)
        if self.pose is not None:
            self.told = self._world.time
            self.emit("pose", self.pose, self.told)
        elif self._tracker.lost:
            self.fail("Astrid has left the view of the stereo camera")

    def _new_tracker(self) -> Tracker:
        return Tracker(self._stereo.camera, astrid.PLATE_HEIGHT, self._frame)
