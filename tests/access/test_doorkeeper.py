"""The doorkeeper of a site, on a bus in memory: it learns who there is, and has its rules follow."""

from __future__ import annotations

import errno
from collections.abc import Iterator
from datetime import timedelta
from pathlib import Path

import pytest

from selfconf.access import (
    AccessRules,
    Authority,
    Certificate,
    Doorkeeper,
    GuardedHub,
    HostAuthority,
    KeysFolder,
    Principal,
    PrincipalKind,
    SiteIdentity,
    believe,
    certificates,
    doorkeeper,
    first_rules,
    keys_folder,
)
from selfconf.access.doorkeeper import (
    GONE_AFTER,
    INTRODUCE_AGAIN,
    KNOWN_FOR,
    LOOK_AT_ALL,
    RAREST_RETRY,
    RENEWED_TOGETHER,
)
from selfconf.bus.memory import MemoryBus, Network
from selfconf.bus.port import Replies, Request, Urgency
from selfconf.bus.zenoh import RefusalLog
from selfconf.errors import AuthorError, NetworkError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Access, Introduction, Page, RefusedAttempt

KEYS = Keys("lab")
LAMP, BELL = IRI("urn:lamp"), IRI("urn:bell")


class Door:
    """A doorkeeper of the site `home`, and what it does."""

    def __init__(self, folder: KeysFolder) -> None:
        self.network, self.folder = Network(1), folder
        self.bus = self.network.node()
        self.enforced: list[AccessRules] = []
        self.said: list[str] = []
        self.hub_opens = True
        self.sites = ["home"]
        self.refusals = RefusalLog(clock=lambda: 0.0)
        credentials = folder.credentials((PrincipalKind.SITE,), "home")
        self.own = {LAMP: LAMP}
        site = SiteIdentity("lab", "home", folder, credentials, own=lambda: self.own)
        hub = GuardedHub(
            first_rules("lab", "home", folder, {LAMP: LAMP}),
            relays=lambda: True,
            sites=lambda: self.sites,
            open_anew=self.open_anew,
            distrusted=lambda: self.said.append("it ends"),
            refusals=self.refusals,
        )
        self.keeper = Doorkeeper(self.bus, site, hub, self.said.append)
        self.other = self.network.node()

    def ask(self, key: str, payload: bytes = b"") -> Replies:
        """What is answered to somebody else."""
        heard: list[Replies] = []
        self.other.ask(key, payload, 5.0, heard.append)
        self.other.run(lambda: bool(heard))
        return heard[0]

    def open_anew(self, rules: AccessRules) -> None:
        """Open the hub with other rules."""
        self.enforced.append(rules)
        if not self.hub_opens:
            raise NetworkError("the port is in use")

    def introduce(self, certificate: str) -> Replies:
        """What is answered to who shows a certificate."""
        return self.ask(KEYS.introduce("home"), encode(Introduction(certificate)))

    def pass_time(self, seconds: float) -> None:
        """Let time pass."""
        until = self.bus.now() + seconds
        self.bus.run(lambda: self.bus.now() >= until)

    @property
    def principals(self) -> set[str]:
        """Who may do anything."""
        return {access.principal for access in self.keeper.rules.accesses}


@pytest.fixture
def door(tmp_path: Path) -> Door:
    """A door."""
    return Door(Authority.init(tmp_path / "keys"))


def test_who_shows_a_good_certificate_is_let_in_and_shown_that_of_the_site(door: Door, tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "elsewhere")
    site = tmp_path / "site"
    authority.issue(Principal(PrincipalKind.SITE, "home"), site)
    alice = authority.issue(Principal(PrincipalKind.READER, "alice"), tmp_path / "alice")
    door = Door(KeysFolder(site))
    assert "read.alice" not in door.principals
    (first,) = door.introduce(alice.pem.decode()).samples
    answer = decode(first.payload, Introduction)
    assert (answer.known, answer.certificate) == (False, (site / "certificate.pem").read_text())
    door.pass_time(0.1)
    assert "read.alice" in door.principals
    assert door.enforced == [door.keeper.rules]
    (again,) = door.introduce(alice.pem.decode()).samples
    assert decode(again.payload, Introduction).known
    door.pass_time(5.0)
    assert len(door.enforced) == 1, "nothing has changed since"


