"""The living ecology as seen from a bus: which components live, and what the sites advertise.

Discovery is acts 1 and 2 of the paper (section 2.4). It asks liveliness which sites there are, asks them all for their
advertisements, and ends when all have answered, or at the time-out, with the names of those that did not. An answer is
checked for completeness, n of n, because the network does not report a site that dies in the middle of its answer.

Answers are distinguished by the *life* of the site and not by its name: where two sites have one name, both are read,
and lists name both. What a site has answered is remembered; asked again, it receives which revision is known, and
replies only that this is still the one.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

from selfconf.bus.port import Bus, Replies, Sample, Undo
from selfconf.errors import PeerError, SelfconfError, TurtleError
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.protocol.codec import MOST_ADVERTISED, decode, encode
from selfconf.protocol.keys import Keys, component_chunk, life_of, owner_of, site_of
from selfconf.protocol.messages import Known, Page
from selfconf.rdf import advertisements
from selfconf.rdf.advertisements import Advertisement

DISCOVERY = 3.0
"""How long, in seconds, the sites may take to answer; once all have answered, nothing is waited for any more."""
DISCOVERY_ATTEMPTS = 3
"""How often a site whose answer is incomplete is asked, all in all."""
LARGEST_ADVERTISEMENT = 1 << 20
"""An advertisement of more bytes than this is left out."""
LARGEST_SITE = 1 << 26
"""How many bytes the advertisements of one site can have together; what comes after that is left out."""
MOST_COMPLAINTS = 20
"""How many things that are wrong with the answer of one site are reported one by one; the rest is counted."""
MANY_LIVES = 2_000
"""From how many components on their lives are not followed all together: a router of Zenoh says nothing else until it
has told a watch all lives, which takes it a second for 10,000, and then its clients take it for dead. A node that
needs few of them calls and follows those, and hears only news of others; one that needs all follows them in parts."""
MOST_LIVES = 16
"""How many lives of one component are followed: there should be one, and two where processes clash."""
BETWEEN_DISCOVERIES = 0.2
"""Seconds between two discoveries of one ecology on average, however often something is said to have changed."""
BACK = 0.3
"""Seconds that all others may take to be back, when the hub of this node has gone and come again."""
IN_A_ROW = 20
"""How many discoveries may begin without a pause after a quiet time, as where tasks contend for components."""


@immutable
class FoundAdvertisement:
    """An advertisement of the living ecology: at which site, from which file, and whether the site can start it."""

    advertisement: Advertisement
    site: str
    source: str
    startable: bool
    site_life: str = ""
    """Which life of the site has answered."""
    unable: str = ""
    """Why the component, a composite, cannot act now, as its site says."""


@dataclass(slots=True)
class Discovery:
    """What a discovery has found: the advertisements by component, and the sites."""

    found: dict[IRI, FoundAdvertisement] = field(default_factory=dict)
    sites: tuple[str, ...] = ()
    """Every site that lives or has answered, sorted; one whose name another has as well is named with its life."""
    missing: tuple[str, ...] = ()
    """The sites that did not answer, or not in full: what they advertise may be missing from `found`. Sorted."""
    site_tokens: frozenset[str] = frozenset()
    """The liveliness keys of the sites at the roll-call: which life of which site was asked."""
    answered: frozenset[str] = frozenset()
    """Those of them whose sites have answered in full."""
    complaints: list[str] = field(default_factory=list)
    """What was left out, and why, in sentences."""

    def name_of_site(self, found: FoundAdvertisement) -> str:
        """What the site of an advertisement is called in `sites`: with its life, where another has its name as well."""
        named = _name_with_life(found.site, found.site_life)
        return named if named in self.sites else found.site


Beliefs = Callable[[], Mapping[IRI, str]]
"""The site that owns a component which several sites advertise, by its name, as far as a person has said so."""
LifeChanged = Callable[[str, bool], None]
"""Hears of a life that has begun or ended, by its key."""
SiteLife = tuple[str, str]
"""A site by its name and its life; the life is empty for a site of before that does not say it."""


@immutable
class KnownSite:
    """What a site has answered in full: at which revision, how many pages, and what was read in them."""

    revision: int
    total: int
    found: tuple[FoundAdvertisement, ...]
    complaints: tuple[str, ...]


@dataclass(slots=True)
class _SiteAnswer:
    """What has come of a site's answer so far."""

    revision: int
    total: int
    pages: dict[int, tuple[Page, Sample]] = field(default_factory=dict)
    known: KnownSite | None = None
    """What is known of the site already, where it has said that this still holds."""
    size: int = 0
    """How many bytes the pages have."""
    excess: int = 0
    """How many pages were left out, because the site advertises more than it may."""

    @property
    def complete(self) -> bool:
        return self.known is not None or len(self.pages) == self.total or self.excess > 0

    def take(self, page: Page, sample: Sample) -> IRI | None:
        """Take a page, and return the component of that page, which differs where two pages have one number."""
        before = self.pages.get(page.index)
        if before is not None:
            return before[0].component
        self.size += len(sample.payload) + len(sample.attachment)
        if self.size > LARGEST_SITE or len(self.pages) >= MOST_ADVERTISED:
            self.excess += 1
        else:
            self.pages[page.index] = page, sample
        return page.component


