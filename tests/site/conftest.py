"""The network of the tests of a site."""

from __future__ import annotations

import pytest

from selfconf.bus.memory import Network


@pytest.fixture
def network() -> Network:
    """A simulated network."""
    return Network()
