"""The kinds of arrays and points that the pictures share."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.floating]
"""Numbers: points are (3, n), so that each coordinate lies in one piece; images (h, w, 3)."""
Matrix = NDArray[np.float64]
Mask = NDArray[np.bool_]
Indices = NDArray[np.integer]
Bytes = NDArray[np.uint8]

Point = tuple[float, float]
Vector = tuple[float, float, float]
Window = tuple[slice, slice]
"""Rows and columns of a part of a picture."""


def vector(values: Array) -> Vector:
    """Return three numbers of an array as a tuple."""
    x, y, z = (float(value) for value in values)
    return x, y, z
