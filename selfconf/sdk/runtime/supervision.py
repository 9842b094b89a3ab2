"""The supervision of a component: it acts for a task only as long as the configurator of that task is alive.

When a configurator's liveliness token has been gone for `GRACE` seconds, or this node is cut off from it for that long,
the component acts for its task no more. Meanwhile another configurator may go on with the task, and another task may
have the component. All of this happens on the thread of the bus, whatever the component's code does.
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from functools import partial

from selfconf.bus.port import Bus, Undo
from selfconf.bus.timer import Timer
from selfconf.sdk.outputs import SIGNALS_FIRST

GRACE = 1.0
"""Seconds after which a component without a living supervisor turns itself off."""


class Supervision:
    """Watches the lives of the configurators for which one component is held."""

    def __init__(self, bus: Bus, orphaned: Callable[[str], None]) -> None:
        """`orphaned` is called with the liveliness key of a supervisor that has been gone for the grace period."""
        self._bus, self._orphaned = bus, orphaned
        self._watched: dict[str, _Watched] = {}

    @property
    def gone(self) -> frozenset[str]:
        """The supervisors whose life was seen to end."""
        return frozenset(supervisor for supervisor, watched in self._watched.items() if watched.gone)

    @property
    def unseen(self) -> frozenset[str]:
        """The supervisors that were not seen to live yet."""
        return frozenset(supervisor for supervisor, watched in self._watched.items() if not watched.seen)

    def watch(self, supervisors: Collection[str]) -> None:
        """Watch exactly these supervisors, given by their liveliness keys."""
        for supervisor in [one for one in self._watched if one not in supervisors]:
            self._watched.pop(supervisor).end()
        for supervisor in supervisors:
            if supervisor not in self._watched:
                self._watched[supervisor] = _Watched(self._bus, supervisor, self._orphaned)


class _Watched:
    """One supervisor: whether it is alive, and how long it may be gone."""

    def __init__(self, bus: Bus, supervisor: str, orphaned: Callable[[str], None]) -> None:
        self._bus, self._supervisor = bus, supervisor
        self.gone = False
        """Whether its life was seen to end."""
        self.seen = False
        """Whether it was seen to live."""
        self._grace = Timer(bus, GRACE, partial(orphaned, supervisor))
        self._watch: Undo | None = None
        self._grace.set()  # until its life is seen for the first time
        self._undo_begin = bus.later(SIGNALS_FIRST, self._begin)

    def end(self) -> None:
        """Watch it no more."""
        self._undo_begin()
        if self._watch is not None:
            self._watch()
        self._grace.stop()

    def _begin(self) -> None:
        self._watch = self._bus.watch(self._supervisor, self._changed)

    def _changed(self, _: str, alive: bool) -> None:
        self.gone, self.seen = not alive, True
        if alive:
            self._grace.stop()
        else:
            self._grace.set()