def test_no_certificate_is_known_while_the_hub_is_about_to_be_opened_anew(door: Door, tmp_path: Path) -> None:
    """Its holder would ask by a link that ends in the next moment."""
    shown = door.folder.issue(Principal(PrincipalKind.READER, "alice"), tmp_path / "alice").pem.decode()
    answers = []
    while not answers or not answers[-1]:
        (answer,) = door.introduce(shown).samples
        answers.append(decode(answer.payload, Introduction).known)
        assert answers[-1] == bool(door.enforced)
    assert len(answers) > 2


def test_a_hub_that_does_not_open_is_tried_more_and_more_rarely_and_complained_of_once(
    door: Door, tmp_path: Path
) -> None:
    door.hub_opens = False
    door.introduce(door.folder.issue(Principal(PrincipalKind.READER, "alice"), tmp_path / "alice").pem.decode())
    door.pass_time(120.0)
    assert 6 <= len(door.enforced) <= 10
    assert door.said == ["the hub cannot be opened with its new rules: the port is in use; trying again"]
    door.hub_opens = True
    door.pass_time(RAREST_RETRY)
    tried = len(door.enforced)
    door.pass_time(60.0)
    assert len(door.enforced) == tried


@pytest.mark.parametrize(
    "certificate", ["", "nonsense", "-----BEGIN CERTIFICATE-----\nAA==\n-----END CERTIFICATE-----"]
)
def test_who_shows_nonsense_is_refused(certificate: str, door: Door) -> None:
    replies = door.introduce(certificate)
    assert replies.errors
    assert not replies.samples
    assert door.enforced == []


def test_a_full_disk_keeps_who_is_new_out_and_is_told_as_what_it_is(
    door: Door, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    cellar = door.network.node()
    mine = door.folder.credentials((PrincipalKind.SITE,), "cellar").certificate.read_text()

    def introduced(request: Request) -> None:
        request.reply(KEYS.introduce("cellar"), encode(Introduction(mine)))
        request.finish()

    def no_room(path: Path, content: bytes) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(path))

    alice = door.folder.issue(Principal(PrincipalKind.READER, "alice"), tmp_path / "alice").pem.decode()
    monkeypatch.setattr(keys_folder, "write_atomically", no_room)
    why = f"{door.folder.path}/admitted/lab/{{}}.pem: cannot be written: No space left on device"
    assert door.introduce(alice).errors == (f"site home: {why.format('read.alice')}",)
    cellar.serve(KEYS.introduce("cellar"), introduced)
    cellar.announce(KEYS.site_life("cellar", "1"))
    door.pass_time(10.0)
    assert door.said == [why.format(one) for one in ("read.alice", "site.home", "site.cellar")]
    assert not caplog.records


class CountedReads(Authority):
    """A folder of keys that counts how often all who were let in are read."""

    reads = 0

    def admitted(self, ecology: str) -> dict[str, Certificate]:
        self.reads += 1
        return super().admitted(ecology)


def test_certificates_without_end_cost_no_look_at_all_others_each(door: Door, tmp_path: Path) -> None:
    folder = CountedReads(door.folder.path)
    door = Door(folder)
    alice = folder.issue(Principal(PrincipalKind.READER, "alice"), tmp_path / "alice").pem.decode()
    before, began = folder.reads, door.bus.now()
    for _ in range(100):
        assert door.introduce("nonsense").errors
        assert door.introduce(alice).samples
        assert door.introduce(f"The same, in other words.\n{alice}").samples
    assert folder.reads - before <= 2 + (door.bus.now() - began), "once for alice, and once a second"


def advertise(door: Door, site: str, *components: IRI) -> MemoryBus:
    """Another site, that has shown its certificate and advertises some components."""
    bus = door.network.node()

    def answer(request: Request) -> None:
        for index, component in enumerate(components):
            page = Page(index, len(components), 1, component, life="1")
            request.reply(KEYS.advertisement(site, component), b"", encode(page))
        request.finish()

    bus.serve(KEYS.advertisements(site), answer)
    bus.announce(KEYS.site_life(site, "1"))
    shown = door.folder.credentials((PrincipalKind.SITE,), site).certificate
    bus.ask(KEYS.introduce("home"), encode(Introduction(shown.read_text())), 5.0, lambda replies: None)
    door.pass_time(2.0)
    return bus


