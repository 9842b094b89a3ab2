"""What a component wants done at intervals, until it stops or fails."""

from __future__ import annotations

import math
from collections.abc import Callable
from numbers import Real

from selfconf.bus.port import Bus, Undo
from selfconf.errors import ProgrammerError
from selfconf.sdk.component_code import ComponentCode


class ComponentTimers:
    """The intervals of one component."""

    def __init__(self, bus: Bus, code: ComponentCode) -> None:
        self.bus, self.code = bus, code
        self.running: set[_Interval] = set()

    def every(self, seconds: float, action: Callable[[], None]) -> None:
        """Call `action` at that interval until the component stops or fails; a call that is late is not made up for.

        May be called from any thread. Raises ProgrammerError for an interval that is none, and for an action
        that cannot be called.
        """
        if not isinstance(seconds, Real) or not 0.0 < seconds < math.inf:
            raise ProgrammerError(f"`every` takes an interval of more than zero seconds, not {seconds!r}")
        if not callable(action):
            raise ProgrammerError(f"`every` takes a function to call, such as self.measure, not {action!r}")
        interval = _Interval(self, seconds, action)
        if self.code.on_bus_thread:
            interval.begin()
        else:
            self.bus.wake_up(interval.begin)

    def end(self) -> None:
        """Do nothing at intervals any more."""
        for interval in self.running:
            interval.undo()
        self.running.clear()


class _Interval:
    """What is done again and again, in one stint of the code."""

    def __init__(self, timers: ComponentTimers, seconds: float, action: Callable[[], None]) -> None:
        self._timers, self._seconds, self._action = timers, seconds, action
        self._stint = timers.code.stint
        self._due = False
        """Whether the code has been asked to do it, and has not begun yet."""
        self.undo: Undo = lambda: None

    def begin(self) -> None:
        """Wait for the first time, unless the code has been stopped since it asked; on the bus's thread."""
        if self._stint == self._timers.code.stint:
            self._timers.running.add(self)
            self._wait()

    def _wait(self) -> None:
        self.undo = self._timers.bus.later(self._seconds, self._tick)

    def _tick(self) -> None:
        code = self._timers.code
        if not code.active or self._stint != code.stint:
            self._timers.running.discard(self)
            return
        self._wait()
        if not self._due:
            self._due = True
            code.tick(self._run)

    def _run(self) -> None:
        """Do it, unless the code was stopped while this waited for it, though it may have been started again."""
        self._due = False
        if self._stint == self._timers.code.stint:
            self._action()
