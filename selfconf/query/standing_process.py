"""The process that holds a dataset and answers many questions, each in a copy of itself (fork) that can be ended.

A copy sees the dataset as it was when the question came: a graph changes between two questions, so no answer sees half
of a change. The copy ends itself when its time is up, by an alarm of the system, for Oxigraph cannot be interrupted; it
is ended when the asker hangs up. Nothing here speaks Zenoh: a copy of a process with threads would not be safe.

On the control socket come messages, each a length in four bytes and as much JSON; `{"graph": IRI, "size": N}` is
followed by N bytes of N-Triples, a question comes with the socket for its answer. There go a line of JSON, the answer,
and last one byte, written by this process: how the copy has ended.
"""

from __future__ import annotations

import contextlib
import gc
import json
import os
import resource
import selectors
import signal
import socket
import sys
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import pyoxigraph as ox

from selfconf.errors import NotAcceptableError, QueryError
from selfconf.query.xml_answers import XML_TYPES, xml_answer
from selfconf.rdf.sparql import Dataset, QueryAnswer

RESULT_TYPES = {
    "application/sparql-results+json": ox.QueryResultsFormat.JSON,
    "application/sparql-results+xml": ox.QueryResultsFormat.XML,
    "text/csv": ox.QueryResultsFormat.CSV,
    "text/tab-separated-values": ox.QueryResultsFormat.TSV,
}
"""The media types of solutions and truth values."""
TRIPLE_TYPES = {
    "text/turtle": ox.RdfFormat.TURTLE,
    "application/n-triples": ox.RdfFormat.N_TRIPLES,
    "application/rdf+xml": ox.RdfFormat.RDF_XML,
    "application/ld+json": ox.RdfFormat.JSON_LD,
}
"""The media types of triples."""
DONE, REFUSED, NO_TYPE, NO_TIME, NO_MEMORY, ENGINE_DOWN, BROKEN = (bytes([number]) for number in range(7))
"""How a copy has ended, as its last byte says."""
NICENESS = 5
"""Questions give way to the programs of the ecology on the same processors."""
_ENDINGS = {signal.SIGALRM: NO_TIME, signal.SIGKILL: NO_MEMORY, signal.SIGABRT: NO_MEMORY, signal.SIGSEGV: ENGINE_DOWN}
_EXIT = {REFUSED: 2, NO_TYPE: 3, NO_MEMORY: 4}


@dataclass(slots=True)
class _Copy:
    """A copy that answers a question, and the socket on which it does."""

    process: int
    line: socket.socket
    ending: bytes = b""


class StandingProcess:
    """Serves one control socket until the other side hangs up."""

    def __init__(self, control: socket.socket) -> None:
        self._control, self._dataset = control, Dataset()
        self._selector = selectors.DefaultSelector()
        self._copies: dict[int, _Copy] = {}
        self._sockets: deque[int] = deque()
        self._received = bytearray()
        self._bell, bell = socket.socketpair()
        self._bell.setblocking(False)
        bell.setblocking(False)
        self._bell_end = bell  # kept open: the signal writes there
        signal.set_wakeup_fd(bell.fileno(), warn_on_full_buffer=False)
        signal.signal(signal.SIGCHLD, lambda *_: None)
        self._selector.register(self._bell, selectors.EVENT_READ)
        self._selector.register(control, selectors.EVENT_READ)

    def run(self) -> None:
        """Answer until the other side has hung up."""
        while True:
            for key, _ in self._selector.select():
                if key.fileobj is self._control:
                    if not self._receive():
                        return
                elif key.fileobj is self._bell:
                    self._reap()
                else:
                    self._attend(key.data)

    def close(self) -> None:
        """End every copy."""
        for process in self._copies:
            os.kill(process, signal.SIGKILL)

    def _receive(self) -> bool:
        more, sockets, _, _ = socket.recv_fds(self._control, 1 << 20, 16)
        self._sockets.extend(sockets)
        self._received += more
        while len(self._received) >= 4:
            size = int.from_bytes(self._received[:4], "big")
            if len(self._received) < 4 + size:
                break
            message = json.loads(self._received[4 : 4 + size])
            end = 4 + size + int(message.get("size", 0))
            if len(self._received) < end:
                break
            if "graph" in message:
                self._dataset.replace(message["graph"], bytes(self._received[4 + size : end]))
            else:
                self._answer(message, socket.socket(fileno=self._sockets.popleft()))
            del self._received[:end]
        return bool(more)

    def _answer(self, question: Mapping[str, Any], line: socket.socket) -> None:
        process = os.fork()
        if process == 0:
            # It must not hold the sockets of other questions, or their askers would wait for its end.
            os.dup2(line.fileno(), 3)
            os.closerange(4, 1 << 16)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)  # what the engine says as it goes down, at each such query
            _answer_and_exit(self._dataset, question)
        copy = self._copies[process] = _Copy(process, line)
        self._selector.register(line, selectors.EVENT_READ, copy)

    def _attend(self, copy: _Copy) -> None:
        """The asker has hung up, or there is room for how it ended."""
        if copy.ending:
            with contextlib.suppress(OSError):
                copy.line.send(copy.ending, socket.MSG_DONTWAIT)
            self._forget(copy)
        elif not self._asker_waits(copy):
            os.kill(copy.process, signal.SIGKILL)
            self._selector.unregister(copy.line)

    @staticmethod
    def _asker_waits(copy: _Copy) -> bool:
        # Not `setblocking`: the copy has the same socket, and is to wait there for an asker that reads slowly.
        try:
            return bool(copy.line.recv(1, socket.MSG_DONTWAIT))  # an asker sends nothing
        except BlockingIOError:
            return True
        except OSError:
            return False

    def _reap(self) -> None:
        with contextlib.suppress(BlockingIOError):
            self._bell.recv(1 << 12)
        while self._copies:
            process, status = os.waitpid(-1, os.WNOHANG)
            if not process:
                return
            copy = self._copies.pop(process)
            copy.ending = _ending(status)
            if copy.line.fileno() in self._selector.get_map():
                self._selector.modify(copy.line, selectors.EVENT_WRITE, copy)
            else:
                copy.line.close()

    def _forget(self, copy: _Copy) -> None:
        self._selector.unregister(copy.line)
        copy.line.close()