def test_a_site_shows_its_certificate_to_others_seldom_once_all_know_it(door: Door) -> None:
    known, shown = [False], list[float]()
    mine = door.folder.credentials((PrincipalKind.SITE,), "cellar").certificate.read_text()
    cellar = door.network.node()

    def answer(request: Request) -> None:
        shown.append(door.bus.now())
        request.reply(KEYS.introduce("cellar"), encode(Introduction(mine, known[0])))
        request.finish()

    def times(seconds: float) -> int:
        shown.clear()
        door.pass_time(seconds)
        return len(shown)

    cellar.serve(KEYS.introduce("cellar"), answer)
    cellar.announce(KEYS.site_life("cellar", "1"))
    door.pass_time(10.0)
    assert times(60.0) == 60.0 / INTRODUCE_AGAIN
    known[0] = True
    door.pass_time(INTRODUCE_AGAIN)
    assert times(60.0) == 60.0 / INTRODUCE_AGAIN / KNOWN_FOR
    door.network.node().announce(KEYS.site_life("attic", "1"))
    assert times(INTRODUCE_AGAIN + 0.1) == 1


def vouched(door: Door, site: str) -> set[str]:
    """The components that another site may speak for."""
    return {c for access in door.keeper.rules.accesses if access.principal == f"site.{site}" for c in access.about}


def test_another_site_speaks_for_what_it_advertises(door: Door) -> None:
    advertise(door, "attic", BELL)
    assert vouched(door, "attic") == {Principal.component(BELL).name}


def test_another_site_of_the_host_hears_what_third_sites_say(door: Door) -> None:
    """It has no other hub, and may keep a task of which components live at a third site of the host."""
    bus = advertise(door, "attic", BELL)
    (attic,) = (access for access in door.keeper.rules.accesses if access.principal == "site.attic")
    assert attic.told
    door.sites.append("attic")
    bus.announce(KEYS.site_life("attic", "2"))
    door.pass_time(1.0)
    (attic,) = (access for access in door.keeper.rules.accesses if access.principal == "site.attic")
    assert not attic.told, "all that it hears"


def test_what_the_site_itself_advertises_anew_is_in_its_rules_at_once(door: Door) -> None:
    changed = door.network.node().publisher(KEYS.changed("home"), Urgency.EVENT)
    door.own[BELL] = BELL
    changed.put(b"")
    door.pass_time(1.0)
    assert Principal.component(BELL).common_name in door.principals
    del door.own[BELL]
    changed.put(b"")
    door.pass_time(1.0)
    assert Principal.component(BELL).common_name not in door.principals


def test_a_site_whose_advertisements_stay_costs_no_new_rules(tmp_path: Path) -> None:
    folder = CountedReads(Authority.init(tmp_path / "keys").path)
    door = Door(folder)
    bus = advertise(door, "attic", BELL)
    before = folder.reads
    for number in range(20):
        end = bus.announce(KEYS.site_life("attic", f"2{number}"))
        door.pass_time(0.2)
        end()
        door.pass_time(0.2)
    assert folder.reads - before <= 4, "those of the looks from time to time"


def test_what_two_sites_advertise_is_nobodys_until_somebody_says_whose(door: Door) -> None:
    advertise(door, "attic", BELL)
    advertise(door, "cellar", BELL)
    assert vouched(door, "attic") == vouched(door, "cellar") == set()
    assert [said for said in door.said if "urn:bell is advertised by the sites attic and cellar" in said]
    believe(door.folder.path, BELL, "cellar")
    door.pass_time(2.0)
    assert vouched(door, "attic") == set()
    assert vouched(door, "cellar") == {Principal.component(BELL).name}


def test_what_a_site_has_advertised_that_is_gone_is_that_of_the_one_that_advertises_it_now(door: Door) -> None:
    advertise(door, "attic", BELL).close()
    advertise(door, "cellar", BELL)
    assert vouched(door, "cellar") == set(), "only the way to the other one may be gone, for a moment"
    door.pass_time(GONE_AFTER + LOOK_AT_ALL)
    assert vouched(door, "cellar") == {Principal.component(BELL).name}
    assert not [said for said in door.said if "is advertised by the sites" in said]
    advertise(door, "attic", BELL)
    assert vouched(door, "attic") == vouched(door, "cellar") == set()
    assert [said for said in door.said if "urn:bell is advertised by the sites attic and cellar" in said]


