"""The tasks of an empty ecology, in memory."""

from __future__ import annotations

import pytest

from tests.api.tasks.simulated_tasks import Tasks


@pytest.fixture
def tasks() -> Tasks:
    """An empty ecology."""
    return Tasks()
