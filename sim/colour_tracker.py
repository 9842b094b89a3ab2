"""The tracker of the living room as a program of its own: it finds Astrid in the images of the camera that feeds it.

It fails when she has left the view of that camera. Which camera that is, it knows by the source of each image, and
where that camera hangs, from the description of the apartment.
"""

from __future__ import annotations

import numpy as np

from selfconf.sdk import Component, Signal, main
from sim.eyes import calibration
from sim.home.apartment import read_apartment
from sim.robot import astrid
from sim.robot.stereo import StereoFrame
from sim.robot.tracker import Tracker


class ColourTracker(Component):
    """Answers each image, with the depths of its time, with a pose of that time."""

    advertisement = "../examples/eyes/colour-tracker.ttl"

    def __init__(self) -> None:
        self._apartment = read_apartment()
        self._depth: Signal | None = None
        self._tracker: Tracker | None = None
        self._source = ""

    def started(self) -> None:
        """Begin anew: what was lost before may be in view again."""
        self._depth, self._tracker, self._source = None, None, ""

    def received(self, port: str, signal: Signal) -> None:
        """Keep depths until the image of their time comes, and look for her in both."""
        if port == "depth":
            self._depth = signal
            return
        depth = self._depth
        if depth is None or (depth.source, depth.time) != (signal.source, signal.time):
            return
        if self._tracker is None or signal.source != self._source:
            camera = calibration(self._apartment, signal.source.short)
            self._tracker = Tracker(camera, astrid.PLATE_HEIGHT, str(self._apartment.iri))
            self._source = signal.source
        pose = self._tracker.look(StereoFrame(np.asarray(signal.value), np.asarray(depth.value, dtype=np.float64)))
        if pose is not None:
            self.emit("pose", pose, signal.time)
        elif self._tracker.lost:
            self.fail(f"Astrid has left the view of the {signal.source.short}")


if __name__ == "__main__":
    main(ColourTracker)
