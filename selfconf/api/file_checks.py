"""The full checks of `validate` over many files: shared among processes, and remembered from one run to the next.

Processes are forked, so that what is loaded is loaded once; but not where the program has other threads. What these
hold at that moment, such as a lock of a library, would be held forever in a forked process, which then never ends.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import multiprocessing
import os
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict
from importlib.metadata import version
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from selfconf.atomic_write import write_atomically
from selfconf.model.diagnostic import Diagnostic, Severity
from selfconf.rdf.validation import CheckEach, FileChecker, UnclearedFile

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess
    from multiprocessing.sharedctypes import Synchronized

WORTH = 16
"""Full checks that take about as long as starting a process."""
ENDING_THREAD = 0.1
"""Seconds that the system may take to end a thread whose work is over."""
PROGRAMS = ("pyshacl", "rdflib", "pyoxigraph")


def shared(
    checker: FileChecker,
    uncleared: Sequence[UnclearedFile],
    forking: Callable[[], AbstractContextManager[None]] = nullcontext,
) -> Iterator[list[Diagnostic]]:
    """Check each uncleared file, in as many processes as there are processors to use, where that pays and can be.

    They are forked inside of a `forking()`, which a program with a thread of its own can have rest meanwhile.
    """
    count = min(os.cpu_count() or 1, len(uncleared) // WORTH)
    if count < 2:
        yield from map(checker, uncleared)
        return
    yield checker(uncleared[0])  # loads what each process will need
    processes: list[BaseProcess] = []
    try:
        with forking():
            readers = _fork(count, processes, checker, uncleared[1:]) if _has_one_thread() else []
        yield from _in_order(readers, checker, uncleared[1:])
    finally:
        for process in processes:
            process.kill()  # it has nothing to put in order, and may have a handler of gentler signals
        for process in processes:
            process.join()


def _fork(
    count: int, processes: list[BaseProcess], checker: FileChecker, uncleared: Sequence[UnclearedFile]
) -> list[Connection]:
    """Begin processes that check files, and add them to `processes`; what they find is to be read from what it gives.

    Ctrl-C does not reach them: it is for this program, which ends them.
    """
    forked = multiprocessing.get_context("fork")
    following, readers = forked.Value("L", 0), []
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        for _ in range(count):
            reader, writer = forked.Pipe(duplex=False)
            processes.append(forked.Process(target=_check, args=(checker, uncleared, following, writer), daemon=True))
            processes[-1].start()
            writer.close()
            readers.append(reader)
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)
    return readers


def _check(
    checker: FileChecker, uncleared: Sequence[UnclearedFile], following: Synchronized[int], writer: Connection
) -> None:
    """Check the files that no other process has taken, one after the other, and send the place and outcome of each.

    It ends without a word at a file that cannot be checked, as this is then tried, and told, where all are read.
    """
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    with contextlib.suppress(Exception):
        while True:
            with following.get_lock():
                place, following.value = following.value, following.value + 1
            if place >= len(uncleared):
                return
            writer.send((place, checker(uncleared[place])))


def _in_order(
    readers: list[Connection], checker: FileChecker, uncleared: Sequence[UnclearedFile]
) -> Iterator[list[Diagnostic]]:
    """What processes have found in each file; what they leave, as one that the system has ended, is checked here."""
    found: dict[int, list[Diagnostic]] = {}
    for place, one in enumerate(uncleared):
        while place not in found and readers:
            for reader in wait(readers):
                try:
                    at, problems = cast("Connection", reader).recv()
                except (EOFError, OSError):
                    readers.remove(cast("Connection", reader))
                else:
                    found[at] = problems
        yield found.pop(place) if place in found else checker(one)


def _has_one_thread() -> bool:
    """Whether this program has no other thread; one that has just ended may be there for a moment still."""
    deadline = time.monotonic() + ENDING_THREAD
    while _threads() > 1 and threading.active_count() == 1 and time.monotonic() < deadline:
        time.sleep(0.001)  # nothing tells when the system has taken it away
    return _threads() == 1


def _threads() -> int:
    """How many threads this program has; where the system does not tell, those of Python."""
    try:
        return len(list(Path("/proc/self/task").iterdir()))
    except OSError:
        return threading.active_count()


class Remembered:
    """Full checks whose outcomes are kept in a file, of the last run only; it depends on nothing but what is hashed."""

    def __init__(self, folder: Path, paths: Iterable[str], each: CheckEach = shared) -> None:
        """`paths` are what is validated: each selection of files has a memory of its own."""
        absolute = "\n".join(str(Path(path).absolute()) for path in paths)
        self._file = folder / "validate" / f"{hashlib.blake2s(os.fsencode(absolute), digest_size=8).hexdigest()}.json"
        self._each, self._versions = each, {"selfconf": _own_version(), **{name: version(name) for name in PROGRAMS}}

    def __call__(self, checker: FileChecker, uncleared: Sequence[UnclearedFile]) -> Iterator[list[Diagnostic]]:
        """What is remembered, and then what is not."""
        known = self._recalled()
        keys = [checker.key(one) for one in uncleared]
        outcomes = {key: known[key] for key in keys if key in known}
        unknown = {key: one for key, one in zip(keys, uncleared, strict=True) if key not in outcomes}
        outcomes.update(zip(unknown, self._each(checker, list(unknown.values())), strict=True))
        if outcomes.keys() != known.keys():
            self._keep(outcomes)
        yield from (outcomes[key] for key in keys)

    def _recalled(self) -> dict[str, list[Diagnostic]]:
        try:
            body = json.loads(self._file.read_bytes())
            if body["versions"] != self._versions:
                return {}
            return {key: [_diagnostic(entry) for entry in entries] for key, entries in body["outcomes"].items()}
        except (OSError, ValueError, KeyError, TypeError, AttributeError):
            return {}  # none yet, or not one of ours

    def _keep(self, outcomes: dict[str, list[Diagnostic]]) -> None:
        """Keep what came of the files; do without where that cannot be written."""
        entries = {key: [asdict(found) for found in problems] for key, problems in outcomes.items()}
        with contextlib.suppress(OSError):
            self._file.parent.mkdir(parents=True, exist_ok=True)
            write_atomically(self._file, json.dumps({"versions": self._versions, "outcomes": entries}).encode())


def _own_version() -> str:
    """The version of selfconf, and a digest of the code that judges, which changes in a checkout without a version."""
    digest = hashlib.blake2s(digest_size=16)
    for room in ("model", "rdf"):
        for file in sorted((Path(__file__).parents[1] / room).rglob("*.py")):
            digest.update(file.read_bytes())
    return f"{version('selfconf')} {digest.hexdigest()}"


def _diagnostic(entry: dict[str, Any]) -> Diagnostic:
    return Diagnostic(**{**entry, "severity": Severity(entry["severity"])})
