"""When the hub of a site is opened anew, as Zenoh reads rules and certificates only then.

By the earliest time that was asked for, after a warning to all clients, as a hub takes these off one after the other;
and again, more and more rarely, for as long as that fails.
"""

from __future__ import annotations

import math
from collections.abc import Callable

from selfconf.bus.growing_pause import GrowingPause
from selfconf.bus.port import Bus, Undo, Urgency
from selfconf.errors import SelfconfError

WARNED = 0.05
"""Seconds between the word that a hub is about to be opened anew and that."""
FIRST_RETRY, RAREST_RETRY = 1.0, 30.0
"""After how many seconds it is tried again to open the hub, at first and at most."""


class HubReopening:
    """Opens one hub anew, as often as is needed."""

    def __init__(
        self,
        bus: Bus,
        reopens: str,
        relays: Callable[[], bool],
        open_anew: Callable[[], None],
        tell_fault: Callable[[str], None],
    ) -> None:
        """`reopens` is the key of the warning, without which it is opened where it does not relay.

        `open_anew` raises SelfconfError where that cannot be.
        """
        self._bus, self._relays, self._open_anew, self._tell_fault = bus, relays, open_anew, tell_fault
        self._warning = bus.publisher(reopens, Urgency.EVENT)
        self.is_near = False
        """Whether clients were warned, and it is opened anew in a moment."""
        self._due, self._pause = math.inf, GrowingPause(FIRST_RETRY, RAREST_RETRY)
        """When it is opened anew next, and how long is waited where that fails."""
        self._undo: Undo = lambda: None

    def within(self, seconds: float) -> None:
        """Open it anew after so many seconds at most: perhaps more changes meanwhile for which it has to be."""
        if not self.is_near and self._bus.now() + seconds < self._due:
            self._plan(seconds, self.now)

    def now(self) -> None:
        """Open it anew."""
        if not self._relays():
            self._open()
        elif not self.is_near:
            self.is_near = True
            self._warning.put(b"")
            self._plan(WARNED, self._open)

    def _plan(self, seconds: float, action: Callable[[], None]) -> None:
        self._undo()
        self._due, self._undo = self._bus.now() + seconds, self._bus.later(seconds, action)

    def _open(self) -> None:
        self._undo()
        self._due, self.is_near = math.inf, False
        try:
            self._open_anew()
        except SelfconfError as error:
            self._tell_fault(f"the hub cannot be opened with its new rules: {error}; trying again")
            self._plan(self._pause.seconds, self._open)
            self._pause.tried()
        else:
            self._pause.begin_anew()
