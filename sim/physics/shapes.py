"""What goes into a physical world and what comes out of it: shapes, and contacts, ray hits and pictures.

Lengths are metres, angles radians; bodies and their parts are known by name.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim.physics.camera import Array

Vector = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]


@dataclass(frozen=True)
class Box:
    """A box by its full extents along x, y and z."""

    size: Vector


@dataclass(frozen=True)
class Cylinder:
    """An upright cylinder."""

    radius: float
    height: float


@dataclass(frozen=True)
class Sphere:
    """A ball."""

    radius: float


@dataclass(frozen=True)
class Mesh:
    """A triangle mesh: corners, three indices per triangle, optionally normals and texture points per corner.

    It can be seen but not touched: a body with a mesh needs `solid=False`. Texture points need normals.
    """

    vertices: Sequence[Sequence[float]]
    indices: Sequence[int]
    normals: Sequence[Sequence[float]] | None = None
    texture_points: Sequence[Sequence[float]] | None = None


Shape = Box | Cylinder | Sphere | Mesh


@dataclass(frozen=True)
class Contact:
    """Two bodies that touch, and their parts, by name; a point in the world; depth in metres; newtons."""

    body: str
    part: str
    other: str
    other_part: str
    position: Vector
    depth: float
    force: float


@dataclass(frozen=True, eq=False)
class RayHits:
    """What n rays hit first: `fraction` (n,) of their length, 1 for nothing; `normals` (n, 3); names."""

    fraction: Array
    normals: Array
    bodies: list[str | None]


@dataclass(frozen=True, eq=False)
class Picture:
    """A rendered image: `rgb` (h, w, 3) bytes, `depth` (h, w), the depth buffer from 0 to 1, `labels` (h, w).

    `names` says which part, such as "sofa" or "astrid/plate", a label is; label -1 is the background.
    """

    rgb: NDArray[np.uint8]
    depth: NDArray[np.float32]
    labels: NDArray[np.int32]
    names: dict[int, str]

    def mask(self, name: str) -> NDArray[np.bool_]:
        """Return where (h, w) a body, or one part of it, is seen."""
        wanted = [label for label, part in self.names.items() if part == name or part.startswith(name + "/")]
        return np.isin(self.labels, wanted)
