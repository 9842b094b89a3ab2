"""What the other sites of an ecology advertise, as a site with keys hears it from them.

Each of them speaks for the components that it advertises, so it is asked for these whenever something changes. What it
has said in full counts, n of n; where it answers in part, as one that is busy or is cut off does, what it advertised
before counts, and it is asked again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import islice
from typing import TypeGuard

from selfconf.bus.port import Bus, Replies
from selfconf.bus.timer import Timer
from selfconf.errors import PeerError
from selfconf.model.term import IRI
from selfconf.protocol.codec import MOST_ADVERTISED, decode, encode
from selfconf.protocol.keys import Keys, life_of, owner_of, site_of
from selfconf.protocol.messages import Known, Page

SOON = 0.05
"""Seconds after which others are asked what they advertise, when something has changed: mostly more does. However many
changes are reported, others are asked no oftener than that."""
SITES_ANSWER = 3.0
"""Seconds that other sites may take to say what they advertise, and who they are."""
ASK_SITES_AGAIN = 5.0
"""Seconds after which they are asked again where one of them has not answered in full."""


class OtherSites:
    """The other sites of an ecology, as one site knows them."""

    def __init__(self, bus: Bus, keys: Keys, site: str, answered: Callable[[], None]) -> None:
        """`site` is the one that asks; `answered` is called whenever the others have said what they advertise."""
        self._bus, self._keys, self._site, self._heard = bus, keys, site, answered
        self._advertised: dict[str, frozenset[IRI]] = {}
        self._revisions: dict[str, int] = {}
        """Of what is known, by the name and the life of the site, as of a `Known`."""
        self._lives: dict[str, set[str]] = {}
        self._away: dict[str, float] = {}
        """Since when no life of a site is there, of those of which one was."""
        self.ask_soon = Timer(bus, SOON, self._ask)
        """Asks them what they advertise: something has changed."""
        self._ask_again = Timer(bus, ASK_SITES_AGAIN, self.ask_soon.set)

    def advertised(self) -> dict[str, frozenset[IRI]]:
        """The components that each other site advertises, as far as is known."""
        return dict(self._advertised)

    def away(self, seconds: float = 0.0) -> frozenset[str]:
        """The sites of which no life is there any more, for so many seconds at least."""
        now = self._bus.now()
        return frozenset(site for site, since in self._away.items() if now - since >= seconds)

    def life_changed(self, key: str, alive: bool) -> None:
        """Note that a life of a site has begun or ended, and ask them all."""
        site = owner_of(key)
        lives = self._lives.setdefault(site, set())
        (lives.add if alive else lives.discard)(life_of(key))
        self._away.pop(site, None)
        if not lives:
            del self._lives[site]
            self._away[site] = self._bus.now()
        self.ask_soon.set()

    def _ask(self) -> None:
        known = encode(Known(dict(self._revisions)))
        self._bus.ask(self._keys.advertisements(), known, SITES_ANSWER, self._answered)

    def _answered(self, replies: Replies) -> None:
        in_part = False
        for site, pages in self._news(replies).items():
            self._revisions = {known: at for known, at in self._revisions.items() if known.partition("/")[0] != site}
            if not _is_whole([page for page, _ in pages]):
                in_part = True
                continue
            self._revisions |= {f"{site}/{page.life}": page.revision for page, _ in pages}
            vouched = (page.component for page, key in pages if self._is_advertised(page.component, site, key))
            self._advertised[site] = frozenset(islice(vouched, MOST_ADVERTISED))
        self._ask_again.stop()
        if in_part or not replies.complete:
            self._ask_again.set()
        self._heard()

    def _news(self, replies: Replies) -> dict[str, list[tuple[Page, str]]]:
        """The pages of each other site that does not advertise the same as before, with their keys."""
        news: dict[str, list[tuple[Page, str]]] = {}
        for sample in replies.samples:
            try:
                page, site = decode(sample.attachment, Page), site_of(sample.key)
            except PeerError:
                continue
            is_as_before = page.component is None and self._revisions.get(f"{site}/{page.life}") == page.revision
            if site != self._site and not is_as_before:
                news.setdefault(site, []).append((page, sample.key))
        return news

    def _is_advertised(self, component: IRI | None, site: str, key: str) -> TypeGuard[IRI]:
        return component is not None and key == self._keys.advertisement(site, component)


def _is_whole(pages: Sequence[Page]) -> bool:
    """Whether what a site has replied is all that it advertises; of two sites of one name, what both have."""
    totals = {page.life: page.total for page in pages}
    replied = {(page.life, page.index) for page in pages if page.component is not None}
    return len(replied) == sum(totals.values())
