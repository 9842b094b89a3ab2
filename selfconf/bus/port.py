"""What the programs of selfconf ask of a network.

A bus belongs to one thread: everything that arrives (samples, requests, replies, lives, timers) is delivered by
callbacks inside `run` or `poll`, one after the other. So a program needs no locks, and it can run unchanged in a
simulated network with a clock turned by hand. But `Publisher.put`, `wake_up` and `later` may be called from any thread,
and a *direct* subscription is called on the thread that a sample arrives on.

What arrives stands in one of three classes, each in order of its arrival:

1. timers that are due;
2. *control*: requests, replies, lives, matching, `wake_up`, and the samples of subscriptions of Urgency.EVENT;
3. *bulk*: the samples of all other subscriptions.

A callback of control waits for those of control before it and for one of bulk at most: a flood of signals or of
`changed` delays no call, no FAIL and no life by more than one such callback. Bulk is bounded; in a flood that the
program cannot keep up with, the oldest samples are dropped.

A *life* is one incarnation of a program or a component: a liveliness token under a key of its own, which is there from
`announce` until that is undone, or until the node is gone.
"""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from typing import NamedTuple, Protocol

from selfconf.model.immutable import immutable


class Urgency(str, Enum):
    """How a sample is to be treated when the network is short of room."""

    SIGNAL = "signal"
    """Small and frequent: the newest counts, an old one may be dropped."""
    BULK = "bulk"
    """What comes in rushes and may wait a moment: many go in one message, and are dropped first."""
    EVENT = "event"
    """FAIL and the like: never dropped, and ahead of everything else, between nodes that reach each other.

    Nothing is kept for a subscriber that was cut off: a life that has ended tells it more than a late event would.
    """


class Sample(NamedTuple):
    """What was put, or replied, on a key; one is made for each signal, so it is a tuple, which is quickly made."""

    key: str
    payload: bytes
    attachment: bytes = b""


LARGEST_REPLIES = 1 << 28
"""How many bytes the replies to one question can have together; what comes after that is dropped."""


@immutable
class Replies:
    """All the replies to a question.

    Not `complete` if a queryable that was asked did not finish in time, or if they were more than `LARGEST_REPLIES`.
    """

    samples: tuple[Sample, ...] = ()
    errors: tuple[str, ...] = ()
    complete: bool = True


class Request(Protocol):
    """A question to a queryable; the asker waits for the end of the answer until `finish`."""

    @property
    def key(self) -> str:
        """The key that was asked; it may hold wildcards."""
        ...

    @property
    def payload(self) -> bytes:
        """What came with the question."""
        ...

    @property
    def attachment(self) -> bytes:
        """What came beside that."""
        ...

    def reply(self, key: str, payload: bytes, attachment: bytes = b"") -> None:
        """One reply, on a concrete key of one's own."""
        ...

    def refuse(self, reason: str) -> None:
        """Reply that it cannot be answered; what is no character in the reason, as in names of files, is replaced."""
        ...

    def finish(self) -> None:
        """End the answer; must be called exactly once."""
        ...


class Undo(Protocol):
    """Something declared on the bus, or a timer; calling it takes it back. Taking it back twice does nothing."""

    def __call__(self) -> None: ...


class Publisher(Protocol):
    """A declared key to put samples on, from any thread."""

    def put(self, payload: bytes, attachment: bytes = b"") -> None:
        """Put a sample."""
        ...

    def undeclare(self) -> None:
        """Take the declaration back."""
        ...


class Bus(Protocol):
    """A node of the network."""

    @property
    def link(self) -> str:
        """By what this node reaches the network; empty if it does not. A link that differs from before: it was cut off.

        Lives that ended while the link changed may go on: this node has only lost sight of them.
        """
        ...

    def when_lost(self, lost: Callable[[], None]) -> None:
        """Call `lost` if other code of this process closes the session of this node, which has left for good then.

        Every life has ended for it, what is put goes nowhere, and it can declare and ask nothing.
        """
        ...

    def now(self) -> float:
        """Seconds of a clock that never goes back."""
        ...

    def later(self, seconds: float, action: Callable[[], None]) -> Undo:
        """Call `action` once, after that time; may be called from any thread."""
        ...

    def wake_up(self, action: Callable[[], None]) -> None:
        """Call `action` on the bus's thread, soon; may be called from any thread."""
        ...

    def publisher(
        self, key: str, urgency: Urgency, matched: Callable[[bool], None] | None = None, *, kept: int = 0
    ) -> Publisher:
        """Declare a key to put on; `matched` is called when there begins to be, or ceases to be, a subscriber.

        `kept` is how many of the newest samples stay at hand for subscribers that come later and ask for them, as
        those of other programs than selfconf's do.
        """
        ...

    def subscribe(
        self,
        key: str,
        receive: Callable[[Sample], None],
        urgency: Urgency = Urgency.SIGNAL,
        *,
        direct: bool = False,
    ) -> Undo:
        """Receive every sample put on a key from now on; those of EVENT before those of other urgencies.

        If `direct`, `receive` is called on whatever thread a sample arrives on, ahead of everything in the queues of
        the bus. It must return at once: nothing else arrives meanwhile. So it puts the sample into a queue of its own,
        and may call `wake_up` and `put`, but nothing else of the bus. Calls do not overlap, and samples of one
        publisher keep their order. Once the undo has returned, no call is under way and none will come; so the undo
        must not be called while holding a lock that `receive` waits for.
        """
        ...

    def serve(self, key: str, answer: Callable[[Request], None], *, complete: bool = False) -> Undo:
        """Answer questions to a key.

        `complete` says that this node has all there is below the key, which some programs other than selfconf ask for.
        """
        ...

    def ask(
        self, key: str, payload: bytes, seconds: float, done: Callable[[Replies], None], attachment: bytes = b""
    ) -> None:
        """Ask all queryables of a key; `done` receives all replies at once, when the last queryable has finished."""
        ...

    def announce(self, key: str) -> Undo:
        """Be alive under a key until undone, or until this node is gone."""
        ...

    def watch(
        self, key: str, changed: Callable[[str, bool], None], *, history: bool = True, many: bool = False
    ) -> Undo:
        """Follow every life under a key: those that are there already, those that begin, those that end.

        Without `history` those that are there already are not reported; nor is it, when this node loses its hub, that
        they have ended. When it has one again, all that live are. `many` says that thousands may come at once.
        """
        ...

    def roll_call(self, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        """The keys that are alive right now."""
        ...

    def poll(self, seconds: float = 0.0) -> None:
        """Run every callback that is due; if there is none, wait up to that long for the first."""
        ...

    def run_aside(self) -> bool:
        """Run callbacks on a thread of their own from now on; False, and nothing else, on a bus in simulated time."""
        ...

    def run(self, until: Callable[[], bool]) -> None:
        """Run callbacks until `until` holds."""
        ...

    def close(self) -> None:
        """Leave the network: what was declared is taken back, and no callback is run any more."""
        ...
