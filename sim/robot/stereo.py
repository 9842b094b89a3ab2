"""The stereo camera: a clean rendering becomes what such a camera would deliver.

Depth from two views comes from a disparity d = f b / z with a constant error, so that the error of z
grows with its square: sigma = 0.01 z^2, in metres, as modelled here (two views are not matched). Pixels
get noise of their own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim.physics.camera import Array, Camera
from sim.physics.shapes import Picture


@dataclass(frozen=True, eq=False)
class StereoFrame:
    """One exposure: `rgb` (h, w, 3) bytes, and `depth` (h, w) in metres along the optical axis."""

    rgb: NDArray[np.uint8]
    depth: Array


class StereoCamera:
    """A calibrated stereo camera with noise drawn from chance."""

    grey_noise, depth_noise = 4.0, 0.01

    def __init__(self, camera: Camera, chance: np.random.Generator) -> None:
        self.camera, self._chance = camera, chance

    def expose(self, picture: Picture) -> StereoFrame:
        """Return the frame that the camera delivers of a rendered picture."""
        grey = self._chance.normal(0.0, self.grey_noise, picture.rgb.shape)
        rgb = np.clip(picture.rgb + grey, 0, 255).astype(np.uint8)
        depth = self.camera.distance(picture.depth)
        depth += self._chance.normal(0.0, 1.0, depth.shape) * self.depth_noise * depth**2
        return StereoFrame(rgb, depth)
