"""What is known of a finished run: where the robot was, by which component it knew that, and what failed."""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from sim.geometry import wrap
from sim.pictures.colours import SOURCES
from sim.pictures.wiring import Wiring


@dataclass(frozen=True)
class Sample:
    """Where the robot truly was: time in seconds, x and y in metres, theta in radians."""

    time: float
    x: float
    y: float
    theta: float = 0.0


@dataclass(frozen=True)
class Supply:
    """A time, in seconds, during which one component supplied the pose; its name reads well after "pose from"."""

    component: str
    start: float
    end: float


@dataclass(frozen=True)
class Failure:
    """A FAIL: when and where the robot was, which component raised it, and why, in plain words."""

    time: float
    x: float
    y: float
    component: str = ""
    reason: str = ""


@dataclass(frozen=True, eq=False)
class CameraImage:
    """An image (h, w, 3) of bytes that a camera took, and the lines of text that belong under it.

    `lost` says that the tracker did not find the robot in it.
    """

    image: NDArray[np.uint8]
    time: float
    caption: str = ""
    lost: bool = False


@dataclass(frozen=True, eq=False)
class RunRecord:
    """A finished run, all that its pictures are drawn from.

    `samples` and `supplies` are in order of time and there is at least one sample; ValueError otherwise.
    """

    samples: tuple[Sample, ...]
    supplies: tuple[Supply, ...] = ()
    failures: tuple[Failure, ...] = ()
    goal: tuple[float, float] | None = None
    sights: tuple[CameraImage, ...] = ()
    wirings: tuple[Wiring, ...] = ()
    title: str = "A run"
    subtitle: str = ""

    def __post_init__(self) -> None:
        """Refuse what cannot be drawn."""
        if not self.samples:
            raise ValueError("a run has at least one sample")
        if any(later.time < earlier.time for earlier, later in zip(self.samples, self.samples[1:], strict=False)):
            raise ValueError("the samples of a run are in order of time")

    @property
    def start(self) -> float:
        """Time of the first sample."""
        return self.samples[0].time

    @property
    def end(self) -> float:
        """Time of the last sample."""
        return self.samples[-1].time

    @property
    def sources(self) -> tuple[str, ...]:
        """The components that supplied the pose, in the order in which they first did."""
        return tuple(dict.fromkeys(supply.component for supply in self.supplies))

    def colours(self) -> dict[str, str]:
        """Return the colour of each component that supplied the pose."""
        return {source: SOURCES[k % len(SOURCES)] for k, source in enumerate(self.sources)}

    def at(self, time: float) -> Sample:
        """Return where the robot was at a time, between two samples on a straight line."""
        after = bisect_right(self.samples, time, key=lambda sample: sample.time)
        if after == 0 or after == len(self.samples):
            return self.samples[min(after, len(self.samples) - 1)]
        first, second = self.samples[after - 1], self.samples[after]
        share = (time - first.time) / (second.time - first.time)
        turn = wrap(second.theta - first.theta)
        return Sample(
            time,
            first.x + share * (second.x - first.x),
            first.y + share * (second.y - first.y),
            wrap(first.theta + share * turn),
        )

    def source(self, time: float) -> str | None:
        """Return the component that supplied the pose at a time; the latest one if two claim it, None if none does."""
        claims = [supply.component for supply in self.supplies if supply.start <= time <= supply.end]
        return claims[-1] if claims else None

    def length(self) -> float:
        """Return the length of the way in metres."""
        return sum(math.hypot(b.x - a.x, b.y - a.y) for a, b in zip(self.samples, self.samples[1:], strict=False))
