"""What a program hands from the thread of its bus to the one that does what takes long, so that the bus never waits."""

from __future__ import annotations

import math
import threading
import time
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from selfconf.rdf.deadline import Abandoned, abandonable

if TYPE_CHECKING:
    from selfconf.model.run_event import AnyRunEvent

UNDISTURBED = 0.2
"""For how many seconds there must have been nothing else before something begins that nothing waits for: other programs
that have begun at the same time want the processors too."""
MOST_UNDISTURBED = 5.0
"""For how many seconds at most, where it was interrupted again and again: it is begun anew each time."""

HELD_UP = 0.05
"""For how many seconds a job may wait for the events before it to be read: a reader is to hear what has led to a long
search, and one that takes long over each event is to hold up no search."""

MOST_AT_LEISURE = 30.0
"""For how many seconds something is done that nothing waits for: a search may go on for hours."""


@dataclass(frozen=True, eq=False, slots=True)
class _Job:
    """Work that takes long, and its owner; what is to be done twice is two jobs."""

    do: Callable[[], None]
    owner: str
    after: int = 0
    """How many events were reported before it."""
    since: float = -math.inf
    """Since when it waits, as told by the monotonic clock."""


@dataclass(eq=False, slots=True)
class _Leisurely:
    """What nothing waits for, and for how many seconds there must have been nothing else before it begins."""

    do: Callable[[], None]
    undisturbed: float


