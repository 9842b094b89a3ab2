"""Components without physics for the failover benchmark, each a process: `python -m benchmarks.failover_actors NAME`.

A position sensor fails when a line is written to its stdin, and comes back in a new life once it has been turned
off. The navigator writes the time at which the first pose of each new source arrives.
"""

from __future__ import annotations

import json
import sys
import threading
import time
from pathlib import Path

from selfconf.sdk import Component, Host, Signal, Termination, open_host

UNTIL_OFF = 0.05
"""Seconds after FAIL, in which it is turned off, until it comes back."""
ADVERTISEMENTS = Path(__file__).parent / "failover"

POSE = {"x": 1.0, "y": 2.0, "theta": 0.5, "frame": "home"}
VELOCITY = {"linear": 0.1, "angular": 0.0}
SIGNALS = {
    "pose": POSE,
    "set.velocity": VELOCITY,
    "odometry": {**POSE, **VELOCITY},
    "ranges": {"angles": [0.0], "ranges": [1.0], "max_range": 4.0},
}
"""A signal of the type that each output promises."""


class Actor(Component):
    """Emits one signal when it is started, as a source that is latched does."""

    output = ""

    def started(self) -> None:
        """A signal at once."""
        if self.output:
            self.emit(self.output, SIGNALS[self.output])


class Navigator(Actor):
    """Writes when a new source is first heard."""

    output = "set.velocity"
    source = ""

    def received(self, port: str, signal: Signal) -> None:
        """Note the first pose of each new source."""
        if port == "position" and signal.source != self.source:
            say("first", time.time(), source=signal.source)
            self.source = signal.source


def say(event: str, moment: float, **facts: str) -> None:
    """A line of JSON on stdout."""
    print(json.dumps({"event": event, "real": moment, **facts}), flush=True)


def actor(name: str) -> type[Actor]:
    """The class for one of the advertisements."""
    base = Navigator if name == "control" else Actor
    outputs = {"sonar": "ranges", "encoder": "odometry", "position-a": "pose", "position-b": "pose"}
    members = {"advertisement": str(ADVERTISEMENTS / f"{name}.ttl"), "output": outputs.get(name, base.output)}
    return type("Actor", (base,), members)


class Phoenix:
    """Keeps a component that fails on command and comes back in a new life."""

    def __init__(self, host: Host, kind: type[Actor]) -> None:
        self._host, self._kind = host, kind
        self._component = host.add(kind())
        threading.Thread(target=self._obey, daemon=True).start()

    def _obey(self) -> None:
        for _ in sys.stdin:
            raised = time.time()
            self._component.fail("told to")
            threading.Event().wait(UNTIL_OFF)
            say("fail", raised)  # not before: whoever reads it would take a core from those who are measured
            self._rise()
            say("back", time.time())

    def _rise(self) -> None:
        """End the life that has failed, and begin another; not on the thread of the bus, which has to do it."""
        runtime, ended = self._host.runtimes.pop(), threading.Event()
        self._host.bus.wake_up(lambda: runtime.close(ended.set))
        ended.wait()
        self._component = self._host.add(self._kind())


def main() -> None:
    """Run one actor until told to end."""
    name = sys.argv[1]
    host = open_host(kinds=[actor(name)])
    ending = Termination(host.bus)
    if name.startswith("position"):
        Phoenix(host, actor(name))
    else:
        host.add(actor(name)())
    say("ready", time.time())
    host.run(ending)
    host.close()


if __name__ == "__main__":
    main()
