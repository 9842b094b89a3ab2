"""An action that is done once for all that ask for it within a while."""

from __future__ import annotations

from collections.abc import Callable

from selfconf.bus.port import Bus


class Coalesced:
    """Does something on the thread of a bus some seconds after it is called, however often that is meanwhile."""

    def __init__(self, bus: Bus, seconds: float, action: Callable[[], None]) -> None:
        self._bus, self._seconds, self._action = bus, seconds, action
        self._is_due = False

    def __call__(self, seconds: float | None = None) -> None:
        """Do it after so many seconds, by default those that are usual, unless the time is set already."""
        if not self._is_due:
            self._is_due = True
            self._bus.later(self._seconds if seconds is None else seconds, self._do)

    def _do(self) -> None:
        self._is_due = False
        self._action()
