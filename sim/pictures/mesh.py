"""Solids as triangle meshes: boxes with rounded edges, cones and ellipsoids, and what their surfaces are made of.

Each is a grid of points, closed at both ends, with the exact normal at every point: so edges catch the light and round
things look round with few triangles.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]
Vector = tuple[float, float, float]

_ROUND = np.linspace(0.0, math.tau, 49)
_SMALL = 0.12


@dataclass(frozen=True)
class Material:
    """A surface: a colour "#rrggbb", its gloss in 0..1, and its grain: "wood", "cloth" or none."""

    colour: str
    gloss: float = 0.0
    grain: str = ""


@dataclass(frozen=True, eq=False)
class Solid:
    """A closed surface: its material, and points, normals (n, 3), texture coordinates (n, 2) and faces (m, 3)."""

    material: Material
    points: Array
    normals: Array
    texture: Array
    faces: NDArray[np.integer]

    def moved(self, x: float, y: float, z: float, theta: float) -> Solid:
        """Return the solid turned about the vertical by an angle, then shifted."""
        turn = upright(theta)
        return Solid(self.material, self.points @ turn + (x, y, z), self.normals @ turn, self.texture, self.faces)


def upright(angle: float) -> Array:
    """Return the axes, as rows, of a frame turned by an angle about the vertical."""
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])


def axes(forward: Sequence[float], up: Vector = (0.0, 0.0, 1.0)) -> Array:
    """Return forward, right and up as the rows of a 3x3 matrix."""
    ahead = np.asarray(forward, np.float64) / math.hypot(*forward)
    beside = np.cross(ahead, up)
    beside /= np.linalg.norm(beside)
    return np.stack([ahead, beside, np.cross(beside, ahead)])


def box(material: Material, centre: Vector, size: Vector, radius: float = 0.006, turn: Array | None = None) -> Solid:
    """Return a box by its full extents; its edges are rounded by a radius."""
    half = np.asarray(size) / 2.0
    radius = min(radius, *half)
    count = 6 if radius >= 0.02 else 2
    # A sphere of the radius, cut into its eight corners, which are pushed apart.
    quarter = np.linspace(0.0, math.pi / 2.0, count)
    rise = np.concatenate([quarter - math.pi / 2.0, quarter])[:, None]
    around = np.concatenate([quarter + k * math.pi / 2.0 for k in range(4)] + [quarter[:1]])[None, :]
    normals = np.stack(
        np.broadcast_arrays(np.cos(rise) * np.cos(around), np.cos(rise) * np.sin(around), np.sin(rise)), -1
    )
    corner = [*np.repeat([0, 1, 2, 3], count).tolist(), 0]
    signs = np.ones_like(normals)
    signs[:, :, 0], signs[:, :, 1] = np.take([1, -1, -1, 1], corner), np.take([1, 1, -1, -1], corner)
    signs[:count, :, 2] = -1.0
    return _solid(material, signs * (half - radius) + radius * normals, normals, centre, turn)


def cone(material: Material, foot: Vector, height: float, low: float, high: float, turn: Array | None = None) -> Solid:
    """Return a cone, by its radius at the bottom and at the top, that stands on the point `foot` along its z axis."""
    edge = min(0.004, height / 2.0, low, high)
    slope = math.atan2(low - high, height)
    profile = [
        (low - edge, 0.0, -math.pi / 2),
        (low, edge, slope),
        (high, height - edge, slope),
        (high - edge, height, math.pi / 2),
    ]
    radius, z, rise = (np.array(column)[:, None] for column in zip(*profile, strict=True))
    points = np.stack(np.broadcast_arrays(radius * np.cos(_ROUND), radius * np.sin(_ROUND), z), -1)
    normals = np.stack(
        np.broadcast_arrays(np.cos(rise) * np.cos(_ROUND), np.cos(rise) * np.sin(_ROUND), np.sin(rise)), -1
    )
    return _solid(material, points, normals, foot, turn)


def ball(material: Material, centre: Vector, half: Vector, turn: Array | None = None) -> Solid:
    """Return an ellipsoid by its semi-axes."""
    # Of what is small there is much, leaves for one, and its corners are not seen: they are off by a millimetre.
    around, rows = (_ROUND[::2], 13) if max(half) < _SMALL else (_ROUND, 17)
    rise = np.linspace(-math.pi / 2.0, math.pi / 2.0, rows)[:, None]
    unit = np.stack(np.broadcast_arrays(np.cos(rise) * np.cos(around), np.cos(rise) * np.sin(around), np.sin(rise)), -1)
    normals = unit / np.asarray(half)
    return _solid(material, unit * half, normals / np.linalg.norm(normals, axis=-1, keepdims=True), centre, turn)


def _solid(material: Material, points: Array, normals: Array, centre: Vector, turn: Array | None) -> Solid:
    """Return the solid of a grid (rows, columns, 3) of points whose columns close, with a lid at both ends."""
    ends = [np.broadcast_to(row.mean(axis=0), row.shape)[None] for row in (points[0], points[-1])]
    points = np.concatenate([ends[0], points, ends[1]])
    normals = np.concatenate([normals[:1], normals, normals[-1:]])
    rows, columns = points.shape[:2]
    number = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))
    faces = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    points, normals = points.reshape(-1, 3), normals.reshape(-1, 3)
    # Grain runs along the longest side; the other two share the second coordinate, so it goes on round the edges.
    long = int(np.argmax(np.ptp(points, axis=0)))
    texture = np.stack([points[:, long], points.sum(axis=1) - points[:, long]], axis=1)
    turn = np.eye(3) if turn is None else turn
    return Solid(material, points @ turn + centre, normals @ turn, texture, faces)
