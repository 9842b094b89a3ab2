"""A site in a simulated network, what it answers, and the processes that it starts, which live in real time."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

from selfconf.bus.memory import Network
from selfconf.bus.port import Replies
from selfconf.protocol.keys import Keys
from selfconf.site import ProcessSettings, Shelf, Site
from tests.lab import PREFIXES, iri

KEYS = Keys("lab")
SLEEPER = iri("sleeper")


def serve(
    network: Network, folder: Path, environment: dict[str, str] | None = None, log_path: Path | None = None
) -> Site:
    """A site over a folder."""
    return Site(network.node(), "lab", "home", Shelf([folder], lambda _: None), ProcessSettings(environment, log_path))


def ask(network: Network, key: str, payload: bytes = b"") -> Replies:
    """Ask the site something."""
    replies: list[Replies] = []
    network.node().ask(key, payload, 1.0, replies.append)
    assert network.run(lambda: bool(replies), 5.0)
    return replies[0]


def live(network: Network, condition: Callable[[], bool], seconds: float = 20.0) -> bool:
    """Let simulated time pass as fast as real time, until a condition holds; whether it does."""
    began, first = time.monotonic(), network.time
    while not condition() and (elapsed := time.monotonic() - began) < seconds:
        network.run(condition, max(0.0, first + elapsed - network.time))
        threading.Event().wait(0.01)  # let the processes have the processor
    return condition()


def until(condition: Callable[[], bool], seconds: float = 10.0) -> bool:
    """Wait in real time for a condition."""
    deadline = time.monotonic() + seconds
    while not condition() and time.monotonic() < deadline:
        threading.Event().wait(0.01)
    return condition()


def dormant(folder: Path, command: str, *names: str, more: str = "") -> Path:
    """Advertisements of components with one command that a site can start."""
    folder.mkdir(parents=True, exist_ok=True)
    quoted = command.replace("\\", "\\\\").replace('"', '\\"')
    for name in names or ("sleeper",):
        said = f':{name} a sc:Component, rob:Encoder ; sc:grounding [ sc:command "{quoted}" ] {more}.\n'
        (folder / f"{name}.ttl").write_text(PREFIXES + said)
    return folder


def python(code: str) -> str:
    """A command that runs some Python and then waits to be ended."""
    return f"{sys.executable} -c '{code}; import signal; signal.pause()'"
