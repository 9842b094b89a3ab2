"""The advertisements of a host: the files they are read from, read again when these change.

To look whether anything has changed is cheap, and only what has is read: of ten thousand files, one that changes costs
as much as one file.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from selfconf import files
from selfconf.errors import AuthorError
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement, SegmentCache

Complaint = Callable[[str], None]
"""Hears, in a sentence, what was left out and why."""


class _ReadFile(NamedTuple):
    """What was in a file, and what was left out of it."""

    stamp: files.FileStamp
    advertisements: tuple[Advertisement, ...]
    complaints: tuple[str, ...]


class Shelf:
    """The advertisements in some files and folders, read again when the files change."""

    def __init__(self, paths: Sequence[Path], complain: Complaint) -> None:
        self._paths, self._complain = paths, complain
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
        self._seen = stamps
        segments = SegmentCache()
        read: dict[str, _ReadFile] = {}
        for name in self._files if self._files.keys() == stamps.keys() else sorted(stamps, key=Path):
            known, stamp = self._files.get(name), stamps[name]
            read[name] = known if known is not None and known.stamp == stamp else _read(Path(name), stamp, segments)
        self._files = read
        found = self._merged(complaints)
        self._tell(complaints)
        changed = found != self.advertisements
        self.advertisements = found
        return changed

    def _look(self, complaints: list[str]) -> dict[str, files.FileStamp]:
        """The stamp of every Turtle file of the shelf that can be found."""

        def left_out(error: AuthorError) -> None:
            complaints.append(f"left out: {error}")

        return {name: stamp for path in self._paths for name, stamp in files.stamps(path, left_out).items()}

    def _merged(self, complaints: list[str]) -> dict[IRI, Advertisement]:
        """The advertisements of all files; of two of one component the first. A file may be given by two paths."""
        found: dict[IRI, tuple[str, Advertisement]] = {}
        for name, file in self._files.items():
            complaints += file.complaints
            for advertisement in file.advertisements:
                component = advertisement.component
                first, counting = found.setdefault(component, (name, advertisement))
                if counting is not advertisement and not files.is_same(first, name):
                    complaints.append(f"{name}: {component} is advertised twice; the first advertisement counts")
        return {component: advertisement for component, (_, advertisement) in found.items()}

    def _tell(self, complaints: Sequence[str]) -> None:
        """Complain of what was not complained of the last time: the files are looked at every second."""
        for complaint in dict.fromkeys(complaints):
            if complaint not in self._told:
                self._complain(complaint)
        self._told = frozenset(complaints)


def _read(path: Path, stamp: files.FileStamp, segments: SegmentCache) -> _ReadFile:
    """Read a file."""
    try:
        good, bad = files.advertisements(path, segments)
    except AuthorError as error:
        return _ReadFile(stamp, (), (f"left out: {error}",))
    left_out = tuple(f"{path}: left out {one.component}: {one.problems[0]}" for one in bad)
    return _ReadFile(stamp, tuple(good), left_out)
