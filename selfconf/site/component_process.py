"""One process of a component program, with the lives of its components as far as its site follows them."""

from __future__ import annotations

import math
from collections.abc import Iterable
from enum import Enum

from selfconf.bus.port import Bus
from selfconf.model.profile import Profile
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Cause
from selfconf.site.life_watch import LifeWatch
from selfconf.site.process_group import ProcessGroup

MOST_WATCHED = 8
"""Of how many components of a process the lives are followed: they share a process, and if that hangs, they all do."""
SEEN_BY_ALL = 1.0
"""Seconds for which a component must have lived before all that wait for it count as having seen that."""


class CountedAs(Enum):
    """What the end of a process, which may be still to come, was counted as."""

    OPEN = "open"
    """As nothing yet: it is a crash if a task has lost by it what it held."""
    CRASH = "crash"
    WANTED = "wanted"
    """As what a person wants: that is no crash, whatever a task has lost by it."""


class ComponentProcess:
    """One started process, and what the site has seen of it."""

    def __init__(self, bus: Bus, keys: Keys, group: ProcessGroup, life: str) -> None:
        """`life` is the name that its components were given for their lives; each may choose another one."""
        self._bus, self._keys, self.group, self.life = bus, keys, group, life
        self._watches: dict[IRI, LifeWatch] = {}
        self._closed = False
        self.counted_as = CountedAs.OPEN
        self.asked_for = False
        """Whether it was asked for while it ran: by a task that saw no life of it."""
        self.silent_since = -math.inf
        """When one of its pipes has ended; long ago as long as none has."""

    def follow(self, profiles: Iterable[Profile]) -> None:
        """Follow the lives of its components, of so many as are followed."""
        for profile in profiles:
            if profile.component not in self._watches and len(self._watches) < MOST_WATCHED:
                self._watches[profile.component] = LifeWatch(self._bus, self._keys, profile, self.life)

    def close(self) -> None:
        """There is nothing left of it: follow no life any more."""
        self._closed = True
        for watch in self._watches.values():
            watch.close()

    @property
    def lived(self) -> bool:
        """Whether one of its components has had a life."""
        return any(watch.lived for watch in self._watches.values())

    @property
    def is_waited_for(self) -> bool:
        """Whether it was asked for while it ran, and what has asked may not have seen its components live since."""
        return self.asked_for and all(watch.lives_for < SEEN_BY_ALL for watch in self._watches.values())

    def is_life(self, component: IRI, life: str) -> bool:
        """Whether a life of a component is its own, as far as is known."""
        watch = None if self._closed else self._watches.get(component)
        return life == self.life or (watch is not None and watch.is_life(life))

    def was_life(self, life: str) -> bool:
        """Whether a life, which may have ended, was that of one of its components, as far as is known."""
        return any(watch.was_life(life) for watch in self._watches.values())

    def last_life(self, component: IRI) -> str:
        """The life that a component has, or had last; empty if it had none, or it is not known which was the last."""
        watch = self._watches.get(component)
        return "" if watch is None else watch.last_life

    def trouble(self) -> tuple[Cause, str] | None:
        """Why it has to be ended, also in words: a component of it hangs, or none of them lives."""
        living = [watch for watch in self._watches.values() if watch.alive]
        if living:
            return next(((Cause.HUNG, found) for watch in living if (found := watch.hanging())), None)
        frozen, watches = self.group.frozen(), self._watches.values()
        return next(((Cause.CRASH, found) for watch in watches if (found := watch.lifeless(frozen))), None)
