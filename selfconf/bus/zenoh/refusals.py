"""What the hubs of this process refuse, read from the log of Zenoh, which tells it nowhere else.

Zenoh logs to the standard output of the process. So that becomes a pipe which a thread reads; what this program itself
prints goes where it went before. Two kinds of lines count:

* "... is unauthorized to Put (ingress) on KEY", with "Msg intercepted!" as the next line of the same thread: a holder
  of a certificate has tried what its name does not allow. What is kept from reaching a client (egress) is no attempt,
  nor is an error reply, which has the key of what was asked: so a site of another host says to all that it does not
  know a component of this one.
* a warning of the TLS link: a client without a trusted certificate has knocked. No such warning is that a connection
  broke off, or was closed, before its certificate was looked at, as one of two is given up where two sites connect to
  each other at once, nor that none could be taken.

Messages that pass cost Zenoh a line each, as they come in and as they go out, for these lines have the target and the
level (trace) of those that say no, and no field but their text: no filter separates them. (The line "Msg
intercepted!" alone could be had for nothing: it has a target of its own, `zenoh::net::routing::interceptor` without
`::access_control`. But it says neither which client, nor what, nor under which key; a span of Zenoh adds the peer, and
leaves open whether that was kept from speaking or another one from hearing.) So this program reads many lines at a
time, and looks into those chunks alone that hold a word of a refusal: a thread that woke up for each line took twice as
long as all the rest that a hub does for a signal (`python -m benchmarks.access`).

A key is what a stranger has written, and may hold line breaks: what follows one could be a line like those of Zenoh,
which says that another client has tried something. But Zenoh writes an ESC of a key as text, and begins its own lines
with one, where it writes in colours. So it is asked for colours, and what does not begin so is no line of Zenoh; and in
a line the key comes last, so what stands before it is what counts.
"""

from __future__ import annotations

import fcntl
import os
import re
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache

from selfconf.bus.zenoh.session import begin_log
from selfconf.protocol.messages import RefusedAttempt

FILTER = "zenoh::net::routing::interceptor=trace,zenoh_link_tls::unicast=warn"
"""What Zenoh logs, as the variable RUST_LOG has it."""
NO_COLOUR = "NO_COLOR"
"""The variable by which a user asks programs for plain text (no-color.org), and Zenoh as its log begins."""
ROOM = 1 << 20
"""Bytes that the pipe holds: a hub that writes into a full one would stand still."""
BETWEEN_READS = 0.05
"""Seconds between two looks into the pipe: a hub that relays 20,000 signals a second fills half of it meanwhile."""
MOST_ATTEMPTS = 1000
"""How many different attempts are kept apart; further ones are counted as those of their principal alone."""
LONGEST_KEY = 300
"""Characters of a key that are kept."""
_COLOUR = re.compile(rb"\x1b\[[0-9;]*m")
_GENUINE = b"\x1b["
"""How a line of Zenoh begins, and nothing can that a key holds."""
_LINE = re.compile(r"\S+ +\w+ +.*?(ThreadId\(\d+\)) (\S+): (.*)", re.DOTALL)
"""A line: when, how grave, on which thread, its target, and its text, to the end of which a key may stand."""
_DENIED = re.compile(
    r"(?:Using cached result: )?(\w+) (?:on (\S+) )?is unauthorized to ([\w/ ]+?) \((\w+)\) on (.*)", re.DOTALL
)
_NAME = re.compile(r"CertCommonName\(([^)]*)\)")
_DETAIL = re.compile(r"\. Hint: .*|: verification time .*", re.DOTALL)
"""What is left out of a warning of the TLS link: an advice, and seconds by which each would be another attempt."""
_NO_VERDICT = re.compile(r"tls handshake eof|.*\(os error \d+\)", re.DOTALL)
"""A warning of the TLS link, without what is left out, that says nothing about a certificate."""
_TLS = "zenoh_link_tls::unicast"
_REFUSING = b" is unauthorized to ", b"Msg intercepted!", _TLS.encode()
"""What stands in every line that counts; the line that says no names the peer, the first time with its certificate."""


