"""One discovery: the sites are asked what they advertise, and what they answer is checked, for none is trusted.

It asks liveliness which sites there are, asks them all for their advertisements, and ends when all have answered, or at
the time-out, with the names of those that did not. An answer is checked for completeness, n of n, because the network
does not report a site that dies in the middle of its answer.

Answers are distinguished by the *life* of the site and not by its name: where two sites have one name, both are read,
and lists name both. What a site has answered is remembered; asked again, it receives which revision is known, and
replies only that this is still the one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

from selfconf.bus.port import Replies, Sample
from selfconf.discovery.found import Discovery, FoundAdvertisement, KnownSite, SiteLife, SiteNames
from selfconf.errors import PeerError, SelfconfError, TurtleError
from selfconf.model.immutable import replace
from selfconf.model.term import IRI
from selfconf.model.wording import listed
from selfconf.protocol.codec import MOST_ADVERTISED, decode, encode
from selfconf.protocol.keys import life_of, owner_of, site_of
from selfconf.protocol.messages import Known, Page
from selfconf.rdf import advertisements
from selfconf.rdf.advertisements import Advertisement

if TYPE_CHECKING:
    from selfconf.discovery.ecology_view import EcologyView

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
BACK = 0.3
"""Seconds that all others may take to be back, when the hub of this node has gone and come again."""


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


class SiteInquiry:
    """One discovery: roll-call of sites, a question to all, again to those incomplete, roll-call of components."""

    def __init__(
        self, ecology: EcologyView, done: Callable[[Discovery], None], again: int = DISCOVERY_ATTEMPTS - 1
    ) -> None:
        """`again` is how often it begins anew when this node has no hub, or has lost it, and others with it."""
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
        if self._again and not self.bus.link == self._link != "":
            self.bus.later(BACK, SiteInquiry(self.ecology, self._done, self._again - 1).start)
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
        names = SiteNames(self._sites())
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

    def _undisputed(self, advertised: Sequence[FoundAdvertisement], names: SiteNames) -> dict[IRI, FoundAdvertisement]:
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
                    f"left out {component}: it is disputed, for the sites {listed(sites)} advertise it; say whose"
                    f" it is: selfconf access --believe SITE {component}"
                )
        found |= _also_elsewhere(found, disputed)
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
        found, complaints = [], list[str]()
        for _, (page, sample) in sorted(answer.pages.items()):
            advertisement = self._advertisement(site[0], page, sample.payload, complaints)
            if advertisement is not None:
                one = FoundAdvertisement(advertisement, site[0], page.source, page.startable, site[1], page.unable)
                found.append(one)
        few = _few(complaints, f"of site {site[0]}")
        if answer.excess:
            few.append(
                f"left out {answer.excess} advertisements of site {site[0]}: it advertises more than"
                f" {MOST_ADVERTISED} components or {LARGEST_SITE >> 20} MiB"
            )
        return KnownSite(answer.revision, answer.total, tuple(found), tuple(few))

    def _advertisement(self, site: str, page: Page, payload: bytes, complaints: list[str]) -> Advertisement | None:
        """The advertisement in a reply, which is untrusted: there must be one, of the component that its page names.

        What is wrong with the reply is added to the complaints.
        """
        name = f"site {site}, {page.source}"
        if len(payload) > LARGEST_ADVERTISEMENT:
            complaints.append(f"left out {page.component} of {name}: {len(payload)} bytes are too many")
            return None
        try:
            good, bad = advertisements.read_advertisements(payload, name, segments=self._segments)
        except TurtleError as error:
            complaints.append(f"left out {page.component}: {error}")
            return None
        complaints += [f"left out {malformed.component} of {name}: {malformed.problems[0]}" for malformed in bad]
        mine = [a for a in good if a.component == page.component]
        if len(mine) != 1 and not bad:
            complaints.append(f"left out a reply of {name}: it does not advertise {page.component}")
        return mine[0] if len(mine) == 1 else None


def _also_elsewhere(found: Mapping[IRI, FoundAdvertisement], disputed: Iterable[IRI]) -> dict[IRI, FoundAdvertisement]:
    """The advertisements that are found of disputed components, each with that said of it."""
    return {one: replace(found[one], also_elsewhere=True) for one in disputed if one in found}


def _few(complaints: list[str], whose: str) -> list[str]:
    """The first of many complaints, and the number of the others."""
    more = len(complaints) - MOST_COMPLAINTS
    return complaints if more <= 0 else [*complaints[:MOST_COMPLAINTS], f"left out {more} further answers {whose}"]
