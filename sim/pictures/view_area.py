"""The view area: where in the plane a camera sees a mark that is carried at a given height."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable

import numpy as np
from shapely import MultiPoint, Polygon, unary_union
from shapely.geometry.base import BaseGeometry

from sim.geometry import Pose
from sim.home.floor_plan import Block, CameraMount, Room, Wall
from sim.pictures.mesh import axes
from sim.pictures.svg import Point


def view_area(camera: CameraMount, walls: Iterable[Wall], rooms: Iterable[Room], height: float) -> list[Point]:
    """Return the outline of the area in which the camera sees a mark at a height, in metres; empty if nowhere.

    It is the frustum in the plane of the mark, cut to the rooms, without the shadows that walls cast away from the
    camera.
    """
    eye = np.asarray(camera.position)
    ahead, beside, above = axes(np.subtract(camera.look_at, camera.position).tolist())
    upward = math.tan(camera.field_of_view / 2.0)
    sideways = upward * camera.width / camera.height
    rays = [ahead + a * sideways * beside + b * upward * above for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    area: BaseGeometry = unary_union([_rectangle(room) for room in rooms]).envelope
    area &= Polygon([_met(eye, ray, height) for ray in rays])
    for panel in (panel for wall in walls for panel in wall.panels()):
        area -= _shadow(panel, eye, height)
    whole = max(getattr(area, "geoms", [area]), key=lambda part: part.area)
    return list(whole.simplify(1e-3).exterior.coords)[:-1] if isinstance(whole, Polygon) else []


def _rectangle(room: Room) -> Polygon:
    x, y = room.width / 2, room.depth / 2
    return Polygon([(room.x + a * x, room.y + b * y) for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def _met(eye: np.ndarray, ray: np.ndarray, height: float) -> Point:
    """Return where a ray meets the plane at a height; rays that do not fall meet it far away."""
    along = (height - eye[2]) / min(ray[2], -1e-3)
    return float(eye[0] + along * ray[0]), float(eye[1] + along * ray[1])


def _shadow(panel: Block, eye: np.ndarray, height: float) -> BaseGeometry:
    """Return the part of the plane at a height that a panel hides from the eye."""
    low, high = max(panel.z, height), min(panel.z + panel.height, eye[2] - 1e-3)
    if low > high:
        return Polygon()
    frame = Pose(panel.x, panel.y, panel.theta)
    places = []
    for a, b, z in itertools.product((-0.5, 0.5), (-0.5, 0.5), (low, high)):
        corner = frame.compose(Pose(a * panel.width, b * panel.depth))
        places.append(_met(eye, np.array([corner.x, corner.y, z]) - eye, height))
    return MultiPoint(places).convex_hull
