"""A temporary folder is locked, so that what clears old files away leaves it alone, and goes with its block."""

from __future__ import annotations

import fcntl
import os

import pytest

from selfconf.api.sites.temporary_folder import temporary_folder


def test_a_folder_is_locked_and_goes_with_its_block() -> None:
    with temporary_folder("selfconf-test-") as folder:
        (folder / "file").write_text("x")
        descriptor = os.open(folder, os.O_RDONLY)
        with pytest.raises(BlockingIOError):
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        os.close(descriptor)
    assert folder.name.startswith("selfconf-test-")
    assert not folder.exists()