class WorkQueue:
    """What a run hands from the thread of its bus to the thread that reads its events: jobs and events, in order.

    A job overtakes events that are not read for `HELD_UP` seconds.
    """

    def __init__(self) -> None:
        self._jobs: deque[_Job] = deque()
        self._under_way: tuple[_Job, Callable[[], None]] | None = None
        """The job that is being done, and what ends it."""
        self._until_more: Callable[[], None] | None = None
        """What ends that which is done only until there is something else."""
        self._leisurely: dict[str, _Leisurely] = {}
        """What is to be done when there is nothing else, one thing for each owner; what was interrupted comes last."""
        self._disturbed = -math.inf
        """When there was something else to do, as told by the monotonic clock."""
        self._events: deque[AnyRunEvent] = deque()
        self._read = 0
        """How many events were read."""
        self._more = threading.Condition()
        self._woken = False

    def add(self, work: Callable[[], None], owner: str = "") -> Callable[[], None]:
        """Have something done that takes long, for an owner where there are several; calling the result abandons it."""
        with self._more:
            one = _Job(work, owner, self._read + len(self._events), time.monotonic())
            self._jobs.append(one)
            self._notify()
        return partial(self._abandon, one)

    def at_leisure(self, work: Callable[[], None], owner: str) -> None:
        """Have `next` do something when there has been nothing else for a while, in place of what that was before.

        What comes in the middle of it is done first, and then this anew, after what waits for other owners and when
        there has been nothing else for twice as long. What takes longer than `MOST_AT_LEISURE` is ended and forgotten;
        so is all outside of the main thread, where nothing could end it.
        """
        with self._more:
            before = self._leisurely.get(owner)
            self._leisurely[owner] = _Leisurely(work, UNDISTURBED if before is None else before.undisturbed)
            self._disturbed = time.monotonic()
            self._notify()

    def _abandon(self, one: _Job) -> None:
        """End and forget one job, if it is not over."""
        with self._more:
            if one in self._jobs:
                self._jobs.remove(one)
            elif self._under_way is not None and self._under_way[0] is one:
                self._under_way[1]()

    def abandon(self, owner: str = "") -> None:
        """End and forget what is done for an owner, or for all if none is named; `next` returns soon."""
        with self._more:
            for job in [job for job in self._jobs if owner in ("", job.owner)]:
                self._jobs.remove(job)
            for one in [one for one in self._leisurely if owner in ("", one)]:
                del self._leisurely[one]
            if self._under_way is not None and owner in ("", self._under_way[0].owner):
                self._under_way[1]()
            self._woken = True
            self._notify()

    def report(self, event: AnyRunEvent) -> None:
        """Hand an event over."""
        with self._more:
            self._events.append(event)
            self._notify()

    def wake_up(self) -> None:
        """Let `next` return at once."""
        with self._more:
            self._woken = True
            self._notify()

    def _notify(self) -> None:
        """There is something to do: nothing goes on that is done only until then."""
        if self._until_more is not None:
            self._until_more()
        self._more.notify()

    def until_more(self, work: Callable[[], None], after: float = 0.0) -> bool:
        """Do something that is ended as soon as there is something else to do; whether it has come to its own end.

        It is begun once there has been nothing else for `after` seconds. Outside of the main thread, where nothing
        could end it, it is not begun.
        """
        if threading.current_thread() is not threading.main_thread():
            return False
        try:
            with abandonable() as abandon:
                with self._more:
                    if self._more.wait_for(lambda: self._has_more, after):
                        return False
                    self._until_more = abandon
                work()
            return True
        except Abandoned:
            return False
        finally:
            self._until_more = None

    @property
    def _has_more(self) -> bool:
        return bool(self._jobs or self._events or self._woken)

    def next(self, seconds: float) -> AnyRunEvent | None:
        """Do the jobs that come before the next event, and return that; None if none has come after that long."""
        with self._more:
            if not self._has_more and seconds > 0:
                self._more.wait(min(seconds, self._until_leisure))
            disturbed, self._woken = self._has_more, False
            if self._comes_later():
                self._disturbed = time.monotonic()
                return self._read_event()
            waiting = len(self._jobs)
        for _ in range(waiting):
            self._do_first()  # one at a time: where one breaks, the others wait for the next call
        if disturbed:
            self._disturbed = time.monotonic()
        self._do_at_leisure()
        with self._more:
            return self._read_event()

    def _comes_later(self) -> bool:
        """Whether the first job that waits comes after an event that has not been read yet."""
        first = next(iter(self._jobs), None)
        return first is not None and self._read < first.after and time.monotonic() - first.since < HELD_UP

    def _read_event(self) -> AnyRunEvent | None:
        if not self._events:
            return None
        self._read += 1
        return self._events.popleft()

    @property
    def _until_leisure(self) -> float:
        """In how many seconds something is done at leisure, if nothing else comes; infinite if nothing is to be."""
        if not self._leisurely:
            return math.inf
        least = min(one.undisturbed for one in self._leisurely.values())
        return max(0.0, self._disturbed + least - time.monotonic())

    def _do_at_leisure(self) -> None:
        """Do what waits for the shortest time in which there is nothing else, if that has passed."""
        with self._more:
            if not self._leisurely or self._until_leisure > 0:
                return
            owner, one = min(self._leisurely.items(), key=lambda each: each[1].undisturbed)
        over, too_long = True, threading.Event()
        limit = threading.Timer(MOST_AT_LEISURE, self._end_leisure, (too_long,))
        limit.daemon = True
        limit.start()
        try:
            over = self.until_more(one.do) or threading.current_thread() is not threading.main_thread()
        finally:
            limit.cancel()
            over = over or too_long.is_set()
            with self._more:
                if not over:
                    self._put_last(owner)
                elif self._leisurely.get(owner) is one:
                    del self._leisurely[owner]

    def _end_leisure(self, too_long: threading.Event) -> None:
        """End what is done at leisure, as it takes too long."""
        too_long.set()
        with self._more:
            if self._until_more is not None:
                self._until_more()

    def _put_last(self, owner: str) -> None:
        """Let what was interrupted wait for a longer time in which there is nothing else, and for other owners."""
        one = self._leisurely.pop(owner, None)
        if one is not None:  # neither has it been abandoned
            one.undisturbed = min(2 * one.undisturbed, MOST_UNDISTURBED)
            self._leisurely[owner] = one

    def do(self, work: Callable[[], None]) -> bool:
        """Do something now; whether it has come to its own end, and was not abandoned."""
        with self._more:
            self._jobs.appendleft(_Job(work, ""))
        return self._do_first()

    def _do_first(self) -> bool:
        """Do what has waited for the longest, unless it is abandoned, or has been meanwhile; whether it is done."""
        try:
            with abandonable() as abandon:
                with self._more:
                    if not self._jobs:
                        return False
                    job = self._jobs.popleft()
                    self._under_way = job, abandon
                job.do()
            return True
        except Abandoned:
            return False
        finally:
            self._under_way = None
