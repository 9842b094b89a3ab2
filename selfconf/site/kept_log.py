"""The log of a site, read while it is written: its latest lines, and what was added since.

A log is its file and those that were put aside of it (`log_file`). A *position* names a file by its inode, which stays
when the file is put aside, and a place in it; so nothing is missed and nothing comes twice, however often the log was
put aside meanwhile. What was added since a position whose file has been removed begins with the oldest that is kept.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from selfconf.errors import PeerError
from selfconf.model.log_line import BETWEEN_COMPONENTS, LogLine
from selfconf.model.term import IRI
from selfconf.protocol.messages import LogPart, LogQuestion
from selfconf.site.log_file import PUT_ASIDE

MOST_LOG_BYTES = 1 << 18
"""How many bytes of a log one answer holds, so that it is well below the largest message."""
MOST_LOG_LINES = 2000
"""How many lines of a log one answer holds."""
_NOT_THERE = "0:0"
"""The position in a log that has no file yet."""


class _LogFileText(NamedTuple):
    """A file of a log as it was read: its whole lines."""

    inode: int
    start: int
    """The place in the file from which on it was read."""
    text: bytes
    is_cut: bool
    """Whether it holds more than was read."""

    @property
    def end(self) -> str:
        """The position after the last whole line."""
        return f"{self.inode}:{self.start + len(self.text)}"


def log_part(path: Path, question: LogQuestion, most_bytes: int = MOST_LOG_BYTES) -> LogPart:
    """What is asked of the log of that path, in at most so many bytes. Raises PeerError for what is no position."""
    if question.position:
        return _added(path, question, most_bytes)
    return _latest(path, question, most_bytes)


def _latest(path: Path, question: LogQuestion, most_bytes: int) -> LogPart:
    """The latest lines: the files are read backwards, until there are enough."""
    found: list[LogLine] = []
    position, room = _NOT_THERE, most_bytes
    seen: set[int] = set()
    for one in _newest_first(path):
        file = _read(one)
        if file is None or file.inode in seen:  # put aside while it was read
            continue
        position = position if seen else file.end
        seen.add(file.inode)
        if len(found) >= question.lines:
            break
        for line, size in _lines(reversed(file.text.split(b"\n")), question.component):
            room -= size
            if len(found) >= question.lines or room < 0:
                return LogPart(tuple(reversed(found)), position)
            found.append(line)
    return LogPart(tuple(reversed(found)), position)


def _added(path: Path, question: LogQuestion, most_bytes: int) -> LogPart:
    inode, start = _place(question.position)
    files = [(one, number) for one in reversed(_newest_first(path)) if (number := _inode(one))]  # oldest first
    known = next((n for n, (_, number) in enumerate(files) if number == inode), None)
    files, start = (files, 0) if known is None else (files[known:], start)
    position, found, room = question.position, list[LogLine](), most_bytes
    for one, number in files:
        file = _read(one, start, room)
        if file is None or file.inode != number:  # put aside while it was read: the next look finds it
            break
        found += (line for line, _ in _lines(iter(file.text.split(b"\n")), question.component))
        position, start, room = file.end, 0, room - len(file.text)
        if file.is_cut or room <= 0:
            return LogPart(tuple(found), position, more=True)
    return LogPart(tuple(found), position)


def _newest_first(path: Path) -> list[Path]:
    return [path, *(path.with_name(f"{path.name}.{number}") for number in range(1, PUT_ASIDE + 1))]


def _inode(path: Path) -> int:
    try:
        return path.stat().st_ino
    except OSError:
        return 0


def _read(path: Path, start: int = 0, most: int = sys.maxsize) -> _LogFileText | None:
    """The whole lines of a file from a place on, as many as fit, and one at least; None if there is no such file."""
    try:
        with path.open("rb") as file:
            inode, size = os.fstat(file.fileno()).st_ino, file.seek(0, os.SEEK_END)
            start = start if start <= size else 0
            file.seek(start)
            text = file.read(min(most, size - start))
            is_cut = len(text) < size - start
            if is_cut and b"\n" not in text:
                text += file.readline()
    except OSError:
        return None
    return _LogFileText(inode, start, text[: text.rfind(b"\n") + 1], is_cut)


def _lines(lines: Iterator[bytes], component: str) -> Iterator[tuple[LogLine, int]]:
    """The lines that concern a component, taken apart, with their bytes; those that do not name it are passed over."""
    name = component.encode()
    for line in lines:
        if line and name in line:
            read = _line(line.decode("utf-8", "replace"))
            if read.concerns(component):
                yield read, len(line)


def _line(line: str) -> LogLine:
    """A line taken apart; one that is none of a site's is a line without a source."""
    parts = line.split(" ", 3)
    if len(parts) < 4:
        return LogLine(parts[0], "", (), " ".join(parts[1:]))
    time, stream, sources, text = parts
    return LogLine(time, stream, tuple(map(IRI.unchecked, sources.split(BETWEEN_COMPONENTS))), text)


def _place(position: str) -> tuple[int, int]:
    inode, _, place = position.partition(":")
    if not (inode.isdecimal() and place.isdecimal() and len(position) < 64):
        raise PeerError(f"{position[:64]!r} is no position in a log")
    return int(inode), int(place)
