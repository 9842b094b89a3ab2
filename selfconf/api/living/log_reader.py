"""What components print, on this machine and on others, read as one log while it is written.

The logs of this machine are files, which are there without the ecology; the sites of other machines are asked for
theirs.
"""

from __future__ import annotations

import heapq
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path

from selfconf.api.arguments import checked_text
from selfconf.api.living.component_terms import iri_or_local_name
from selfconf.api.living.living_ecology import LivingEcology, join
from selfconf.api.living.site_logs import LogSource, local_log, names_of_log, site_logs
from selfconf.errors import NetworkError
from selfconf.model.log_line import LogLine
from selfconf.model.wording import one_line
from selfconf.protocol.messages import LogPart, LogQuestion
from selfconf.rendezvous import asked_for
from selfconf.this_machine import local_sites

FOLLOW_PAUSE = 0.2
"""Seconds after which a log that is followed is looked at again: nothing tells when a file has grown."""
ASK_AGAIN = 1.0
"""Seconds after which sites of other machines are asked again, and logs are looked for that were not there before."""
FROM_THE_BEGINNING = "0:0"
"""The position in a log that had no file yet."""


class LogReader:
    """Reads some logs as one, in the order of the times of their lines: the latest lines, then what is added."""

    def __init__(
        self,
        sources: Iterable[LogSource],
        component: str = "",
        pause: float = FOLLOW_PAUSE,
        look_up: Callable[[str], object] | None = None,
        further: Callable[[], Iterable[LogSource]] = tuple,
    ) -> None:
        """`component` is an IRI, a CURIE or a local name: only the lines of its processes are read; empty: all.

        `pause` is for how many seconds one who follows the logs is to wait between two looks. `look_up` raises
        AuthorError for a component that is not there; None where the ecology cannot be asked. `further` finds the logs
        of sites that have begun since it was asked last.
        """
        self._named, self.pause, self._look_up = component, pause, look_up
        self._component = iri_or_local_name(component)
        self._positions = dict.fromkeys(sources, "")
        self._further, self._began = further, time.time()

    def latest(self, most: int) -> list[LogLine]:
        """The latest lines, so many at most; what is added from then on is what `added` returns."""
        found = self._merged(lambda source: self._part(source, LogQuestion(self._component, most)).lines)
        return found[max(0, len(found) - most) :]

    def why_nothing(self) -> str:
        """Say that no line is kept. Raises AuthorError where it is known that there is no such component."""
        if not self._named:
            return "nothing that a component has printed is kept in the log"
        if self._look_up is not None:
            self._look_up(self._named)
        return f"nothing that {one_line(self._component)} has printed is kept in the log"

    def added(self) -> list[LogLine]:
        """The lines that were added since the last look, also by sites that have begun meanwhile."""
        found = set(self._further())
        self._positions |= dict.fromkeys(found, FROM_THE_BEGINNING)
        return self._merged(lambda source: self._since_it_began(source) if source in found else self._added(source))

    def _since_it_began(self, source: LogSource) -> list[LogLine]:
        """The lines of a log that was not there before, without those of a former site of its name."""
        return [line for line in self._added(source) if line.moment is None or line.moment >= self._began]

    def _added(self, source: LogSource) -> list[LogLine]:
        lines, more = list[LogLine](), True
        while more:
            part = self._part(source, LogQuestion(self._component, 0, self._positions[source]))
            lines += part.lines
            more = part.more
        return lines

    def _part(self, source: LogSource, question: LogQuestion) -> LogPart:
        part = source(question)
        self._positions[source] = part.position
        return part

    def _merged(self, lines_of: Callable[[LogSource], Sequence[LogLine]]) -> list[LogLine]:
        return list(heapq.merge(*map(lines_of, self._positions), key=lambda line: line.time))