class RefusalLog:
    """Who has tried what, and how often; read from lines of Zenoh's log."""

    def __init__(self, clock: Callable[[], float] = time.time) -> None:
        self._clock = clock
        self._found: dict[tuple[str, str, str], tuple[int, float]] = {}
        self._names: dict[str, str] = {}
        """The common name of each peer, by what Zenoh calls it."""
        self._denied: dict[str, tuple[str, str, str, str]] = {}
        """The last line of each thread that says no: peer, attempt, flow, key."""
        self._lock = threading.Lock()

    @property
    def refused(self) -> tuple[RefusedAttempt, ...]:
        """What was refused, the latest first."""
        with self._lock:
            found = [RefusedAttempt(*what, number, latest) for what, (number, latest) in self._found.items()]
        return tuple(sorted(found, key=lambda one: -one.latest))

    def take(self, line: str) -> None:
        """Read one line."""
        parts = _LINE.fullmatch(line)
        if parts is None:
            return
        thread, target, text = parts.groups()
        denied = _DENIED.fullmatch(text)
        if target == _TLS:
            warning = _DETAIL.sub("", text)
            if _NO_VERDICT.fullmatch(warning) is None:
                self._count("", warning[:LONGEST_KEY], "")
        elif denied is not None:
            self._denied[thread] = self._note(*denied.groups())
        elif text == "Msg intercepted!" and thread in self._denied:
            peer, attempt, flow, key = self._denied.pop(thread)
            withdraws = attempt.startswith("Undeclare ")  # it concerns what is one's own, or nothing
            says_no = attempt == "Reply" and "*" in key
            if flow == "ingress" and not withdraws and not says_no:
                self._count(self._names.get(peer, "?"), attempt, key[:LONGEST_KEY])

    def _note(self, peer: str, link: str | None, attempt: str, flow: str, key: str) -> tuple[str, str, str, str]:
        """Remember what a peer is called, where its link says so."""
        name = _NAME.search(link or "")
        if name is not None:
            self._names.pop(peer, None)
            self._names[peer] = name[1]
            if len(self._names) > MOST_ATTEMPTS:  # a client that comes again and again has another number each time
                del self._names[next(iter(self._names))]
        return peer, attempt, flow, key

    def _count(self, principal: str, attempt: str, key: str) -> None:
        with self._lock:
            what = principal, attempt, key
            if what not in self._found and len(self._found) >= MOST_ATTEMPTS:
                what = principal, "further attempts", ""
            if what in self._found or len(self._found) < 2 * MOST_ATTEMPTS:
                self._found[what] = self._found.get(what, (0, 0.0))[0] + 1, self._clock()

    def drop(self, attempt: RefusedAttempt) -> None:
        """Forget one attempt: it was none, or was made before it was known that it may be made."""
        with self._lock:
            self._found.pop((attempt.principal, attempt.attempt, attempt.key), None)

    def take_chunk(self, chunk: bytes) -> None:
        """Read some whole lines; quickly where none of them says that something was refused."""
        if any(word in chunk for word in _REFUSING):
            for line in chunk.split(b"\n"):
                if line.startswith(_GENUINE) and any(word in line for word in _REFUSING):
                    self.take(_COLOUR.sub(b"", line).decode(errors="replace"))


@cache
def hear_refusals() -> RefusalLog:
    """Begin to read the log, before any session of this process is opened; a process has one, as Zenoh has."""
    log = RefusalLog()
    reading, writing = os.pipe()
    fcntl.fcntl(writing, fcntl.F_SETPIPE_SZ, ROOM)
    sys.stdout.flush()
    before = os.dup(1)
    os.dup2(writing, 1)
    os.close(writing)
    sys.stdout = os.fdopen(before, "w", buffering=1, encoding=sys.stdout.encoding, errors=sys.stdout.errors)
    with _colours():
        begin_log(FILTER)
    threading.Thread(target=_read, args=(reading, log), daemon=True, name="refusals").start()
    return log


@contextmanager
def _colours() -> Iterator[None]:
    """Have Zenoh write its log in colours, whatever the user wants on a terminal: this log is not shown."""
    before = os.environ.pop(NO_COLOUR, None)
    try:
        yield
    finally:
        if before is not None:
            os.environ[NO_COLOUR] = before


def _read(pipe: int, log: RefusalLog) -> None:
    """Read a pipe until it ends, in whole lines."""
    rest, room = b"", bytearray(ROOM)  # one for all: to have the memory for each look costs more than the look
    while size := os.readv(pipe, [room]):
        whole, newline, last = (rest + bytes(memoryview(room)[:size])).rpartition(b"\n")
        rest = last[-ROOM:]
        if newline:
            log.take_chunk(whole)
        time.sleep(BETWEEN_READS)  # lines come without an end, and a look at each costs more than the hub itself
