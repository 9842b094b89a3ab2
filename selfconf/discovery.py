"""The living ecology as seen from a bus: which components live, and what the sites advertise.

Discovery is acts 1 and 2 of the paper (section 2.4). It asks liveliness which sites there are, asks them all for their
advertisements, and ends when all have answered, or at the time-out, with the names of those that did not. An answer is
checked for completeness, n of n, because the network does not report a site that dies in the middle of its answer.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from selfconf.bus.port import Bus, Replies, Sample, Undo
from selfconf.errors import PeerError, TurtleError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys, component_chunk, life_of, owner_of, site_of
from selfconf.protocol.messages import Page
from selfconf.rdf import advertisements
from selfconf.rdf.advertisements import Advertisement

DISCOVERY = 3.0
"""How long, in seconds, the sites may take to answer; once all have answered, nothing is waited for any more."""
DISCOVERY_ATTEMPTS = 3
"""How often a site whose answer is incomplete is asked, all in all."""
LARGEST_ADVERTISEMENT = 1 << 20
"""An advertisement of more bytes than this is left out."""


@dataclass(frozen=True, slots=True)
class FoundAdvertisement:
    """An advertisement of the living ecology: at which site, from which file, and whether the site can start it."""

    advertisement: Advertisement
    site: str
    source: str
    startable: bool


@dataclass(slots=True)
class Discovery:
    """What a discovery has found: the advertisements by component, and the sites."""

    found: dict[IRI, FoundAdvertisement] = field(default_factory=dict)
    sites: tuple[str, ...] = ()
    """Every site that lives or has answered, sorted."""
    missing: tuple[str, ...] = ()
    """The sites that did not answer, or not in full: what they advertise may be missing from `found`. Sorted."""
    site_tokens: frozenset[str] = frozenset()
    """The liveliness keys of the sites at the roll-call: which life of which site was asked."""
    complaints: list[str] = field(default_factory=list)
    """What was left out, and why, in sentences."""


class EcologyView:
    """One ecology as seen from a bus: it can be discovered, and its lives followed."""

    def __init__(self, bus: Bus, name: str) -> None:
        self.bus, self.keys = bus, Keys(name)
        self.lives: dict[str, tuple[str, ...]] = {}
        """The lives of each living component, sorted, by the component's chunk: more than one where processes clash."""
        self.discovery = Discovery()
        self._followed = False
        self._undo: list[Undo] = []

    def life(self, component: IRI) -> str | None:
        """The life of a component, or None if it does not live; of several the one that stays."""
        lives = self.lives.get(component_chunk(component))
        return lives[0] if lives else None

    def lives_on(self, component: IRI, life: str) -> bool:
        """Whether a component lives a certain life."""
        return life in self.lives.get(component_chunk(component), ())

    def began(self, chunk: str, life: str) -> None:
        """Note that a life has begun."""
        self.lives[chunk] = tuple(sorted({*self.lives.get(chunk, ()), life}))

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

    def follow(self, changed: Callable[[str, bool], None], site_changed: Callable[[str, bool], None]) -> None:
        """Follow the life of every component and site from now on, those that are there first; twice does nothing.

        Not to be called before the first discovery has ended: Zenoh answers a roll-call in part only if a watch of
        the same lives begins meanwhile.
        """
        if not self._followed:
            self._followed = True
            self._undo = [
                self.bus.watch(self.keys.any_life(), changed),
                self.bus.watch(self.keys.any_site_life(), site_changed),
            ]

    def unfollow(self) -> None:
        """Follow no life any more."""
        for undo in self._undo:
            undo()
        self._undo.clear()

    def discover(self, done: Callable[[Discovery], None]) -> None:
        """Ask all sites what they advertise; `done` is called once, when all have answered or time is up."""
        _Inquiry(self, done).start()


