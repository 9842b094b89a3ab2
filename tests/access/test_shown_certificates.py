"""Who shows a certificate to a site, on a bus in memory, is let in for as long as that is good."""

from __future__ import annotations

import errno
from datetime import timedelta
from pathlib import Path

import pytest

from selfconf.access import Authority, KeysFolder, Principal, PrincipalKind, certificates, keys_folder
from selfconf.access.doorkeeper import INTRODUCE_AGAIN, KNOWN_FOR, LOOK_AT_ALL
from selfconf.bus.port import Request
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.messages import Introduction
from tests.access.door import KEYS, CountedReads, Door


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


def test_who_is_revoked_is_out(door: Door, tmp_path: Path) -> None:
    eve = door.folder.issue(Principal(PrincipalKind.CONFIGURATOR, "eve"), tmp_path / "eve")
    door.introduce(eve.pem.decode())
    door.pass_time(0.1)
    assert "conf.eve" in door.principals
    door.folder.revoke(Principal(PrincipalKind.CONFIGURATOR, "eve"))
    door.pass_time(1.5)
    assert "conf.eve" not in door.principals


def test_who_has_expired_is_out_of_the_rules(door: Door, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bob = door.folder.issue(Principal(PrincipalKind.CONFIGURATOR, "bob"), tmp_path / "bob")
    door.introduce(bob.pem.decode())
    door.pass_time(1.5)
    assert "conf.bob" in door.principals
    monkeypatch.setattr(certificates, "_now", lambda: bob.ends + timedelta(seconds=1.0))
    door.pass_time(LOOK_AT_ALL + 1.5)
    assert "conf.bob" not in door.principals
