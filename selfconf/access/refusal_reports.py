"""What a site with keys says of the attempts that were refused at its hub."""

from __future__ import annotations

from collections.abc import Callable

from selfconf.bus.port import Bus
from selfconf.bus.zenoh import LONGEST_KEY, RefusalLog
from selfconf.model.wording import client_text
from selfconf.protocol.messages import RefusedAttempt

LOOKS = 3
"""After how many looks a refused attempt is reported: one that its client may make by then does not count."""
LIFE = "Liveliness Token"
"""What Zenoh calls the announcement of a life."""
LIFE_ANSWER = 3.0
"""Seconds that others may take to say whether a life is there."""
MOST_TOLD = 20
"""How many refused attempts of one principal a site tells of in a minute; `selfconf access` shows them all."""


class RefusalReports:
    """Tells of the attempts that a hub has refused, each once, and not without end."""

    def __init__(
        self, bus: Bus, refusals: RefusalLog, complain: Callable[[str], None], allowed: Callable[[RefusedAttempt], bool]
    ) -> None:
        """`allowed` says whether the rules that there are by now allow an attempt."""
        self._bus, self._refusals, self._complain, self._allowed = bus, refusals, complain, allowed
        self._seen: dict[tuple[str, str, str], int] = {}
        """How often each refused attempt was seen in the log."""
        self._told_at: dict[str, list[float]] = {}
        """When something was said of each principal in the last minute: the attempts of one hide no other one."""

    @property
    def refused(self) -> tuple[RefusedAttempt, ...]:
        """What was refused, the latest first, but for what was tried before the rules allowed it."""
        for one in self._refusals.refused:
            if self._allowed(one):
                self._refusals.drop(one)
        return self._refusals.refused

    def look(self) -> None:
        """Report the attempts that have stayed refused for `LOOKS` calls of this method."""
        refused = {(one.principal, one.attempt, one.key): one for one in self.refused}
        self._seen = {what: self._seen.get(what, 0) + 1 for what in refused}
        for what, one in refused.items():
            if self._seen[what] == LOOKS:
                self._judge(one)

    def _judge(self, refused: RefusedAttempt) -> None:
        """Report an attempt, unless it was a site's announcement of a life that is there.

        Zenoh answers a question for lives with those that it has heard of from others, whatever the rules of its end
        say. A key that is kept in part is none that could be asked for.
        """

        def judge(living: tuple[str, ...] = ()) -> None:
            if refused.key in living:
                self._refusals.drop(refused)
            else:
                self.tell(refused.principal, refused.attempt, refused.key)

        if refused.attempt == LIFE and "*" not in refused.key and len(refused.key) < LONGEST_KEY:
            self._bus.roll_call(refused.key, LIFE_ANSWER, judge)
        else:
            judge()

    def tell(self, principal: str, attempt: str, key: str) -> None:
        """Say that an attempt of a principal was refused, and under which key; of `MOST_TOLD` in a minute at most."""
        now = self._bus.now()
        recent = self._told_at[principal] = [at for at in self._told_at.get(principal, ()) if now - at < 60.0]
        if len(recent) < MOST_TOLD:
            recent.append(now)
            self._complain(f"refused: {client_text(principal)}: {attempt}{f' on {key}' if key else ''}")
