"""The person tracker: finds Astrid's plate of two colours in a stereo frame and computes her pose from it.

It knows colours, depths and the camera's calibration, and nothing else of the world. Every point of the
level plate has the same height, so the noisy depths of all its pixels are averaged into this one number,
and each pixel's sight line is cut with the plane at that height: far steadier than each pixel's own
depth. The heading leads from the middle of the cyan half to the middle of the magenta half.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from sim.physics.camera import Array, Camera
from sim.robot.stereo import StereoFrame
from sim.signals import PlanarPose2D


class Tracker:
    """A tracker for a plate at `plate_height` metres; it gives poses in `frame`.

    `lost` becomes true after two frames in a row without her, and false when she is seen again. A frame
    is without her if either colour has fewer than six pixels or touches the border of the image. One robot has such a
    plate: of two in view, the pose would be one between them.
    """

    patience, fewest_pixels = 2, 6
    height_tolerance = 0.35

    def __init__(self, camera: Camera, plate_height: float, frame: str) -> None:
        self._camera, self._plate_height, self._frame = camera, plate_height, frame
        self._missed = 0

    @property
    def lost(self) -> bool:
        """Whether she has not been seen whole for two frames in a row."""
        return self._missed >= self.patience

    def look(self, exposure: StereoFrame) -> PlanarPose2D | None:
        """Return her pose on the floor plan, or None if this frame does not show her whole plate."""
        magenta, cyan = (self._plate(mask, exposure.depth) for mask in plate_colours(exposure.rgb))
        if not (self._is_whole(magenta) and self._is_whole(cyan)):
            self._missed += 1
            return None
        self._missed = 0
        both = np.concatenate([magenta, cyan])
        columns, rows = both[:, 0], both[:, 1]
        seen = self._camera.locate(columns, rows, exposure.depth[rows, columns])
        height = float(seen[:, 2].mean())
        front, back = self._middle(magenta, height), self._middle(cyan, height)
        x, y = ((front + back) / 2).tolist()
        theta = math.atan2(front[1] - back[1], front[0] - back[0])
        return {"x": x, "y": y, "theta": theta, "frame": self._frame}

    def _plate(self, mask: NDArray[np.bool_], depth: Array) -> NDArray[np.intp]:
        """Return the pixels (n, 2), column and row, of a mask that lie about as high as the plate."""
        rows, columns = np.nonzero(mask)
        heights = self._camera.locate(columns, rows, depth[rows, columns])[:, 2]
        high = np.abs(heights - self._plate_height) < self.height_tolerance
        return np.stack([columns[high], rows[high]], axis=1)

    def _is_whole(self, pixels: NDArray[np.intp]) -> bool:
        last = self._camera.width - 1, self._camera.height - 1
        return len(pixels) >= self.fewest_pixels and not bool(np.any((pixels == 0) | (pixels == last)))

    def _middle(self, pixels: NDArray[np.intp], height: float) -> Array:
        points = self._camera.meet_plane(pixels[:, 0], pixels[:, 1], height)
        # A pixel stands for an area of the plane that grows with the third power of its distance.
        weights = np.linalg.norm(points - self._camera.position, axis=1) ** 3
        return np.asarray(np.average(points[:, :2], axis=0, weights=weights), dtype=np.float64)


def plate_colours(rgb: NDArray[np.uint8]) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Return where (h, w) an image shows the plate's magenta and its cyan, by ratios: shade does not matter."""
    red, green, blue = (rgb[:, :, k].astype(np.int32) for k in range(3))
    magenta = (red > 100) & (blue > 100) & (red > 3 * green) & (blue > 3 * green)
    cyan = (green > 100) & (blue > 100) & (green > 3 * red) & (blue > 3 * red)
    return magenta, cyan
