"""The advertisements of a host: the files they are read from, read again when these change."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from selfconf import files
from selfconf.errors import AuthorError
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement, SegmentCache

Complaint = Callable[[str], None]
"""Hears, in a sentence, what was left out and why."""


class Shelf:
    """The advertisements in some files and folders, read again when the files change."""

    def __init__(self, paths: Sequence[Path], complain: Complaint) -> None:
        self._paths, self._complain = paths, complain
        self._seen: dict[Path, tuple[int, int]] = {}
        self._told: frozenset[str] = frozenset()
        self.advertisements: dict[IRI, Advertisement] = {}

    def refresh(self) -> bool:
        """Read the files again if any has changed, come or gone; return whether the advertisements are others now."""
        stamps: dict[Path, tuple[int, int]] = {}
        complaints: list[str] = []
        for path in self._files(complaints):
            try:
                status = path.stat()
            except OSError:  # it has gone since the folder was read
                continue
            stamps[path] = status.st_mtime_ns, status.st_size
        if stamps == self._seen and self._told.issuperset(complaints):
            return False
        self._seen = stamps
        found: dict[IRI, Advertisement] = {}
        segments = SegmentCache()
        for path in stamps:
            try:
                good, bad = files.advertisements(path, segments)
            except AuthorError as error:
                complaints.append(f"left out: {error}")
                continue
            complaints += [f"{path}: left out {one.component}: {one.problems[0]}" for one in bad]
            for advertisement in good:
                component = advertisement.profile.component
                if found.setdefault(component, advertisement) is not advertisement:
                    complaints.append(f"{path}: {component} is advertised twice; the first advertisement counts")
        self._tell(complaints)
        changed = found != self.advertisements
        self.advertisements = found
        return changed

    def _files(self, complaints: list[str]) -> list[Path]:
        """Every Turtle file of the shelf that can be found, sorted."""

        def left_out(error: AuthorError) -> None:
            complaints.append(f"left out: {error}")

        return sorted({file for path in self._paths for file in files.within(path, left_out)})

    def _tell(self, complaints: Sequence[str]) -> None:
        """Complain of what was not complained of the last time: the files are looked at every second."""
        for complaint in dict.fromkeys(complaints):
            if complaint not in self._told:
                self._complain(complaint)
        self._told = frozenset(complaints)
