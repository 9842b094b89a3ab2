"""A bus whose questions are waited for: what the library asks the living ecology, it answers before it goes on."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from typing import TypeVar

from selfconf.bus.port import Bus, Replies, Sample, Undo, Urgency
from selfconf.errors import NetworkError, ProgrammerError

ROLL_CALL = 3.0
"""How long, in seconds, a roll-call or a question may take, if nothing else is said."""
ANSWER_PATIENCE = 20.0
"""How long, in seconds, an answer is waited for that the bus itself should end earlier."""
LONGEST_TURN = 0.05
"""Seconds for which a thread waits at most until others have their turn, or until it notices that the bus is closed."""
LINK_BACK = 2.0
"""Seconds within which a hub that is opened anew is there again, or another one in its place."""
OTHERS_BACK = 1.0
"""Seconds that others may take to be connected again after this program; on a busy machine 0.3 is not enough."""
LOSS_TOLD = 0.5
"""Seconds after the end of a question by which the loss of the link is known that has ended it."""
ASKED = 3
"""How often something is asked at most, where the link is lost each time."""
ATTENDED = 1.0
"""How often, in seconds, a bus is attended to while nothing is asked."""
CUT_OFF_MEANWHILE = "cut off from the ecology while it was asked; try again"
_Result = TypeVar("_Result")


class SynchronousBus:
    """Asks over a bus, and lets that run until the answer is there; may be used by several threads, which take turns.

    What has come for any of them is done by the one whose turn it is, so none waits for the answers of others.
    """

    def __init__(
        self, bus: Bus, seconds: float = ROLL_CALL, lives: str = "", check_own: Callable[[], None] = lambda: None
    ) -> None:
        """`seconds` is how long a roll-call or a question may take, unless it says otherwise.

        `lives` is a key of lives of which some are seen unless this program is cut off, such as those of sites.
        `check_own` is called where this program is cut off, and raises if that is for a reason of its own.
        """
        self._bus, self._seconds, self._lives, self._check_own = bus, seconds, lives, check_own
        self._link = bus.link
        """The link over which others were last known to be connected too."""
        self._cut_off = False
        """Whether the last question waited for a link in vain; the next one does not."""
        self._left = False
        self._over = threading.Event()
        """Set once it was left, for the thread that attends to the bus."""
        self._attending: threading.Thread | None = None
        self._process = os.getpid()
        self._turn, self._next_turn = threading.Lock(), threading.Lock()
        self._running: int | None = None
        """The thread whose turn it is."""

    def leave(self) -> None:
        """From now on nothing can be asked: the bus is closed by its owner."""
        self._left = True
        self._over.set()
        attending = self._attending
        if attending is not None and attending is not threading.current_thread() and self._process == os.getpid():
            attending.join()

    def attend(self) -> None:
        """Have the bus do what is due also while nothing is asked, on a thread of its own, until it is left."""
        self._attending = threading.Thread(target=self._attend, daemon=True, name="attending")
        self._attending.start()

    def _attend(self) -> None:
        while not self._over.wait(ATTENDED):
            # Not waited for: a thread whose turn it is lets the bus run itself, and may be the one that is leaving.
            if self._turn.acquire(blocking=False):
                self._running = threading.get_ident()
                try:
                    self._bus.poll(0.0)
                finally:
                    self._running = None
                    self._turn.release()

    def check(self) -> None:
        """Raises ProgrammerError where the ecology was left, and in a process that was forked since it was joined."""
        if self._left:
            raise ProgrammerError("the ecology was left, by `close` or at the end of its `with`; join it again")
        if self._process != os.getpid():
            raise ProgrammerError("the ecology was joined before this process was forked; spawn it, and join there")

    @contextmanager
    def _in_turn(self) -> Iterator[None]:
        """In the block the bus belongs to this thread."""
        if self._running == threading.get_ident():  # a handler of signals asks, in the middle of the thread's own turn
            yield
            return
        with self._next_turn:  # without it, the thread that has just had its turn would have the next one, too
            self._turn.acquire()
        self._running = threading.get_ident()
        try:
            yield
        finally:
            self._running = None
            self._turn.release()

    def run(self, until: Callable[[], bool]) -> None:
        """Let the bus run until `until` holds. Raises ProgrammerError where the ecology was left."""
        while not until():
            self.check()
            with self._in_turn():
                self._run_once(until)

    def _run_once(self, until: Callable[[], bool]) -> None:
        over: list[bool] = []
        undo = self._bus.later(LONGEST_TURN, partial(over.append, True))
        self._bus.run(lambda: until() or bool(over) or self._left)
        undo()

    def wait(self, begin: Callable[[Callable[[_Result], None]], None]) -> _Result:
        """Begin something that says when it is done, and return its result. Raises NetworkError if it never does.

        Raises ProgrammerError where the ecology was left.
        """
        self.check()
        results: list[_Result] = []
        with self._in_turn():
            begin(results.append)
        deadline = self._bus.now() + ANSWER_PATIENCE
        self.run(lambda: bool(results) or self._bus.now() > deadline)
        if not results:
            raise NetworkError("the ecology does not answer")
        return results[0]

    def while_linked(self, ask: Callable[[], _Result], heard: Callable[[_Result], bool] = bool) -> _Result:
        """What was asked over one link; it is asked again where that was lost meanwhile, by which answers are missed.

        `heard` says whether there was any answer. Raises NetworkError where the link is not back in time, or lost each
        time: to be cut off looks like an ecology in which nothing lives.
        """
        for _ in range(ASKED):
            self._await_link()
            answer = ask()
            if self._bus.link == self._link and (heard(answer) or not self._has_lost_link()):
                return answer
        self._check_own()
        raise NetworkError(CUT_OFF_MEANWHILE)

    def _has_lost_link(self) -> bool:
        """Whether the link is lost over which nothing was heard: the bus ends all questions moments before it says so.

        To see that others live is quicker than to wait for that.
        """
        if not self._lives or self._called_once(self._lives):
            return False
        deadline = self._bus.now() + LOSS_TOLD
        self.run(lambda: self._bus.link != self._link or self._bus.now() > deadline)
        return self._bus.link != self._link

    def _await_link(self) -> None:
        """Wait until this program is connected, and then, if it was not for a moment, until others are."""
        if self._link == self._bus.link != "":
            return
        deadline = self._bus.now() + (0.0 if self._cut_off else LINK_BACK)
        self.run(lambda: bool(self._bus.link) or self._bus.now() > deadline)
        self._link = self._bus.link
        self._cut_off = not self._link
        if self._cut_off:
            self._check_own()
            raise NetworkError(CUT_OFF_MEANWHILE)
        self.pause(OTHERS_BACK)

    def ask(self, key: str, payload: bytes = b"", seconds: float | None = None) -> Replies:
        """Return all answers to a question, which may be asked more than once. Raises NetworkError if cut off."""
        return self.ask_each([(key, payload)], seconds)[0]

    def ask_each(self, questions: Sequence[tuple[str, bytes]], seconds: float | None = None) -> list[Replies]:
        """Return the answers to several questions, each a key and a payload, that are asked all at once; in order."""
        if not questions:
            return []
        return self.while_linked(lambda: self._asked_once(questions, seconds), _any_answer)

    def _asked_once(self, questions: Sequence[tuple[str, bytes]], seconds: float | None) -> list[Replies]:
        patience = self._seconds if seconds is None else seconds
        found: dict[int, Replies] = {}

        def begin(done: Callable[[list[Replies]], None]) -> None:
            def answered(index: int, replies: Replies) -> None:
                found[index] = replies
                if len(found) == len(questions):
                    done([found[place] for place in range(len(questions))])

            for index, (key, payload) in enumerate(questions):
                self._bus.ask(key, payload, patience, partial(answered, index))

        return self.wait(begin)

    def demand(self, key: str, payload: bytes, trouble: str, seconds: float | None = None) -> None:
        """Have something done, once. Raises NetworkError, which begins with the trouble, where no node has done it."""
        replies = self._asked_once([(key, payload)], seconds)[0]
        if not replies.samples:
            raise NetworkError(f"{trouble}: {'; '.join(replies.errors) or 'it does not answer'}")

    def living(self, key: str) -> tuple[str, ...]:
        """Return the liveliness keys that match a key. Raises NetworkError if cut off."""
        return self.while_linked(lambda: self._called_once(key))

    def _called_once(self, key: str) -> tuple[str, ...]:
        def begin(done: Callable[[tuple[str, ...]], None]) -> None:
            self._bus.roll_call(key, self._seconds, done)

        return self.wait(begin)

    def subscribe(self, key: str, receive: Callable[[Sample], None]) -> Undo:
        """Receive what is put on a key from now on, whenever the bus runs; returns what ends that."""
        self.check()
        with self._in_turn():
            return self._bus.subscribe(key, receive, Urgency.EVENT)

    def pause(self, seconds: float) -> None:
        """Let the bus run for some time."""
        with self._in_turn():
            self._bus.poll(seconds)

    def now(self) -> float:
        """Seconds of the bus's clock."""
        return self._bus.now()


def _any_answer(replies: Sequence[Replies]) -> bool:
    return any(one.samples or one.errors for one in replies)
