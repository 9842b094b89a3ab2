"""The supervision of a component: it obeys a configurator only as long as that is alive.

When the configurator's liveliness token has been gone for `GRACE` seconds, or this node is cut off from it for that
long, the component turns itself off. Meanwhile another configurator may take it over.
"""

from __future__ import annotations

from collections.abc import Callable

from selfconf.bus.port import Bus, Undo
from selfconf.sdk.outputs import SIGNALS_FIRST

GRACE = 1.0
"""Seconds after which a component without a living supervisor turns itself off."""


class Supervision:
    """Watches the life of the configurator that supervises one component."""

    def __init__(self, bus: Bus, orphaned: Callable[[], None]) -> None:
        """`orphaned` is called when the supervisor has been gone for the grace period."""
        self._bus, self._orphaned = bus, orphaned
        self._supervisor = ""
        """The liveliness key that is watched; empty for none."""
        self._watch: Undo | None = None
        self._grace: Undo | None = None
        self.gone = False
        """Whether the supervisor's life was seen to end."""

    def begin(self, supervisor: str) -> None:
        """Watch the life of a supervisor, given by its liveliness key, instead of the one before."""
        if supervisor == self._supervisor:
            return
        self.end()
        self._supervisor = supervisor
        self._begin_grace()  # until its life is seen for the first time
        self._bus.later(SIGNALS_FIRST, lambda: self._begin_watch(supervisor))

    def end(self) -> None:
        """Watch nothing."""
        if self._watch is not None:
            self._watch()
        self._watch, self._supervisor, self.gone = None, "", False
        self._end_grace()

    def _begin_watch(self, supervisor: str) -> None:
        """Watch the supervisor's life, unless the component was turned off or taken over meanwhile."""
        if self._supervisor == supervisor and self._watch is None:
            self._watch = self._bus.watch(supervisor, self._changed)

    def _changed(self, _: str, alive: bool) -> None:
        self.gone = not alive
        if alive:
            self._end_grace()
        else:
            self._begin_grace()

    def _begin_grace(self) -> None:
        if self._grace is None:
            self._grace = self._bus.later(GRACE, self._end_of_grace)

    def _end_grace(self) -> None:
        if self._grace is not None:
            self._grace()
            self._grace = None

    def _end_of_grace(self) -> None:
        self._grace = None
        self._orphaned()
