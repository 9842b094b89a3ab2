"""Whether the hub of a bus answers: it may break inside while its process goes on.

Routers of Zenoh 1.10 panic now and then when many clients are lost and come back at once, as after a common stall, and
answer nothing from then on (zenoh#2624). A client, too, may be deaf: one that was connected to a hub of its own process
may go to another one, and nothing reads what comes over that connection, though what it says is heard.
"""

from __future__ import annotations

from collections.abc import Callable

from selfconf.bus.port import Bus

HUB_ANSWER = 2.0
"""Seconds that a hub may take to answer a site; one that works answers within milliseconds."""
UNANSWERED = 3
"""How many questions in a row it may leave unanswered; each follows at the end of the time of the one before."""
BUSY = 0.5
"""Seconds after the end of that time by which its end is heard; later, this site itself had no time to hear it."""


class HubHealth:
    """The questions of one bus to its hub."""

    def __init__(self, bus: Bus, key: str, broken: Callable[[], None]) -> None:
        """`key` is that of lives that the hub is asked for; `broken` is called once it has left too many unanswered."""
        self._bus, self._key, self._broken = bus, key, broken
        self._unanswered = 0
        self._asking = False

    def ask(self) -> None:
        """Ask the hub who lives, unless it is being asked; what counts is that it answers before the time is over."""
        if not self._asking:
            self._ask()

    def _ask(self) -> None:
        self._asking, asked = True, self._bus.now()

        def answered(_: tuple[str, ...]) -> None:
            self._asking = False
            took = self._bus.now() - asked
            if self._bus.link and took < HUB_ANSWER:
                self._unanswered = 0
            elif took < HUB_ANSWER + BUSY:
                self._unanswered += 1
            if self._unanswered >= UNANSWERED:
                self._unanswered = 0
                self._broken()
            elif took >= HUB_ANSWER:
                self._ask()

        self._bus.roll_call(self._key, HUB_ANSWER, answered)
