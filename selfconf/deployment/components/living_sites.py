"""Which sites live, as one configurator knows it: by their answers, and by what the watch shows of their lives."""

from __future__ import annotations

from collections.abc import Collection

from selfconf.bus.timer import Timer
from selfconf.configurator import Appeared
from selfconf.deployment.components.waking import Waking
from selfconf.deployment.task_context import TaskContext
from selfconf.discovery import Discovery
from selfconf.protocol.keys import owner_of

AWAY = 0.3
"""Seconds that a component may take to find another router when its own is gone."""
ASK_SITE_AGAIN = 5.0
"""Seconds after which a site that lives, but has not answered in full, is taken for news, and so is asked again."""


class LivingSites:
    """The sites of an ecology that live; what is learned of them is news for the machine of one task."""

    def __init__(self, context: TaskContext, waking: Waking) -> None:
        self._bus, self._step, self._waking = context.ecology.bus, context.step, waking
        self._ecology = context.ecology
        self._sites: set[str] = set()
        """The liveliness keys of the sites that answered last, or are news: one that was started again has another."""
        self._shown: set[str] = set()
        """The liveliness keys of the sites that the watch shows to live."""
        self._unseen: set[str] = set()
        """The liveliness keys of the sites that have answered, but that the watch has not shown yet."""
        self._ended: set[str] = set()
        """The liveliness keys of the sites that have ended since the last discovery, whatever they answer to it."""
        self._last_end = float("-inf")
        """When the life of a site ended the last time."""
        self._ask_again = Timer(self._bus, ASK_SITE_AGAIN, lambda: self._step(Appeared({})))

    def lives(self, site: str) -> bool:
        """Whether a site lives, as far as is known."""
        return site in map(owner_of, self._sites | self._shown)

    def answered(self, discovery: Discovery) -> None:
        """Take in which sites have answered."""
        self._sites = set(discovery.answered - self._ended)
        self._ended.clear()

    def expect(self, answered: Collection[str], seconds: float) -> None:
        """Have those of the sites that have answered end which the watch, that begins, has not shown by then."""
        self._unseen = set(answered)
        self._bus.later(seconds, self._end_unseen)

    def ask_again(self, discovery: Discovery) -> None:
        """Ask sites later that were not asked, or have not answered in full."""
        self._ask_again.stop()  # it leads to a discovery, which comes here again
        if discovery.missing or not discovery.site_tokens.issuperset(self._shown):
            self._ask_again.set()

    def back_in(self, living: Collection[str]) -> float:
        """In how many seconds what seems to have ended with a site would be back; 0 or less if no site has ended.

        `living` are the liveliness keys of the sites that the network shows now, ends included that the watch has not
        shown yet.
        """
        if living and not self._sites.issubset(living):
            self._last_end = self._bus.now()
        return self._last_end + AWAY - self._bus.now()

    def changed(self, key: str, alive: bool) -> None:
        """The watch shows that the life of a site has begun or ended."""
        self._unseen.discard(key)
        if alive:
            self._ended.discard(key)
            self._shown.add(key)
        else:
            self._ended.add(key)
            self._shown.discard(key)
        if alive and key not in self._sites:
            self._sites.add(key)
            self._waking.site_began(owner_of(key))
            self._step(Appeared({}))
        elif not alive:
            self._last_end = self._bus.now()
            self._sites.discard(key)
            if not self.lives(owner_of(key)):
                self._waking.site_ended(owner_of(key))
            if any(one.also_elsewhere and one.site == owner_of(key) for one in self._ecology.discovery.found.values()):
                self._step(Appeared({}))  # what other sites advertise as well counts now as theirs

    def _end_unseen(self) -> None:
        for site in sorted(self._unseen):
            self.changed(site, alive=False)
