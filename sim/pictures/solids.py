"""Solids and the rays that hit them: boxes, cones and balls, each in closed form.

A picture of a furnished room needs some hundred convex solids and no triangles: a ray against a box, a cone or an
ellipsoid is a line of algebra, done for all pixels of the solid's own window at once. So depth, normal and which solid
it is are exact, at any resolution and in any view, and the same function draws pictures and shadow maps.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from sim.pictures.arrays import Array, Matrix, Vector, Window
from sim.pictures.matter import Matter
from sim.pictures.view import View

Triple = tuple[Array, Array, Array]

FAR = np.float32(np.inf)
_THIN = np.float32(1e-12)


def upright(angle: float) -> Matrix:
    """Return the axes, as rows, of a frame turned by an angle about the vertical."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


@dataclass(frozen=True, eq=False)
class Solid:
    """A convex body: its matter, its centre, half its extents along its own axes, and these axes as rows."""

    matter: Matter
    centre: Vector
    half: Vector
    turn: Matrix = field(default_factory=lambda: np.eye(3))

    @cached_property
    def corners(self) -> Matrix:
        """Return the corners (3, 8) of the box that bounds the solid."""
        signs = np.array(np.meshgrid(*[(-1.0, 1.0)] * 3)).reshape(3, 8)
        return np.asarray(self.turn.T @ (signs * np.asarray(self.half)[:, None]) + np.asarray(self.centre)[:, None])

    def local(self, points: Array) -> Array:
        """Return world points (3, n) in the solid's own frame."""
        offset = (self.turn @ np.asarray(self.centre)).astype(np.float32)
        return np.asarray(self.turn.astype(np.float32) @ points - offset[:, None])

    def hit(self, start: Triple, way: Triple) -> Array:
        """Return the depth at which rays of the solid's own frame enter it; infinity where they pass by."""
        raise TypeError(f"{type(self).__name__} has no surface")

    def normal(self, points: Array) -> Array:
        """Return the outward normals (3, n), in the world, at points (3, n) of the surface in the solid's frame."""
        raise TypeError(f"{type(self).__name__} has no surface")


@dataclass(frozen=True, eq=False)
class Box(Solid):
    """A box with rounded edges: from 2 cm of radius on they are cut round, below that they only catch the light."""

    radius: float = 0.006

    def hit(self, start: Triple, way: Triple) -> Array:
        enter: Array = np.array(-FAR)
        leave: Array = np.array(FAR)
        for origin, step, half in zip(start, way, self.half, strict=True):
            inverse = 1.0 / np.where(np.abs(step) < _THIN, _THIN, step)
            middle, reach = -origin * inverse, np.abs(np.float32(half) * inverse)
            enter, leave = np.maximum(enter, middle - reach), np.minimum(leave, middle + reach)
        depth = np.where((enter <= leave) & (leave > 0.0), enter, FAR)
        return self._rounded(depth, start, way) if self.radius >= 0.02 else depth

    def _rounded(self, depth: Array, start: Triple, way: Triple) -> Array:
        """March the rays that entered the box on to the rounded surface inside it."""
        hits = np.isfinite(depth)
        origin = np.stack([np.broadcast_to(part, depth.shape)[hits] for part in start])
        step = np.stack([np.broadcast_to(part, depth.shape)[hits] for part in way])
        core = (np.asarray(self.half, np.float32) - np.float32(self.radius))[:, None]
        length = np.sqrt((step * step).sum(axis=0))
        along = depth[hits]
        gap = np.zeros_like(along)
        for _ in range(12):
            outside = np.maximum(np.abs(origin + along * step) - core, 0.0)
            gap = np.sqrt((outside * outside).sum(axis=0)) - np.float32(self.radius)
            along = along + gap / length
        rounded = np.full_like(depth, FAR)
        rounded[hits] = np.where(gap < 0.004, along, FAR)
        return rounded

    def normal(self, points: Array) -> Array:
        core = (np.asarray(self.half, np.float32) - np.float32(self.radius))[:, None]
        return _unit(self.turn, np.maximum(np.abs(points) - core, 1e-6) * np.sign(points))


