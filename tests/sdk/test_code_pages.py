"""The code of a library is let go of, and read again when it is run again."""

from __future__ import annotations

import sys
from pathlib import Path

import pyoxigraph as ox
import pytest

from selfconf.sdk import code_pages
from selfconf.sdk.code_pages import let_go_of_code

TURTLE = "<urn:a> <urn:b> <urn:c> ."
linux = pytest.mark.skipif(sys.platform != "linux", reason="only Linux says what the memory of a process holds")


def code_in_memory(library: str) -> int:
    """How many kilobytes of a library's code this process has in its memory."""
    size, counts = 0, False
    for line in Path("/proc/self/smaps").read_text().splitlines():
        if "-" in line.split(maxsplit=1)[0]:
            counts = " r-xp " in line and library in line.rpartition("/")[2]
        elif counts and line.startswith("Rss:"):
            size += int(line.split()[1])
    return size


@linux
def test_code_is_let_go_of_and_runs_again() -> None:
    assert list(ox.parse(TURTLE, ox.RdfFormat.TURTLE))
    before = code_in_memory("pyoxigraph")
    let_go_of_code("pyoxigraph")
    assert code_in_memory("pyoxigraph") < before / 2
    assert list(ox.parse(TURTLE, ox.RdfFormat.TURTLE))


def test_nothing_is_done_where_it_is_not_said_what_the_memory_holds(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(code_pages, "MAPS", tmp_path / "none")
    let_go_of_code("pyoxigraph")
