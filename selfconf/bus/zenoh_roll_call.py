"""Roll-calls over Zenoh, each made again where Zenoh may have left some of the answer out.

Of the tokens that a session knows already, its own and those that a watch has shown, it answers itself, in the call of
`get`; its router leaves out those, answers the others, and ends the answer, on another thread. On a busy machine that
end may come before the session has said what it knows, which is lost then (Zenoh 1.10.2: of 100 calls right after a
watch had shown the life that was called, up to 10 came to nothing). It has said all when `get` has returned: if the
answer has ended by then, the call is made again, which takes one more round trip.

All answers come by channels, as those can be asked whether they have ended: a callback would have to wait for Python's
lock to say so, and `get` may have returned meanwhile.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from selfconf.bus.loop import Loop
from selfconf.bus.reader_threads import ReaderThreads
from selfconf.bus.zenoh_channels import READ_TOGETHER, at_hand, may_be_many, open_channel, read_together

MOST_ROLL_CALLS = 6
"""How often one roll-call is made at most."""
MOST_ROLL_CALLS_OF_MANY = 2
"""How often where so many answer that it may have ended while they were read, if the session knows many."""


class RollCalls:
    """The roll-calls of one session."""

    def __init__(self, loop: Loop, session: Any, readers: ReaderThreads) -> None:
        self._loop, self._session, self._readers = loop, session, readers
        self._lock = threading.Lock()
        self._few: deque[Callable[[], None]] = deque()
        """What is to be read of calls for a few lives; one thread reads them in turn, as their router answers them."""
        self._reads_few = False
        self.knows_many = False
        """Whether a watch may have shown the session more lives than are read together."""

    def call(self, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        """Ask which lives there are under a key; `done` hears of them on the thread of the loop."""
        self._call(key, seconds, done, set(), 1)

    def _call(
        self, key: str, seconds: float, done: Callable[[tuple[str, ...]], None], alive: set[str], calls: int
    ) -> None:
        """Make a call for the so-manieth time; `alive` is what came of the times before."""
        channel = self._session.liveliness().get(key, open_channel(), timeout=seconds)
        known, goes_on = at_hand(channel)
        most_calls = MOST_ROLL_CALLS
        if len(known) == READ_TOGETHER:  # a second call of ten thousand lives takes as long as the first
            most_calls = MOST_ROLL_CALLS_OF_MANY if self.knows_many else 1

        def take(replies: Sequence[Any]) -> None:
            alive.update(str(reply.ok.key_expr) for reply in replies if reply.ok is not None)

        def read() -> None:
            take(known)
            while some := read_together(channel):
                take(some)
            if goes_on or calls >= most_calls:
                keys = tuple(sorted(alive))
                self._loop.wake_up(lambda: done(keys))
            else:
                self._loop.wake_up(lambda: self._call(key, seconds, done, alive, calls + 1))

        if may_be_many(key):
            self._readers.begin(read)
        else:
            self._read_in_turn(read)

    def _read_in_turn(self, read: Callable[[], None]) -> None:
        with self._lock:
            self._few.append(read)
            begins, self._reads_few = not self._reads_few, True
        if begins:
            self._readers.begin(self._read_few)

    def _read_few(self) -> None:
        while True:
            with self._lock:
                if not self._few:
                    self._reads_few = False
                    return
                read = self._few.popleft()
            read()
