"""The doorkeeper of a site with keys: it learns which holders there are, and has the hub let in just these.

Zenoh reads its rules only as a router is opened. So they follow from what holders are, not from what is deployed: from
the certificates that people, programs and sites have shown (`introduce`), from the advertisements of this host, and
from those of each other site, which speaks for the components that it advertises. When any of that changes, the hub is
opened anew, which takes some ten milliseconds.

A component that two sites advertise belongs to no site, until `selfconf access --believe SITE COMPONENT` has said to
which; on its own host a site goes on with its own.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from pathlib import Path
from typing import NamedTuple

from selfconf.access.certificate_files import read_certificate, read_pair
from selfconf.access.disputed_components import believed, claims
from selfconf.access.expiry import CertificateWatch
from selfconf.access.host_authority import HostAuthority
from selfconf.access.hub_reopening import HubReopening
from selfconf.access.keys_folder import KeysFolder
from selfconf.access.other_sites import SITES_ANSWER, OtherSites
from selfconf.access.principal import Principal, PrincipalKind
from selfconf.access.refusal_reports import RefusalReports
from selfconf.access.rules import AccessRules, rules_of
from selfconf.access.shown_certificates import Process, ShownCertificates, holders
from selfconf.bus.answers import answering
from selfconf.bus.credentials import Credentials
from selfconf.bus.port import Bus, Replies, Request
from selfconf.bus.timer import Timer
from selfconf.bus.zenoh import RefusalLog
from selfconf.errors import PeerError, SelfconfError
from selfconf.files import FileStamp, stamp
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.model.wording import listed
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Introduction

LOOK = 1.0
"""How often, in seconds, it is checked whether the folder of keys has changed, and what was refused."""
LOOK_AT_ALL = 10.0
"""After how many seconds at most the rules are made anew, and certificates renewed, though nothing seems to change."""
FAULT_AGAIN = 600.0
"""After how many seconds a fault that lasts is reported again."""
RENEWED_TOGETHER = 2.0
"""Seconds after which a hub is opened anew for a renewed certificate: a program looks at its own once a second."""
GONE_AFTER = 10.0
"""Seconds after which a site that is away is taken to be gone: its lives blink where a hub is opened anew."""
INTRODUCTIONS = (0.05, 0.3, 1.0, 3.0)
"""Seconds after which a site shows its certificate to others, and from then on every `INTRODUCE_AGAIN` seconds."""
INTRODUCE_AGAIN = 5.0
KNOWN_FOR = 6
"""How many of these times pass once all that live know it: each of many sites would else look at all others at once."""


def first_rules(ecology: str, site: str, folder: KeysFolder, own: Mapping[IRI, IRI]) -> AccessRules:
    """The rules that follow from what a site knows by itself; `own` as of a `SiteIdentity`."""
    return rules_of(ecology, site, _processes(own.items()), {}, holders(folder, ecology))


def _processes(components: Iterable[tuple[IRI, IRI]]) -> list[Process]:
    """The processes of components that are given each with the one that stands for its process."""
    found: dict[IRI, list[IRI]] = {}
    for component, program in sorted(components):
        found.setdefault(program, []).append(component)
    return [tuple(map(Principal.component, dict.fromkeys((program, *mine)))) for program, mine in found.items()]


class _Advertised(NamedTuple):
    """What the rules of a site follow from, beside the certificates that were shown."""

    own: Mapping[IRI, IRI]
    """The components of the site, each with the one whose certificate its process has."""
    others: Mapping[str, frozenset[IRI]]
    """The components that each other site advertises."""
    beside: frozenset[str]
    """The other sites of its host."""
    gone: frozenset[str]
    """The other sites that are there no more."""


@immutable
class SiteIdentity:
    """Who a site with keys is."""

    ecology: str
    name: str
    folder: KeysFolder
    credentials: Credentials
    """What it shows."""
    own: Callable[[], Mapping[IRI, IRI]]
    """The components of the site, each with the one whose certificate its process has."""


@immutable
class GuardedHub:
    """The hub that a site opens, or would open as the one that relays on its host."""

    rules: AccessRules
    """The rules in force to begin with."""
    relays: Callable[[], bool]
    """Whether the site relays."""
    sites: Callable[[], Iterable[str]]
    """The names of the sites of this host, whose components connect to the hub."""
    open_anew: Callable[[AccessRules], None]
    """Opens it with other rules; raises NetworkError."""
    distrusted: Callable[[], None]
    """Ends the site, as its certificate was revoked: nothing is to pass through its hub, nor its components to act."""
    refusals: RefusalLog


class Doorkeeper:
    """Keeps the rules of one site's hub."""

    def __init__(self, bus: Bus, site: SiteIdentity, hub: GuardedHub, complain: Callable[[str], None]) -> None:
        self._bus, self._hub, self._complain = bus, hub, complain
        self._keys, self._name, self._folder = Keys(site.ecology), site.name, site.folder
        self._credentials, self._own = site.credentials, site.own
        self._reopening = HubReopening(
            bus, self._keys.reopens(site.name), hub.relays, self._open_anew, self._tell_fault
        )
        self._certificates = ShownCertificates(site.folder, site.ecology, bus.now)
        self._ruled: _Advertised | None = None
        """What was advertised, and by which sites, when the rules were made."""
        self._disputed: frozenset[IRI] = frozenset()
        self._known_for = 0
        """How often it need not be shown to others, as all know it and none has come since."""
        self._reports = RefusalReports(bus, hub.refusals, complain, lambda one: self.rules.allow(one))
        self._faults: dict[str, float] = {}
        """What was said to be wrong with the keys or the hub, and when."""
        self._renew_rules_soon = Timer(bus, 0.0, self._renew_rules)  # once what is done now is done
        self._renews_components = False
        """Whether the certificates of components are being renewed."""
        self._shown, self._stamps = stamp(self._credentials.certificate), dict[Path, FileStamp]()
        """The stamp of the certificate that the hub shows, and those of the folder of keys when all was looked at."""
        self._look_at_all = bus.now()
        """When all is looked at again."""
        self.rules = hub.rules
        bus.serve(self._keys.introduce(site.name), self._introduced)
        bus.serve(self._keys.access(site.name), self._tell)
        self._others = OtherSites(bus, self._keys, site.name, self._others_answered)
        bus.subscribe(self._keys.changed(), lambda _: self._others.ask_soon.set())
        bus.watch(self._keys.any_site_life(), self._site_changed)
        CertificateWatch(bus, site.ecology, site.credentials, complain, distrusted=hub.distrusted)
        for pause in INTRODUCTIONS:
            bus.later(pause, self._introduce)
        bus.later(INTRODUCE_AGAIN, self._introduce_again)
        self._look()

    # Who there is.

    def _introduced(self, request: Request) -> None:
        """A client shows a certificate: the hub lets it in if the authority has issued it."""
        try:
            shown = self._certificates.admit(decode(request.payload, Introduction).certificate)
            if self._certificates.renews(shown) and self._has_life_here(shown.principals[0]):
                self._reopening.within(RENEWED_TOGETHER)
            known = self.rules.knows(shown.principals)
            if not known:
                self._renew_rules_soon.set()
            known = known and not self._reopening.is_near  # perhaps that is as the hub does not know it yet
            beside = tuple(sorted(self._hub.sites()))
            request.reply(self._keys.introduce(self._name), encode(Introduction(self._own_pem(), known, beside)))
        except PeerError as error:
            request.refuse(str(error))
        except SelfconfError as error:
            self._tell_fault(str(error))
            request.refuse(f"site {self._name}: {error}")
        finally:
            request.finish()

    def _own_pem(self) -> str:
        """The certificate of this site as it lies in its file now. Raises AuthorError."""
        return read_certificate(self._credentials.certificate).pem.decode()

    def _has_life_here(self, holder: Principal) -> bool:
        """Whether a holder is one of which lives seem to end, without a warning, as its certificate expires.

        Zenoh ends a link when the certificate expires by which it was made. A component has a life here, and so has
        another site of this host.
        """
        is_beside = holder.kind is PrincipalKind.SITE and holder.name in self._beside()
        return is_beside or holder.kind is PrincipalKind.COMPONENT

    def _introduce(self) -> None:
        """Show the certificate of this site to all others, and learn theirs."""
        try:
            mine = encode(Introduction(self._own_pem()))
        except SelfconfError as error:
            self._tell_fault(str(error))
            return
        self._bus.ask(self._keys.introduce("*"), mine, SITES_ANSWER, self._met)

    def _introduce_again(self) -> None:
        self._bus.later(INTRODUCE_AGAIN, self._introduce_again)
        if self._known_for:
            self._known_for -= 1
        else:
            self._introduce()

    def _met(self, replies: Replies) -> None:
        all_know, known = replies.complete and not replies.errors, True
        for sample in replies.samples:
            try:
                answer = decode(sample.payload, Introduction)
                all_know &= answer.known
                known &= self.rules.knows(self._certificates.admit(answer.certificate).principals)
            except PeerError as error:
                all_know = False
                self._reports.tell("", str(error), sample.key)
            except SelfconfError as error:
                all_know = False
                self._tell_fault(str(error))
        self._known_for = KNOWN_FOR - 1 if all_know and known else 0
        if not known:
            self._renew_rules()

    def _site_changed(self, key: str, alive: bool) -> None:
        self._known_for = 0
        self._others.life_changed(key, alive)

    def _others_answered(self) -> None:
        if self._advertised() != self._ruled:
            self._renew_rules()

    # The rules.

    def _made(self) -> AccessRules:
        shown = holders(self._folder, self._keys.ecology)
        sites = {process[0].name for process in shown if process[0].kind is PrincipalKind.SITE}
        own, others, beside, gone = ruled = self._advertised()
        advertised = {self._name: frozenset(own), **{s: c for s, c in others.items() if s in sites}}
        undisputed = self._undisputed(advertised, gone)
        processes = _processes((component, own[component]) for component in undisputed[self._name])
        for site in beside & undisputed.keys():
            processes += _processes((component, component) for component in undisputed[site])
        vouched = {site: components for site, components in undisputed.items() if site != self._name}
        self._ruled = ruled
        return rules_of(self._keys.ecology, self._name, processes, vouched, shown, beside)

    def _advertised(self) -> _Advertised:
        return _Advertised(dict(self._own()), self._others.advertised(), self._beside(), self._others.away(GONE_AFTER))

    def _beside(self) -> frozenset[str]:
        """The other sites of this host."""
        return frozenset(self._hub.sites()) - {self._name}

    def _undisputed(self, advertised: Mapping[str, frozenset[IRI]], gone: frozenset[str]) -> dict[str, frozenset[IRI]]:
        """The components that each site speaks for; complains of those that have become disputed by sites that live.

        And of those that a site advertises while they are believed to be another's.
        """
        decided = believed(self._folder.path)
        owned, disputed = claims(advertised, decided, here=self._name, gone=gone)
        away = self._others.away()
        disputed = {one: sites for one, sites in disputed.items() if one in decided or len({*sites} - away) > 1}
        for component in sorted(disputed.keys() - self._disputed):
            sites = f"site{'s' * (len(disputed[component]) > 1)} {listed(disputed[component])}"
            other = f", and believed to be that of {decided[component]}" if component in decided else ""
            self._complain(
                f"{component} is advertised by the {sites}{other}; it belongs to none until you say to which: selfconf"
                f" access --believe SITE {component}"
            )
        self._disputed = frozenset(disputed)
        return owned

    def _renew_rules(self) -> None:
        """Have the hub opened anew if who may do what has changed."""
        try:
            rules = self._made()
        except SelfconfError as error:
            self._tell_fault(str(error))
            return
        if rules != self.rules:
            self.rules = rules
            self._reopening.now()

    def _open_anew(self) -> None:
        """Have the hub opened anew. Raises SelfconfError."""
        read_pair(self._credentials.certificate.with_suffix(""))  # the hub as it is would be closed, and not open
        self._hub.open_anew(self.rules)

    def _look(self) -> None:
        """Look at what changes without a message: the folder of keys, the time, and what was refused."""
        self._bus.later(LOOK, self._look)
        try:
            stamps = self._folder.stamps(self._keys.ecology)
        except SelfconfError as error:
            self._tell_fault(str(error))
        else:
            stamps[self._credentials.certificate] = stamp(self._credentials.certificate)
            if stamps != self._stamps or self._bus.now() >= self._look_at_all:
                self._stamps, self._look_at_all = stamps, self._bus.now() + LOOK_AT_ALL
                self._renew_certificates()
                self._renew_rules()
        self._reports.look()

    def _renew_certificates(self) -> None:
        """Renew the certificates of components, and have the hub show the site's own as it lies in the folder now.

        Those of components are good for as long as the site's own at most, and are due when half of that has passed.
        """
        try:
            left = read_certificate(self._credentials.certificate).seconds_left()
            self._look_at_all = min(self._look_at_all, self._bus.now() + left / 4)
            if not self._renews_components:
                self._renew_next(HostAuthority(self._folder).renew_components())
        except SelfconfError as error:
            self._tell_fault(str(error))

    def _renew_next(self, renewals: Iterator[None]) -> None:
        """Take the next step of renewing the certificates of components; between them the bus does other things.

        A renewed certificate of the site is shown after the last one: links are made anew with theirs then.
        """
        self._renews_components = False
        try:
            for _ in renewals:
                self._renews_components = True
                self._bus.later(0.0, partial(self._renew_next, renewals))
                return
        except SelfconfError as error:
            self._tell_fault(str(error))
        own = stamp(self._credentials.certificate)
        if own != self._shown:
            self._shown = own
            self._reopening.now()

    # Reports.

    def _tell_fault(self, sentence: str) -> None:
        """Say what is wrong with the keys or the hub, unless that was said a short while ago."""
        now = self._bus.now()
        if now - self._faults.get(sentence, -FAULT_AGAIN) >= FAULT_AGAIN:
            self._faults = {told: at for told, at in self._faults.items() if now - at < FAULT_AGAIN} | {sentence: now}
            self._complain(sentence)

    def _tell(self, request: Request) -> None:
        """Who may do what, and what was refused: a reply for each."""
        with answering(request):
            for access in self.rules.accesses:
                request.reply(self._keys.access(self._name), encode(access))
            for refused in self._reports.refused:
                request.reply(self._keys.access(self._name), encode(refused))
