"""The folder of an authority issues, renews and revokes, and knows which folders have heard of it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta
from pathlib import Path

import pytest

from selfconf.access import Authority, KeysFolder, Principal, PrincipalKind, certificates
from selfconf.errors import AuthorError, PeerError

CONF, READ, SITE = PrincipalKind.CONFIGURATOR, PrincipalKind.READER, PrincipalKind.SITE
ALICE = Principal(READ, "alice")


@pytest.fixture
def authority(tmp_path: Path) -> Authority:
    """A new authority."""
    return Authority.init(tmp_path / "authority")


def test_with_the_folder_of_an_authority_a_program_gets_what_it_needs(authority: Authority) -> None:
    assert authority.credentials((CONF, READ)).name == "conf.main"
    assert authority.credentials((SITE,), "attic").name == "site.attic"
    assert authority.credentials((SITE,), "attic") == authority.credentials((SITE,), "attic")
    assert {"conf.main", "read.main"} == authority.admitted("lab").keys()


def test_an_authority_whose_making_was_broken_off_is_of_use(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(Authority, "credentials", interrupted)
        with pytest.raises(KeyboardInterrupt):
            Authority.init(tmp_path / "authority")
    assert Authority(tmp_path / "authority").admitted("lab").keys() == {"conf.main", "read.main"}


def test_a_certificate_is_renewed_for_the_same_key(authority: Authority, tmp_path: Path) -> None:
    old = authority.issue(ALICE, tmp_path / "alice", ["10.0.0.1"], days=1)
    key = (tmp_path / "alice/certificate.key").read_bytes()
    new = authority.renew(tmp_path / "alice", days=9)
    assert (tmp_path / "alice/certificate.key").read_bytes() == key
    assert new.ends > old.ends
    assert new.hosts == old.hosts
    assert KeysFolder(tmp_path / "alice").own() == new
    other = Authority.init(tmp_path / "other")
    with pytest.raises(AuthorError, match="another authority"):
        other.renew(tmp_path / "alice")
    with pytest.raises(AuthorError, match="nothing to renew"):
        authority.renew(authority.path)


def test_what_is_half_over_is_renewed_by_itself(authority: Authority, monkeypatch: pytest.MonkeyPatch) -> None:
    def serial() -> int:
        return KeysFolder(authority.path / "own/site.attic").own().serial

    authority.credentials((SITE,), "attic")
    first = serial()
    authority.credentials((SITE,), "attic")
    assert serial() == first
    monkeypatch.setattr(certificates.Certificate, "half_over", lambda self: True)
    authority.credentials((SITE,), "attic")
    assert serial() != first


def test_what_has_expired_of_programs_with_the_folder_of_the_authority_is_removed(
    authority: Authority, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each run with advertisements of its own is a site of a random name."""

    def kept() -> tuple[set[str], set[str]]:
        issued = {path.stem.partition("~")[0] for path in (authority.path / "issued").iterdir()}
        return {path.name for path in (authority.path / "own").iterdir()}, issued

    authority.issue(ALICE, tmp_path / "alice")
    for number in range(3):
        authority.credentials((SITE,), f"s{number}")
    mains, runs = {"conf.main", "read.main"}, {"site.s0", "site.s1", "site.s2"}
    assert kept() == (mains | runs, mains | runs | {"read.alice"})
    later = certificates._now() + timedelta(days=8)
    monkeypatch.setattr(certificates, "_now", lambda: later)
    authority.credentials((SITE,), "s3")
    assert kept() == (mains | {"site.s3"}, {"site.s3", "read.alice"})
    assert authority.credentials((SITE,), "s0").name == "site.s0"