class EcologyView:
    """One ecology as seen from a bus: it can be discovered, and its lives followed."""

    def __init__(self, bus: Bus, name: str, believed: Beliefs | None = None, *, selects: bool = False) -> None:
        """With keys, `believed` says whose a component is; without, it is that of the first site by name.

        A view that `selects` knows in a large ecology only the lives of the components that were selected.
        """
        self.bus, self.keys, self.believed, self._selects = bus, Keys(name), believed, selects
        self.lives: dict[str, tuple[str, ...]] = {}
        """The lives of each living component, sorted, by the component's chunk: more than one where processes clash."""
        self._selected: set[str] | None = None
        """The chunks of the components whose lives are known; None: of all."""
        self.discovery = Discovery()
        self.aside: Callable[[Callable[[], None]], object] = lambda work: work()
        """Reads what the sites have answered; by default at once, where there is only one thread."""
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

    def discover(self, done: Callable[[Discovery], None]) -> None:
        """Ask all sites what they advertise; `done` is called once, when all have answered or time is up.

        On average discoveries begin `BETWEEN_DISCOVERIES` seconds apart, or strangers who put `changed` again and again
        could keep all nodes busy (the generic cell rate algorithm, ITU-T I.371).
        """
        now, inquiry = self.bus.now(), _Inquiry(self, done)
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


