"""A terminal shows what strangers have written and is not steered by it: control characters become escapes.

Names, labels, file names and the words of a failure come from whoever is on the network. A file or a program that
reads the output gets it unchanged; only a terminal obeys `ESC [ 2 J`.
"""

from __future__ import annotations

import io
import re
import sys
from typing import TextIO

# The controls of ASCII and Latin-1 but for tab and line feed, and those that change the direction of writing.
_STEERING = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")


def plain(text: str) -> str:
    """The text with `\\x1b` and the like spelt out."""
    return _STEERING.sub(lambda found: found[0].encode("unicode_escape").decode(), text)


class Terminal(io.TextIOBase):
    """A stream that leads to a terminal."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write text that steers nothing."""
        self._stream.write(plain(text))
        return len(text)

    def flush(self) -> None:
        """Let the terminal have it."""
        self._stream.flush()

    def fileno(self) -> int:
        """The number of the stream."""
        return self._stream.fileno()

    def isatty(self) -> bool:
        """It does lead to a terminal."""
        return True


def guard() -> None:
    """From now on write to standard output and error as a `Terminal`, where they are one."""
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is not None and stream.isatty() and not isinstance(stream, Terminal):
            setattr(sys, name, Terminal(stream))
