"""The advertisements of a host: the files they are read from, read again when these change.

To look whether anything has changed is cheap, and only what has is read: of ten thousand files, one that changes costs
as much as one file.

What the system does not let be read, as where the site may open no more files, is tried again each time, and what was
known of it stays until then: no task is to lose a component for that.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from selfconf import files
from selfconf.errors import AuthorError, UnreadableError
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement, SegmentCache

Complaint = Callable[[str], None]
"""Hears, in a sentence, what was left out and why."""


_UNREAD: files.FileStamp = (-1,)
"""The stamp of a file that could not be read, which no file has: so it is read again."""


class _ReadFile(NamedTuple):
    """What was in a file, and what was left out of it."""

    stamp: files.FileStamp
    advertisements: tuple[Advertisement, ...]
    complaints: tuple[str, ...]


class Shelf:
    """The advertisements in some files and folders, read again when the files change."""

    def __init__(self, paths: Sequence[Path], complain: Complaint) -> None:
        self._paths, self.complain = paths, complain
        self._files: dict[str, _ReadFile] = {}
        """What was read of each file, in the order in which of two advertisements of one component the first counts."""
        self._seen: dict[str, files.FileStamp] = {}
        self._told: frozenset[str] = frozenset()
        self.advertisements: dict[IRI, Advertisement] = {}

    def refresh(self) -> bool:
        """Read what has changed, come or gone since the last time; return whether the advertisements are others now."""
        complaints: list[str] = []
        stamps = self._look(complaints)
        if stamps == self._seen and self._told.issuperset(complaints):
            return False
        segments = SegmentCache()
        read: dict[str, _ReadFile] = {}
        for name in self._files if self._files.keys() == stamps.keys() else sorted(stamps, key=Path):
            known, stamp = self._files.get(name), stamps[name]
            unchanged = known is not None and known.stamp == stamp != _UNREAD
            read[name] = known if known and unchanged else _read(Path(name), stamp, segments, known)
        self._files, self._seen = read, {name: file.stamp for name, file in read.items()}
        found = self._merged(complaints)
        self._tell(complaints)
        changed = found != self.advertisements
        self.advertisements = found
        return changed

    def _look(self, complaints: list[str]) -> dict[str, files.FileStamp]:
        """The stamp of every Turtle file of the shelf that can be found, or was where nothing can be seen now."""
        kept: dict[str, files.FileStamp] = {}
        found: dict[str, files.FileStamp] = {}

        def unread(error: UnreadableError) -> None:
            place = error.path + os.sep
            below = {name: stamp for name, stamp in self._seen.items() if (name + os.sep).startswith(place)}
            complaints.append(_complaint(error, bool(below)))
            kept.update(below)

        for path in self._paths:
            try:
                found |= files.stamps(files.existing(path), unread)
            except UnreadableError as error:
                unread(error)
            except AuthorError as error:
                complaints.append(f"left out: {error}")
        return kept | found

    def _merged(self, complaints: list[str]) -> dict[IRI, Advertisement]:
        """The advertisements of all files; of two of one component the first. A file may be given by two paths."""
        found: dict[IRI, tuple[str, Advertisement]] = {}
        for name, file in self._files.items():
            complaints += file.complaints
            for advertisement in file.advertisements:
                component = advertisement.component
                first, counting = found.setdefault(component, (name, advertisement))
                if counting is not advertisement and not files.is_same(first, name):
                    complaints.append(f"{name}: left out {component}: it is advertised in {first} already")
        return {component: advertisement for component, (_, advertisement) in found.items()}

    def _tell(self, complaints: Sequence[str]) -> None:
        """Complain of what was not complained of the last time: the files are looked at every second."""
        for complaint in dict.fromkeys(complaints):
            if complaint not in self._told:
                self.complain(complaint)
        self._told = frozenset(complaints)


def _read(path: Path, stamp: files.FileStamp, segments: SegmentCache, known: _ReadFile | None) -> _ReadFile:
    """Read a file, of which something may be known from before."""
    try:
        good, bad = files.advertisements(path, segments)
    except UnreadableError as error:
        kept = known.advertisements if known is not None else ()
        return _ReadFile(_UNREAD, kept, (_complaint(error, bool(kept)),))
    except AuthorError as error:
        return _ReadFile(stamp, (), (f"left out: {error}",))
    left_out = tuple(f"{path}: left out {one.component}: {one.problems[0]}" for one in bad)
    return _ReadFile(stamp, tuple(good), left_out)


def _complaint(error: UnreadableError, is_known: bool) -> str:
    """What is said of a file or folder that cannot be read, of which something is known from before, or nothing."""
    return f"{error}; what it advertised before stays" if is_known else f"left out: {error}"