class _Inquiry:
    """One discovery: roll-call of sites, a question to all, again to those incomplete, roll-call of components."""

    def __init__(
        self, ecology: EcologyView, done: Callable[[Discovery], None], again: int = DISCOVERY_ATTEMPTS - 1
    ) -> None:
        """`again` is how often it begins anew when this node has lost its hub meanwhile, and others with it."""
        self._again, self._link = again, ""
        self.ecology, self.bus, self.keys, self._done = ecology, ecology.bus, ecology.keys, done
        self._tokens: tuple[str, ...] = ()
        self._lives: dict[str, set[str]] = {}
        """The lives of the sites at the roll-call, by their names."""
        self._answers: dict[SiteLife, _SiteAnswer] = {}
        self._complaints: list[str] = []
        self._insecure: set[str] = set()
        """The sites that say that they listen beyond their host without keys."""
        self._attempt = 0
        self._segments = advertisements.SegmentCache()

    def start(self) -> None:
        self._link = self.bus.link
        self.bus.roll_call(self.keys.any_site_life(), DISCOVERY, self._called)

    def _called(self, keys: tuple[str, ...]) -> None:
        self._tokens = keys
        for key in keys:
            self._lives.setdefault(owner_of(key), set()).add(life_of(key))
        self._ask("*")

    def _ask(self, site: str) -> None:
        self._attempt += 1
        known = Known({f"{name}/{life}": known.revision for (name, life), known in self.ecology.known.items() if life})
        self.bus.ask(self.keys.advertisements(site), encode(known), DISCOVERY, self._replied)

    def _replied(self, replies: Replies) -> None:
        for sample in replies.samples:
            self._take(sample)
        incomplete = [site for site in self._sites() if site not in self._answers or not self._answers[site].complete]
        if incomplete and self._attempt < DISCOVERY_ATTEMPTS and replies.complete:
            self._ask(incomplete[0][0] if len(incomplete) == 1 else "*")
        elif self.ecology.followed:
            self._end(incomplete)
        elif not self.ecology.calls_all(sum(answer.total for answer in self._answers.values())):
            self.ecology.called(None)
            self._end(incomplete)
        else:
            self.bus.roll_call(self.keys.any_life(), DISCOVERY, partial(self._living, incomplete))

    def _living(self, incomplete: list[SiteLife], keys: tuple[str, ...]) -> None:
        if not self.ecology.followed:  # else another discovery has ended meanwhile, and its watch knows better
            self.ecology.called(keys)
        self._end(incomplete)

    def _end(self, incomplete: list[SiteLife]) -> None:
        if self.bus.link != self._link and self._again:
            self.bus.later(BACK, _Inquiry(self.ecology, self._done, self._again - 1).start)
        else:
            self.ecology.aside(lambda: self._finish(incomplete))

    def _finish(self, incomplete: list[SiteLife]) -> None:
        """Read what has come, wherever that is done, and hand it over on the bus's thread."""
        discovery = self._result(incomplete)
        self.bus.wake_up(lambda: self._done(discovery))

    def _sites(self) -> list[SiteLife]:
        """Every site; one may begin to answer and die, or begin to live after the roll-call: a page is as a token."""
        called = {(name, life) for name, lives in self._lives.items() for life in lives}
        return sorted(called | self._answers.keys())

    def _take(self, sample: Sample) -> None:
        try:
            page, name = decode(sample.attachment, Page), site_of(sample.key)
        except PeerError as error:
            self._complaints.append(f"a reply on {sample.key} is none: {error}")
            return
        lives = self._lives.get(name, set())
        site = name, page.life or (next(iter(lives)) if len(lives) == 1 else "")
        answer = self._answers.get(site)
        if answer is not None and answer.revision > page.revision:
            return
        if answer is None or (answer.revision, answer.total) != (page.revision, page.total):
            answer = self._answers[site] = _SiteAnswer(page.revision, page.total)
        known = self.ecology.known.get(site)
        if page.insecure:
            self._insecure.add(name)
        if page.component is None:
            same = known is not None and (known.revision, known.total) == (page.revision, page.total)
            answer.known = known if same else None
            return
        of = answer.take(page, sample)
        if of != page.component:
            self._complaints.append(f"left out {page.component} of site {name}: its page {page.index} is that of {of}")

    def _result(self, missing: list[SiteLife]) -> Discovery:
        read = {site: self._read(site, answer) for site, answer in sorted(self._answers.items())}
        self.ecology.known = {site: known for site, known in read.items() if site not in missing}
        names = _Names(self._sites())
        self._complaints = _few(self._complaints, "of several sites")
        for known in read.values():
            self._complaints += known.complaints
        found = self._undisputed([one for known in read.values() for one in known.found], names)
        self._complaints += names.complaints()
        self._complaints += [
            f"site {site} is insecure: it listens beyond its host without keys" for site in sorted(self._insecure)
        ]
        answered = frozenset(key for key in self._tokens if (owner_of(key), life_of(key)) not in missing)
        return Discovery(
            found,
            tuple(map(names.of, self._sites())),
            tuple(map(names.of, missing)),
            frozenset(self._tokens),
            answered,
            self._complaints,
        )

    def _undisputed(self, advertised: Sequence[FoundAdvertisement], names: _Names) -> dict[IRI, FoundAdvertisement]:
        """The advertisement of each component; of one that several sites advertise, that of the site that is believed.

        Without keys it is the first by name, and the others are named. With keys no site is believed until a person has
        said whose it is: then it is left out.
        """
        claims: dict[IRI, list[FoundAdvertisement]] = {}
        for one in advertised:
            claims.setdefault(one.advertisement.component, []).append(one)
        found = {component: claim[0] for component, claim in claims.items()}
        disputed = [component for component, claim in claims.items() if len(claim) > 1]
        decided = self._decided() if disputed else {}
        said: list[str] = []
        for component in disputed:
            claim = claims[component]
            sites = [names.of((one.site, one.site_life)) for one in claim]
            if decided is None:
                said += [
                    f"left out {component} of site {site}: site {sites[0]} advertises it too" for site in sites[1:]
                ]
                continue
            theirs = [one for one in claim if one.site == decided.get(component)]
            if len(theirs) == 1:
                found[component] = theirs[0]
            else:
                del found[component]
                said.append(
                    f"left out {component}: it is disputed, for the sites {' and '.join(sites)} advertise it; say whose"
                    f" it is: selfconf access --believe SITE {component}"
                )
        self._complaints += _few(said, "that are disputed" if decided is not None else "of components that others have")
        return found

    def _decided(self) -> Mapping[IRI, str] | None:
        """The sites that own disputed components, as a person has said; None without keys."""
        if self.ecology.believed is None:
            return None
        try:
            return self.ecology.believed()
        except SelfconfError as error:
            self._complaints.append(str(error))
            return {}

    def _read(self, site: SiteLife, answer: _SiteAnswer) -> KnownSite:
        """What a site has answered, now or before."""
        if answer.known is not None:
            return answer.known
        complaints, self._complaints = self._complaints, []
        found = []
        for _, (page, sample) in sorted(answer.pages.items()):
            advertisement = self._advertisement(site[0], page, sample.payload)
            if advertisement is not None:
                one = FoundAdvertisement(advertisement, site[0], page.source, page.startable, site[1], page.unable)
                found.append(one)
        said, self._complaints = self._complaints, complaints
        few = _few(said, f"of site {site[0]}")
        if answer.excess:
            few.append(
                f"left out {answer.excess} advertisements of site {site[0]}: it advertises more than"
                f" {MOST_ADVERTISED} components or {LARGEST_SITE >> 20} MiB"
            )
        return KnownSite(answer.revision, answer.total, tuple(found), tuple(few))

    def _advertisement(self, site: str, page: Page, payload: bytes) -> Advertisement | None:
        """The advertisement in a reply, which is untrusted: there must be one, of the component that its page names."""
        name = f"site {site}, {page.source}"
        if len(payload) > LARGEST_ADVERTISEMENT:
            self._complaints.append(f"left out {page.component} of {name}: {len(payload)} bytes are too many")
            return None
        try:
            good, bad = advertisements.read_advertisements(payload, name, segments=self._segments)
        except TurtleError as error:
            self._complaints.append(f"left out {page.component}: {error}")
            return None
        for malformed in bad:
            self._complaints.append(f"left out {malformed.component} of {name}: {malformed.problems[0]}")
        mine = [a for a in good if a.component == page.component]
        if len(mine) != 1 and not bad:
            self._complaints.append(f"left out a reply of {name}: it does not advertise {page.component}")
        return mine[0] if len(mine) == 1 else None


