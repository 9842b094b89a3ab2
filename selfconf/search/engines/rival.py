"""An engine in a process of its own: CaDiCaL, which looks for the same least solution beside the search.

The process gets the clauses through a socket and answers with the options of the least solution, slot after slot, as
it settles them; what is settled here is not told there. A thread sends and receives, as clauses may be more than the
socket takes at once, and the search is in a call of its own solver meanwhile, which the answer ends. The process is
ended with the search, however that ends; if this one is killed, the other one finds the socket closed after its next
few conflicts, and ends.
"""

from __future__ import annotations

import marshal
import os
import socket
import subprocess
import sys
import threading
from array import array
from collections.abc import Callable, Sequence
from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path

from selfconf.search.engines.clause_learning import PAIRED, SECOND_SOLVER
from selfconf.search.engines.encoding import Encoding

PROGRAM = Path(__file__).with_name("rival_process.py")


def processors() -> int:
    """Return how many processors this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class Rival:
    """The process, and what it has found so far; use it in a `with` statement. OSError where none can be started."""

    def __init__(
        self, encoding: Encoding, slots: Sequence[int], least: bool, ended: Callable[[], None] = lambda: None
    ) -> None:
        """Start the process; `ended` is called in a thread once it has answered."""
        question = (
            SECOND_SOLVER,
            PAIRED,
            encoding.top,
            list(encoding.clauses()),
            [(list(bound.literals), bound.most, list(bound.force)) for bound in encoding.bounds],
            [encoding.plays[role] for role in slots],
            [place > 0 and slots[place] == slots[place - 1] for place in range(len(slots))],
            least,
        )
        data = marshal.dumps(question)
        self._found = b""
        self._answer = array("i").itemsize * (1 + len(slots))
        """How many bytes an answer with a solution has."""
        self.possible: bool | None = None
        """Whether there is a solution, once that is known."""
        self._socket, other = socket.socketpair()
        found = find_spec("pysat")
        assert found is not None  # for `available` has found it
        assert found.origin is not None  # for it is a package with an `__init__`
        place = Path(found.origin).parents[1]
        command = [sys.executable, "-I", str(PROGRAM), str(place)]
        nothing = subprocess.DEVNULL
        try:
            # A session of its own: Ctrl-C at a terminal is for the search, which then ends this process.
            self._process = subprocess.Popen(
                command, stdin=other.fileno(), stdout=nothing, stderr=nothing, start_new_session=True
            )
        except OSError:
            self._socket.close()
            raise
        finally:
            other.close()
        sent = len(data).to_bytes(8, "big"), data
        self._thread = threading.Thread(target=self._exchange, args=(sent, ended), daemon=True)
        try:
            self._thread.start()
        except RuntimeError as error:  # the system lets this program begin no further thread
            self._process.kill()
            self._process.wait()
            self._socket.close()
            raise OSError(str(error)) from None

    @staticmethod
    def available() -> bool:
        """Return whether a process can be started, and there is a processor for it."""
        return processors() > 1 and bool(sys.executable) and PROGRAM.is_file()

    def __enter__(self) -> Rival:
        return self

    def __exit__(self, *_: object) -> None:
        self._process.kill()
        self._process.wait()
        self._thread.join()  # which finds the other end of the socket closed
        self._socket.close()

    def _exchange(self, sent: Sequence[bytes], ended: Callable[[], None]) -> None:
        """Send the question, and receive what is found, until the process has ended.

        What it has found until then stays true, and the search goes on alone.
        """
        with suppress(OSError):
            for part in sent:
                self._socket.sendall(part)
            while part := self._socket.recv(1 << 16):
                self._found += part
                if len(self._found) == self._answer or not any(self._found):
                    ended()

    def settled(self) -> Sequence[int]:
        """Return the options of the first slots that are settled by now, without waiting."""
        found, numbers = self._found, array("i")
        numbers.frombytes(found[: len(found) // numbers.itemsize * numbers.itemsize])
        if numbers:
            self.possible = bool(numbers[0])
        return numbers[1:]
