"""A folder of keys issues, renews and revokes, is read by its owner alone, and says what is wrong with it."""

from __future__ import annotations

import stat
from datetime import timedelta
from pathlib import Path

import pytest

from selfconf.access import KeysFolder, Principal, PrincipalKind, certificates
from selfconf.errors import AuthorError, PeerError
from selfconf.model.term import IRI

CONF, READ, SITE, COMP = (
    PrincipalKind.CONFIGURATOR,
    PrincipalKind.READER,
    PrincipalKind.SITE,
    PrincipalKind.COMPONENT,
)
ALICE = Principal(READ, "alice")


@pytest.fixture
def authority(tmp_path: Path) -> KeysFolder:
    """A new authority."""
    return KeysFolder.init(tmp_path / "authority")


def test_keys_are_read_by_their_owner_alone(authority: KeysFolder, tmp_path: Path) -> None:
    authority.issue(ALICE, tmp_path / "alice")
    authority.component(Principal.component(IRI("urn:c")))
    for path in (*authority.path.rglob("*"), *(tmp_path / "alice").rglob("*")):
        assert not stat.S_IMODE(path.stat().st_mode) & 0o077, path
    (tmp_path / "alice/certificate.key").chmod(0o640)
    with pytest.raises(AuthorError, match=r"others may read .*chmod 600"):
        KeysFolder(tmp_path / "alice")


def test_a_holder_shows_what_it_was_issued(authority: KeysFolder, tmp_path: Path) -> None:
    issued = authority.issue(ALICE, tmp_path / "alice", ["10.0.0.1"], days=3)
    folder = KeysFolder(tmp_path / "alice")
    assert folder.own() == issued
    assert not folder.is_authority
    shown = folder.credentials((READ, CONF))
    assert (shown.name, shown.folder) == ("read.alice", tmp_path / "alice")
    with pytest.raises(AuthorError, match=r"speaks for read.alice; this takes a certificate of conf.NAME or site.NAME"):
        folder.credentials((CONF, SITE))
    with pytest.raises(AuthorError, match="not the folder of an authority"):
        folder.issue(ALICE, tmp_path / "other")


def test_with_the_folder_of_an_authority_a_program_gets_what_it_needs(authority: KeysFolder) -> None:
    assert authority.credentials((CONF, READ)).name == "conf.main"
    assert authority.credentials((SITE,), "attic").name == "site.attic"
    assert authority.credentials((SITE,), "attic") == authority.credentials((SITE,), "attic")
    assert {"conf.main", "read.main"} == authority.admitted("lab").keys()


def test_a_certificate_is_renewed_for_the_same_key(authority: KeysFolder, tmp_path: Path) -> None:
    old = authority.issue(ALICE, tmp_path / "alice", ["10.0.0.1"], days=1)
    key = (tmp_path / "alice/certificate.key").read_bytes()
    new = authority.renew(tmp_path / "alice", days=9)
    assert (tmp_path / "alice/certificate.key").read_bytes() == key
    assert new.ends > old.ends
    assert new.hosts == old.hosts
    assert KeysFolder(tmp_path / "alice").own() == new
    other = KeysFolder.init(tmp_path / "other")
    with pytest.raises(AuthorError, match="another authority"):
        other.renew(tmp_path / "alice")
    with pytest.raises(AuthorError, match="nothing to renew"):
        authority.renew(authority.path)


def test_what_is_half_over_is_renewed_by_itself(authority: KeysFolder, monkeypatch: pytest.MonkeyPatch) -> None:
    def serial() -> int:
        return KeysFolder(authority.path / "own/site.attic").own().serial

    authority.credentials((SITE,), "attic")
    first = serial()
    authority.credentials((SITE,), "attic")
    assert serial() == first
    monkeypatch.setattr(certificates.Certificate, "half_over", lambda self: True)
    authority.credentials((SITE,), "attic")
    assert serial() != first


def test_who_is_revoked_is_admitted_no_more_and_gets_no_new_certificate(authority: KeysFolder, tmp_path: Path) -> None:
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
    assert authority.revoke(Principal(CONF, "main")) == 1
    assert certificate.serial in authority.revoked(), "a list holds what it held before"
    with pytest.raises(AuthorError, match="nothing to revoke"):
        authority.revoke(Principal(READ, "bob"))


