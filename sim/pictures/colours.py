"""Colours of the pictures: Okabe and Ito's colour-blind safe hues for meaning, quiet greys for everything else.

A colour is written as "#rrggbb" (sRGB). Light adds up only in linear space, so the renderer works there and
comes back through `to_screen`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

BLUE = "#0072b2"
ORANGE = "#e69f00"
GREEN = "#009e73"
PURPLE = "#cc79a7"
SKY = "#56b4e9"

SOURCES = (BLUE, ORANGE, GREEN, PURPLE, SKY)
"""The colours of the components that supplied the pose, in the order in which they first did."""

FAIL = "#d11d2a"
"""The red of everything that failed."""

PAPER = "#ffffff"
INK = "#1f2430"
GREY = "#5b6372"
MIST = "#c9ced8"
SLATE = "#2d3442"


def rgb(colour: str) -> tuple[int, int, int]:
    """Return red, green and blue in 0..255 of a colour "#rrggbb"; ValueError for anything else."""
    if len(colour) != 7 or colour[0] != "#":
        raise ValueError(f"not a colour of the form #rrggbb: {colour!r}")
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def written(colour: tuple[float, float, float]) -> str:
    """Return "#rrggbb" for red, green and blue from 0 to 1."""
    return "#" + "".join(f"{round(part * 255):02x}" for part in colour)


def linear(colour: str) -> NDArray[np.floating]:
    """Return a colour as three linear intensities in 0..1, what a surface reflects of white light."""
    return to_linear(np.asarray(rgb(colour), np.float32) / 255.0)


def to_linear(screen: NDArray[np.floating]) -> NDArray[np.floating]:
    """Return the linear intensities of sRGB values in 0..1."""
    return np.where(screen <= 0.04045, screen / 12.92, ((screen + 0.055) / 1.055) ** 2.4).astype(np.float32)


def to_screen(intensity: NDArray[np.floating]) -> NDArray[np.uint8]:
    """Return 8-bit sRGB values of linear intensities; 1.0 is paper white, and brighter light is cut off."""
    level = np.clip(intensity, 0.0, 1.0)
    curve = np.where(level <= 0.0031308, 12.92 * level, 1.055 * level ** (1 / 2.4) - 0.055)
    return np.asarray(curve * 255.0 + 0.5, np.uint8)


def mix(first: str, second: str, share: float) -> str:
    """Return the colour that lies the given share (0..1) of the way from the first to the second, in sRGB."""
    pairs = zip(rgb(first), rgb(second), strict=True)
    return "#" + "".join(f"{round(a + (b - a) * share):02x}" for a, b in pairs)
