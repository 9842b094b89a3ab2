"""The thread on which the code of components runs, apart from the thread of the bus.

What a component does with a signal may take its time; a call of a configurator, or the end of its life, may not wait
for that. So the bus has a thread of its own, and hands to the code's thread what is to be done there: calls before
signals, calls in their order, signals in the order in which their queues have begun to wait, in turns with what is to
be done at intervals. A queue of signals is bounded, so a slow component costs neither memory nor supervision.

`CodeThread.overdue` is for the bus's thread: it names the code that has not returned within its deadline, without any
help of that code. While a component is to come to rest, no code may take longer than a site would wait for that,
whatever its deadline: it may turn a motor for a task that is gone. On a bus in simulated time all of this happens at
once, in the one thread there is.
"""

from __future__ import annotations

import math
import queue
import time
from collections import deque
from collections.abc import Callable
from typing import NamedTuple, TypeVar

Action = Callable[[], None]
_Result = TypeVar("_Result")
RUSH = 0.0002
"""Seconds between actions below which the thread lets some come together before it goes on.

Else it would be woken for each signal of many, and in turns with the thread that these arrive on take most of its time
for that: interrupt coalescing. What comes less often is run at once.
"""
TO_REST = 2.0
"""Seconds that code may take while a component is to come to rest: as long as one may take to obey a release."""


class RunningCode(NamedTuple):
    """The code that runs now: whose, what it does, since when, and how long it may take, in seconds."""

    owner: object
    what: str
    began: float
    limit: float
    delays_rest: bool = False
    """Whether the time is that which it may take while a component is to come to rest."""

    @property
    def why_overdue(self) -> str:
        """What is said of it when it has not returned in that time."""
        when = ", though a component is to come to rest" if self.delays_rest else ""
        return f"`{self.what}` has not returned within {self.limit:g} s{when}"


class CodeThread:
    """Runs the code of the components of one host, one piece after the other, in the thread that polls."""

    def __init__(self, inline: bool) -> None:
        """`inline`: everything is run at once by the thread that hands it over; there is no other."""
        self.inline = inline
        self._running: tuple[object, str, float, float] | None = None
        """What `running` says; that is put in words only where it is asked for, not for each signal."""
        self._rests: deque[float] = deque()
        """Since when each component that is to come to rest is to do so, by the monotonic clock."""
        self._calls: deque[Action] = deque()
        self._signals: deque[Action] = deque()
        self._ticks: deque[Action] = deque()
        """What is to be done at intervals, and is due."""
        self._tick_was_last = False
        """Whether of signals and ticks, while both wait, a tick had the last turn."""
        self._in_rush = False
        """Whether the last action did not have to be waited for, or not for long."""
        self._asleep = False
        """Whether the thread is about to wait, or waits, and nothing has woken it yet."""
        self._woken: queue.SimpleQueue[None] = queue.SimpleQueue()
        """An entry for each time that the thread is to look around."""

    def call(self, action: Action) -> None:
        """Run what a call or the end of a supervision asks for; before any signal that waits."""
        self._put(self._calls, action)

    def rest(self, action: Action) -> None:
        """Run what brings a component to rest, as a call; nothing may take long until that is done."""

        def rest() -> None:
            try:
                action()
            finally:
                self._rests.popleft()  # the first: calls run in their order

        self._rests.append(time.monotonic())
        self.call(rest)

    def signal(self, action: Action) -> None:
        """Run what a signal asks for. May be called from any thread."""
        self._put(self._signals, action)

    def tick(self, action: Action) -> None:
        """Run what is to be done at intervals after one signal at most, however many wait, and before the next."""
        self._put(self._ticks, action)

    def _put(self, actions: deque[Action], action: Action) -> None:
        if self.inline:
            action()
            return
        actions.append(action)
        if self._asleep:  # looked at after the action is there, as the thread looks for actions after it is set
            self._asleep = False
            self._woken.put(None)

    def wake_up(self) -> None:
        """Let the thread that polls look whether to go on. May be called from any thread."""
        self._woken.put(None)

    def limited(self, owner: object, what: str, limit: float, action: Callable[[], _Result]) -> _Result:
        """Return what code of a component returns that may take so many seconds; `overdue` sees it meanwhile."""
        before, self._running = self._running, (owner, what, time.monotonic(), limit)
        try:
            return action()
        finally:
            self._running = before

    @property
    def running(self) -> RunningCode | None:
        """The code that runs now."""
        running = self._running
        return None if running is None else RunningCode(*running)

    def overdue(self, since: float = -math.inf) -> RunningCode | None:
        """The code that runs for longer than it may, by a time from which on that counts.

        For another thread, which that code does not hold up.
        """
        running = self.running
        if running is None:
            return None
        now, began = time.monotonic(), max(running.began, since)
        if now - began > running.limit:
            return running
        if now - max(began, self._rests_since) > TO_REST:
            return running._replace(limit=TO_REST, delays_rest=True)
        return None

    @property
    def _rests_since(self) -> float:
        """Since when some component is to come to rest."""
        try:
            return self._rests[0]
        except IndexError:  # the other thread may have taken out the last one by now
            return math.inf

    def poll(self, seconds: float = 0.0) -> None:
        """Run all that waits; if nothing does, wait up to that long for the first.

        Signals that come while these run wait for the next time: those that go in a circle would have no end.
        """
        action, left = self._next(seconds), len(self._signals) + len(self._ticks)
        while action is not None:
            action()
            if not self._calls:
                left -= 1
                if left < 0:
                    return
            action = self._next(0.0)

    def run(self, until: Callable[[], bool]) -> None:
        """Run what comes, until `until` holds; it is asked after each piece."""
        while not until():
            action = self._next(0.5)
            if action is not None:
                action()

    def _next(self, seconds: float) -> Action | None:
        """What is next, waited for so long; None if there is nothing, or the thread was woken."""
        if self._calls or self._signals or self._ticks:
            self._in_rush = True
        elif seconds > 0:
            if self._in_rush:
                time.sleep(RUSH)  # for no condition: meanwhile more actions come, to be run together
            began = time.monotonic()
            self._wait(seconds)
            self._in_rush = time.monotonic() - began < RUSH
        actions = self._calls or (self._in_turns() if self._ticks else self._signals)
        return actions.popleft() if actions else None

    def _in_turns(self) -> deque[Action]:
        """What comes next of ticks and signals, of which some wait: neither waits for all of the other."""
        self._tick_was_last = not (self._tick_was_last and self._signals)
        return self._ticks if self._tick_was_last else self._signals

    def _wait(self, seconds: float) -> None:
        """Wait until there is an action, or the thread is woken; not longer than that."""
        self._asleep = True
        try:
            if not (self._calls or self._signals or self._ticks):
                self._woken.get(timeout=seconds)
        except queue.Empty:
            pass
        finally:
            self._asleep = False
