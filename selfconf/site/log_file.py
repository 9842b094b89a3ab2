"""A file of lines that is put aside when it has become large, so that what is kept is bounded."""

from __future__ import annotations

import logging
import os
from collections.abc import Collection
from itertools import pairwise
from pathlib import Path

log = logging.getLogger(__name__)

MOST_BYTES = 1 << 20
"""A file does not grow beyond this size: the folder of runtime files is often in memory."""
PUT_ASIDE = 3
"""How many files that have become full are kept: `NAME.1`, which is the newest, to `NAME.3`."""


MOST_LOGS = 20
"""How many logs of sites that have ended are kept in the folder of all sites."""


def forget_oldest(folder: Path, kept: Collection[str]) -> None:
    """Remove all but the newest `MOST_LOGS` logs of a folder, with what was put aside of them; those in `kept` stay."""
    logs: dict[str, list[Path]] = {}
    for path in folder.glob("*.log*"):
        logs.setdefault(path.name[: path.name.rindex(".log")] + ".log", []).append(path)
    try:
        newest = sorted(set(logs) - set(kept), key=lambda name: max(path.stat().st_mtime_ns for path in logs[name]))
        for name in newest[:-MOST_LOGS]:
            for path in logs[name]:
                path.unlink(missing_ok=True)
    except OSError as error:  # another site does the same at this moment
        log.info("cannot remove an old log: %s", error.strerror)


class LogFile:
    """A file that lines are added to. It is made with its first line, and anew where it was removed or moved away."""

    def __init__(self, path: Path, most_bytes: int = MOST_BYTES) -> None:
        self.path, self._most = path, most_bytes
        self._descriptor: int | None = None
        self._size = 0
        self._failing = False
        self._cut = False
        """Whether the last line was written in part, as the disk was full, perhaps in another life of the site."""

    def write(self, lines: bytes) -> None:
        """Add whole lines. Where that cannot be done, say so once, and go on without them."""
        try:
            if not self._is_open():
                self.close()
                self._open()
            if self._size and self._size + len(lines) > self._most:
                self.close()
                self._put_aside()
                self._open()
            if self._descriptor is not None:
                self._add(self._descriptor, b"\n" + lines if self._cut else lines)
            self._failing = False
        except OSError as error:
            if not self._failing:
                log.error("cannot write %s: %s", self.path, error.strerror)
            self._failing = True

    def _add(self, descriptor: int, lines: bytes) -> None:
        written = os.write(descriptor, lines)
        self._size += written
        self._cut = lines[written - 1 : written] != b"\n"

    def _is_open(self) -> bool:
        """Whether what is written goes to the file of that name: a person, or a program, may have put it elsewhere."""
        try:
            return self._descriptor is not None and os.path.samestat(os.fstat(self._descriptor), self.path.stat())
        except FileNotFoundError:
            return False

    def close(self) -> None:
        """Write no more until there are further lines."""
        if self._descriptor is not None:
            os.close(self._descriptor)
            self._descriptor = None

    def _open(self) -> None:
        self.path.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        self._descriptor = os.open(self.path, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC, 0o600)
        self._size = os.fstat(self._descriptor).st_size
        self._cut = self._size > 0 and os.pread(self._descriptor, 1, self._size - 1) != b"\n"

    def _put_aside(self) -> None:
        aside = [self.path, *(self.path.with_name(f"{self.path.name}.{number + 1}") for number in range(PUT_ASIDE))]
        for newer, older in reversed(list(pairwise(aside))):
            if newer.exists():
                newer.replace(older)
