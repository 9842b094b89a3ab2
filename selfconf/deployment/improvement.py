"""When a task that runs looks whether something would be rather had than what runs.

What has appeared is looked at once it has been there for a while. Another task that lets go of something tells only
those that wait for it, so a task that left something to others looks again after a while.
"""

from __future__ import annotations

from collections.abc import Iterable

from selfconf.bus.timer import Timer
from selfconf.configurator import Improvable
from selfconf.deployment.task_context import TaskContext
from selfconf.model.term import IRI

MOST_UNREST = 4
"""How many times as long as usual what has appeared has to settle at most, while something comes all the time."""
LET_GO_OF = 10.0
"""After how many seconds a task looks again whether another has let go of something."""


class Improvement:
    """The timers by which one task looks for something better; a task that is to keep what runs never does."""

    def __init__(self, context: TaskContext) -> None:
        self._bus, self._step = context.ecology.bus, context.step
        self._settling = context.request.upgrade
        """After how many seconds what has appeared may be rather had; None: what runs is kept."""
        self._look_soon = Timer(context.ecology.bus, 0.0, self._look)
        self._look_at_others = Timer(context.ecology.bus, LET_GO_OF, self._look)
        self._at_the_latest: float | None = None
        """By when it is looked however much appears; None: nothing that has appeared waits to be looked at."""
        self._unsettled: dict[IRI, float] = {}
        """The components that have appeared of late, each with when it will have been there for long enough."""

    def settle(self, appeared: Iterable[IRI] = ()) -> None:
        """Look, after a while, whether what has appeared would be rather had; each time anew, so that it settles.

        Not forever: in a large ecology there is always something that comes.
        """
        if self._settling is None:
            return
        now = self._bus.now()
        self._unsettled |= dict.fromkeys(appeared, now + self._settling)
        if self._at_the_latest is None:
            self._at_the_latest = now + MOST_UNREST * self._settling
        self._look_soon.reset(max(0.0, min(self._settling, self._at_the_latest - now)))

    def look_whether_free(self) -> None:
        """Look, after a while, whether what was left to other tasks is free."""
        if self._settling is not None:
            self._look_at_others.reset()

    def _look(self) -> None:
        """Look at what has been there for long enough, and at the rest once it has."""
        now, self._at_the_latest = self._bus.now(), None
        self._unsettled = {component: until for component, until in self._unsettled.items() if until > now}
        self._step(Improvable(frozenset(self._unsettled)))
        if self._unsettled:
            assert self._settling is not None
            self._at_the_latest = min(self._unsettled.values()) + (MOST_UNREST - 1) * self._settling
            self._look_soon.reset(max(self._unsettled.values()) - now)
