"""Two nodes of the network in memory that watch each other, for tests of what becomes of one of them."""

from __future__ import annotations

from selfconf.bus.memory import Faults, Network
from selfconf.bus.port import Urgency


class Watched:
    """Two nodes: one that is alive, hears a key and has a timer; another that watches it and talks to it."""

    def __init__(self, faults: Faults | None = None) -> None:
        self.network = Network(0, faults)
        self.one, self.other = self.network.node(), self.network.node()
        self.heard: list[str] = []
        self.lives: list[bool] = []
        self.seen: list[bool] = []
        self.one.subscribe("a", lambda sample: self.heard.append(sample.payload.decode()))
        self.one.announce("live/one")
        self.other.announce("live/other")
        self.other.watch("live/one", lambda _, alive: self.lives.append(alive))
        self.one.watch("live/other", lambda _, alive: self.seen.append(alive))
        self.publisher = self.other.publisher("a", Urgency.EVENT)
        self.let_pass(0.1)

    def let_pass(self, seconds: float) -> None:
        """Let simulated time pass."""
        self.network.run(lambda: False, seconds)

    def put(self, text: str) -> None:
        """Let the other node say something, and let it arrive."""
        self.publisher.put(text.encode())
        self.let_pass(0.1)
