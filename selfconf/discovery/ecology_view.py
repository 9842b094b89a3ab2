"""One ecology as seen from a bus: which components live, and what the sites have advertised.

In a large ecology a node need not know how all components live: it calls and follows the lives of those that it needs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence

from selfconf.bus.port import Bus, Undo
from selfconf.discovery.found import Discovery, KnownSite, SiteLife
from selfconf.discovery.inquiry import BACK, DISCOVERY, DISCOVERY_ATTEMPTS, SiteInquiry
from selfconf.model.term import IRI
from selfconf.protocol.keys import Keys, component_chunk, life_of, owner_of

MANY_LIVES = 2_000
"""From how many components on their lives are not followed all together: a router of Zenoh says nothing else until it
has told a watch all lives, which takes it a second for 10,000, and then its clients take it for dead. A node that
needs few of them calls and follows those, and hears only news of others; one that needs all follows them in parts."""
MOST_LIVES = 16
"""How many lives of one component are followed: there should be one, and two where processes clash."""
BETWEEN_DISCOVERIES = 0.2
"""Seconds between two discoveries of one ecology on average, however often something is said to have changed."""
IN_A_ROW = 20
"""How many discoveries may begin without a pause after a quiet time, as where tasks contend for components."""

Beliefs = Callable[[], Mapping[IRI, str]]
"""The site that owns a component which several sites advertise, by its name, as far as a person has said so."""
LifeChanged = Callable[[str, bool], None]
"""Hears of a life that has begun or ended, by its key."""


class EcologyView:
    """One ecology as seen from a bus: it can be discovered, and its lives followed."""

    def __init__(
        self,
        bus: Bus,
        name: str,
        believed: Beliefs | None = None,
        *,
        selects: bool = False,
        aside: Callable[[Callable[[], None]], object] = lambda work: work(),
        suspended_sites: Callable[[], Iterable[str]] = tuple,
    ) -> None:
        """With keys, `believed` says whose a component is; without, it is that of the first site by name.

        A view that `selects` knows in a large ecology only the lives of the components that were selected. `aside`
        reads what the sites have answered, by default at once, where there is only one thread. `suspended_sites` are
        known not to answer because their processes are suspended, however long ago.
        """
        self.bus, self.keys, self.believed, self._selects = bus, Keys(name), believed, selects
        self.aside, self._suspended_sites = aside, suspended_sites
        self.lives: dict[str, tuple[str, ...]] = {}
        """The lives of each living component, sorted, by the component's chunk: more than one where processes clash."""
        self._selected: set[str] | None = None
        """The chunks of the components whose lives are known; None: of all."""
        self.discovery = Discovery()
        self.known: dict[SiteLife, KnownSite] = {}
        """What the sites that live have answered before."""
        self._followed = False
        self._changed: LifeChanged = lambda key, alive: None
        self._undo: list[Undo] = []
        self._next_discovery = -math.inf
        """When, on the bus's clock, the next discovery may begin."""

    def life(self, component: IRI) -> str | None:
        """The life of a component, or None if it does not live; of several the one that stays."""
        lives = self.lives.get(component_chunk(component))
        return lives[0] if lives else None

    def lives_on(self, component: IRI, life: str) -> bool:
        """Whether a component lives a certain life."""
        return life in self.lives.get(component_chunk(component), ())

    def may_be_shared(self, component: IRI) -> bool:
        """Whether several tasks may hold a component at once, unless its advertisement is known and says otherwise."""
        found = self.discovery.found.get(component)
        return found is None or found.advertisement.profile.is_shareable

    def began(self, chunk: str, life: str) -> None:
        """Note that a life has begun; of very many of one component the least, which stay, are noted."""
        self.lives[chunk] = tuple(sorted({*self.lives.get(chunk, ()), life})[:MOST_LIVES])

    def ended(self, chunk: str, life: str) -> None:
        """Note that a life has ended."""
        left = tuple(one for one in self.lives.get(chunk, ()) if one != life)
        if left:
            self.lives[chunk] = left
        else:
            self.lives.pop(chunk, None)

    @property
    def followed(self) -> bool:
        """Whether `lives` is kept up to date."""
        return self._followed

    def follow(self, changed: LifeChanged, site_changed: LifeChanged) -> None:
        """Follow the life of every component and site from now on, those that are there first; twice does nothing.

        Of components that could be selected, but are not, only news are reported: a life that begins, or, after this
        node has lost its hub, is there again. Not to be called before the first discovery has ended: Zenoh answers a
        roll-call in part only if a watch of the same lives begins meanwhile.
        """
        if self._followed:
            return
        self._followed, self._changed = True, changed
        self._undo = [self.bus.watch(self.keys.any_site_life(), site_changed)]
        if self._selected is not None:
            self._undo.append(self.bus.watch(self.keys.any_life(), self._news, history=False, many=True))
        else:
            lives = self.keys.parts_of_lives() if len(self.lives) > MANY_LIVES else (self.keys.any_life(),)
            self._undo += [self.bus.watch(key, changed, many=True) for key in lives]

    def _news(self, key: str, alive: bool) -> None:
        if alive and not self.knows(owner_of(key)):
            self._changed(key, alive)

    def knows(self, chunk: str) -> bool:
        """Whether `lives` says how a component lives, that is given by its chunk."""
        return self._selected is None or chunk in self._selected

    def select(self, components: Iterable[IRI], done: Callable[[Sequence[str]], None]) -> None:
        """Call the lives of components, and follow them from then on; not to be called before `follow`.

        `done` is called with the keys of those that live and were not known; at once where all were.
        """
        unknown = sorted(component for component in components if not self.knows(component_chunk(component)))
        if unknown:
            _Selection(self, unknown, done).start()
        else:
            done(())

    def selected(self, components: Iterable[IRI], keys: Iterable[str]) -> Sequence[str]:
        """Note the answer to a call of the lives of components, follow these, and return what is news."""
        unknown = [component for component in components if not self.knows(component_chunk(component))]
        chunks = set(map(component_chunk, unknown))
        news = [key for key in keys if owner_of(key) in chunks]
        for key in news:
            self.began(owner_of(key), life_of(key))
        if self._selected is not None:
            self._selected |= chunks
        self._undo += [self.bus.watch(self.keys.lives(component), self._changed) for component in unknown]
        return news

    def called(self, keys: Iterable[str] | None) -> None:
        """Note the answer to a call of all lives, or, with None, that they are too many for that."""
        self.lives, self._selected = {}, None if keys is not None else set()
        for key in keys or ():
            self.began(owner_of(key), life_of(key))

    def calls_all(self, advertised: int) -> bool:
        """Whether, in an ecology that advertises so many components, the lives of all are called."""
        return not (self._selects and advertised > MANY_LIVES)

    def unfollow(self) -> None:
        """Follow no life any more."""
        self._selected = None
        for undo in self._undo:
            undo()
        self._undo.clear()

    def silent_sites(self, discovery: Discovery) -> tuple[str, ...]:
        """The sites of which a discovery may lack something, sorted; of those that seem gone, the suspended ones."""
        return tuple(sorted({*discovery.missing, *(set(self._suspended_sites()) - set(discovery.sites))}))

    def discover(self, done: Callable[[Discovery], None]) -> None:
        """Ask all sites what they advertise; `done` is called once, when all have answered or time is up.

        On average discoveries begin `BETWEEN_DISCOVERIES` seconds apart, or strangers who put `changed` again and again
        could keep all nodes busy (the generic cell rate algorithm, ITU-T I.371).
        """
        now, inquiry = self.bus.now(), SiteInquiry(self, done)
        begin = max(now, self._next_discovery)
        self._next_discovery = max(self._next_discovery, now - IN_A_ROW * BETWEEN_DISCOVERIES) + BETWEEN_DISCOVERIES
        if begin > now:
            self.bus.later(begin - now, inquiry.start)
        else:
            inquiry.start()


class _Selection:
    """One call of the lives of some components, each by its key, so that no answer tells of thousands of others."""

    def __init__(
        self,
        ecology: EcologyView,
        components: Sequence[IRI],
        done: Callable[[Sequence[str]], None],
        again: int = DISCOVERY_ATTEMPTS - 1,
    ) -> None:
        """`again` is how often it begins anew when this node has lost its hub meanwhile."""
        self._ecology, self._components, self._done, self._again = ecology, components, done, again
        self._link = ecology.bus.link
        self._missing = len(components)
        self._alive: list[str] = []

    def start(self) -> None:
        for component in self._components:
            self._ecology.bus.roll_call(self._ecology.keys.lives(component), DISCOVERY, self._called)

    def _called(self, keys: tuple[str, ...]) -> None:
        self._alive += keys
        self._missing -= 1
        if self._missing:
            return
        if self._ecology.bus.link != self._link and self._again:
            anew = _Selection(self._ecology, self._components, self._done, self._again - 1)
            self._ecology.bus.later(BACK, anew.start)
        else:
            self._done(self._ecology.selected(self._components, self._alive))
