"""Other processes that are the same component: the life with the smallest name stays, all others leave.

Two processes that begin at the same moment see each other only when both are there, so each looks a second time a
moment later. Two that were cut off from each other, or one of which was frozen, may meet at any time. So a component
follows the lives of its own IRI while a task holds it. While no task holds it, it does nothing and need not look.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from selfconf.bus.port import Undo
from selfconf.protocol.keys import life_of
from selfconf.sdk.component_context import ComponentContext
from selfconf.sdk.outputs import SIGNALS_FIRST

LOOKS_FOR_OTHERS = (0.0, 1.0)
"""Seconds after the beginning of a life at which it is checked whether another process is the same component."""
LIVES_CALL = 3.0
"""Seconds that this may take."""


class OtherLives:
    """Looks for the other lives of one component."""

    def __init__(self, context: ComponentContext, outlived: Callable[[str], None]) -> None:
        """`outlived` hears of a life with a smaller name."""
        self._bus, self._life, self._outlived = context.bus, context.life, outlived
        self._lives = context.keys.lives(context.profile.component)
        self._unfollow: Undo | None = None
        self._undo_looks = [self._bus.later(seconds, self._look) for seconds in LOOKS_FOR_OTHERS]

    def follow(self, held: bool) -> None:
        """Follow the lives of the component as long as it is held for a task."""
        if held and self._unfollow is None:
            self._unfollow = self._bus.later(SIGNALS_FIRST, self._begin)
        elif not held and self._unfollow is not None:
            self._unfollow()
            self._unfollow = None

    def close(self) -> None:
        """Look for no others any more."""
        self.follow(False)
        for undo in self._undo_looks:
            undo()

    def _begin(self) -> None:
        self._unfollow = self._bus.watch(self._lives, self._noticed)

    def _noticed(self, key: str, alive: bool) -> None:
        """Look which lives there are: a new watch of Zenoh sometimes reports one that has ended, such as the last."""
        if alive and life_of(key) < self._life:
            self._look()

    def _look(self) -> None:
        self._bus.roll_call(self._lives, LIVES_CALL, self._heard)

    def _heard(self, keys: Iterable[str]) -> None:
        smaller = [life for life in map(life_of, keys) if life < self._life]
        if smaller:
            self._outlived(min(smaller))
