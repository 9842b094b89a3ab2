"""A timer: an action that is done once for all that ask for it within a while, unless it is taken back before."""

from __future__ import annotations

from collections.abc import Callable

from selfconf.bus.port import Bus, Undo


class Timer:
    """Does something on the thread of a bus some seconds after it is set, however often it is set meanwhile.

    It is set and taken back on that thread alone.
    """

    def __init__(self, bus: Bus, seconds: float, action: Callable[[], None]) -> None:
        """`seconds` is how long it takes where it is set to no other time."""
        self._bus, self._seconds, self._action = bus, seconds, action
        self._undo: Undo | None = None

    @property
    def is_set(self) -> bool:
        """Whether the action is about to be done."""
        return self._undo is not None

    def set(self, seconds: float | None = None) -> None:
        """Do it after so many seconds, by default those that are usual, unless the time is set already."""
        if self._undo is None:
            self._undo = self._bus.later(self._seconds if seconds is None else seconds, self._do)

    def reset(self, seconds: float | None = None) -> None:
        """Do it after so many seconds from now on, whatever time was set before."""
        self.stop()
        self.set(seconds)

    def stop(self) -> None:
        """Do it only once it is set anew."""
        if self._undo is not None:
            self._undo()
            self._undo = None

    def _do(self) -> None:
        self._undo = None
        self._action()
