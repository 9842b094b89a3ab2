"""Astrid: her wheels' odometry, her navigation and her motors, three components in one program."""

from __future__ import annotations

import json
import math
import os
import urllib.request
from typing import Any

from selfconf.sdk import Component, Signal, main

PLACES = {"(AT BEDROOM)": (5.0, 0.8)}
"""Where the places of behavioural goals are, in metres."""
NEAR, FASTEST, TURNING = 0.15, 0.8, 2.0
"""Metres at which a place is reached; metres and radians a second at most."""


def room(what: str, value: Any = None) -> Any:
    """What the room answers to a question, or to being told something."""
    body = None if value is None else json.dumps(value).encode()
    with urllib.request.urlopen(f"{os.environ['ROOM']}{what}", data=body, timeout=1.8) as answer:
        return json.loads(answer.read() or b"null")


class Odometry(Component):
    """Where Astrid is as her wheels have it: from where she was switched on, a little less well with each metre."""

    advertisement = "astrid.ttl"
    component = "https://example.org/astrid#odometry"
    x = y = 0.4
    theta = 0.0
    before = (0.0, 0.0)

    def started(self) -> None:
        self.every(0.1, self.count)

    def count(self) -> None:
        """Add what the wheels have turned since the last time."""
        forward, turned = room("wheels")
        going, turning = (forward - self.before[0]) * 1.01, (turned - self.before[1]) * 0.99
        self.before = forward, turned
        self.x += going * math.cos(self.theta + turning / 2)
        self.y += going * math.sin(self.theta + turning / 2)
        self.theta += turning
        self.emit("pose", {"x": self.x, "y": self.y, "theta": self.theta, "frame": "room"})


class Navigation(Component):
    """Drives to a place by whatever position it is fed."""

    advertisement = "astrid.ttl"
    component = "https://example.org/astrid#navigation"

    def parameter_set(self, name: str, value: Any) -> None:
        self.place = PLACES[value]

    def started(self) -> None:
        self.source = ""

    def received(self, port: str, signal: Signal) -> None:
        if signal.source != self.source:
            self.source = signal.source
            print(f"my position comes from {signal.source.rpartition('/')[2].rpartition('#')[2]}", flush=True)
        east, north = self.place[0] - signal["x"], self.place[1] - signal["y"]
        away = math.remainder(math.atan2(north, east) - signal["theta"], math.tau)
        there = math.hypot(east, north) < NEAR
        linear = 0.0 if there else FASTEST * max(0.0, math.cos(away))
        angular = 0.0 if there else max(-TURNING, min(TURNING, 2.0 * away))
        self.emit("velocity", {"linear": linear, "angular": angular})


class Drive(Component):
    """Astrid's motors."""

    advertisement = "astrid.ttl"
    component = "https://example.org/astrid#drive"

    def received(self, port: str, signal: Signal) -> None:
        room("velocity", signal.value)

    def stopped(self) -> None:
        room("velocity", {"linear": 0.0, "angular": 0.0})


if __name__ == "__main__":
    main(Odometry, Navigation, Drive)