@dataclass(frozen=True, eq=False)
class Cone(Solid):
    """A round solid about its own z axis, with one radius at the bottom and another at the top."""

    low: float = 0.0
    high: float = 0.0

    def hit(self, start: Triple, way: Triple) -> Array:
        (ox, oy, oz), (dx, dy, dz) = start, way
        tall = np.float32(self.half[2])
        slope, mean = (
            np.float32((self.high - self.low) / 2.0) / tall,
            np.float32((self.high + self.low) / 2.0),
        )
        wide = mean + slope * oz
        a = dx * dx + dy * dy - slope * slope * dz * dz
        b = ox * dx + oy * dy - slope * dz * wide
        c = ox * ox + oy * oy - wide * wide
        root = np.sqrt(np.maximum(b * b - a * c, 0.0))
        a = np.where(np.abs(a) < _THIN, _THIN, a)
        depth = np.full(np.broadcast_shapes(root.shape, a.shape), FAR, np.float32)
        for along in ((-b - root) / a, (-b + root) / a):
            z = oz + along * dz
            good = (root > 0.0) & (np.abs(z) <= tall) & (along > 0.0)
            depth = np.where(good & (along < depth), along, depth)
        fall = np.where(np.abs(dz) < _THIN, _THIN, dz)
        for end, radius in ((-tall, self.low), (tall, self.high)):
            along = (end - oz) / fall
            x, y = ox + along * dx, oy + along * dy
            good = (x * x + y * y <= np.float32(radius * radius)) & (along > 0.0)
            depth = np.where(good & (along < depth), along, depth)
        return depth

    def normal(self, points: Array) -> Array:
        x, y, z = points
        slope = np.float32((self.high - self.low) / (2.0 * self.half[2]))
        across = np.maximum(np.sqrt(x * x + y * y), 1e-9)
        beside = across - (np.float32((self.high + self.low) / 2.0) + slope * z)
        above = np.abs(z) - np.float32(self.half[2])
        edge = np.float32(min(0.006, self.half[2] / 2.0))
        outward, upward = np.maximum(beside + edge, 1e-6), np.maximum(above + edge, 0.0) * np.sign(z)
        return _unit(self.turn, np.stack([x / across * outward, y / across * outward, upward - slope * outward]))


@dataclass(frozen=True, eq=False)
class Ball(Solid):
    """An ellipsoid."""

    def hit(self, start: Triple, way: Triple) -> Array:
        (ox, oy, oz), (dx, dy, dz) = (
            tuple(part / np.float32(half) for part, half in zip(rays, self.half, strict=True)) for rays in (start, way)
        )
        a = dx * dx + dy * dy + dz * dz
        b = ox * dx + oy * dy + oz * dz
        c = ox * ox + oy * oy + oz * oz - np.float32(1.0)
        inside = b * b - a * c
        depth = (-b - np.sqrt(np.maximum(inside, 0.0))) / a
        return np.where((inside > 0.0) & (depth > 0.0), depth, FAR)

    def normal(self, points: Array) -> Array:
        return _unit(self.turn, points / np.square(np.asarray(self.half, np.float32))[:, None])


def _unit(turn: Matrix, normals: Array) -> Array:
    """Return local normals, of any length, as unit vectors of the world."""
    length = np.sqrt((normals * normals).sum(axis=0))
    return np.asarray(turn.T.astype(np.float32) @ (normals / np.maximum(length, 1e-12)), np.float32)


def box(
    matter: Matter,
    centre: Vector,
    size: Vector,
    radius: float = 0.006,
    turn: Matrix | None = None,
) -> Box:
    """Return a box by its full extents."""
    half = (size[0] / 2.0, size[1] / 2.0, size[2] / 2.0)
    return Box(matter, centre, half, np.eye(3) if turn is None else turn, min(radius, *half))


def cone(
    matter: Matter,
    foot: Vector,
    height: float,
    low: float,
    high: float,
    turn: Matrix | None = None,
) -> Cone:
    """Return a cone that stands on the point `foot`; its axis is the third row of `turn`, if that is given."""
    axis = np.array([0.0, 0.0, 1.0]) if turn is None else turn[2]
    x, y, z = np.asarray(foot) + axis * (height / 2.0)
    wide = max(low, high)
    turn = np.eye(3) if turn is None else turn
    return Cone(matter, (float(x), float(y), float(z)), (wide, wide, height / 2.0), turn, low, high)


def ball(matter: Matter, centre: Vector, half: Vector, turn: Matrix | None = None) -> Ball:
    """Return an ellipsoid by its semi-axes."""
    return Ball(matter, centre, half, np.eye(3) if turn is None else turn)


@dataclass(frozen=True, eq=False)
class Sighting:
    """What each pixel of a view sees: depth in metres (infinity for nothing) and the number of the solid (-1)."""

    depth: Array
    which: NDArray[np.int16]


def look(solids: Sequence[Solid], view: View) -> Sighting:
    """Return what a view sees of the solids."""
    depth = np.full((view.height, view.width), FAR, np.float32)
    which = np.full(depth.shape, -1, np.int16)
    for number, (solid, window) in enumerate(zip(solids, _windows(solids, view), strict=True)):
        seen = depth[window]
        if seen.size == 0:
            continue
        start, way = view.within(solid.centre, solid.turn).rays(window)
        found = np.broadcast_to(solid.hit(start, way), seen.shape)
        nearer = found < seen
        np.copyto(seen, found, where=nearer)
        np.copyto(which[window], np.int16(number), where=nearer)
    return Sighting(depth, which)


def _windows(solids: Sequence[Solid], view: View) -> list[Window]:
    """Return for each solid the rows and columns in which it may be seen."""
    if not solids:
        return []
    columns, rows, _ = view.project(np.concatenate([solid.corners for solid in solids], axis=1))
    ends = []
    for places, size in ((rows, view.height), (columns, view.width)):
        of_each = places.reshape(-1, 8)
        low, high = np.floor(of_each.min(axis=1)) - 1, np.ceil(of_each.max(axis=1)) + 1
        ends.append(np.clip([low, high], 0, size).astype(int).T.tolist())
    return [(slice(*row), slice(*column)) for row, column in zip(*ends, strict=True)]