def test_what_is_believed_to_be_that_of_a_site_that_was_not_seen_yet_is_no_others(door: Door) -> None:
    believe(door.folder.path, BELL, "attic")
    advertise(door, "cellar", BELL)
    assert vouched(door, "cellar") == set()
    assert [said for said in door.said if "urn:bell is advertised by the site cellar, and believed to be" in said]
    advertise(door, "attic", BELL)
    assert vouched(door, "attic") == {Principal.component(BELL).name}


def test_a_site_goes_on_with_its_own(door: Door) -> None:
    advertise(door, "attic", LAMP)
    assert vouched(door, "attic") == set()
    assert Principal.component(LAMP).common_name in door.principals
    assert door.said


def test_what_was_refused_is_told_once_and_shown_to_who_asks(door: Door) -> None:
    for _ in range(3):
        door.refusals.take("2126Z WARN acc-0 ThreadId(1) zenoh_link_tls::unicast: peer sent no certificates. Hint: x")
    door.pass_time(10.0)
    assert door.said == ["refused: a client without a trusted certificate: peer sent no certificates"]
    replies = door.ask(KEYS.access("home"))
    shown = [decode(sample.payload, RefusedAttempt) for sample in replies.samples if b"refused" in sample.payload[:40]]
    assert [(one.principal, one.number) for one in shown] == [("", 3)]
    rules = [decode(sample.payload, Access) for sample in replies.samples if b"access" in sample.payload[:40]]
    assert tuple(rules) == door.keeper.rules.accesses


def test_a_renewed_certificate_is_shown_by_the_hub(door: Door, tmp_path: Path) -> None:
    certificate = door.folder.path / "own/site.home/certificate.pem"
    before = certificate.stat()
    certificate.write_bytes(certificate.read_bytes())
    assert certificate.stat().st_mtime_ns != before.st_mtime_ns
    door.pass_time(1.5)
    assert len(door.enforced) == 1


def test_a_renewed_certificate_is_shown_though_those_of_components_cannot_be_renewed(
    door: Door, monkeypatch: pytest.MonkeyPatch
) -> None:
    def not_renewed(authority: HostAuthority) -> Iterator[None]:
        yield from ()
        raise AuthorError("holds no private key in PEM")

    monkeypatch.setattr(HostAuthority, "renew_components", not_renewed)
    certificate = door.folder.path / "own/site.home/certificate.pem"
    certificate.write_bytes(certificate.read_bytes())
    door.pass_time(1.5)
    assert len(door.enforced) == 1
    assert door.said == ["holds no private key in PEM"]


