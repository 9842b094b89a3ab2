"""Views: which ray of the scene each picture point looks along.

A ray starts at `start[0] + a start[1] + b start[2]` and runs along `way[0] + a way[1] + b way[2]`, both linear in the
picture coordinates a (right) and b (up). With a fixed start that is a perspective view, with a fixed way a parallel
one, and everything else (hitting solids, shadow maps, re-drawing a window of the picture) need not know which.
The parameter along a ray is always the depth in metres: `way[0]` is a unit vector, orthogonal to the other two.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from sim.pictures.arrays import Array, Matrix, Vector, Window


def axes(forward: Vector, up: Vector = (0.0, 0.0, 1.0)) -> Matrix:
    """Return forward, right and up as the rows of a 3x3 matrix; a vertical `forward` has north for up."""
    ahead = np.asarray(forward, np.float64) / math.hypot(*forward)
    beside = np.cross(ahead, up)
    if float(np.linalg.norm(beside)) < 1e-6:
        beside = np.cross(ahead, (0.0, 1.0, 0.0))
    beside /= np.linalg.norm(beside)
    return np.stack([ahead, beside, np.cross(beside, ahead)])


@dataclass(frozen=True, eq=False)
class View:
    """A picture plane of width x height pixels; `step` is the size of a pixel in picture coordinates.

    `middle` is the column and row, in pixels, of the picture point (0, 0).
    """

    width: int
    height: int
    step: float
    middle: tuple[float, float]
    start: Matrix
    way: Matrix

    @classmethod
    def perspective(cls, size: tuple[int, int], eye: Vector, target: Vector, angle: float) -> View:
        """Return the view of an eye that looks at a target in the picture's middle; `angle` is the vertical one."""
        width, height = size
        way = axes((target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]))
        start = np.stack([np.asarray(eye, np.float64), np.zeros(3), np.zeros(3)])
        return cls(width, height, 2.0 * math.tan(angle / 2.0) / height, (width / 2.0, height / 2.0), start, way)

    @classmethod
    def parallel(cls, forward: Vector, points: Matrix, step: float) -> View:
        """Return the view along `forward` that just holds the points (n, 3), `step` metres a pixel.

        Depth 0 lies a pixel before the point that is nearest to the viewer.
        """
        way = axes(forward)
        seen = points @ way.T
        low, high = seen.min(axis=0), seen.max(axis=0)
        width, height = (math.ceil((high[k] - low[k]) / step) + 3 for k in (1, 2))
        corner = (low[0] - step) * way[0] + (low[1] - step) * way[1] + (low[2] - step) * way[2]
        start = np.stack([corner, way[1], way[2]])
        return cls(width, height, step, (0.0, float(height)), start, np.stack([way[0], np.zeros(3), np.zeros(3)]))

    @property
    def is_parallel(self) -> bool:
        """Whether all rays run the same way."""
        return not self.way[1:].any()

    def shifted(self, columns: float, rows: float) -> View:
        """Return the same view with its picture moved by a (fraction of a) pixel to the right and down."""
        return replace(self, middle=(self.middle[0] + columns, self.middle[1] + rows))

    def cropped(self, window: Window) -> View:
        """Return the part of this view that a window (rows, columns) holds."""
        rows, columns = window
        middle = (self.middle[0] - columns.start, self.middle[1] - rows.start)
        return replace(self, width=columns.stop - columns.start, height=rows.stop - rows.start, middle=middle)

    def within(self, centre: Vector, turn: Matrix) -> View:
        """Return this view in the frame that lies at `centre` with the rows of `turn` for axes."""
        start = self.start @ turn.T
        start[0] -= turn @ np.asarray(centre, np.float64)
        return replace(self, start=start, way=self.way @ turn.T)

    def project(self, points: Array) -> tuple[Array, Array, Array]:
        """Return column, row and depth, each (n,), of the points (3, n); columns and rows count from the corner."""
        basis = np.concatenate([self.way[:1], (self.start if self.is_parallel else self.way)[1:]])
        offset = basis @ self.start[0]
        depth, right, up = basis.astype(np.float32) @ points.astype(np.float32) - offset.astype(np.float32)[:, None]
        if not self.is_parallel:
            right, up = right / depth, up / depth
        return (
            self.middle[0] + right / np.float32(self.step),
            self.middle[1] - up / np.float32(self.step),
            depth,
        )

    def window(self, points: Array, margin: int = 1) -> Window:
        """Return the rows and columns of the picture that the points (3, n) span, cut to the picture."""
        columns, rows, _ = self.project(points)
        left, right = math.floor(columns.min()) - margin, math.ceil(columns.max()) + margin
        top, bottom = math.floor(rows.min()) - margin, math.ceil(rows.max()) + margin
        return (
            slice(min(max(top, 0), self.height), min(max(bottom, 0), self.height)),
            slice(min(max(left, 0), self.width), min(max(right, 0), self.width)),
        )

    def everything(self) -> Window:
        """Return the window that is the whole picture."""
        return slice(0, self.height), slice(0, self.width)

    def rays(self, window: Window) -> tuple[tuple[Array, Array, Array], tuple[Array, Array, Array]]:
        """Return start and way of the rays of a window, three arrays each that broadcast to its rows x columns."""
        rows, columns = window
        right = (np.arange(columns.start, columns.stop) + 0.5 - self.middle[0])[None, :] * self.step
        up = (self.middle[1] - np.arange(rows.start, rows.stop) - 0.5)[:, None] * self.step
        return _linear(self.start, right, up), _linear(self.way, right, up)


def _linear(rows: Matrix, right: Array, up: Array) -> tuple[Array, Array, Array]:
    if not rows[1:].any():
        x, y, z = (np.float32(value) * np.ones((1, 1), np.float32) for value in rows[0])
    else:
        x, y, z = ((rows[0, k] + right * rows[1, k] + up * rows[2, k]).astype(np.float32) for k in range(3))
    return x, y, z
