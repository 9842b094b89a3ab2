"""The experiment without the network: the same world and the same algorithms, wired by hand in one loop.

Tracker, failure, odometry, arrival (section 4 of the paper), with a pause where the configurator would
work. It shows that the parts can do it, and leaves a log for pictures; the configuration itself is none
of its business.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from sim.geometry import Pose
from sim.home.apartment import Apartment
from sim.home.floor_plan import Block
from sim.physics.noise import stream
from sim.physics.world import TIME_STEP, World
from sim.robot import astrid
from sim.robot.drive import Drive
from sim.robot.navigator import Decision, Navigator
from sim.robot.odometry import AbsoluteOdometry, WheelOdometry
from sim.robot.sonar import Sonar
from sim.robot.stereo import StereoCamera
from sim.robot.tracker import Tracker

TICK = 0.1


@dataclass
class Log:
    """What happened, tick by tick of 0.1 s: `times`, `poses` (the truth), `sources` (whose poses counted).

    `lost_at` is when the tracker raised its failure, `outcome` the navigator's last word, `touched` what
    she hit.
    """

    times: list[float] = field(default_factory=list)
    poses: list[Pose] = field(default_factory=list)
    sources: list[str] = field(default_factory=list)
    touched: set[str] = field(default_factory=set)
    lost_at: float | None = None
    outcome: Decision | None = None

    def error(self, goal: Pose) -> float:
        """Return how far from the goal she truly ended, in metres."""
        return self.poses[-1].distance(goal)


def rehearse(
    apartment: Apartment,
    seed: int,
    goal: str = "(AT BEDROOM)",
    *,
    start: Pose | None = None,
    obstacles: Iterable[Block] = (),
    pause: float = 1.0,
    patience: float = 90.0,
) -> Log:
    """Let Astrid pursue a goal, first by the tracker, after its failure and a pause in seconds by odometry.

    Ends when the navigator has arrived or is stuck, or when the patience, in simulated seconds, is at an
    end.
    """
    world = World(apartment, seed, start=start)
    for block in obstacles:
        world.put(block)
    stereo = StereoCamera(world.camera(), stream(seed, "stereo"))
    tracker = Tracker(stereo.camera, astrid.PLATE_HEIGHT, apartment.iri)
    sonar = Sonar(astrid.SONAR_ANGLES, astrid.SONAR_RING, astrid.SONAR_HEIGHT, stream(seed, "sonar"))
    encoder = WheelOdometry(astrid.WHEEL_RADIUS, astrid.TRACK, stream(seed, "encoder"))
    odometry = AbsoluteOdometry(world.start, apartment.iri)
    navigator, drive, log = Navigator(apartment, goal), Drive(), Log()
    tick = 0
    while log.outcome is None and world.time < patience:
        wheels, scan = encoder.update(*world.wheel_angles(), world.time), sonar.hear(world.echo(sonar.beams))
        pose, source = None, "none"
        if log.lost_at is None:
            source = "tracker"
            if tick % 2 == 0:
                pose = tracker.look(stereo.expose(world.capture(stereo.camera)))
                if tracker.lost:
                    log.lost_at = world.time
        elif world.time > log.lost_at + pause:
            pose, source = odometry.locate(wheels), "odometry"
        if pose is not None:
            decision = navigator.update(pose, scan, wheels, world.time)
            drive.accept(decision.velocity, world.time)
            if decision.state != "driving":
                log.outcome = decision
        log.times.append(world.time)
        log.poses.append(world.pose())
        log.sources.append(source)
        world.drive(drive.set_point(world.time))
        for _ in range(round(TICK / TIME_STEP)):
            world.step()
            log.touched.update(touch.other for touch in world.contacts())
        tick += 1
    world.close()
    return log
