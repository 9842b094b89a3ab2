"""What happened in the world, period by period, and what the tracker's camera saw; saved for the pictures."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from sim.geometry import Pose
from sim.robot.stereo import StereoFrame
from sim.signals import PlanarPose2D

SIGHT_EVERY = 1.0
"""Simulated seconds between two camera images that are kept, besides the first and the last ones."""


class Logbook:
    """Times in seconds, true poses, which position sensor was active, what she touched, and camera images."""

    def __init__(self) -> None:
        self.times: list[float] = []
        self.poses: list[Pose] = []
        self.sources: list[str] = []
        self.touched: set[str] = set()
        self.sights: list[tuple[float, NDArray[np.uint8], PlanarPose2D | None]] = []
        self._recent: list[tuple[float, NDArray[np.uint8], PlanarPose2D | None]] = []
        self._seen = -1

    @property
    def last_pose(self) -> Pose:
        """Where she was at the last entry."""
        return self.poses[-1]

    def write(self, time: float, pose: Pose, source: str) -> None:
        """An entry: where she truly is, and whose poses count."""
        self.times.append(time)
        self.poses.append(pose)
        self.sources.append(source)

    def see(self, time: float, frame: StereoFrame | None, pose: PlanarPose2D | None) -> None:
        """A camera image, with the pose that the tracker found in it; only some are kept."""
        if frame is None or id(frame) == self._seen:
            return
        self._seen = id(frame)
        sight = (time, frame.rgb, pose)
        self._recent = [*self._recent[-3:], sight]
        if not self.sights or time - self.sights[-1][0] >= SIGHT_EVERY:
            self.sights.append(sight)

    def save(self, path: Path) -> None:
        """Write everything to an .npz file; `load` reads it."""
        kept = {time: (image, pose) for time, image, pose in (*self.sights, *self._recent)}
        times = sorted(kept)
        found = [kept[time][1] for time in times]
        np.savez_compressed(
            path,
            times=np.array(self.times),
            poses=np.array([(pose.x, pose.y, pose.theta) for pose in self.poses]),
            sources=np.array(self.sources),
            sight_times=np.array(times),
            sight_images=np.array([kept[time][0] for time in times], dtype=np.uint8),
            sight_poses=np.array(
                [(p["x"], p["y"], p["theta"]) if p is not None else (np.nan,) * 3 for p in found], dtype=np.float64
            ).reshape(len(found), 3),
        )
