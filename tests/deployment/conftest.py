"""The ecology of the tests of a configurator, and sites that keep tasks in it."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.deployment.keepers import Keepers
from tests.lab import Lab


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    """The paper's ecology, at two sites, before any task."""
    lab = Lab(tmp_path)
    lab.navigation()
    return lab


@pytest.fixture
def keepers(lab: Lab, tmp_path: Path) -> Keepers:
    """Three sites that keep tasks."""
    return Keepers(lab, tmp_path / "disks")
