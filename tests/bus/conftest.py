"""The networks of the bus contract."""

from __future__ import annotations

import secrets
from collections.abc import Iterator

import pytest

from selfconf.bus.zenoh import ZenohBus, router
from tests.bus.nets import MemoryNet, Net, ZenohNet


@pytest.fixture(scope="session")
def zenoh_router() -> Iterator[ZenohBus]:
    """One router for all tests: opening one takes half a second."""
    bus = router()
    yield bus
    bus.close()


@pytest.fixture(params=["memory", "zenoh"])
def net(request: pytest.FixtureRequest) -> Iterator[Net]:
    """Each of the two networks."""
    if request.param == "memory":
        yield MemoryNet()
        return
    real = ZenohNet(request.getfixturevalue("zenoh_router"))
    yield real
    real.close()


@pytest.fixture
def top() -> str:
    """The first chunks of the keys of one test."""
    return f"selfconf/test-{secrets.token_hex(4)}"
