"""A folder of keys is read by its owner alone, shows what was issued to it, and says what is wrong with it."""

from __future__ import annotations

import stat
from datetime import timedelta
from pathlib import Path

import pytest

from selfconf.access import Authority, HostAuthority, KeysFolder, Principal, PrincipalKind, certificates
from selfconf.errors import AuthorError, PeerError
from selfconf.model.term import IRI

CONF, READ, SITE = PrincipalKind.CONFIGURATOR, PrincipalKind.READER, PrincipalKind.SITE
ALICE = Principal(READ, "alice")


@pytest.fixture
def authority(tmp_path: Path) -> Authority:
    """A new authority."""
    return Authority.init(tmp_path / "authority")


def test_keys_are_read_by_their_owner_alone(authority: Authority, tmp_path: Path) -> None:
    authority.issue(ALICE, tmp_path / "alice")
    HostAuthority(authority).component(Principal.component(IRI("urn:c")))
    for path in (*authority.path.rglob("*"), *(tmp_path / "alice").rglob("*")):
        assert not stat.S_IMODE(path.stat().st_mode) & 0o077, path
    (tmp_path / "alice/certificate.key").chmod(0o640)
    with pytest.raises(AuthorError, match=r"others may read .*chmod 600"):
        KeysFolder(tmp_path / "alice")


@pytest.mark.parametrize("key", ["authority.key", "components.key", "certificate.key"])
def test_a_folder_with_a_key_that_others_may_read_is_refused(authority: Authority, tmp_path: Path, key: str) -> None:
    authority.issue(ALICE, tmp_path / "alice")
    (tmp_path / "alice" / key).touch(0o600)
    KeysFolder(tmp_path / "alice")
    (tmp_path / "alice" / key).chmod(0o604)
    with pytest.raises(AuthorError, match=rf"others may read .*{key}, so it is no secret"):
        KeysFolder(tmp_path / "alice")


@pytest.mark.parametrize("believed", [".", "authority.pem", "components.pem"])
def test_a_certificate_of_an_authority_that_others_may_replace_is_refused(
    authority: Authority, tmp_path: Path, believed: str
) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic")
    HostAuthority(KeysFolder(tmp_path / "attic")).hub_authorities()
    spoilt = tmp_path / "attic" / believed
    spoilt.chmod(spoilt.stat().st_mode | 0o020)
    with pytest.raises(AuthorError, match=rf"others may write into {spoilt}, .*`chmod go-w {spoilt}`"):
        KeysFolder(tmp_path / "attic")


def test_a_holder_shows_what_it_was_issued(authority: Authority, tmp_path: Path) -> None:
    issued = authority.issue(ALICE, tmp_path / "alice", ["10.0.0.1"], days=3)
    folder = KeysFolder(tmp_path / "alice")
    assert folder.own() == issued
    assert not folder.is_authority
    shown = folder.credentials((READ, CONF))
    assert (shown.name, shown.folder) == ("read.alice", tmp_path / "alice")
    with pytest.raises(AuthorError, match=r"speaks for read.alice; this takes a certificate of conf.NAME or site.NAME"):
        folder.credentials((CONF, SITE))
    with pytest.raises(AuthorError, match="not the folder of an authority"):
        Authority(tmp_path / "alice")


def test_a_holder_that_knows_that_it_is_revoked_shows_nothing(authority: Authority, tmp_path: Path) -> None:
    authority.issue(ALICE, tmp_path / "alice")
    authority.revoke(ALICE)
    with pytest.raises(AuthorError, match=r"the certificate of read\.alice was revoked"):
        KeysFolder(tmp_path / "alice").credentials((READ,))


def test_a_site_admits_whom_its_authority_vouches_for(authority: Authority, tmp_path: Path) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic")
    alice = authority.issue(ALICE, tmp_path / "alice")
    site = KeysFolder(tmp_path / "attic")
    assert site.admitted("lab") == {}
    site.admit("lab", alice.pem)
    assert site.admitted("lab") == {"read.alice": alice}
    stranger = Authority.init(tmp_path / "other").issue(ALICE, tmp_path / "eve")
    with pytest.raises(PeerError, match="another authority"):
        site.admit("lab", stranger.pem)
    with pytest.raises(PeerError, match="no certificate"):
        site.admit("lab", b"nonsense")
    authority.revoke(ALICE)
    assert site.admitted("lab") == {}
    with pytest.raises(PeerError, match="was revoked"):
        site.admit("lab", alice.pem)


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
    spoil: object, words: str, authority: Authority, tmp_path: Path
) -> None:
    authority.issue(ALICE, tmp_path / "alice")
    spoil(tmp_path / "alice")  # type: ignore[operator]  # each is a function of the folder
    with pytest.raises(AuthorError, match=words):
        KeysFolder(tmp_path / "alice").credentials((READ,))


def test_an_old_certificate_that_somebody_shows_does_not_take_the_place_of_the_new_one(
    authority: Authority, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
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
