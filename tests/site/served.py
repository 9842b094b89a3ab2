"""A site in a simulated network, and what it answers."""

from __future__ import annotations

from pathlib import Path

from selfconf.bus.memory import Network
from selfconf.bus.port import Replies
from selfconf.protocol.keys import Keys
from selfconf.site import Shelf, Site

KEYS = Keys("lab")


def serve(network: Network, folder: Path, environment: dict[str, str] | None = None) -> Site:
    """A site over a folder."""
    return Site(network.node(), "lab", "home", Shelf([folder], lambda _: None), environment)


def ask(network: Network, key: str, payload: bytes = b"") -> Replies:
    """Ask the site something."""
    replies: list[Replies] = []
    network.node().ask(key, payload, 1.0, replies.append)
    assert network.run(lambda: bool(replies), 5.0)
    return replies[0]
