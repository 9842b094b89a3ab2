"""Files that are written as a whole: neither another process nor a power cut finds a part of one."""

from __future__ import annotations

import os
import tempfile
from contextlib import suppress
from pathlib import Path

PRIVATE = 0o600
"""The permissions of a file that only its owner may read."""
READABLE = 0o644
"""The permissions of a file that others may read, and only its owner change."""


def write_atomically(path: Path, content: bytes, mode: int = PRIVATE) -> None:
    """Put a file in the place of what is there, once the disk holds all of it.

    Without the disk's word a power cut may leave the new name with nothing in the file. Raises OSError, and then what
    was there stays.
    """
    descriptor, temporary = tempfile.mkstemp(prefix=".new-", dir=path.parent)
    try:
        with os.fdopen(descriptor, "wb") as file:
            os.fchmod(descriptor, mode)
            file.write(content)
            file.flush()
            os.fsync(descriptor)
        Path(temporary).replace(path)
    except BaseException:
        with suppress(OSError):
            Path(temporary).unlink(missing_ok=True)
        raise
    with suppress(OSError):  # some systems synchronize no folders
        _synchronize(path.parent)


def _synchronize(folder: Path) -> None:
    """Have the disk hold which files are in a folder. Raises OSError."""
    opened = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(opened)
    finally:
        os.close(opened)