def test_a_site_admits_whom_its_authority_vouches_for(authority: KeysFolder, tmp_path: Path) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic")
    alice = authority.issue(ALICE, tmp_path / "alice")
    site = KeysFolder(tmp_path / "attic")
    assert site.admitted("lab") == {}
    site.admit("lab", alice.pem)
    assert site.admitted("lab") == {"read.alice": alice}
    stranger = KeysFolder.init(tmp_path / "other").issue(ALICE, tmp_path / "eve")
    with pytest.raises(PeerError, match="another authority"):
        site.admit("lab", stranger.pem)
    with pytest.raises(PeerError, match="no certificate"):
        site.admit("lab", b"nonsense")
    authority.revoke(ALICE)
    assert site.admitted("lab") == {}
    with pytest.raises(PeerError, match="was revoked"):
        site.admit("lab", alice.pem)


def test_a_site_whose_folder_cannot_be_told_what_is_revoked_is_named(authority: KeysFolder, tmp_path: Path) -> None:
    authority.credentials((SITE,), "home")
    for name in ("attic", "cellar", "moved", "replaced"):
        authority.issue(Principal(SITE, name), tmp_path / name)
    authority.issue(ALICE, tmp_path / "alice")
    (tmp_path / "moved").rename(tmp_path / "elsewhere")
    (tmp_path / "replaced").rename(tmp_path / "before")
    KeysFolder.init(tmp_path / "replaced")
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


def test_a_site_whose_folder_was_moved_and_renewed_has_the_list(authority: KeysFolder, tmp_path: Path) -> None:
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


def test_what_a_host_issues_to_its_components_opens_no_other_door(authority: KeysFolder, tmp_path: Path) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic")
    authority.issue(Principal(SITE, "cellar"), tmp_path / "cellar")
    attic, cellar = KeysFolder(tmp_path / "attic"), KeysFolder(tmp_path / "cellar")
    first, second = Principal.component(IRI("urn:a")), Principal.component(IRI("urn:b"))
    component = KeysFolder(attic.component(first, [second]))
    assert component.credentials((COMP,)).name == first.common_name
    assert attic.admit("lab", component.own().pem).principals == (first, second)
    with pytest.raises(PeerError, match="another authority"):
        cellar.admit("lab", component.own().pem)
    assert component.own().fault((*cellar.believed_authorities(), authority.authority))
    assert component.own().fault(())
    assert not component.own().fault(attic.believed_authorities())
    before = component.own()
    assert KeysFolder(attic.component(first, [second])).own() == before
    alone = KeysFolder(attic.component(first)).own()
    assert (alone.principals, alone.common_name) == ((first,), before.common_name)
    assert KeysFolder(attic.component(first, [second])).own() == before, "in another ecology it shares a process"
    attic.admit("lab", alone.pem)
    assert {one.principals for one in attic.admitted("lab").values()} == {(first, second), (first,)}


def test_the_sites_of_a_host_believe_the_components_of_each_other(authority: KeysFolder, tmp_path: Path) -> None:
    lamp, shared = Principal.component(IRI("urn:lamp")), tmp_path / "shared"
    shared.mkdir(0o700)
    sites = []
    for name in ("attic", "cellar"):
        authority.issue(Principal(SITE, name), tmp_path / name)
        sites.append(KeysFolder(tmp_path / name))
    attic, cellar = sites
    before = KeysFolder(cellar.component(lamp)).own()
    for site in (attic, cellar):
        site.share_host_authority(shared)
    assert attic.hub_authorities().read_bytes() == cellar.hub_authorities().read_bytes()
    with pytest.raises(PeerError, match="issued by another authority"):
        attic.admit("lab", before.pem)
    renewed = KeysFolder(cellar.component(lamp)).own()
    assert attic.admit("lab", renewed.pem) == renewed, "its certificate is made anew by the common authority"
    assert all(not stat.S_IMODE(path.stat().st_mode) & 0o077 for path in shared.iterdir())


