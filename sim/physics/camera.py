"""The pinhole camera: 4x4 matrices with the conventions of OpenGL, and the way back from pixels to the world.

A world point p, a homogeneous column, is projected to `projection @ view @ p`; after division by its last
component x points right, y up, and the depth buffer holds (z + 1) / 2. A camera looks along its own -z
axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Point = tuple[float, float, float]


def look_at(eye: Point, target: Point, up: Point = (0.0, 0.0, 1.0)) -> Array:
    """Return the 4x4 view matrix of a camera at `eye` that looks at `target`, not parallel to `up`."""
    forward = np.subtract(target, eye).astype(np.float64)
    forward /= np.linalg.norm(forward)
    right = np.cross(forward, up)
    right /= np.linalg.norm(right)
    view = np.eye(4)
    view[0, :3], view[1, :3], view[2, :3] = right, np.cross(right, forward), -forward
    view[:3, 3] = -view[:3, :3] @ np.asarray(eye, dtype=np.float64)
    return view


def perspective(field_of_view: float, aspect: float, near: float = 0.1, far: float = 12.0) -> Array:
    """Return the 4x4 projection: vertical angle in radians, width over height, clipping planes in metres."""
    scale = 1.0 / math.tan(field_of_view / 2.0)
    projection = np.zeros((4, 4))
    projection[0, 0], projection[1, 1] = scale / aspect, scale
    projection[2, 2], projection[2, 3] = (far + near) / (near - far), 2.0 * far * near / (near - far)
    projection[3, 2] = -1.0
    return projection


@dataclass(frozen=True, eq=False)
class Camera:
    """A calibrated camera: image size in pixels, view and projection as 4x4 matrices."""

    width: int
    height: int
    view: Array
    projection: Array

    def distance(self, depth: NDArray[np.floating]) -> Array:
        """Return, in metres along the optical axis, what the depth buffer's values in [0, 1] mean."""
        a, b = self.projection[2, 2], self.projection[2, 3]
        return np.asarray(b / (2.0 * np.asarray(depth, dtype=np.float64) - 1.0 + a), dtype=np.float64)

    def locate(self, columns: NDArray[np.integer], rows: NDArray[np.integer], distance: Array) -> Array:
        """Return the world points (n, 3) seen at pixels (columns, rows) at a distance along the optical axis.

        Only the symmetric projections that `perspective` makes are understood.
        """
        x = ((columns + 0.5) / self.width * 2.0 - 1.0) / self.projection[0, 0] * distance
        y = (1.0 - (rows + 0.5) / self.height * 2.0) / self.projection[1, 1] * distance
        in_camera = np.stack([x, y, -distance], axis=-1)
        rotation, translation = self.view[:3, :3], self.view[:3, 3]
        return np.asarray((in_camera - translation) @ rotation, dtype=np.float64)

    @property
    def position(self) -> Array:
        """Where the camera is, (3,)."""
        return np.asarray(-self.view[:3, 3] @ self.view[:3, :3], dtype=np.float64)

    def meet_plane(self, columns: NDArray[np.integer], rows: NDArray[np.integer], height: float) -> Array:
        """Return the world points (n, 3) where the sight lines of pixels pass a height above the floor."""
        lines = self.locate(columns, rows, np.ones(len(columns))) - self.position
        reach = (height - self.position[2]) / lines[:, 2:]
        return np.asarray(self.position + reach * lines, dtype=np.float64)

    def project(self, points: Array) -> Array:
        """Return the pixels (n, 2), column and row, of world points (n, 3); NaN behind the camera."""
        homogeneous = np.concatenate([points, np.ones((len(points), 1))], axis=1)
        clip = homogeneous @ (self.projection @ self.view).T
        with np.errstate(divide="ignore", invalid="ignore"):
            device = np.where(clip[:, 3:] > 0.0, clip[:, :2] / clip[:, 3:], np.nan)
        return np.stack([(device[:, 0] + 1.0) / 2.0 * self.width, (1.0 - device[:, 1]) / 2.0 * self.height], axis=1)
