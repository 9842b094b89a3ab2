"""What surfaces are made of: a colour, a gloss and a grain that varies the colour over the surface.

Grains are looked up in one tile of smooth noise, stretched differently for wood, cloth and leaf. They are fine on
purpose: several exposures average them to what an eye would see at that distance.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from sim.pictures.arrays import Array
from sim.pictures.palette import linear

_SIDE = 512


@dataclass(frozen=True)
class Matter:
    """A surface: a colour "#rrggbb", its gloss in 0..1, and its grain: "wood", "cloth", "leaf" or none.

    `glow`, in 0..1, is the share of its colour that shows without any light: a lamp shade has some.
    """

    colour: str
    gloss: float = 0.0
    grain: str = ""
    glow: float = 0.0

    def colours(self, points: Array, half: tuple[float, float, float]) -> Array:
        """Return linear colours (3, n) at points (3, n) of a solid's own frame, whose half extents are given."""
        plain = linear(self.colour)[:, None]
        x, y, z = points
        if self.grain == "wood":
            if half[2] >= max(half[0], half[1]):
                along, across, beside = z, x, y
            else:
                along, across, beside = (x, y, z) if half[0] >= half[1] else (y, x, z)
            fine = noise(along * 34.0, (across + 0.7 * beside) * 900.0)
            coarse = noise(along * 16.0, across * 210.0 + beside * 90.0)
            tone = 1.0 + 0.06 * fine + 0.05 * coarse
        elif self.grain == "cloth":
            tone = 1.0 + 0.05 * noise((x + z) * 900.0, (y - z) * 900.0)
        elif self.grain == "leaf":
            rib = np.exp(-np.square(y / np.float32(0.12 * half[1])))
            tone = 0.80 + 0.35 * rib + 0.25 * (x / np.float32(half[0]))
        else:
            tone = np.ones_like(x)
        return np.asarray(plain * tone, np.float32)


@lru_cache(maxsize=1)
def _tile() -> Array:
    """Return a tile of noise about 0 with a deviation of 1 and no seam, smooth over some three pixels."""
    white = np.random.default_rng(8).standard_normal((_SIDE, _SIDE))
    frequency = np.hypot(np.fft.fftfreq(_SIDE)[:, None], np.fft.fftfreq(_SIDE)[None, :])
    smooth = np.fft.ifft2(np.fft.fft2(white) * np.exp(-np.square(frequency / 0.12))).real
    return np.asarray(smooth / smooth.std(), np.float32)


def noise(column: Array, row: Array) -> Array:
    """Return smooth noise, deviation 1, at places given in pixels of an endless tile."""
    index = (row.astype(np.int32) % _SIDE) * _SIDE + column.astype(np.int32) % _SIDE
    return np.asarray(_tile().ravel()[index])