def test_a_common_authority_that_is_spoilt_is_made_anew(authority: KeysFolder, tmp_path: Path) -> None:
    shared = tmp_path / "shared"
    shared.mkdir(0o700)
    authority.share_host_authority(shared)
    (key,) = shared.glob("*.key")
    for spoil in (lambda: key.write_bytes(b"nothing"), lambda: key.chmod(0o644), key.unlink):
        spoil()
        authority.share_host_authority(shared)
        assert key.read_bytes() == (authority.path / "components.key").read_bytes()
        assert not stat.S_IMODE(key.stat().st_mode) & 0o077


def test_the_authorities_of_two_ecologies_share_nothing(tmp_path: Path) -> None:
    shared = tmp_path / "shared"
    shared.mkdir(0o700)
    one, other = (KeysFolder.init(tmp_path / name) for name in ("one", "other"))
    for folder in (one, other):
        folder.share_host_authority(shared)
    assert len(list(shared.glob("*.key"))) == 2
    assert (one.path / "components.key").read_bytes() != (other.path / "components.key").read_bytes()


def test_a_host_cannot_make_itself_a_configurator(authority: KeysFolder, tmp_path: Path) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic")
    attic = KeysFolder(tmp_path / "attic")
    forged = attic.component(Principal(CONF, "main"))
    with pytest.raises(PeerError, match="another authority"):
        attic.admit("lab", KeysFolder(forged).own().pem)


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda f: (f / "authority.pem").unlink(), "there is no authority.pem"),
        (lambda f: (f / "authority.pem").write_text("x"), "no certificate in PEM"),
        (lambda f: (f / "certificate.pem").unlink(), "there is no certificate.pem"),
        (lambda f: (f / "certificate.key").write_text("x"), "no private key"),
        (
            lambda f: (f / "certificate.key").write_bytes(certificates.key_pem(certificates.new_key())),
            "is not the key of",
        ),
        (lambda f: (f / "revoked.pem").write_text("x"), "no list of revoked"),
    ],
)
def test_each_way_to_be_spoilt_has_its_sentence(
    spoil: object, words: str, authority: KeysFolder, tmp_path: Path
) -> None:
    authority.issue(ALICE, tmp_path / "alice")
    spoil(tmp_path / "alice")  # type: ignore[operator]  # each is a function of the folder
    with pytest.raises(AuthorError, match=words):
        KeysFolder(tmp_path / "alice").credentials((READ,))


def test_nothing_is_written_over(authority: KeysFolder, tmp_path: Path) -> None:
    with pytest.raises(AuthorError, match="not empty"):
        KeysFolder.init(authority.path)
    authority.issue(ALICE, tmp_path / "alice")
    with pytest.raises(AuthorError, match="not empty"):
        authority.issue(ALICE, tmp_path / "alice")
    with pytest.raises(AuthorError, match="there is no folder"):
        KeysFolder(tmp_path / "nowhere")


def test_a_component_has_no_certificate_for_longer_than_its_site(authority: KeysFolder, tmp_path: Path) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic", days=0.5)
    attic, lamp = KeysFolder(tmp_path / "attic"), Principal.component(IRI("urn:lamp"))
    component = KeysFolder(attic.component(lamp))
    assert component.own().ends == attic.own().ends
    authority.renew(attic.path, days=0.25)
    attic.renew_components()
    assert component.own().ends == attic.own().ends
    authority.renew(attic.path, days=30.0)
    attic.renew_components()
    assert not component.own().half_over(), "it is renewed when half of its time has passed"


def test_an_old_certificate_that_somebody_shows_does_not_take_the_place_of_the_new_one(
    authority: KeysFolder, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Certificates are no secret; with the old one, the holder would be out as soon as that expires."""
    monkeypatch.setattr(certificates, "CLOCKS_DIFFER", timedelta(minutes=6))
    old = authority.issue(ALICE, tmp_path / "alice", days=1)
    monkeypatch.undo()
    new = authority.renew(tmp_path / "alice", days=0.5)
    assert authority.admit("lab", old.pem) == old
    assert authority.admit("lab", new.pem) == new
    assert authority.admit("lab", old.pem) == old, "it is good"
    assert authority.admitted("lab")["read.alice"] == new
