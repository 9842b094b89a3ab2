"""What the tests of importing share."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.importing.imports import Workshop


@pytest.fixture
def workshop(tmp_path: Path) -> Workshop:
    """A folder with sources and a folder for what is made of them."""
    return Workshop(tmp_path)
