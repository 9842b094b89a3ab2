"""The logs in which the sites of this machine keep what their components print, read while they are written.

A log is read with what was put aside of it (`selfconf.site.log_file`), oldest lines first; those of several sites are
put in the order of their times. A log stays after its site has ended: what a component said before it died is in it.
"""

from __future__ import annotations

import heapq
import os
from collections import deque
from collections.abc import Callable, Iterator
from datetime import datetime, timezone
from pathlib import Path
from typing import NamedTuple

from selfconf import rendezvous
from selfconf.errors import AuthorError, NetworkError
from selfconf.model.term import IRI
from selfconf.site import PUT_ASIDE

LOOK_FOR_LINES = 0.2
"""Seconds after which a log that is followed is looked at again: nothing tells when a file has grown."""


class LogLine(NamedTuple):
    """A line of a log."""

    time: str
    """When it was printed, as UTC in ISO 8601."""
    stream: str
    """`stdout`, `stderr`, or `site` for what the site itself has noted."""
    components: tuple[IRI, ...]
    """The components of the process that has printed it."""
    text: str

    def concerns(self, component: str) -> bool:
        """Whether a component, by its IRI or its local name, is among those of the process."""
        return not component or any(component in (one, one.short) for one in self.components)

    @property
    def local_time(self) -> str:
        """The time of day here, for people."""
        try:
            moment = datetime.strptime(self.time, "%Y-%m-%dT%H:%M:%S.%fZ").replace(tzinfo=timezone.utc)
        except ValueError:
            return self.time
        return moment.astimezone().strftime("%H:%M:%S.%f")[:-3]

    def body(self) -> dict[str, object]:
        """The line as JSON."""
        return {"time": self.time, "stream": self.stream, "components": list(self.components), "text": self.text}


def site_logs(ecology: str | None, folder: Path | None = None) -> list[Path]:
    """The logs of the sites of an ecology on this machine, also of those that have ended, sorted.

    Without a folder they are where the sites that run keep them, and in the folder that is usual. Raises NetworkError,
    where there is none, and AuthorError where several ecologies have logs and none is named.
    """
    folders = _folders(ecology) if folder is None else {folder}
    found = sorted(path for one in folders if one.is_dir() for path in one.glob(f"{ecology or '*'}@*.log"))
    if ecology is None:
        found = _of_one_ecology(found)
    if not found:
        which = "" if ecology is None else f" of the ecology {ecology!r}"
        where = ", ".join(map(str, sorted(folders)))
        raise NetworkError(
            f"no site{which} has kept a log in {where}; a site keeps one, on its own host, from the first component on"
            " that it starts"
        )
    return found


def _folders(ecology: str | None) -> set[Path]:
    sites = rendezvous.local_sites(ecology)
    return {rendezvous.log_folder(), *(Path(site.log).parent for site in sites if site.log)}


def _of_one_ecology(logs: list[Path]) -> list[Path]:
    """The logs of the only ecology that has some, or else of the only one of these that lives. Raises AuthorError."""
    named = {path.name.partition("@")[0] for path in logs}
    living = named & {site.ecology for site in rendezvous.local_sites()}
    chosen = living if len(living) == 1 else named
    if len(chosen) > 1:
        raise AuthorError(f"several ecologies have logs; say which with --ecology: {', '.join(sorted(chosen))}")
    return [path for path in logs if path.name.partition("@")[0] in chosen]


def kept_lines(paths: list[Path], component: str = "", most: int | None = None) -> list[LogLine]:
    """The lines of some logs in the order of their times: those that concern a component, and of these the last."""
    each = (filter(lambda line: line.concerns(component), _lines_of(path)) for path in paths)
    return list(deque(heapq.merge(*each, key=lambda line: line.time), maxlen=most))


def followed_lines(paths: list[Path], wait: Callable[[float], object], component: str = "") -> Iterator[LogLine]:
    """The lines that are added to some logs from now on, without an end; `wait` passes the time between two looks."""
    tails = [_Tail(path) for path in paths]
    while True:
        for tail in tails:
            yield from (line for line in tail.lines() if line.concerns(component))
        wait(LOOK_FOR_LINES)


def _lines_of(path: Path) -> Iterator[LogLine]:
    aside = [path.with_name(f"{path.name}.{number}") for number in range(PUT_ASIDE, 0, -1)]
    for one in (*aside, path):
        try:
            with one.open(encoding="utf-8", errors="replace", newline="\n") as file:
                yield from (_read(line) for line in file)
        except FileNotFoundError:  # never written, or put aside while it was read
            continue


def _read(line: str) -> LogLine:
    """A line taken apart; one that is none of a site's is a line without a source."""
    parts = line.rstrip("\n").split(" ", 3)
    if len(parts) < 4:
        return LogLine(parts[0], "", (), " ".join(parts[1:]))
    time, stream, sources, text = parts
    return LogLine(time, stream, tuple(map(IRI, sources.split(","))), text)


class _Tail:
    """The end of a log, which grows, and is put aside when it is full."""

    def __init__(self, path: Path) -> None:
        self._path, self._rest = path, b""
        status = self._status()
        self._file = -1 if status is None else status.st_ino
        self._offset = 0 if status is None else status.st_size

    def lines(self) -> Iterator[LogLine]:
        """The whole lines that have been added since the last look."""
        status = self._status()
        if status is None:
            return
        if status.st_ino != self._file:
            if self._file >= 0:  # the one before was put aside: what it got after the last look is there
                yield from self._added(self._path.with_name(f"{self._path.name}.1"))
            self._file, self._offset, self._rest = status.st_ino, 0, b""
        yield from self._added(self._path)

    def _added(self, path: Path) -> Iterator[LogLine]:
        try:
            with path.open("rb") as file:
                if os.fstat(file.fileno()).st_ino != self._file:
                    return
                file.seek(self._offset)
                added = file.read()
        except OSError:
            return
        self._offset += len(added)
        *whole, self._rest = (self._rest + added).split(b"\n")
        yield from (_read(line.decode("utf-8", "replace")) for line in whole)

    def _status(self) -> os.stat_result | None:
        try:
            return self._path.stat()
        except OSError:
            return None
