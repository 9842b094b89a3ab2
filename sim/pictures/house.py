"""The doll's house: walls cut low enough to look over, the slab that they stand on, and the cameras."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from sim.home.apartment import Apartment
from sim.home.floor_plan import CameraMount, Room, Wall
from sim.pictures.colours import written
from sim.pictures.furniture import DARK, furnish
from sim.pictures.mesh import Material, Solid, axes, box, cone
from sim.pictures.scene import SLAB

CUT = 0.95
"""Height at which walls are cut, in metres."""
FRONT = 0.14
"""Height of the walls in front, between the viewer and the rooms."""
SAWN = Material("#4f586b")
EDGE = Material("#8d8478")


def house(apartment: Apartment) -> list[Solid]:
    """Return the slab below the floor, walls, furniture and cameras."""
    west, south, east, north = extent(apartment)
    middle = ((west + east) / 2, (south + north) / 2, -SLAB / 2)
    slab = box(EDGE, middle, (east - west, north - south, SLAB), 0.004)
    walls = [solid for wall in apartment.walls for solid in _wall(wall, apartment.rooms)]
    cameras = [solid for camera in apartment.cameras for solid in _camera(camera)]
    return [slab, *walls, *furnish(apartment.furniture), *cameras]


def extent(apartment: Apartment) -> tuple[float, float, float, float]:
    """Return the west, south, east and north end of rooms and walls, in metres."""
    outlines = [_outline(room, 0.0) for room in apartment.rooms]
    outlines += [_outline(wall, wall.theta) for wall in apartment.walls]
    west, south, east, north = zip(*outlines, strict=True)
    return min(west), min(south), max(east), max(north)


def _outline(thing: Room | Wall, theta: float) -> tuple[float, float, float, float]:
    """Return the ends of the upright rectangle about a rectangle turned by an angle."""
    cosine, sine = abs(math.cos(theta)) / 2, abs(math.sin(theta)) / 2
    x, y = cosine * thing.width + sine * thing.depth, sine * thing.width + cosine * thing.depth
    return thing.x - x, thing.y - y, thing.x + x, thing.y + y


def _wall(wall: Wall, rooms: Sequence[Room]) -> Iterable[Solid]:
    """Yield the panels of a wall, each with the face that it was sawn off at."""
    in_front = all(wall.y < room.y - 0.3 * room.depth for room in rooms)
    cut = FRONT if in_front else CUT
    plaster = Material(written(wall.colour))
    for panel in wall.panels():
        height = min(cut, panel.z + panel.height) - panel.z
        if height > 0:
            solids = [box(plaster, (0, 0, height / 2), (panel.width, panel.depth, height), 0.002)]
            solids += [box(SAWN, (0, 0, height), (panel.width, panel.depth, 0.012), 0.002)]
            yield from (solid.moved(panel.x, panel.y, panel.z, panel.theta) for solid in solids)


def _camera(camera: CameraMount) -> Iterable[Solid]:
    """Yield a stereo camera; a rod carries it, and lower, where the wall that it hangs on is cut away."""
    (x, y, _), z = camera.position, min(camera.position[2], CUT + 0.45)
    ahead = axes(np.subtract(camera.look_at, camera.position).tolist())
    yield cone(Material("#8f96a3", gloss=0.4), (x, y, 0), z, 0.016, 0.016)
    yield box(Material("#2b2f38", gloss=0.3), (x, y, z), (0.10, 0.26, 0.08), 0.02, ahead)
    outward = np.stack([ahead[1], ahead[2], ahead[0]])
    for side in (-0.08, 0.08):
        lens = np.array([x, y, z]) + 0.05 * ahead[0] + side * ahead[1]
        yield cone(DARK, tuple(lens), 0.03, 0.032, 0.036, outward)
