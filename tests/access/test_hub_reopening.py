"""When a hub is opened anew: for other rules, for renewed certificates, and again where that fails."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.access import Certificate, HostAuthority, Principal, PrincipalKind, hub_reopening
from selfconf.access.doorkeeper import LOOK_AT_ALL, RENEWED_TOGETHER
from selfconf.access.hub_reopening import RAREST_RETRY, WARNED, HubReopening
from selfconf.bus.memory import Network
from selfconf.errors import AuthorError
from selfconf.model.term import IRI
from selfconf.protocol.codec import decode
from selfconf.protocol.messages import Introduction
from tests.access.door import BELL, KEYS, LAMP, Door


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

    monkeypatch.setattr(hub_reopening, "WARNED", 0.0)  # the steps take no time here
    monkeypatch.setattr(HostAuthority, "_issue", issue)
    monkeypatch.setattr(Certificate, "half_over", lambda self, now=None: True)
    door.pass_time(LOOK_AT_ALL + 1.0)
    assert len(set(issued)) == 5
    assert heard[:5] == [1, 2, 3, 4, 5]
    assert renewed_before() == 5, "links are made with their certificates then"


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


def test_a_hub_is_opened_anew_once_by_the_earliest_time_that_was_asked_for() -> None:
    network, opened, warned = Network(1), list[float](), list[float]()
    bus = network.node()
    bus.subscribe(KEYS.reopens(), lambda _: warned.append(bus.now()))
    began = bus.now()
    reopening = HubReopening(bus, KEYS.reopens("home"), lambda: True, lambda: opened.append(bus.now()), pytest.fail)
    for seconds in (5.0, 1.0, 2.0):
        reopening.within(seconds)
    network.let_pass(10.0)
    assert opened == pytest.approx([began + 1.0 + WARNED], abs=0.02)
    assert warned == pytest.approx([began + 1.0], abs=0.02)
    reopening.within(1.0)
    reopening.now()
    reopening.within(0.01)
    reopening.now()
    network.let_pass(10.0)
    assert len(opened) == len(warned) == 2
