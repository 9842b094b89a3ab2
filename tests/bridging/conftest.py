"""What the tests of bridges have in common: an ecology on a real network, and Things that speak real HTTP."""

from __future__ import annotations

import ssl
from collections.abc import Callable, Iterator

import pytest

from tests.bridging.thing_server import ThingServer
from tests.sdk.conftest import living as living  # a fixture, and the one that it needs
from tests.sdk.conftest import sdk_router as sdk_router


@pytest.fixture
def thing_server() -> Iterator[Callable[[], ThingServer]]:
    """Starts servers, which end with the test."""
    servers: list[ThingServer] = []

    def start(port: int = 0, tls: ssl.SSLContext | None = None) -> ThingServer:
        servers.append(ThingServer(port, tls))
        return servers[-1]

    yield start
    for server in servers:
        server.close()
