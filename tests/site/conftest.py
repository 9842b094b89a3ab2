"""The network of the tests of a site, and a site that can start components."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from selfconf import rendezvous
from selfconf.bus.memory import Network
from selfconf.site import Site
from tests.site.served import dormant, serve


@pytest.fixture
def network() -> Network:
    """A simulated network."""
    return Network()


@pytest.fixture
def site(network: Network, tmp_path: Path) -> Iterator[Callable[..., Site]]:
    """A site over `here` that can start components, and keeps what they print in `home.log`."""
    made: list[Site] = []

    def make(command: str, *names: str, more: str = "") -> Site:
        folder = dormant(tmp_path / "here", command, *names, more=more)
        environment = rendezvous.environment("lab", "tcp/127.0.0.1:1")
        made.append(serve(network, folder, environment, tmp_path / "home.log"))
        return made[-1]

    yield make
    for each in made:
        each.close()
