"""What an input knows of one output that it follows: what waits to be read, when the newest came, whether it is lost.

What arrives waits in a queue of its own for each output that an input follows, until the component's code has time.
The queue is bounded: the newest signal counts of an output that promises a rate, and of one that does not as many are
kept as events may need (`signal_queue`); `sc:depth` of the input says otherwise. What is dropped is counted.

Nothing here speaks with the bus: `last_signal` asks the output, and `source_watch` decides whether it is lost.
"""

from __future__ import annotations

from collections.abc import Callable

from selfconf.bus.port import Replies, Sample
from selfconf.errors import PeerError
from selfconf.protocol.messages import Stamp
from selfconf.protocol.stamps import StampReader
from selfconf.sdk.inputs.signal_order import NONE, SignalNumber, SignalOrder
from selfconf.sdk.inputs.signal_queue import SignalQueue

JUST_COME = 0.5
"""Seconds for which the newest signal of an output that stood by counts when the output becomes an input's own."""


class FollowedOutput:
    """Filled by the thread that signals arrive on, emptied by that of the component's code, judged by the bus's.

    While it is muted, because it only stands by or the connection is about to end, it keeps the newest signal alone:
    that counts if it is unmuted right after.
    """

    def __init__(self, now: Callable[[], float], queue: SignalQueue, waits: Callable[[], None]) -> None:
        """`now` is the bus's clock, in seconds; `waits` is called for each signal that waits to be delivered."""
        self._now, self._queue, self._waits = now, queue, waits
        self._stamps = StampReader()
        self.order = SignalOrder()
        self.lives: set[str] = set()
        """The lives of its component that are seen to live."""
        self.muted = True
        self.ended = False
        """Whether it is followed no more."""
        self.lost = False
        """Whether it can issue nothing any more, as far as is known."""
        self.heard_at = -JUST_COME
        """When the newest signal came, in seconds of the bus's clock."""
        self.understood_at = self.heard_at
        """When the newest signal was read that could be: what cannot be read is no sign that the output issues."""
        self._complained = False

    @property
    def dropped(self) -> int:
        """How many signals were dropped because the component's code was too slow."""
        return self._queue.dropped

    @property
    def issued(self) -> bool:
        """Whether it has issued a signal since it is listened to."""
        return self.heard_at >= 0.0

    @property
    def just_issued(self) -> bool:
        """Whether it has just issued a signal, so that the input that follows it from now on is fed.

        None that it may have issued for a task of which it has let go.
        """
        return bool(self._queue) and self.order.doubted is None and self._now() - self.heard_at < JUST_COME

    @property
    def heard_life(self) -> str:
        """The life that has issued the newest signal, which may still wait: the code may be busy, as in `started`."""
        waiting = self._queue.newest()
        stamp = self._stamp_of(waiting) if waiting is not None else None
        return self.order.newest.life if stamp is None else stamp.life

    def unmute(self) -> bool:
        """Keep what comes from now on, and the newest signal if that has only just come; whether it has."""
        just_issued = self.just_issued
        self._queue.keep(1 if just_issued else 0)
        self.muted = False
        return just_issued

    def deliver(self) -> None:
        """Have what waits already delivered, after `unmute`."""
        if self._queue:
            self._waits()

    def mute(self) -> None:
        """Pass over what comes."""
        self.muted = True
        self._queue.keep(0)
        self.order.newest = NONE  # what the input follows it again for may be what it has had before

    def forget(self) -> None:
        """Drop what waits."""
        self._queue.keep(0)

    def receive(self, sample: Sample) -> None:
        """Let a signal wait that comes, unless it was issued before its source failed or let go of its task."""
        stamp = self._stamp_of(sample) if self.order.is_in_question else None
        if stamp is not None:
            if self.order.is_over(stamp):
                return
            self.order.settle(stamp, self.lives.__contains__)
        self.heard_at = self._now()
        if self.muted:
            self._queue.keep(0)
        grown = self._queue.append(sample)
        if grown and not self.muted:  # as many reads are due as there are signals
            self._waits()

    def receive_again(self, replies: Replies) -> None:
        """Let the last signal wait, by which an output has answered, unless there is one that is newer."""
        for sample in () if self.ended else replies.samples:
            stamp = self._stamp_of(sample)
            if stamp is not None:
                self.order.said_again = SignalNumber(stamp.life, stamp.sequence)
            if stamp is not None and self.order.is_old(stamp, self.lost):
                self.heard_at = self._now()  # but it takes no room: a new signal would be driven out for it
            elif not self._queue or (self.muted and stamp is not None and not self._has_come(stamp)):
                self.receive(sample)

    def pop(self) -> Sample | None:
        """The oldest signal that waits to be delivered; none may be left, as the queue keeps the newest only."""
        return None if self.muted else self._queue.pop()

    def stamp(self, sample: Sample) -> tuple[bool, Stamp]:
        """Whether a signal is bytes and not JSON, and its stamp. Raises PeerError for what is no stamp."""
        return self._stamps.read(sample.attachment)

    def not_understood(self) -> bool:
        """Take note that a signal could not be read; whether the one before could be."""
        first = not self._complained
        self._complained, self.heard_at = True, self.understood_at
        return first

    def understood(self) -> None:
        """Take note that a signal could be read."""
        if self._complained:
            self._complained, self.heard_at = False, self._now()
        self.understood_at = self.heard_at

    def _has_come(self, stamp: Stamp) -> bool:
        """Whether a signal, or one that was issued after it, is the newest that waits."""
        waiting = self._queue.newest()
        newest = self._stamp_of(waiting) if waiting is not None else None
        return newest is not None and SignalNumber(newest.life, newest.sequence).covers(stamp)

    def _stamp_of(self, sample: Sample) -> Stamp | None:
        """The stamp of a signal; None if that cannot be read."""
        try:
            return self.stamp(sample)[1]
        except PeerError:
            return None
