"""Light: one sun with a soft edge, a sky that fills the shadows, and what the floor throws back.

Light comes from many parallel lamps. Each lamp keeps a shadow map, the depth of the scene as the lamp sees it, so
whether it reaches a point is one look into that map. A sun is a handful of lamps on a small disc, a sky some dozens
spread over the dome: averaged, the first gives shadows that are sharp where things touch and soften with distance,
the second the darkness of corners (ambient occlusion). No picture point asks all lamps: the renderer averages
several exposures, each with its own few, and their sum knows them all.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.pictures.arrays import Array, Mask, Vector
from sim.pictures.solids import Solid, look
from sim.pictures.view import View

SUN = np.array([1.00, 0.93, 0.81], np.float32) * 0.72
SKY = np.array([0.90, 0.95, 1.00], np.float32) * 0.46
BOUNCE = np.array([1.00, 0.93, 0.83], np.float32) * 0.42
SUN_FROM: Vector = (-0.50, 0.42, 0.84)
SUN_RADIUS = 0.035
"""Half the angle of the sun's disc in radians: seven times the real one, which is a picture maker's sun."""


@dataclass(frozen=True, eq=False)
class Lamp:
    """A parallel light: the direction towards it, and the map of how far it reaches."""

    towards: Array
    view: View
    depth: Array

    def reaches(self, points: Array) -> Mask:
        """Say for points (3, n) whether the lamp shines on them."""
        columns, rows, depth = self.view.project(points)
        # The map's rim is empty, so whatever lies outside of it is in the light as well.
        column = np.clip(columns, 0, self.view.width - 1).astype(np.int32)
        row = np.clip(rows, 0, self.view.height - 1).astype(np.int32)
        reach = self.depth.ravel()[row * self.view.width + column]
        return np.asarray(depth <= reach + np.float32(0.008))


def lamp(solids: Sequence[Solid], towards: Vector, step: float) -> Lamp:
    """Return the lamp that shines on the solids from a direction, with `step` metres a pixel in its map."""
    forward = (-towards[0], -towards[1], -towards[2])
    corners = np.concatenate([solid.corners for solid in solids], axis=1).T
    view = View.parallel(forward, corners, step)
    unit = np.asarray(towards, np.float32) / np.float32(math.hypot(*towards))
    return Lamp(unit, view, look(solids, view).depth)


def sun(solids: Sequence[Solid], count: int, step: float) -> list[Lamp]:
    """Return lamps spread evenly over the sun's disc."""
    return [lamp(solids, towards, step) for towards in sun_directions(count)]


def sun_directions(count: int) -> list[Vector]:
    """Return directions spread evenly over the sun's disc, in the order of the golden angle."""
    ahead = np.asarray(SUN_FROM) / math.hypot(*SUN_FROM)
    beside = np.cross(ahead, (0.0, 0.0, 1.0))
    beside /= np.linalg.norm(beside)
    above = np.cross(beside, ahead)
    found = []
    for k in range(count):
        radius, angle = SUN_RADIUS * math.sqrt((k + 0.5) / count), k * math.pi * (3.0 - math.sqrt(5.0))
        x, y, z = ahead + radius * (math.cos(angle) * beside + math.sin(angle) * above)
        found.append((float(x), float(y), float(z)))
    return found


def sky(solids: Sequence[Solid], count: int, step: float) -> list[Lamp]:
    """Return lamps spread evenly over the dome of the sky; neighbours in the list lie far apart."""
    return [lamp(solids, towards, step) for towards in sky_directions(count)]


def sky_directions(count: int) -> list[Vector]:
    """Return directions over the dome, equal solid angles each; the lowest tenth is left out as it lights nothing."""
    found = []
    for k in range(count):
        height = 0.06 + 0.94 * _radical_inverse(k, 2, count)
        angle = math.tau * _radical_inverse(k, 3)
        across = math.sqrt(1.0 - height * height)
        found.append((across * math.cos(angle), across * math.sin(angle), height))
    return found


def _radical_inverse(k: int, base: int, count: int = 0) -> float:
    """Return the van der Corput number: any stretch of the sequence is spread evenly over 0..1."""
    value, share = 0.0, 1.0 / base
    while k:
        value += (k % base) * share
        k, share = k // base, share / base
    return value + (0.5 / count if count else 0.0)
