"""Roll-calls over Zenoh, each made again where Zenoh may have left some of the answer out.

Of the tokens that a session knows already, its own and those that a watch has shown, it answers itself, in the call of
`get`; its router leaves out those, answers the others, and ends the answer, on another thread. On a busy machine that
end may come before the session has said what it knows, which is lost then (Zenoh 1.10.2: of 100 calls right after a
watch had shown the life that was called, up to 10 came to nothing). It has said all when `get` has returned: if the
answer has ended by then, the call is made again, which takes one more round trip.

What comes too late goes astray: the session takes the first such token for another one, of the number 0. So a new watch
may show that life when it has ended; and the next end of a token that a watch without history has not shown, which has
that number too, comes as the end of this one (of 84 lives, 78 seemed to end). What watches show of such a life is
*doubtful*, and the life is called first.

All answers come by channels, as those can be asked whether they have ended: a callback would have to wait for Python's
lock to say so, and `get` may have returned meanwhile.
"""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import Any

from selfconf.bus.loop import Loop
from selfconf.bus.zenoh.channels import READ_TOGETHER, at_hand, may_be_many, open_channel, read_together
from selfconf.bus.zenoh.reader_threads import ReaderThreads

MOST_DOUBTFUL = 1000
"""How many lives are noted as doubtful at most; then each that comes drives out the oldest one."""
SECOND_ANSWER = 0.05
"""Seconds after which a doubtful life is called again that has not answered: until a watch that begins has received
all, the router answers nothing."""
CONFIRMATION = 1.0
"""Seconds that the answer to such a call may take."""
BEFORE_AGAIN = 0.0002
"""Seconds until a roll-call is made again; four times as long each time, as threads get in each other's way in bursts.
"""
MOST_ROLL_CALLS = 7
"""How often one roll-call is made at most."""
MOST_ROLL_CALLS_OF_MANY = 2
"""How often one is made where so many answer that it may have ended meanwhile, if the session knows many."""


class RollCalls:
    """The roll-calls of one session."""

    def __init__(self, loop: Loop, session: Any, readers: ReaderThreads, is_linked: Callable[[], bool]) -> None:
        """`is_linked` says whether the session has a router, on any thread."""
        self._loop, self._session, self._readers, self._is_linked = loop, session, readers, is_linked
        self._lock = threading.Lock()
        self._few: deque[Callable[[], None]] = deque()
        """What is to be read of calls for a few lives; one thread reads them in turn, as their router answers them."""
        self._reads_few = False
        self.knows_many = False
        """Whether a watch may have shown the session more lives than are read together."""
        self.doubtful: dict[str, None] = {}
        """The lives of which a watch may show an end, or a beginning, that is none; the oldest first."""

    def call(self, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        """Ask which lives there are under a key; `done` hears of them on the thread of the loop."""
        self._call(key, seconds, done, [])

    def confirm(self, key: str, alive: bool, confirmed: Callable[[], None]) -> None:
        """Call `confirmed` if a doubtful life has begun, or ended, as a watch has shown; on the thread of the loop.

        It is called twice at least where it does not answer, and again for as long as calls time out: these say
        nothing. They end as soon as the router does, as the session does not wait for one that it has lost.
        """

        def call(again: bool) -> None:
            began = self._loop.now()
            self.call(key, CONFIRMATION, lambda keys: heard(keys, again or self._loop.now() - began >= CONFIRMATION))

        def heard(keys: Sequence[str], again: bool) -> None:
            if key in keys:
                if alive:
                    confirmed()
                else:  # the token that had gone astray has ended
                    with self._lock:
                        self.doubtful.pop(key, None)
            elif again:
                self._loop.later(SECOND_ANSWER, lambda: call(False))
            elif not alive:
                confirmed()

        self._loop.wake_up(lambda: call(True))

    def _call(
        self, key: str, seconds: float, done: Callable[[tuple[str, ...]], None], before: Sequence[set[str]]
    ) -> None:
        """Make a call once more; `before` is what came of each time before, which ended too soon."""
        channel = self._session.liveliness().get(key, open_channel(), timeout=seconds)
        known, goes_on = at_hand(channel)
        most_calls = MOST_ROLL_CALLS
        if len(known) == READ_TOGETHER:  # a second call of ten thousand lives takes as long as the first
            most_calls = MOST_ROLL_CALLS_OF_MANY if self.knows_many else 1

        alive: set[str] = set()

        def take(replies: Sequence[Any]) -> None:
            alive.update(str(reply.ok.key_expr) for reply in replies if reply.ok is not None)

        def read() -> None:
            take(known)
            while some := read_together(channel):
                take(some)
            if goes_on or len(before) + 1 >= most_calls or not self._is_linked():  # without a router all end at once
                keys = tuple(sorted(alive.union(*before)))
                self._doubt(key for some in before for key in keys if key not in some)
                self._loop.wake_up(lambda: done(keys))
            else:
                again = partial(self._call, key, seconds, done, [*before, alive])
                self._loop.wake_up(partial(self._later, BEFORE_AGAIN * 4 ** len(before), again))

        if may_be_many(key):
            self._readers.begin(read)
        else:
            self._read_in_turn(read)

    def _later(self, seconds: float, call: Callable[[], None]) -> None:
        self._loop.later(seconds, call)

    def _doubt(self, lives: Iterable[str]) -> None:
        with self._lock:
            for life in lives:
                self.doubtful[life] = None
                if len(self.doubtful) > MOST_DOUBTFUL:
                    del self.doubtful[next(iter(self.doubtful))]

    def _read_in_turn(self, read: Callable[[], None]) -> None:
        with self._lock:
            self._few.append(read)
            begins, self._reads_few = not self._reads_few, True
        if begins:
            try:
                self._readers.begin(self._read_few)
            except RuntimeError:  # the next call tries again, and its thread reads this one as well
                with self._lock:
                    self._reads_few = False
                raise

    def _read_few(self) -> None:
        while True:
            with self._lock:
                if not self._few:
                    self._reads_few = False
                    return
                read = self._few.popleft()
            read()
