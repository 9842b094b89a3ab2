"""The cameras and the tracker of the lookout; in a picture one can read how far the boat is."""

import sys
from time import monotonic

from selfconf.sdk import Component, Signal, main


class Camera(Component):
    advertisement = "parts.ttl"

    def started(self) -> None:
        self.every(0.2, self.expose)

    def expose(self) -> None:
        self.emit("image", f"{100.0 - monotonic() % 100.0:.1f}".encode(), media="text/plain")


class Tracker(Component):
    advertisement = "parts.ttl"

    def received(self, port: str, signal: Signal) -> None:
        metres = float(bytes(signal.value))
        self.emit("pose", {"x": metres, "y": 0.0, "theta": 0.0, "frame": f"seen by {signal.source.short}"})


if __name__ == "__main__":
    name = sys.argv[1]
    kind = Tracker if name.endswith("tracker") else Camera
    main(type(name, (kind,), {"component": f"https://example.org/harbour#{name}"}), arguments=sys.argv[2:])
