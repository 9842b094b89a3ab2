"""What an apartment consists of: rooms, walls, doors, furniture, places, cameras and robots, as plain values.

Lengths are metres, angles radians; x, y and theta belong to a thing's centre, z to its lowest point.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from sim.geometry import Pose

Colour = tuple[float, float, float]


@dataclass(frozen=True)
class Block:
    """An upright solid, a box or (if `round`) a cylinder of diameter `width`."""

    name: str
    x: float
    y: float
    z: float
    theta: float
    width: float
    depth: float
    height: float
    colour: Colour
    round: bool = False

    def distance(self, x: float, y: float) -> float:
        """Return the distance in metres from a point of the plane to the block's outline, 0 inside."""
        local = Pose(self.x, self.y, self.theta).relative(Pose(x, y))
        if self.round:
            return max(0.0, math.hypot(local.x, local.y) - self.width / 2)
        return math.hypot(max(0.0, abs(local.x) - self.width / 2), max(0.0, abs(local.y) - self.depth / 2))


@dataclass(frozen=True)
class Furniture(Block):
    """A thing that stands in a room: `kind` is its class, such as Sofa; a floor covering is not `solid`."""

    iri: str = ""
    kind: str = ""
    room: str = ""
    solid: bool = True


@dataclass(frozen=True)
class Door:
    """An opening in a wall, `width` along the wall, which lies at angle `theta`; joins two rooms by name."""

    iri: str
    name: str
    x: float
    y: float
    theta: float
    width: float
    height: float
    rooms: tuple[str, str]


@dataclass(frozen=True)
class Wall(Block):
    """A wall with its doors; `width` is its length, `depth` its thickness."""

    iri: str = ""
    doors: tuple[Door, ...] = ()

    def panels(self) -> tuple[Block, ...]:
        """Return what is left of the wall when its doors are cut out: upright panels, and lintels (z > 0)."""
        frame = Pose(self.x, self.y, self.theta)
        blocks: list[Block] = []

        def add(low: float, high: float, z: float, height: float) -> None:
            if high - low > 1e-6 and height > 1e-6:
                at = frame.compose(Pose((low + high) / 2, 0.0))
                name = f"{self.name}/{len(blocks)}"
                size = high - low, self.depth, height
                blocks.append(Block(name, at.x, at.y, z, self.theta, *size, self.colour))

        done = -self.width / 2
        for door in sorted(self.doors, key=lambda d: frame.relative(Pose(d.x, d.y)).x):
            offset = frame.relative(Pose(door.x, door.y)).x
            add(done, offset - door.width / 2, self.z, self.height)
            done = offset + door.width / 2
            add(offset - door.width / 2, done, door.height, self.z + self.height - door.height)
        add(done, self.width / 2, self.z, self.height)
        return tuple(blocks)


@dataclass(frozen=True)
class Room:
    """A rectangular room; `name` is the last part of its IRI."""

    iri: str
    name: str
    label: str
    x: float
    y: float
    width: float
    depth: float
    colour: Colour

    def contains(self, x: float, y: float) -> bool:
        """Say whether a point of the plane lies in the room."""
        return abs(x - self.x) <= self.width / 2 and abs(y - self.y) <= self.depth / 2


@dataclass(frozen=True)
class Place:
    """A room or a spot: `notation` is its name in behavioural goals, `standing` where a robot stands."""

    iri: str
    name: str
    label: str
    x: float
    y: float
    z: float
    room: str
    notation: str | None
    standing: Pose | None


@dataclass(frozen=True)
class CameraMount:
    """Where a camera hangs and looks: vertical field of view in radians, size in pixels, rate in hertz."""

    iri: str
    name: str
    position: tuple[float, float, float]
    look_at: tuple[float, float, float]
    field_of_view: float
    width: int
    height: int
    rate: float


@dataclass(frozen=True)
class Robot:
    """A robot and the pose at which it starts."""

    iri: str
    name: str
    start: Pose
