"""A terminal shows what strangers have written and is not steered by it: control characters become escapes.

Names, labels, file names and the words of a failure come from the network. A file or a program that
reads the output gets it unchanged; only a terminal obeys `ESC [ 2 J`. Colours come from `paint` alone: it marks a text
in a way that no other program can know, and a `Terminal` makes the sequences of it.

Nor does what a command comes to depend on its readers: one may have seen enough, or never have been there.
"""

from __future__ import annotations

import errno
import io
import json
import os
import re
import secrets
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TextIO

from selfconf.aside_writer import AsideWriter, write_text
from selfconf.model.wording import plain

COLOURS = {"bold": "1", "dim": "2", "red": "1;31", "green": "32", "yellow": "1;33", "cyan": "36"}
"""The parameters of SGR (ECMA-48, 8.3.117) by what we call them."""
STATE_COLOURS = {"alive": "green", "active": "green", "absent": "red", "running": "green", "refused": "red"}
"""The colours of the states of components and tasks that a reader looks for."""
_MARK = f"\ue000{secrets.token_hex(8)}"
_MARKED = re.compile(f"{_MARK}([0-9;]+)m")


@contextmanager
def _reader_may_have_gone() -> Iterator[None]:
    """A terminal that was closed is a reader that has gone, as of a pipe; Linux calls it an error of the device."""
    try:
        yield
    except OSError as error:
        if error.errno == errno.EIO:
            raise BrokenPipeError(errno.EPIPE, "the terminal was closed") from None
        raise


class Terminal(io.TextIOBase):
    """A stream that leads to a terminal. Each method that writes raises BrokenPipeError once that was closed."""

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write text that steers nothing."""
        with _reader_may_have_gone():
            self._stream.write(self.shown(text))
        return len(text)

    def shown(self, text: str) -> str:
        """A text that steers nothing, with the sequences of its colours."""
        return _MARKED.sub("\x1b[\\1m", plain(text))

    def renew(self, text: str) -> None:
        """Show a text in place of all that is on the screen."""
        with _reader_may_have_gone():
            self._stream.write("\x1b[H\x1b[2J")
        self.write(text)
        self.flush()

    def renew_line(self, text: str) -> None:
        """Show a text in place of the line that the cursor is in, past the buffer. Raises OSError.

        What a narrow terminal would show in a second line, where it would stay, is left out.
        """
        write_text(self._stream, f"\r\x1b[2K{self.shown(text)[: self._columns() - 1]}")

    def _columns(self) -> int:
        """How many letters a line has; more than any text where that is not known."""
        try:
            return os.get_terminal_size(self.fileno()).columns or sys.maxsize
        except OSError:
            return sys.maxsize

    def flush(self) -> None:
        """Let the terminal have it; as Python ends, that may be gone first."""
        if not self._stream.closed:
            with _reader_may_have_gone():
                self._stream.flush()

    def fileno(self) -> int:
        """The number of the stream."""
        return self._stream.fileno()

    def isatty(self) -> bool:
        """Whether the stream leads to a terminal: it does."""
        return True


def guard() -> None:
    """From now on standard output and error can be written to, whatever they are.

    A terminal becomes a `Terminal`, and nowhere takes the place of a stream that is closed. What the encoding does not
    have, such as the bytes of a file name that is not UTF-8, becomes an escape.
    """
    for name in ("stdout", "stderr"):
        stream = getattr(sys, name)
        if stream is None:
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_WRONLY), "w"))
        elif not isinstance(stream, Terminal):
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(errors="backslashreplace")
            if stream.isatty():
                setattr(sys, name, Terminal(stream))


def in_colour(stream: TextIO | None = None) -> bool:
    """Whether a stream, else stdout, is shown in colour: by a terminal that has some, unless the environment says no.

    NO_COLOR (https://no-color.org) says no where it is not empty.
    """
    is_terminal = isinstance(stream or sys.stdout, Terminal)
    return is_terminal and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def paint(text: str, colour: str, stream: TextIO | None = None) -> str:
    """A text in one of `COLOURS` where the stream, else stdout, is shown in colour; without one as it is."""
    return f"{_MARK}{COLOURS[colour]}m{text}{_MARK}0m" if text and colour and in_colour(stream) else text


def styled_state(column: str, cell: str, padded: str) -> str:
    """A cell of a table with the states of components or tasks, in the colour of the state."""
    return paint(padded, STATE_COLOURS.get(cell, "")) if column in ("state", "phase") else padded


def for_programs() -> None:
    """Standard output holds what programs read, such as JSON or Turtle: that is UTF-8, whatever text is here.

    A terminal keeps its encoding; what it does not have is for people to look at.
    """
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(encoding="utf-8", errors="backslashreplace")


def display(text: str, stream: TextIO | None = None, end: str = "\n") -> None:
    """Print a result, or what else there is to say, to a reader who may have seen enough."""
    stream = stream or sys.stdout
    try:
        print(text, end=end, file=stream, flush=True)
    except BrokenPipeError:
        silence(stream)


def display_json(body: object) -> None:
    """Print a result for programs, as indented JSON in which letters are letters, of whatever script."""
    display(json.dumps(body, indent=2, ensure_ascii=False))


def complain(sentence: str) -> None:
    """Say something on stderr that is not a result; where that cannot be written, that is all that can be done.

    A thread that a held terminal keeps here keeps no lock that the end of the program waits for.
    """
    stream, line = sys.stderr, f"{sentence}\n"
    try:
        write_text(stream, stream.shown(line) if isinstance(stream, Terminal) else line)
    except OSError:
        silence(sys.stderr)


@contextmanager
def complaining_aside() -> Iterator[Callable[[str], None]]:
    """What complains on a thread of its own: a program that serves others waits for no terminal."""
    said = AsideWriter(complain, str)
    try:
        yield said.put
    finally:
        said.close()


def silence(stream: TextIO) -> None:
    """Let what is still to be written to a stream come to nothing."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, stream.fileno())
    os.close(nowhere)
