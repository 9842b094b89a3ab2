"""A component without physics that a site starts: `python -m benchmarks.faults.actor NAME`.

It tells the witness of the benchmark, a datagram socket, that it is born, and every 20 ms that it acts. It fails when
it is sent SIGUSR1.
"""

from __future__ import annotations

import json
import os
import signal
import socket
import sys
import time
from contextlib import suppress
from pathlib import Path

from selfconf.sdk import Component, Host, Signal, Termination, open_host

ADVERTISEMENTS = Path(__file__).parent / "ads"
OUTPUTS = {
    "sonar": "ranges",
    "encoder": "odometry",
    "tracker": "pose",
    "odometry": "pose",
    "control": "set.velocity",
    "drive": "",
}
"""The actors of the task, each with its output."""
RIVAL_OUTPUTS = {"veer": "set.velocity"}
"""The actors that only the rival of the task needs, inside its composite, each with its output."""
VEERING = 1.0
"""The angular velocity by which what the rival issues is told from what the task issues, in rad/s."""
SIGNALS: dict[str, dict[str, object]] = {
    "ranges": {"angles": [0.0], "ranges": [1.0], "max_range": 5.0},
    "odometry": {"x": 1.0, "y": 2.0, "theta": 0.5, "linear": 0.1, "angular": 0.0},
    "pose": {"x": 1.0, "y": 2.0, "theta": 0.5, "frame": "home"},
    "set.velocity": {"linear": 0.1, "angular": 0.0},
}
"""What each output emits: a signal of its type."""
BEAT = 0.02
"""Seconds between two signs of an actor that acts."""


class Actor(Component):
    """Emits and says that it acts, as long as it does."""

    name = output = ""
    witness: Witness

    def started(self) -> None:
        """Begin to act."""
        self.witness.note(self.name, "started")
        self.every(BEAT, self.beat)
        self.beat()

    def stopped(self) -> None:
        """Cease to act."""
        self.witness.note(self.name, "stopped")

    def beat(self) -> None:
        """Act once."""
        self.witness.note(self.name, "acts")
        if self.output:
            self.emit(self.output, SIGNALS[self.output] | ({"angular": VEERING} if self.name in RIVAL_OUTPUTS else {}))

    def received(self, port: str, signal: Signal) -> None:
        """Say whose velocity it is; pass over all else that is heard."""
        if port == "velocity":
            self.witness.note(self.name, "heeds the rival" if signal["angular"] else "heeds the task")


class Witness:
    """Tells the benchmark what this process does; what does not get through is not waited for."""

    def __init__(self, address: str) -> None:
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        self._address = address

    def note(self, name: str, what: str) -> None:
        """Say what a component does now."""
        with suppress(OSError):  # the benchmark is gone, or does not read for a moment
            self._socket.sendto(json.dumps([name, os.getpid(), what, time.monotonic()]).encode(), self._address)


def actor(name: str, witness: Witness) -> type[Actor]:
    """The class of one of the advertisements."""
    (advertisement,) = ADVERTISEMENTS.glob(f"*/{name}.ttl")
    output = (OUTPUTS | RIVAL_OUTPUTS)[name]
    members = {"advertisement": str(advertisement), "output": output, "name": name, "witness": witness}
    return type("Actor", (Actor,), members)


def main() -> None:
    """Run one actor until told to end."""
    name = sys.argv[1]
    witness = Witness(os.environ["FAULTS_WITNESS"])
    witness.note(name, "born")
    host = open_host(kinds=[actor(name, witness)])
    ending = Termination(host.bus)
    component = _joined(host, name, witness)
    signal.signal(signal.SIGUSR1, lambda *_: component.fail("told to"))
    host.run(ending)
    host.close()


def _joined(host: Host, name: str, witness: Witness) -> Component:
    return host.add(actor(name, witness)())


if __name__ == "__main__":
    main()