def test_what_was_issued_while_the_clock_was_ahead_is_made_anew(
    authority: Authority, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As on a board without a clock of its own: until then it would not be valid, however long that is."""
    now = certificates._now()
    monkeypatch.setattr(certificates, "_now", lambda: now + timedelta(days=1000))
    before = KeysFolder(authority.credentials((CONF,)).certificate.parent).own()
    monkeypatch.setattr(certificates, "_now", lambda: now)
    assert before.untimely()
    after = KeysFolder(authority.credentials((CONF,)).certificate.parent).own()
    assert not after.untimely()
    assert after.common_name == before.common_name


def test_who_is_revoked_is_admitted_no_more_and_gets_no_new_certificate(authority: Authority, tmp_path: Path) -> None:
    certificate = authority.issue(ALICE, tmp_path / "alice")
    authority.admit("lab", certificate.pem)
    assert "read.alice" in authority.admitted("lab")
    assert "read.alice" not in authority.admitted("home")
    assert authority.revoke(ALICE) == 1
    assert authority.revoked() == {certificate.serial}
    assert "read.alice" not in authority.admitted("lab")
    for forbidden in (
        lambda: authority.issue(ALICE, tmp_path / "again"),
        lambda: authority.renew(tmp_path / "alice"),
        lambda: authority.admit("lab", certificate.pem),
    ):
        with pytest.raises((AuthorError, PeerError), match="revoked"):
            forbidden()
    bob = Principal(READ, "bob")
    authority.credentials((bob.kind,), bob.name)
    authority.revoke(bob)
    with pytest.raises(AuthorError, match="choose another name"):
        authority.credentials((bob.kind,), bob.name)
    assert authority.revoke(Principal(CONF, "main")) == 1
    authority.credentials((CONF,))
    assert certificate.serial in authority.revoked(), "a list holds what it held before"
    with pytest.raises(AuthorError, match="nothing to revoke"):
        authority.revoke(Principal(READ, "eve"))


def test_a_folder_that_is_issued_later_knows_what_was_revoked_before(authority: Authority, tmp_path: Path) -> None:
    alice = authority.issue(ALICE, tmp_path / "alice")
    authority.revoke(ALICE)
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic")
    with pytest.raises(PeerError, match="was revoked"):
        KeysFolder(tmp_path / "attic").admit("lab", alice.pem)


def test_what_is_revoked_at_once_is_all_revoked(authority: Authority, tmp_path: Path) -> None:
    names = [Principal(READ, f"reader{number}") for number in range(8)]
    for name in names:
        authority.issue(name, tmp_path / name.name)
    with ThreadPoolExecutor(len(names)) as people:
        assert list(people.map(lambda name: Authority(authority.path).revoke(name), names)) == [1] * len(names)
    assert len(authority.revoked()) == len(names)


def test_a_site_whose_folder_cannot_be_told_what_is_revoked_is_named(authority: Authority, tmp_path: Path) -> None:
    authority.credentials((SITE,), "home")
    for name in ("attic", "cellar", "moved", "replaced"):
        authority.issue(Principal(SITE, name), tmp_path / name)
    authority.issue(ALICE, tmp_path / "alice")
    (tmp_path / "moved").rename(tmp_path / "elsewhere")
    (tmp_path / "replaced").rename(tmp_path / "before")
    Authority.init(tmp_path / "replaced")
    (tmp_path / "cellar/revoked.pem").mkdir()  # it cannot be written, by root either
    authority.revoke(ALICE)
    assert not (tmp_path / "replaced/revoked.pem").exists()
    assert (tmp_path / "attic/revoked.pem").read_bytes() == (authority.path / "revoked.pem").read_bytes()
    unaware = [(f"site.{name}", tmp_path / name) for name in ("cellar", "moved", "replaced")]
    assert authority.unaware() == unaware
    authority.revoke(Principal(SITE, "moved"))
    assert authority.unaware() == [unaware[0], unaware[2]]
    for note in (authority.path / "issued").glob("site.cellar*.folder"):
        note.unlink()
    assert authority.unaware()[0] == ("site.cellar", None)


def test_a_site_whose_folder_was_moved_and_renewed_has_the_list(authority: Authority, tmp_path: Path) -> None:
    site = Principal(SITE, "attic")
    authority.issue(site, tmp_path / "before")
    (tmp_path / "before").rename(tmp_path / "now")
    authority.renew(tmp_path / "now")
    authority.issue(ALICE, tmp_path / "alice")
    authority.revoke(ALICE)
    assert authority.unaware() == []
    assert set(authority.aware()) == {tmp_path / "now", tmp_path / "alice"}
    authority.issue(site, tmp_path / "another")
    (tmp_path / "another").rename(tmp_path / "away")
    assert authority.unaware() == [("site.attic", tmp_path / "another")], "it has another key"


def test_nothing_is_written_over(authority: Authority, tmp_path: Path) -> None:
    with pytest.raises(AuthorError, match="not empty"):
        Authority.init(authority.path)
    authority.issue(ALICE, tmp_path / "alice")
    with pytest.raises(AuthorError, match="not empty"):
        authority.issue(ALICE, tmp_path / "alice")
    with pytest.raises(AuthorError, match="there is no folder"):
        KeysFolder(tmp_path / "nowhere")
