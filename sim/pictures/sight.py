"""The view area: where in the plane a camera sees a mark that is carried at a given height.

In that plane the camera's frustum is a convex polygon, and walls cast sight shadows away from the camera. Along each
direction from the camera the mark is seen from where the ray enters the frustum to the first wall, so sweeping the
directions of all corners and crossings gives the outline exactly.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np

from sim.floor_plan import Block, CameraMount, Room, Wall
from sim.geometry import Pose, wrap
from sim.pictures.arrays import Point
from sim.pictures.view import axes

HalfPlane = tuple[float, float, float]
"""The points with a x + b y + c >= 0."""

_DIRECTIONS = 360


def view_area(camera: CameraMount, walls: Iterable[Wall], rooms: Iterable[Room], height: float) -> list[Point]:
    """Return the outline of the area in which the camera sees a mark at a height, in metres; empty if nowhere."""
    eye = camera.position
    pyramid, extent = _frustum(camera, height), _extent(rooms)
    frustum = [*pyramid, *extent]
    panels = [panel for wall in walls for panel in wall.panels()]
    sides = [*frustum, *(_outward(side, panel) for panel in panels for side in _sides(panel))]
    crossings = [_crossing(one, other) for one in frustum for other in sides]
    axis = math.atan2(camera.look_at[1] - eye[1], camera.look_at[0] - eye[0])
    turns = {wrap(k * math.tau / _DIRECTIONS) for k in range(_DIRECTIONS)}
    for x, y in [*_corners(panels), *(point for point in crossings if point is not None)]:
        turn = wrap(math.atan2(y - eye[1], x - eye[0]) - axis)
        turns |= {turn - 1e-5, turn, turn + 1e-5}
    near: list[Point] = []
    far: list[Point] = []
    for turn in sorted(turns):
        way = (math.cos(axis + turn), math.sin(axis + turn))
        enter, leave = _stretch(frustum, (eye[0], eye[1]), way)
        leave = min([leave, *(_blocked(panel, eye, way, height) for panel in panels)])
        if leave > enter + 1e-6:
            near.append((eye[0] + enter * way[0], eye[1] + enter * way[1]))
            far.append((eye[0] + leave * way[0], eye[1] + leave * way[1]))
    return _straightened(far + near[::-1])


def _frustum(camera: CameraMount, height: float) -> list[HalfPlane]:
    """Return the frustum's four sides where they cut the plane z = height."""
    eye, target = camera.position, camera.look_at
    ahead, beside, above = axes((target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]))
    upward = math.tan(camera.field_of_view / 2.0)
    sideways = upward * camera.width / camera.height
    sides = (
        sideways * ahead + beside,
        sideways * ahead - beside,
        upward * ahead + above,
        upward * ahead - above,
    )
    return [(float(a), float(b), float(c * (height - eye[2]) - a * eye[0] - b * eye[1])) for a, b, c in sides]


def _extent(rooms: Iterable[Room]) -> list[HalfPlane]:
    boxes = [(r.x - r.width / 2, r.y - r.depth / 2, r.x + r.width / 2, r.y + r.depth / 2) for r in rooms]
    low, high = np.min(boxes, axis=0), np.max(boxes, axis=0)
    return [
        (1.0, 0.0, -float(low[0])),
        (0.0, 1.0, -float(low[1])),
        (-1.0, 0.0, float(high[2])),
        (0.0, -1.0, float(high[3])),
    ]


def _sides(panel: Block) -> list[HalfPlane]:
    """Return the four sides of a panel in its own frame."""
    x, y = panel.width / 2, panel.depth / 2
    return [(1.0, 0.0, x), (-1.0, 0.0, x), (0.0, 1.0, y), (0.0, -1.0, y)]


def _outward(side: HalfPlane, panel: Block) -> HalfPlane:
    """Return a side of a panel's own frame in the apartment's frame."""
    normal = Pose(0.0, 0.0, panel.theta).compose(Pose(side[0], side[1]))
    return normal.x, normal.y, side[2] - normal.x * panel.x - normal.y * panel.y


def _crossing(one: HalfPlane, other: HalfPlane) -> Point | None:
    """Return where two lines cross, None if they are parallel."""
    (a, b, c), (d, e, f) = one, other
    area = a * e - b * d
    return None if abs(area) < 1e-9 else ((b * f - c * e) / area, (c * d - a * f) / area)


def _corners(panels: Iterable[Block]) -> list[Point]:
    return [
        (corner.x, corner.y)
        for panel in panels
        for sign, other in ((-1, -1), (-1, 1), (1, -1), (1, 1))
        for corner in [
            Pose(panel.x, panel.y, panel.theta).compose(Pose(sign * panel.width / 2, other * panel.depth / 2))
        ]
    ]


def _stretch(sides: Sequence[HalfPlane], start: Point, way: Point) -> tuple[float, float]:
    """Return from where to where a ray runs within all half planes; the second is smaller if it never does."""
    enter, leave = 0.0, math.inf
    for a, b, c in sides:
        now, slope = a * start[0] + b * start[1] + c, a * way[0] + b * way[1]
        if abs(slope) < 1e-12:
            leave = leave if now >= 0.0 else -math.inf
        elif slope > 0.0:
            enter = max(enter, -now / slope)
        else:
            leave = min(leave, -now / slope)
    return enter, leave


def _blocked(panel: Block, eye: tuple[float, float, float], way: Point, height: float) -> float:
    """Return how far, in metres of the plane, sight reaches before a panel hides a mark at a height."""
    frame = Pose(panel.x, panel.y, panel.theta)
    local = frame.relative(Pose(eye[0], eye[1], math.atan2(way[1], way[0])))
    enter, leave = _stretch(_sides(panel), (local.x, local.y), (math.cos(local.theta), math.sin(local.theta)))
    if leave <= enter or panel.z + panel.height < min(height, eye[2]):
        return math.inf
    if panel.z <= height:
        return enter
    # A lintel: the line of sight passes below it until the mark is so far away that the line meets its edge.
    drop = eye[2] - panel.z
    return math.inf if drop <= 0.0 else enter * (eye[2] - height) / drop


def _straightened(outline: Sequence[Point]) -> list[Point]:
    """Return an outline without the points that lie on a straight line between their neighbours."""
    apart = [p for p, before in zip(outline, [*outline[-1:], *outline], strict=False) if math.dist(p, before) > 1e-3]
    kept: list[Point] = []
    for k, (x, y) in enumerate(apart):
        (x0, y0), (x1, y1) = kept[-1] if kept else apart[k - 1], apart[(k + 1) % len(apart)]
        if abs((x - x0) * (y1 - y0) - (y - y0) * (x1 - x0)) > 5e-4 * math.hypot(x1 - x0, y1 - y0):
            kept.append((x, y))
    return kept
