"""Who lives in the measured ecology: `python -m benchmarks.live.crowd NAME COUNT`, a process that ends with its stdin.

`crowd` is COUNT components that live and do nothing: a liveliness token each, as the SDK declares it. `first`, `second`
and `sink` are components of the SDK; a source emits once when it is started, and the sink writes when it hears another.
`pairs` are COUNT sources and COUNT sinks, which write nothing.
"""

from __future__ import annotations

import sys
import threading
import time

from benchmarks.live.world import bystander, pair_file, written_for
from selfconf import rendezvous
from selfconf.bus.zenoh import client
from selfconf.protocol.keys import Keys
from selfconf.sdk import Component, Signal, open_host


class Source(Component):
    """Emits one signal when it is started."""

    def started(self) -> None:
        """A signal at once."""
        self.emit("pose", {"x": 1.0, "y": 2.0, "theta": 0.5, "frame": "home"})


class Sink(Component):
    """Writes when a new source is first heard."""

    source = ""

    def received(self, port: str, signal: Signal) -> None:
        """Note the first signal of each new source."""
        if signal.source != self.source:
            self.source = signal.source
            print(time.time(), flush=True)


class QuietSink(Component):
    """Passes over what it hears."""

    def received(self, port: str, signal: Signal) -> None:
        """Nothing."""


def kinds_of(name: str, count: int) -> list[type[Component]]:
    """The components of a process by its name, which are so many pairs or one."""
    if name == "pairs":
        return [
            type(which, (paired,), {"advertisement": str(pair_file(which, number))})
            for number in range(count)
            for which, paired in (("source", Source), ("sink", QuietSink))
        ]
    kind: type[Component] = Sink if name == "sink" else Source
    return [type(name, (kind,), {"advertisement": str(written_for(name))})]


def end_with_stdin(over: threading.Event) -> None:
    """Set the event when stdin ends."""
    sys.stdin.read()
    over.set()


def main() -> None:
    """Live until stdin ends."""
    name, count = sys.argv[1], int(sys.argv[2])
    over = threading.Event()
    threading.Thread(target=end_with_stdin, args=(over,), daemon=True).start()
    if name == "crowd":
        ecology, endpoints = rendezvous.find(None, [])
        bus, keys = client(endpoints), Keys(ecology)
        for number in range(count):
            bus.announce(keys.life(bystander(number), "1"))
        print("ready", flush=True)
        bus.run(over.is_set)
        bus.close()
        return
    kinds = kinds_of(name, count)
    host = open_host(kinds=kinds)
    for kind in kinds:
        host.add(kind())
    print("ready", flush=True)
    host.run(over.is_set)
    host.close()


if __name__ == "__main__":
    main()
