"""A real network for the tests of components whose code has a thread of its own."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.bus.zenoh import ZenohBus, router
from tests.sdk.living import LivingStage


@pytest.fixture(scope="session")
def sdk_router() -> Iterator[ZenohBus]:
    """One router for all tests: opening one takes half a second."""
    bus = router()
    bus.run_aside()
    yield bus
    bus.close()


@pytest.fixture
def living(sdk_router: ZenohBus, tmp_path: Path) -> Iterator[LivingStage]:
    """An ecology in real time, with a configurator that is alive."""
    stage = LivingStage(sdk_router.endpoint, tmp_path)
    yield stage
    stage.close()