@contextmanager
def log_reader(
    ecology: str | None,
    connect: Sequence[str],
    keys: Path | None,
    folder: Path | None,
    component: str,
    complain: Callable[[str], None],
) -> Iterator[LogReader]:
    """What reads the logs of an ecology: those in a folder, or those of this machine and of the sites of others.

    `complain` hears of what cannot be read. Raises NetworkError where there is no log at all, and AuthorError where
    several ecologies have logs and none is named, or for what names no component.
    """
    checked_text(component, "the name of a component")
    ecology, endpoints = asked_for(ecology, connect)
    with ExitStack() as stack:
        living: LivingEcology | NetworkError | None = None
        if connect or (endpoints and folder is None):
            living = _joined(ecology, endpoints, keys, stack)
        if isinstance(living, LivingEcology):
            ecology = living.name  # and not that of logs which happen to be here
        paths = _logs_here(ecology, folder)
        if isinstance(paths, list):
            ecology = ecology or names_of_log(paths[0])[0]
        if living is None and folder is None and local_sites(ecology):
            living = _joined(ecology, endpoints, keys, stack)
        logs = _Logs(ecology, folder, living, complain)
        sources, asks = logs.first(paths)
        look_up = living.component if isinstance(living, LivingEcology) else None
        yield LogReader(sources, component, ASK_AGAIN if asks else FOLLOW_PAUSE, look_up, logs.further)


class _Logs:
    """The logs of an ecology that can be read: those that there are, and those that are there later."""

    def __init__(
        self,
        ecology: str | None,
        folder: Path | None,
        living: LivingEcology | NetworkError | None,
        complain: Callable[[str], None],
    ) -> None:
        self._ecology, self._folder, self._living, self._complain = ecology, folder, living, complain
        self._known_paths: set[Path] = set()
        self._known_sites: set[str] = set()
        self._looked = time.monotonic()

    def first(self, paths: list[Path] | NetworkError) -> tuple[list[LogSource], bool]:
        """The logs that can be read, and whether sites are asked for some. Raises NetworkError where there are none.

        A site that lives is asked for its log unless that is here. What is here of a site of that name which does not
        run on this machine was kept by one of before, unless a folder was given: these logs, wherever they are from,
        are meant.
        """
        here, living = [] if isinstance(paths, NetworkError) else paths, self._living
        self._known_paths.update(here)
        others: list[LogSource] = []
        if isinstance(living, LivingEcology):
            names = {names_of_log(path)[1] for path in here}
            running = {site.site for site in local_sites(living.name)}
            self._known_sites = names if self._folder is not None else names & running
            others = self._others(living)
        elif living is not None:
            if not here:
                raise living
            self._complain(f"only the logs of this machine are shown: {living}")
        if isinstance(paths, NetworkError) and not others:
            raise paths
        return [*map(local_log, here), *others], bool(others)

    def further(self) -> list[LogSource]:
        """The logs that were not there before; it is looked for them once in a while."""
        if time.monotonic() < self._looked + ASK_AGAIN:
            return []
        self._looked = time.monotonic()
        paths = _logs_here(self._ecology, self._folder)
        here = [] if isinstance(paths, NetworkError) else [path for path in paths if path not in self._known_paths]
        self._known_paths.update(here)
        self._known_sites.update(names_of_log(path)[1] for path in here)
        others: list[LogSource] = []
        if isinstance(self._living, LivingEcology):
            with suppress(NetworkError):  # this program is cut off for a moment
                others = self._others(self._living)
        return [*map(local_log, here), *others]

    def _others(self, living: LivingEcology) -> list[LogSource]:
        """The logs of the sites that live and were not known before."""
        found = living.other_logs(self._known_sites, self._complain)
        self._known_sites.update(found)
        return list(found.values())


def _joined(
    ecology: str | None, endpoints: Sequence[str], keys: Path | None, stack: ExitStack
) -> LivingEcology | NetworkError:
    """The ecology, left when the stack is closed, or why it cannot be joined."""
    try:
        return stack.enter_context(join(ecology, connect=endpoints, keys=keys))
    except NetworkError as error:
        return error


def _logs_here(ecology: str | None, folder: Path | None) -> list[Path] | NetworkError:
    """The logs of `site_logs`, or why there are none."""
    try:
        return site_logs(ecology, folder)
    except NetworkError as error:
        return error
