"""What a program says to people, written by a thread of its own: a held terminal (Ctrl-S) holds up nothing else.

What such a terminal could not take in time is left out, and counted. It is written past Python's own buffers: a thread
that is held would keep their lock, and the program could not even end then.
"""

from __future__ import annotations

import contextlib
import logging
import os
import queue
import sys
import threading
from collections.abc import Callable
from typing import Generic, TextIO, TypeVar

from selfconf.model.wording import plain

WAITING_AT_ONCE = 1000
"""How many pieces wait for a terminal before more are left out."""
LAST_WORDS = 1.0
"""Seconds that the last pieces may take to be written when a program ends."""
_Piece = TypeVar("_Piece")


class AsideWriter(Generic[_Piece]):
    """Writes pieces in their order; its methods may be called from any thread, and wait only at the end."""

    def __init__(
        self,
        write: Callable[[_Piece], None],
        left_out: Callable[[str], _Piece],
        most: int = WAITING_AT_ONCE,
        last_words: float = LAST_WORDS,
    ) -> None:
        """`write` may block, and raise OSError; `left_out` makes a piece of the sentence that some were left out."""
        self._write, self._piece_of, self._last_words = write, left_out, last_words
        self._waiting: queue.Queue[_Piece | None] = queue.Queue(most)
        self._left_out = 0
        self._starting = threading.Lock()
        self._thread: threading.Thread | None = None

    def put(self, piece: _Piece) -> None:
        """Have a piece written soon."""
        with self._starting:
            if self._thread is None:
                thread = threading.Thread(target=self._run, name="writer", daemon=True)
                thread.start()  # first: where the system lets no thread begin, there is none to wait for
                self._thread = thread
            try:
                if self._left_out:
                    sentence = f"({self._left_out} pieces of output were left out here)"
                    self._waiting.put_nowait(self._piece_of(sentence))
                    self._left_out = 0
                self._waiting.put_nowait(piece)
            except queue.Full:
                self._left_out += 1

    def close(self) -> None:
        """Write what is waiting, unless that takes too long."""
        with self._starting:
            thread, self._thread = self._thread, None
        if thread is not None:
            with contextlib.suppress(queue.Full):
                self._waiting.put(None, timeout=self._last_words)
                thread.join(self._last_words)

    def _run(self) -> None:
        while (piece := self._waiting.get()) is not None:
            with contextlib.suppress(OSError):  # its reader has gone
                self._write(piece)


def write_bytes(descriptor: int, text: bytes) -> None:
    """Write all of a text to a file descriptor. Raises OSError."""
    while text:
        text = text[os.write(descriptor, text) :]


def write_text(stream: TextIO, text: str) -> None:
    """Write a text to a stream, past its buffer where it is a file. Raises OSError."""
    try:
        descriptor = stream.fileno()
    except (OSError, ValueError):  # it is none, as in tests
        stream.write(text)
        return
    stream.flush()
    write_bytes(descriptor, text.encode(getattr(stream, "encoding", None) or "utf-8", "backslashreplace"))


def write_line(text: str) -> None:
    """Write a line to stderr, without anything that steers a terminal. Raises OSError."""
    write_text(sys.stderr, f"{plain(text)}\n")


class AsideHandler(logging.Handler):
    """A handler of logs that writes lines to stderr, and makes no thread wait for that."""

    def __init__(self, form: str) -> None:
        """`form` is how a line looks, as `logging.Formatter` has it."""
        super().__init__()
        self.setFormatter(logging.Formatter(form))
        self._writer = AsideWriter(write_line, str)

    def emit(self, record: logging.LogRecord) -> None:
        """Have a record written soon."""
        try:
            self._writer.put(self.format(record))
        except Exception:  # as other handlers do: what cannot be worded breaks no work
            self.handleError(record)

    def close(self) -> None:
        """Write what is waiting, unless that takes too long."""
        self._writer.close()
        super().close()