class _Inquiry:
    """One discovery: roll-call of sites and components, a question to all sites, and again to those incomplete."""

    def __init__(self, ecology: EcologyView, done: Callable[[Discovery], None]) -> None:
        self.ecology, self.bus, self.keys, self._done = ecology, ecology.bus, ecology.keys, done
        self._tokens: tuple[str, ...] = ()
        self._sites: tuple[str, ...] = ()
        self._pages: dict[str, dict[int, tuple[Page, Sample]]] = {}
        self._expected: dict[str, tuple[int, int]] = {}
        self._complaints: list[str] = []
        self._attempt = 0
        self._segments = advertisements.SegmentCache()

    def start(self) -> None:
        if self.ecology.followed:
            self._call_sites()
        else:
            self.bus.roll_call(self.keys.any_life(), DISCOVERY, self._living)

    def _living(self, keys: tuple[str, ...]) -> None:
        self.ecology.lives = {}
        for key in keys:
            self.ecology.began(owner_of(key), life_of(key))
        self._call_sites()

    def _call_sites(self) -> None:
        self.bus.roll_call(self.keys.any_site_life(), DISCOVERY, self._called)

    def _called(self, keys: tuple[str, ...]) -> None:
        self._tokens, self._sites = keys, tuple(sorted({owner_of(key) for key in keys}))
        self._ask("*")

    def _ask(self, site: str) -> None:
        self._attempt += 1
        self.bus.ask(self.keys.advertisements(site), b"", DISCOVERY, self._replied)

    def _replied(self, replies: Replies) -> None:
        for sample in replies.samples:
            self._take(sample)
        # A site may begin to answer and die, or begin to live after the roll-call: pages count as much as a token.
        incomplete = [site for site in sorted({*self._sites, *self._pages}) if not self._complete(site)]
        if incomplete and self._attempt < DISCOVERY_ATTEMPTS and replies.complete:
            self._ask(incomplete[0] if len(incomplete) == 1 else "*")
        else:
            self._done(self._result(tuple(incomplete)))

    def _take(self, sample: Sample) -> None:
        try:
            page, site = decode(sample.attachment, Page), site_of(sample.key)
        except PeerError as error:
            self._complaints.append(f"a reply on {sample.key} is none: {error}")
            return
        expected = (page.revision, page.total)
        if self._expected.get(site, expected) != expected and self._expected[site][0] > page.revision:
            return
        if self._expected.get(site) != expected:
            self._expected[site], self._pages[site] = expected, {}
        if page.component is not None:
            self._pages[site][page.index] = page, sample

    def _complete(self, site: str) -> bool:
        return site in self._expected and len(self._pages[site]) == self._expected[site][1]

    def _result(self, missing: tuple[str, ...]) -> Discovery:
        found: dict[IRI, FoundAdvertisement] = {}
        for site in sorted(self._pages):
            for _, (page, sample) in sorted(self._pages[site].items()):
                advertisement = self._advertisement(site, page, sample.payload)
                if advertisement is None:
                    continue
                component = advertisement.profile.component
                if component in found:
                    other = found[component].site
                    self._complaints.append(f"left out {component} of site {site}: site {other} advertises it too")
                else:
                    found[component] = FoundAdvertisement(advertisement, site, page.source, page.startable)
        sites = tuple(sorted({*self._sites, *self._pages}))
        return Discovery(found, sites, missing, frozenset(self._tokens), self._complaints)

    def _advertisement(self, site: str, page: Page, payload: bytes) -> Advertisement | None:
        """The advertisement in a reply, which is untrusted: there must be one, of the component that its page names."""
        name = f"site {site}, {page.source}"
        if len(payload) > LARGEST_ADVERTISEMENT:
            self._complaints.append(f"left out {page.component} of {name}: {len(payload)} bytes are too many")
            return None
        try:
            good, bad = advertisements.read_advertisements(payload, name, segments=self._segments)
        except TurtleError as error:
            self._complaints.append(f"left out: {error}")
            return None
        for malformed in bad:
            self._complaints.append(f"left out {malformed.component} of {name}: {malformed.problems[0]}")
        mine = [a for a in good if a.profile.component == page.component]
        if len(mine) != 1 and not bad:
            self._complaints.append(f"left out a reply of {name}: it does not advertise {page.component}")
        return mine[0] if len(mine) == 1 else None
