"""The two stills of a run: the doll's house in perspective, and the plan from straight above."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from sim.pictures.arrays import Matrix, Vector, vector
from sim.pictures.solids import Solid
from sim.pictures.view import View

Frame = tuple[float, float, float, float]
"""Left, top, right and bottom of a part of a page, in pixels."""

Viewpoint = Callable[[Sequence[Solid], tuple[int, int], Frame], View]
"""Finds the view of solids on a page of a size, in which they fill a frame."""

FROM: Vector = (0.0, -0.74, 0.92)
"""Where the perspective eye looks from, as seen from the middle of the house."""


def perspective(solids: Sequence[Solid], size: tuple[int, int], frame: Frame) -> View:
    """Return the view from the south and above in which all solids just fit into a frame of the page."""
    corners = np.concatenate([solid.corners for solid in solids], axis=1)
    low, high = corners.min(axis=1), corners.max(axis=1)
    middle = (low + high) / 2.0
    middle[2] = 0.0
    eye = middle + np.asarray(FROM) * float(np.linalg.norm(high - low))
    view = View.perspective(size, vector(eye), vector(middle), 0.5)
    return _fitted(view, corners, frame)


def plan(solids: Sequence[Solid], size: tuple[int, int], frame: Frame) -> View:
    """Return the view from straight above in which all solids just fit into a frame of the page."""
    corners = np.concatenate([solid.corners for solid in solids], axis=1)
    view = View.parallel((0.0, 0.0, -1.0), corners.T, 0.01)
    return _fitted(replace(view, width=size[0], height=size[1]), corners, frame)


def _fitted(view: View, points: Matrix, frame: Frame) -> View:
    """Return a view zoomed and shifted so that the points (3, n) fill a frame as well as they can."""
    columns, rows, _ = view.project(points)
    left, right, top, bottom = (float(value) for value in (columns.min(), columns.max(), rows.min(), rows.max()))
    zoom = min((frame[2] - frame[0]) / (right - left), (frame[3] - frame[1]) / (bottom - top))
    across = (frame[0] + frame[2]) / 2.0 - zoom * ((left + right) / 2.0 - view.middle[0])
    down = (frame[1] + frame[3]) / 2.0 - zoom * ((top + bottom) / 2.0 - view.middle[1])
    return replace(view, step=view.step / zoom, middle=(across, down))
