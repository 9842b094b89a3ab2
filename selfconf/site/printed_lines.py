"""What components print, line by line: kept in the log of their site, and shown where the site itself prints.

A line of the log is a time (UTC), a stream (`stdout`, `stderr`, or `site` for what the site itself notes), the IRIs of
the components of the process with commas between them, and the text, each apart by one space:

    2026-11-22T06:30:12.345Z stdout https://example.org/my-home#clock 12:00:01

One thread reads all pipes, so that no component waits for the site's own work, and the site for none. What is shown
goes by way of a second thread: a terminal that is held (Ctrl-S) holds up nothing. What it could not take is counted
there; the log has it.
"""

from __future__ import annotations

import contextlib
import os
import queue
import selectors
import socket
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime, timezone
from functools import partial

from selfconf.aside_writer import AsideWriter, write_bytes
from selfconf.model.log_line import LONGEST_LINE
from selfconf.model.wording import plain
from selfconf.site.log_file import LogFile

CHUNK = 1 << 13
"""How many bytes are read at a time."""
MOST_A_SECOND = 1 << 19
"""How many bytes a second are read of one pipe: a process that prints more waits, and does not keep the site busy."""
PIPE_HOLDS = 1 << 16
"""How many bytes Linux keeps in a pipe."""
SHOWN_AT_ONCE = 1000
"""How many pieces wait for a terminal before more are left out."""
STDERR = 2
"""Where components print: stdout is for the results of the command that started them."""
LAST_LINES = 1.0
"""Seconds that the last lines may take to be read and shown when a site ends."""


@dataclass(slots=True)
class _Pipe:
    """One stream of one process."""

    stream: str
    source: str
    ended: Callable[[], None]
    rest: bytes = b""
    """The beginning of a line whose end has not come yet."""
    second: float = 0.0
    """When the second began in which bytes are counted."""
    in_second: int = 0
    """How many bytes were read in this second."""


class PrintedLines:
    """Reads what the processes of a site print. Its methods may be called from any thread."""

    def __init__(self, log: LogFile | None) -> None:
        """`log` keeps the lines; None: they are only shown."""
        self._log = log
        self._selector = selectors.DefaultSelector()
        self._orders: queue.SimpleQueue[tuple[int, _Pipe] | bytes | None] = queue.SimpleQueue()
        self._woken, self._wake = socket.socketpair()
        self._wake.setblocking(False)
        self._selector.register(self._woken, selectors.EVENT_READ)
        self._resting: dict[int, _Pipe] = {}
        """The pipes that are not read for the rest of their second."""
        self._shown = AsideWriter(partial(write_bytes, STDERR), _left_out, SHOWN_AT_ONCE, LAST_LINES)
        self._reading = threading.Thread(target=self._read, name="printed lines", daemon=True)
        self._reading.start()

    def follow(self, pipe: int, stream: str, source: str, ended: Callable[[], None]) -> None:
        """Read a pipe until its end, close it, and call `ended`, on another thread."""
        self._order((pipe, _Pipe(stream, source, ended)))

    def note(self, source: str, text: str) -> None:
        """Keep what the site itself has to say of a process."""
        self._order(_worded("site", source, [text.encode(errors="replace")]))

    def close(self) -> None:
        """Read and show what is there already, and end."""
        self._order(None)
        self._reading.join(LAST_LINES)
        self._shown.close()

    def _order(self, order: tuple[int, _Pipe] | bytes | None) -> None:
        self._orders.put(order)
        with contextlib.suppress(BlockingIOError, OSError):  # full: it will wake up anyway; closed: it has ended
            self._wake.send(b"\0")

    def _read(self) -> None:
        going_on = True
        while going_on:
            for key, _ in self._selector.select(self._read_again()):
                if isinstance(key.data, _Pipe):
                    self._hear(key.fd, key.data)
                else:
                    self._woken.recv(CHUNK)
                    going_on = self._obey()
        for key in list(self._selector.get_map().values()):
            if isinstance(key.data, _Pipe):
                self._resting[key.fd] = key.data
        for descriptor, pipe in self._resting.items():
            self._hear_the_rest(descriptor, pipe)
        self._selector.close()
        self._woken.close()
        self._wake.close()
        if self._log is not None:
            self._log.close()

    def _read_again(self) -> float | None:
        """Read the pipes again whose second is over; return how long it takes until the next one's is."""
        now = time.monotonic()
        for descriptor, pipe in list(self._resting.items()):
            if now >= pipe.second + 1.0:
                del self._resting[descriptor]
                self._selector.register(descriptor, selectors.EVENT_READ, pipe)
        return min((pipe.second + 1.0 - now for pipe in self._resting.values()), default=None)

    def _hear_the_rest(self, descriptor: int, pipe: _Pipe) -> None:
        """Read what is in a pipe, and no more."""
        os.set_blocking(descriptor, False)
        with contextlib.suppress(OSError):
            self._say(pipe, os.read(descriptor, PIPE_HOLDS))
        self._say(pipe, b"")
        os.close(descriptor)

    def _obey(self) -> bool:
        """Carry out what is ordered; return whether to go on."""
        with contextlib.suppress(queue.Empty):
            while True:
                order = self._orders.get_nowait()
                if order is None:
                    return False
                if isinstance(order, bytes):
                    self._keep(order)
                else:
                    self._selector.register(order[0], selectors.EVENT_READ, order[1])
        return True

    def _hear(self, descriptor: int, pipe: _Pipe) -> None:
        """Read some lines."""
        try:
            said = os.read(descriptor, CHUNK)
        except OSError:
            said = b""
        self._say(pipe, said)
        if not said:
            self._selector.unregister(descriptor)
            os.close(descriptor)
            pipe.ended()
            return
        now = time.monotonic()
        if now >= pipe.second + 1.0:
            pipe.second, pipe.in_second = now, 0
        pipe.in_second += len(said)
        if pipe.in_second > MOST_A_SECOND:
            self._selector.unregister(descriptor)
            self._resting[descriptor] = pipe

    def _say(self, pipe: _Pipe, said: bytes) -> None:
        """Keep and show the lines that are whole now; at the end of a pipe the last line is whole as it is."""
        whole, newline, rest = (pipe.rest + said).rpartition(b"\n")
        if not said or len(rest) > LONGEST_LINE:
            whole, newline, rest = pipe.rest + said, b"\n", b""
        pipe.rest = rest
        if whole:
            self._keep(_worded(pipe.stream, pipe.source, whole.split(b"\n")))
            self._shown.put(whole + newline)

    def _keep(self, lines: bytes) -> None:
        if self._log is not None:
            self._log.write(lines)


def _worded(stream: str, source: str, lines: list[bytes]) -> bytes:
    """Lines as they are kept; a process that is no part of selfconf may print anything, so controls are spelt out."""
    now = datetime.fromtimestamp(time.time(), timezone.utc).strftime("%Y-%m-%dT%H:%M:%S.%f")[:-3]
    head = f"{now}Z {stream} {source} "
    pieces = [
        line[start : start + LONGEST_LINE]
        for line in lines
        for start in range(0, max(len(line.rstrip(b"\r")), 1), LONGEST_LINE)
    ]
    said = (plain(piece.rstrip(b"\r").decode("utf-8", "backslashreplace")) for piece in pieces)
    return "".join(f"{head}{text}\n" for text in said).encode()


def _left_out(sentence: str) -> bytes:
    return f"{sentence}\n".encode()
