"""The two networks that the bus contract runs on, behind one face."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Protocol

from selfconf.bus.memory import Network
from selfconf.bus.port import Bus, Sample
from selfconf.bus.zenoh import ZenohBus, client


class Net(Protocol):
    """A network to test on."""

    def node(self) -> Bus:
        """A new node that reaches all others."""
        ...

    def until(self, condition: Callable[[], bool], seconds: float = 5.0) -> bool:
        """Let every node say what it has to say until a condition holds; whether it does."""
        ...

    def settle(self) -> None:
        """Let pass what is on the way."""
        ...


class MemoryNet:
    """The simulated network, perfect and fast."""

    def __init__(self) -> None:
        self.network = Network()

    def node(self) -> Bus:
        """A node."""
        return self.network.node()

    def until(self, condition: Callable[[], bool], seconds: float = 5.0) -> bool:
        """Simulated time passes."""
        return self.network.run(condition, seconds)

    def settle(self) -> None:
        """A second of simulated time."""
        self.network.run(lambda: False, 1.0)


class ZenohNet:
    """Clients of one router, all in this process."""

    def __init__(self, router: ZenohBus) -> None:
        self._router, self._nodes = router, list[ZenohBus]()

    def node(self) -> Bus:
        """A client of the router."""
        bus = client([self._router.endpoint])
        self._nodes.append(bus)
        return bus

    def until(self, condition: Callable[[], bool], seconds: float = 30.0) -> bool:
        """Real time passes, until the deadline at most."""
        deadline = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > deadline:
                return False
            for bus in (self._router, *self._nodes):
                bus.poll(0.001)
        return True

    def settle(self) -> None:
        """A message from each node to each other has gone there and back: what was on the way before has come."""
        back: list[object] = []
        open_nodes = [bus for bus in self._nodes if bus.link]
        for bus in open_nodes:
            bus.roll_call("selfconf/**", 1.0, back.append)
        self.until(lambda: len(back) == len(open_nodes))
        quiet = time.monotonic() + 0.02
        self.until(lambda: time.monotonic() > quiet)

    def close(self) -> None:
        """Close every client."""
        for bus in self._nodes:
            bus.close()


def payloads(samples: list[Sample]) -> list[bytes]:
    """What was put, in order of arrival."""
    return [sample.payload for sample in samples]
