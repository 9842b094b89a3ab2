"""The pages of a library's code, which a program lets go of that has no need of them any more.

When a process is killed, the kernel takes its memory apart, page by page, before it closes its connections, and others
hear of its end only then: of ten megabytes half a millisecond later. The code of a library is in its file all the same:
what is let go of is read from there again, if it is run again.
"""

from __future__ import annotations

import ctypes
import mmap
from collections.abc import Iterator
from pathlib import Path

MAPS = Path("/proc/self/maps")
"""Where Linux says what the memory of this process holds: on each line a range, what may be done there, and a file."""
_CODE = "r-xp"


def let_go_of_code(library: str) -> None:
    """Let go of the pages of code of the libraries with this in the names of their files, where Linux lets it."""
    try:
        ranges = [*_ranges(library)]
    except OSError:  # there is no such file, or it may not be read
        return
    for first, last in ranges:
        ctypes.CDLL(None).madvise(ctypes.c_void_p(first), ctypes.c_size_t(last - first), mmap.MADV_DONTNEED)


def _ranges(library: str) -> Iterator[tuple[int, int]]:
    """The ranges of addresses with such code: it may only be read and run, so its pages are as they are in the file."""
    for line in MAPS.read_text(errors="replace").splitlines():
        place, may, *_, file = line.split(maxsplit=5)
        if may == _CODE and library in file.rpartition("/")[2]:
            first, _, last = place.partition("-")
            yield int(first, 16), int(last, 16)
