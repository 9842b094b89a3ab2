"""A door that is guarded, on a bus in memory."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.access import Authority
from tests.access.door import Door


@pytest.fixture
def door(tmp_path: Path) -> Door:
    """A door with keys of its own."""
    return Door(Authority.init(tmp_path / "keys"))
