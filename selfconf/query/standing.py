"""A dataset in a process of its own, for a server: graphs are replaced, and questions answered many at a time.

The graphs are remembered here, so that the process is started again should it end.
"""

from __future__ import annotations

import contextlib
import json
import socket
import subprocess
import threading
from collections.abc import Sequence
from dataclasses import asdict

from selfconf.errors import NetworkError, NotAcceptableError, ProgrammerError, QueryError, QueryTimeoutError
from selfconf.model.immutable import immutable
from selfconf.module_command import module_command
from selfconf.query import standing_process as endings
from selfconf.query.limits import ENGINE_DOWN, too_large, too_slow

STANDING_SECONDS = 30.0
"""How long an answer of a standing dataset may take by default."""
STANDING_MEMORY = 2 << 30
"""How many bytes of address space a question to it may take."""
STANDING_END = 5.0
"""Seconds that the process may take to end."""


@immutable
class StandingQuestion:
    """A query, the graphs that are its dataset, if not all, and the media types wanted, the best first."""

    text: str
    media: Sequence[str]
    default_graphs: Sequence[str] = ()
    named_graphs: Sequence[str] = ()
    seconds: float = STANDING_SECONDS
    memory: int = STANDING_MEMORY
    base: str | None = None
    """What relative IRIs of the query are relative to."""


class StandingDataset:
    """Named graphs in a process of their own; may be used from any thread."""

    def __init__(self) -> None:
        self._graphs: dict[str, bytes] = {}
        self._lock = threading.Lock()
        self._control: socket.socket | None = None
        self._process: subprocess.Popen[bytes] | None = None

    def start(self) -> None:
        """Start the process already now, so that the first question need not wait for it."""
        with self._lock, contextlib.suppress(OSError):  # the first question tries again, and says why
            self._start()

    def replace(self, graph: str, triples: bytes) -> None:
        """Let a graph hold these N-Triples and nothing else; without any it is gone. Later questions see that."""
        with self._lock:
            if triples:
                self._graphs[graph] = triples
            else:
                self._graphs.pop(graph, None)
            if self._control is not None:
                try:
                    self._send({"graph": graph, "size": len(triples)}, triples)
                except OSError:
                    self._end()  # the next question starts it again, with all graphs

    def begin(self, question: StandingQuestion) -> socket.socket:
        """Ask, and return the socket on which the answer comes, to be read to its end for `outcome`.

        Closing it ends the query. Raises NetworkError if there can be no process that answers.
        """
        line, other = socket.socketpair()
        with self._lock, other:
            for _ in range(2):
                try:
                    self._start()
                    self._send(asdict(question), b"", other)
                except OSError:
                    self._end()
                else:
                    return line
        line.close()
        raise NetworkError("the process that answers queries cannot be started")

    def ask(self, question: StandingQuestion) -> tuple[str, bytes]:
        """The media type of the answer and the answer. Raises as `outcome` does."""
        with self.begin(question) as line:
            parts = []
            while part := line.recv(1 << 16):
                parts.append(part)
        return outcome(b"".join(parts), question)

    def close(self) -> None:
        """End the process and all that it answers."""
        with self._lock:
            self._end()

    def _start(self) -> None:
        if self._control is not None:
            return
        self._control, other = socket.socketpair()
        command = module_command("selfconf.query", str(other.fileno()))
        with other:
            # A group of its own: Ctrl-C is for the program that serves, which ends this one.
            self._process = subprocess.Popen(command, pass_fds=[other.fileno()], start_new_session=True)
        for graph, triples in self._graphs.items():
            self._send({"graph": graph, "size": len(triples)}, triples)

    def _send(self, message: dict[str, object], triples: bytes, line: socket.socket | None = None) -> None:
        assert self._control is not None
        body = json.dumps(message).encode()
        head = len(body).to_bytes(4, "big")
        if line is None:
            self._control.sendall(head)
        else:
            socket.send_fds(self._control, [head], [line.fileno()])
        self._control.sendall(body + triples)

    def _end(self) -> None:
        if self._control is not None:
            self._control.close()
            self._control = None
        if self._process is not None:
            try:
                self._process.wait(STANDING_END)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
            self._process = None


def outcome(received: bytes, question: StandingQuestion) -> tuple[str, bytes]:
    """The media type of an answer and the answer, by all that has come on its socket.

    Raises QueryError for what is no query, QueryTimeoutError where a limit was reached, NotAcceptableError where no
    media type fits or can write the answer, and ProgrammerError where the process has broken.
    """
    head, _, body = received[:-1].partition(b"\n")
    ending = received[-1:]
    if ending == endings.DONE:
        return str(json.loads(head)["media"]), body
    if ending == endings.REFUSED:
        raise QueryError(body.decode())
    if ending == endings.NO_TYPE:
        raise NotAcceptableError(body.decode() or "the answer can be had in none of the media types that Accept names")
    if ending == endings.NO_TIME:
        raise QueryTimeoutError(too_slow(question.seconds))
    if ending == endings.NO_MEMORY:
        raise QueryTimeoutError(too_large(question.memory))
    if ending == endings.ENGINE_DOWN:
        raise QueryError(ENGINE_DOWN)
    raise ProgrammerError("the process that answers queries has broken")
