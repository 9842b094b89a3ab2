"""What a component does while a required input is unfed: its code is called, and an actuator rests until it is fed.

An input is unfed from the loss of its last source to the first signal of the next. An actuator, a component without
outputs, whatever operations it offers, is stopped when a required input has been unfed for longer than it tolerates,
and started again by that signal; calls of its operations are refused meanwhile.
"""

from __future__ import annotations

from collections.abc import Callable
from math import inf

from selfconf.bus.port import Bus
from selfconf.bus.timer import Timer

TOLERATES = 1.0
"""Seconds for which an actuator acts on with an unfed input, unless its advertisement says otherwise."""


class UnfedInputs:
    """The unfed inputs of one component, and whether it rests because of those that it requires."""

    def __init__(self, bus: Bus, required: frozenset[str], tolerates: float | None, rest: Callable[[], None]) -> None:
        """`rest` is called on the bus's thread when a required input was unfed for too long; None: never."""
        self._bus, self._required, self._tolerates, self._rest = bus, required, tolerates, rest
        self.unfed: dict[str, float] = {}
        """The inputs that are unfed, each with the time since when, by the clock of the bus."""
        self._timer = Timer(bus, tolerates or 0.0, self._too_long)
        self._amiss = inf
        """Since when something has been amiss, by the clock of the bus, while an input is unfed."""

    @property
    def blind(self) -> bool:
        """Whether a required input is unfed."""
        return not self._required.isdisjoint(self.unfed)

    def begin(self, port: str) -> bool:
        """Note on the bus's thread that an input is unfed; whether that is new."""
        if port in self.unfed:
            return False
        self.unfed[port] = self._bus.now()
        if self._tolerates is not None and port in self._required:
            self._timer.set()
        return True

    def has_lasted(self, seconds: float) -> None:
        """Count each unfed input as unfed for so many seconds at least: as long as something has been amiss."""
        if self._timer.is_set:
            self._amiss = self._bus.now() - seconds  # apart from `unfed`: the code's thread may take one out meanwhile
            self._timer.stop()
            self._too_long()

    def end(self, port: str) -> bool:
        """Note on the thread of the component's code that an input is fed; whether it was unfed."""
        if port not in self.unfed:
            return False
        self.unfed.pop(port, None)
        self._bus.wake_up(self._look)
        return True

    def forget(self) -> None:
        """Forget everything: the component is off."""
        self.unfed.clear()
        self._look()

    def _look(self) -> None:
        if self.blind:
            return
        self._amiss = inf
        self._timer.stop()

    def _too_long(self) -> None:
        longest = max(
            (
                self._bus.now() - min(since, self._amiss)
                for port, since in list(self.unfed.items())
                if port in self._required
            ),
            default=None,
        )
        if longest is None or self._tolerates is None:
            return
        if longest < self._tolerates:  # another input was unfed when the timer began, and is fed by now
            self._timer.set(self._tolerates - longest)
        else:
            self._rest()