def _ending(status: int) -> bytes:
    if os.WIFSIGNALED(status):
        return _ENDINGS.get(signal.Signals(os.WTERMSIG(status)), BROKEN)
    code = os.WEXITSTATUS(status)
    return next((ending for ending, exit_code in _EXIT.items() if exit_code == code), BROKEN if code else DONE)


def _answer_and_exit(dataset: Dataset, question: Mapping[str, Any]) -> None:
    """Answer a question on the socket with the number 3; the only way out is the exit of the process."""
    code = 1
    try:
        signal.set_wakeup_fd(-1)
        with contextlib.suppress(ValueError, OSError):  # some systems have no such limit
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            resource.setrlimit(resource.RLIMIT_AS, (question["memory"], question["memory"]))
        signal.setitimer(signal.ITIMER_REAL, question["seconds"])
        with open(3, "wb", buffering=1 << 16) as line:
            code = _write(dataset, question, line)
    except MemoryError:
        code = _EXIT[NO_MEMORY]
    except ConnectionError:
        code = 0  # the asker has hung up, and hears nothing more
    finally:
        os._exit(code)


def _write(dataset: Dataset, question: Mapping[str, Any], line: Any) -> int:
    """Write the answer in the first media type that is wanted, fits its kind and can write it; how the copy exits."""
    try:
        found = _asked(dataset, question)
    except QueryError as error:
        line.write(b"{}\n" + _encoded(error))
        return _EXIT[REFUSED]
    fitting: Mapping[str, object] = TRIPLE_TYPES if isinstance(found, ox.QueryTriples) else RESULT_TYPES
    why_not = b""
    for media in (media for media in question["media"] if media in fitting):
        if why_not:
            found = _asked(dataset, question)  # it was read for the media type before
        head = json.dumps({"media": media}).encode() + b"\n"
        if media in XML_TYPES:
            try:
                line.write(head + xml_answer(found))
            except NotAcceptableError as error:
                why_not = why_not or _encoded(error)
                continue
        elif isinstance(found, ox.QueryTriples):
            line.write(head)
            found.serialize(line, format=TRIPLE_TYPES[media])
        else:
            line.write(head)
            found.serialize(line, format=RESULT_TYPES[media])
        return 0
    line.write(b"{}\n" + why_not)
    return _EXIT[NO_TYPE]


def _asked(dataset: Dataset, question: Mapping[str, Any]) -> QueryAnswer:
    """What the dataset answers to a question. Raises QueryError."""
    return dataset.query(
        question["text"],
        default_graphs=question["default_graphs"],
        named_graphs=question["named_graphs"],
        base=question["base"],
    )


def _encoded(error: QueryError) -> bytes:
    return str(error).encode(errors="backslashreplace")


def main(control: int) -> int:
    """Serve the control socket of that number."""
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, signal.SIG_IGN)  # its end is that of the program that has started it
    os.nice(NICENESS)
    Dataset().query("ASK {}")  # loads what every copy needs
    gc.freeze()
    process = StandingProcess(socket.socket(fileno=control))
    try:
        process.run()
    except OSError as error:
        print(f"the process that answers queries: {error}", file=sys.stderr)
    finally:
        process.close()
    return 0