def _few(complaints: list[str], whose: str) -> list[str]:
    """The first of many complaints, and the number of the others."""
    more = len(complaints) - MOST_COMPLAINTS
    return complaints if more <= 0 else [*complaints[:MOST_COMPLAINTS], f"left out {more} further answers {whose}"]


def namesakes(lives: Iterable[str]) -> list[str]:
    """A sentence for each name that several sites have, by the liveliness keys of all sites."""
    return _Names(sorted((owner_of(key), life_of(key)) for key in lives)).complaints()


def _name_with_life(name: str, life: str) -> str:
    return f"{name} ({life or 'no life given'})"


class _Names:
    """What sites are called in lists: by their names, and by their lives where several have one name."""

    def __init__(self, sites: Sequence[SiteLife]) -> None:
        self._lives: dict[str, list[str]] = {}
        for name, life in sites:
            self._lives.setdefault(name, []).append(life)

    def of(self, site: SiteLife) -> str:
        """The name of a site that tells it from all others."""
        name, life = site
        return name if len(self._lives.get(name, ())) < 2 else _name_with_life(name, life)

    def complaints(self) -> list[str]:
        """A sentence for each name that several sites have."""
        return [
            f"{len(lives)} sites are called {name}: {', '.join(self.of((name, life)) for life in lives)}"
            for name, lives in sorted(self._lives.items())
            if len(lives) > 1
        ]