def test_while_the_certificates_of_many_components_are_renewed_the_site_does_other_things(
    door: Door, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each takes some 20 ms, and the site may be running tasks."""
    host, issued, heard = HostAuthority(door.folder), list[Path](), list[int]()
    for number in range(5):
        host.component(Principal.component(IRI(f"urn:lamp{number}")))

    def issue(authority: HostAuthority, folder: Path, *_: object) -> None:
        issued.append(folder)
        door.bus.later(0.0, lambda: heard.append(len(issued)))

    def renewed_before() -> int:
        """How many were renewed before the hub was opened with a new certificate of the site, which is due as well."""
        issued.clear()
        door.enforced.clear()
        door.bus.run(lambda: bool(door.enforced))
        return len(set(issued))

    monkeypatch.setattr(doorkeeper, "WARNED", 0.0)  # the steps take no time here
    monkeypatch.setattr(HostAuthority, "_issue", issue)
    monkeypatch.setattr(Certificate, "half_over", lambda self, now=None: True)
    door.pass_time(LOOK_AT_ALL + 1.0)
    assert len(set(issued)) == 5
    assert heard[:5] == [1, 2, 3, 4, 5]
    assert renewed_before() == 5, "links are made with their certificates then"


@pytest.mark.parametrize("copied", [b"\x30\x82", None], ids=["not in PEM", "of another key"])
def test_by_a_wrong_certificate_the_hub_is_not_opened_anew_until_there_is_a_good_one(
    door: Door, tmp_path: Path, copied: bytes | None
) -> None:
    alice = door.folder.issue(Principal(PrincipalKind.READER, "alice"), tmp_path / "alice").pem
    certificate = door.folder.path / "own/site.home/certificate.pem"
    good = certificate.read_bytes()
    certificate.write_bytes(alice if copied is None else copied)
    door.introduce(alice.decode())
    door.pass_time(10.0)
    assert door.enforced == []
    assert any(one.startswith("the hub cannot be opened with its new rules: ") for one in door.said)
    certificate.write_bytes(good)
    door.pass_time(2.0)
    assert door.enforced[-1] is door.keeper.rules
    assert "read.alice" in door.principals


def test_who_is_revoked_is_out(door: Door, tmp_path: Path) -> None:
    eve = door.folder.issue(Principal(PrincipalKind.CONFIGURATOR, "eve"), tmp_path / "eve")
    door.introduce(eve.pem.decode())
    door.pass_time(0.1)
    assert "conf.eve" in door.principals
    door.folder.revoke(Principal(PrincipalKind.CONFIGURATOR, "eve"))
    door.pass_time(1.5)
    assert "conf.eve" not in door.principals


def test_a_site_that_is_revoked_ends(door: Door) -> None:
    door.folder.revoke(Principal(PrincipalKind.SITE, "home"))
    door.pass_time(1.5)
    assert door.said[-1] == "it ends"


def test_what_a_site_says_for_its_components_before_these_are_known_is_no_attempt(door: Door) -> None:
    bus = advertise(door, "attic")
    for component in (BELL, LAMP):
        line = "2126-01-01T00:00:00Z TRACE rx ThreadId(1) x: {}"
        key = KEYS.outputs(component)
        peer = "a1 on Interface(lo)+CertCommonName(site.attic) is unauthorized to Declare Queryable (ingress) on"
        door.refusals.take(line.format(f"{peer} {key}"))
        door.refusals.take(line.format("Msg intercepted!"))
    bus.close()
    advertise(door, "attic", BELL)
    door.pass_time(5.0)
    assert [said for said in door.said if "refused" in said] == [
        f"refused: site.attic: Declare Queryable on {KEYS.outputs(LAMP)}"
    ]


def test_a_folder_in_which_nothing_changes_is_read_seldom_and_at_once_when_something_does(tmp_path: Path) -> None:
    authority = Authority.init(tmp_path / "keys")
    folder = CountedReads(authority.path)
    door = Door(folder)
    door.pass_time(5.0)
    before = folder.reads
    door.pass_time(3.0 * LOOK_AT_ALL)
    assert 2 <= folder.reads - before <= 4
    bob = authority.issue(Principal(PrincipalKind.CONFIGURATOR, "bob"), tmp_path / "bob")
    authority.admit("lab", bob.pem)  # as another site of this host does
    door.pass_time(1.5)
    assert "conf.bob" in door.principals


def test_who_has_expired_is_out_of_the_rules(door: Door, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bob = door.folder.issue(Principal(PrincipalKind.CONFIGURATOR, "bob"), tmp_path / "bob")
    door.introduce(bob.pem.decode())
    door.pass_time(1.5)
    assert "conf.bob" in door.principals
    monkeypatch.setattr(certificates, "_now", lambda: bob.ends + timedelta(seconds=1.0))
    door.pass_time(LOOK_AT_ALL + 1.5)
    assert "conf.bob" not in door.principals


def test_a_hub_is_opened_anew_for_the_renewed_certificates_of_components_and_sites_of_its_host(
    door: Door, tmp_path: Path
) -> None:
    """Zenoh ends a link as the certificate expires by which it was made, and lives would seem to end unannounced."""

    components = [Principal.component(one) for one in (LAMP, BELL)]
    attic, cellar = (Principal(PrincipalKind.SITE, name) for name in ("attic", "cellar"))
    alice = Principal(PrincipalKind.CONFIGURATOR, "alice")

    def openings(number: int, *principals: Principal) -> int:
        """How often the hub is opened anew as principals show the certificate of this number."""
        door.enforced.clear()
        for one in principals:
            folder = tmp_path / f"{one.common_name} {number}"
            if not folder.exists():
                door.folder.issue(one, folder, days=number)
            door.introduce((folder / "certificate.pem").read_text())
        door.pass_time(RENEWED_TOGETHER + 0.1)
        return len(door.enforced)

    door.sites.append("attic")
    openings(1, *components, attic, cellar, alice)  # once, as all are new to it
    assert openings(1, *components, attic, cellar, alice) == 0
    assert openings(2, *components) == 1
    assert openings(2, attic) == 1
    assert openings(2, cellar, alice) == 0, "links to other hosts are made anew by these, and that of alice is her own"
    assert openings(1, *components) == 0, "those of before"
