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
from pathlib import Path
from typing import TYPE_CHECKING, Any

from selfconf.atomic_write import write_atomically
from selfconf.model.diagnostic import Diagnostic, Severity
from selfconf.rdf.validation import CheckEach, FileChecker, UnclearedFile

if TYPE_CHECKING:
    from multiprocessing.pool import Pool

WORTH = 16
"""Full checks that take about as long as starting a process."""
ENDING_THREAD = 0.1
"""Seconds that the system may take to end a thread whose work is over."""
PROGRAMS = ("pyshacl", "rdflib", "pyoxigraph")
_checker: FileChecker | None = None


def shared(
    checker: FileChecker,
    uncleared: Sequence[UnclearedFile],
    forking: Callable[[], AbstractContextManager[None]] = nullcontext,
) -> Iterator[list[Diagnostic]]:
    """Check each uncleared file, in as many processes as there are processors to use, where that pays and can be.

    They are forked inside of a `forking()`, which a program with a thread of its own can have rest meanwhile.
    """
    processes = min(os.cpu_count() or 1, len(uncleared) // WORTH)
    if processes < 2:
        yield from map(checker, uncleared)
        return
    yield checker(uncleared[0])  # loads what each process will need
    with forking():
        pool = _pool(processes, checker) if _has_one_thread() else None
    if pool is None:
        yield from map(checker, uncleared[1:])
        return
    with pool:
        yield from pool.imap(_checked, uncleared[1:], chunksize=4)
        # They end by themselves: a program may have a handler of SIGTERM, which they have, too, until they begin.
        pool.close()
        pool.join()


def _pool(processes: int, checker: FileChecker) -> Pool:
    """Processes that check files. Ctrl-C does not reach them: it is for this program, which ends them."""
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        return multiprocessing.get_context("fork").Pool(processes, _begin, (checker,))
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


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


def _begin(checker: FileChecker) -> None:
    global _checker
    _checker = checker
    signal.signal(signal.SIGTERM, signal.SIG_DFL)


def _checked(uncleared: UnclearedFile) -> list[Diagnostic]:
    assert _checker is not None
    return _checker(uncleared)


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
