"""From where a picture is looked at: the doll's house in perspective, and the plan from straight above."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sim.pictures.mesh import Array, Solid, Vector, axes

Frame = tuple[float, float, float, float]
"""Left, top, right and bottom of a part of a picture, in pixels."""
Window = tuple[int, int, int, int]
"""Left, top, right and bottom of a part of a picture, in whole pixels."""

FROM: Vector = (0.0, -0.74, 0.92)
"""Where the perspective eye looks from, as seen from the middle of the house."""


@dataclass(frozen=True, eq=False)
class Viewpoint:
    """A pinhole camera: its eye, its axes (forward, right and up, as rows), the size of its picture in pixels,
    how many pixels a thing of 1 m is large at a distance of 1 m, and the pixel that lies straight ahead.
    """

    size: tuple[int, int]
    eye: Array
    axes: Array
    zoom: float = 1.0
    middle: tuple[float, float] = (0.0, 0.0)

    def project(self, points: Array) -> Array:
        """Return column and row (n, 2) of the points (n, 3)."""
        depth, right, up = self.axes @ (np.asarray(points) - self.eye).T
        return np.stack([self.middle[0] + self.zoom * right / depth, self.middle[1] - self.zoom * up / depth], axis=-1)

    def fitted(self, points: Array, frame: Frame) -> Viewpoint:
        """Return a view zoomed and shifted so that the points (n, 3) fill a frame as well as they can."""
        places = replace(self, zoom=1.0, middle=(0.0, 0.0)).project(points)
        (left, top), (right, bottom) = places.min(axis=0), places.max(axis=0)
        zoom = min((frame[2] - frame[0]) / (right - left), (frame[3] - frame[1]) / (bottom - top))
        across, down = (
            (frame[0] + frame[2] - zoom * (left + right)) / 2,
            (frame[1] + frame[3] - zoom * (top + bottom)) / 2,
        )
        return replace(self, zoom=float(zoom), middle=(float(across), float(down)))

    def window(self, points: Array, margin: int) -> Window:
        """Return the part of the picture that the points (n, 3) span, with a margin, cut to the picture."""
        places = self.project(points)
        left, top = np.clip(np.floor(places.min(axis=0)) - margin, 0, self.size).astype(int).tolist()
        right, bottom = np.clip(np.ceil(places.max(axis=0)) + margin, 0, self.size).astype(int).tolist()
        return left, top, right, bottom


def perspective(solids: Sequence[Solid], size: tuple[int, int], frame: Frame) -> Viewpoint:
    """Return the view from the south and above in which all solids just fit into a frame of the picture."""
    points = np.concatenate([solid.points for solid in solids])
    low, high = points.min(axis=0), points.max(axis=0)
    middle = np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, 0.0])
    eye = middle + np.asarray(FROM) * math.dist(low, high)
    return Viewpoint(size, eye, axes((middle - eye).tolist())).fitted(points, frame)


def plan(solids: Sequence[Solid], size: tuple[int, int], frame: Frame) -> Viewpoint:
    """Return the view from straight above in which all solids just fit into a frame of the picture."""
    points = np.concatenate([solid.points for solid in solids])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    # From so far away that nothing leans: a wall's top is shifted by less than a pixel.
    eye = np.add(middle, (0.0, 0.0, 900.0))
    return Viewpoint(size, eye, axes((0.0, 0.0, -1.0), (0.0, 1.0, 0.0))).fitted(points, frame)
