"""The ecology of the tests of a configurator."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.lab import Lab


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    """The paper's ecology, at two sites, before any task."""
    lab = Lab(tmp_path)
    lab.navigation()
    return lab
