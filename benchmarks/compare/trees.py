"""Two trees and the programs of each: a tree is imported by PYTHONPATH, and every program is a process of its own."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LONGEST = 600
"""Seconds that one process may take."""


@dataclass(frozen=True)
class Tree:
    """A tree of selfconf and what to call it."""

    name: str
    path: Path
    cache: Path
    """Where it keeps what it remembers; the other tree is not to profit from it."""

    def run(self, *arguments: str, cwd: Path | None = None) -> Done:
        """What a Python program says, `-m MODULE ARGUMENT...`, and the processor time that it and its children take.

        It starts in the tree unless told otherwise, as `-m` looks for modules in the current folder first.
        """
        environment = {
            name: value for name, value in os.environ.items() if not name.startswith(("SELFCONF_", "PYTHON"))
        }
        environment |= {"PYTHONPATH": str(self.path), "SELFCONF_CACHE_DIR": str(self.cache)}
        environment["SELFCONF_RUNTIME_DIR"] = str(self.cache)
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        process = subprocess.run(
            [sys.executable, *arguments],
            cwd=cwd or self.path,
            env=environment,
            capture_output=True,
            text=True,
            timeout=LONGEST,
            check=False,
        )
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        seconds = after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
        return Done(process.returncode, process.stdout, process.stderr, seconds)

    def check(self) -> None:
        """Raise SystemExit if another tree than this one would be measured."""
        found = self.run("-c", "import selfconf; print(selfconf.__file__)").out.strip()
        if not Path(found).resolve().is_relative_to(self.path.resolve()):
            raise SystemExit(f"selfconf is imported from {found}, not from {self.path}")


@dataclass(frozen=True)
class Done:
    """What came of a process."""

    code: int
    out: str
    err: str
    seconds: float
    """Processor time, user and system, of the process and its children."""


@contextmanager
def both(revision: str) -> Iterator[tuple[Tree, Tree]]:
    """The tree at a revision, in a folder that is removed afterwards, and the tree as it is."""
    before, now = _git("rev-parse", "--short", f"{revision}^{{commit}}"), _git("describe", "--always", "--dirty")
    with tempfile.TemporaryDirectory(prefix="selfconf-compare-") as name:
        folder = Path(name)
        for each in ("before", "before-cache", "after-cache"):
            (folder / each).mkdir()
        archive = subprocess.run(["git", "archive", before], cwd=ROOT, stdout=subprocess.PIPE, check=True).stdout
        subprocess.run(["tar", "-x", "-C", str(folder / "before")], input=archive, check=True)
        trees = (
            Tree(f"{revision} ({before})", folder / "before", folder / "before-cache"),
            Tree(f"the tree as it is ({now})", ROOT, folder / "after-cache"),
        )
        for tree in trees:
            tree.check()
        yield trees


def _git(*arguments: str) -> str:
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode:
        raise SystemExit(f"git {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout.strip()
