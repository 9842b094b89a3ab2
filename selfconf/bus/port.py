"""What the programs of selfconf ask of a network.

A bus belongs to one thread: everything it has to say (samples, requests, replies, lives, timers) is said by calling
back inside `run` or `poll`, one call after the other, in order of arrival. So a program needs no locks, and the same
program runs in a simulated network with a clock turned by hand. The one exception: `Publisher.put` and `wake_up` may
be called from any thread.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Protocol


class Urgency(str, Enum):
    """How a sample is to be treated when the network is short of room."""

    SIGNAL = "signal"
    """Small and frequent: the newest counts, an old one may be dropped."""
    BULK = "bulk"
    """Images and the like: dropped first."""
    EVENT = "event"
    """FAIL and the like: never dropped, and ahead of everything else, between nodes that reach each other.

    Nothing is kept for a subscriber that was cut off: that shows as a life that ended, which says more.
    """


@dataclass(frozen=True, slots=True)
class Sample:
    """What was put, or replied, on a key."""

    key: str
    payload: bytes
    attachment: bytes = b""


@dataclass(frozen=True, slots=True)
class Replies:
    """All the replies to a question; not `complete` if somebody who might have answered did not in time."""

    samples: tuple[Sample, ...] = ()
    errors: tuple[str, ...] = ()
    complete: bool = True


class Request(Protocol):
    """A question to a queryable; nobody hears the end of the answer before `finish`."""

    @property
    def key(self) -> str:
        """The key that was asked; it may hold wildcards."""
        ...

    @property
    def payload(self) -> bytes:
        """What came with the question."""
        ...

    def reply(self, key: str, payload: bytes, attachment: bytes = b"") -> None:
        """One reply, on a concrete key of one's own."""
        ...

    def refuse(self, reason: str) -> None:
        """Reply that it cannot be answered."""
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
        """By what this node reaches the network; empty if it does not. Another one than before: it was cut off.

        That others seem dead says nothing about them if the link is not what it was.
        """
        ...

    def now(self) -> float:
        """Seconds of a clock that never goes back."""
        ...

    def later(self, seconds: float, action: Callable[[], None]) -> Undo:
        """Call `action` once, after that time."""
        ...

    def wake_up(self, action: Callable[[], None]) -> None:
        """Call `action` on the bus's thread, soon; may be called from any thread."""
        ...

    def publisher(self, key: str, urgency: Urgency, matched: Callable[[bool], None] | None = None) -> Publisher:
        """Declare a key to put on; `matched` hears when there begins to be, or ceases to be, a subscriber."""
        ...

    def subscribe(self, key: str, receive: Callable[[Sample], None], urgency: Urgency = Urgency.SIGNAL) -> Undo:
        """Hear every sample put on a key from now on."""
        ...

    def serve(self, key: str, answer: Callable[[Request], None]) -> Undo:
        """Answer questions to a key."""
        ...

    def ask(self, key: str, payload: bytes, seconds: float, done: Callable[[Replies], None]) -> None:
        """Ask everybody who serves a key; `done` hears all the replies at once, when the last one has finished."""
        ...

    def announce(self, key: str) -> Undo:
        """Be alive under a key until undone, or until this node is gone."""
        ...

    def watch(self, key: str, changed: Callable[[str, bool], None]) -> Undo:
        """Hear of every life under a key: those that are there already, those that begin, those that end."""
        ...

    def roll_call(self, key: str, seconds: float, done: Callable[[tuple[str, ...]], None]) -> None:
        """The keys that are alive right now."""
        ...

    def poll(self, seconds: float = 0.0) -> None:
        """Say everything there is to say; wait up to that long for something if there is nothing."""
        ...

    def run(self, until: Callable[[], bool]) -> None:
        """Say everything there is to say, until `until` holds."""
        ...

    def close(self) -> None:
        """Leave the network: what was declared is taken back, and nothing is said any more."""
        ...
