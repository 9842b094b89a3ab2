"""The fixture of the tests of discovery."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.discovery.field import Field


@pytest.fixture
def field(tmp_path: Path) -> Field:
    """A perfect network."""
    return Field(tmp_path)
