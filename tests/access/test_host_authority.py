"""What a host issues to its components is believed there alone, by all sites of one user."""

from __future__ import annotations

import errno
import os
import stat
import time
from contextlib import suppress
from datetime import datetime, timedelta, timezone, tzinfo
from pathlib import Path

import pytest

from selfconf.access import Authority, HostAuthority, KeysFolder, Principal, PrincipalKind, certificates, host_authority
from selfconf.access.certificate_files import HOST_AUTHORITY, read_pair
from selfconf.errors import AuthorError, PeerError
from selfconf.model.term import IRI

CONF, SITE, COMP = PrincipalKind.CONFIGURATOR, PrincipalKind.SITE, PrincipalKind.COMPONENT


@pytest.fixture
def authority(tmp_path: Path) -> Authority:
    """A new authority."""
    return Authority.init(tmp_path / "authority")


def test_what_a_host_issues_to_its_components_opens_no_other_door(authority: Authority, tmp_path: Path) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic")
    authority.issue(Principal(SITE, "cellar"), tmp_path / "cellar")
    attic, cellar = KeysFolder(tmp_path / "attic"), KeysFolder(tmp_path / "cellar")
    first, second = Principal.component(IRI("urn:a")), Principal.component(IRI("urn:b"))
    component = KeysFolder(HostAuthority(attic).component(first, [second]))
    assert component.credentials((COMP,)).name == first.common_name
    assert attic.admit("lab", component.own().pem).principals == (first, second)
    with pytest.raises(PeerError, match="another authority"):
        cellar.admit("lab", component.own().pem)
    assert component.own().fault((*cellar.believed_authorities(), authority.authority))
    assert component.own().fault(())
    assert not component.own().fault(attic.believed_authorities())
    before = component.own()
    assert KeysFolder(HostAuthority(attic).component(first, [second])).own() == before
    alone = KeysFolder(HostAuthority(attic).component(first)).own()
    assert (alone.principals, alone.common_name) == ((first,), before.common_name)
    shared = KeysFolder(HostAuthority(attic).component(first, [second]))
    assert shared.own() == before, "in another ecology it shares a process"
    attic.admit("lab", alone.pem)
    assert {one.principals for one in attic.admitted("lab").values()} == {(first, second), (first,)}


def test_the_sites_of_a_host_believe_the_components_of_each_other(authority: Authority, tmp_path: Path) -> None:
    lamp, shared = Principal.component(IRI("urn:lamp")), tmp_path / "shared"
    shared.mkdir(0o700)
    sites = []
    for name in ("attic", "cellar"):
        authority.issue(Principal(SITE, name), tmp_path / name)
        sites.append(KeysFolder(tmp_path / name))
    attic, cellar = sites
    before = KeysFolder(HostAuthority(cellar).component(lamp)).own()
    for site in (attic, cellar):
        HostAuthority(site).share(shared)
    assert HostAuthority(attic).hub_authorities().read_bytes() == HostAuthority(cellar).hub_authorities().read_bytes()
    with pytest.raises(PeerError, match="issued by another authority"):
        attic.admit("lab", before.pem)
    renewed = KeysFolder(HostAuthority(cellar).component(lamp)).own()
    assert attic.admit("lab", renewed.pem) == renewed, "its certificate is made anew by the common authority"
    assert all(not stat.S_IMODE(path.stat().st_mode) & 0o077 for path in shared.iterdir())


@pytest.mark.parametrize("room", range(13))
def test_a_certificate_that_a_full_disk_has_cut_off_is_made_anew_as_a_whole(
    authority: Authority, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, room: int
) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic")
    host, lamp = HostAuthority(KeysFolder(tmp_path / "attic")), Principal.component(IRI("urn:lamp"))
    written = iter(range(room))

    def synchronize(descriptor: int) -> None:
        if next(written, None) is None:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    with monkeypatch.context() as full:
        full.setattr("os.fsync", synchronize)
        with suppress(AuthorError):
            host.component(lamp)
    assert KeysFolder(host.component(lamp)).credentials((COMP,)).name == lamp.common_name


def test_a_common_authority_that_is_spoilt_is_made_anew(authority: Authority, tmp_path: Path) -> None:
    shared = tmp_path / "shared"
    shared.mkdir(0o700)
    HostAuthority(authority).share(shared)
    (key,) = shared.glob("*.key")
    for spoil in (lambda: key.write_bytes(b"nothing"), lambda: key.chmod(0o644), key.unlink):
        spoil()
        HostAuthority(authority).share(shared)
        assert key.read_bytes() == (authority.path / "components.key").read_bytes()
        assert not stat.S_IMODE(key.stat().st_mode) & 0o077


def test_an_authority_of_a_host_that_was_written_in_part_is_made_anew(authority: Authority, tmp_path: Path) -> None:
    """The program that made it was ended between its key and its certificate."""
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic")
    host = HostAuthority(KeysFolder(tmp_path / "attic"))
    host.hub_authorities()
    (tmp_path / "attic" / f"{HOST_AUTHORITY}.pem").unlink()
    host.hub_authorities()
    component = KeysFolder(host.component(Principal.component(IRI("urn:a"))))
    assert not component.own().fault(component.believed_authorities())


def test_the_authorities_of_two_ecologies_share_nothing(tmp_path: Path) -> None:
    shared = tmp_path / "shared"
    shared.mkdir(0o700)
    one, other = (Authority.init(tmp_path / name) for name in ("one", "other"))
    for folder in (one, other):
        HostAuthority(folder).share(shared)
    assert len(list(shared.glob("*.key"))) == 2
    assert (one.path / "components.key").read_bytes() != (other.path / "components.key").read_bytes()


def test_a_host_cannot_make_itself_a_configurator(authority: Authority, tmp_path: Path) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic")
    attic = KeysFolder(tmp_path / "attic")
    forged = HostAuthority(attic).component(Principal(CONF, "main"))
    with pytest.raises(PeerError, match="another authority"):
        attic.admit("lab", KeysFolder(forged).own().pem)


def test_a_component_has_no_certificate_for_longer_than_its_site(authority: Authority, tmp_path: Path) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic", days=0.5)
    attic, lamp = KeysFolder(tmp_path / "attic"), Principal.component(IRI("urn:lamp"))
    component = KeysFolder(HostAuthority(attic).component(lamp))
    assert component.own().ends == attic.own().ends
    authority.renew(attic.path, days=0.25)
    list(HostAuthority(attic).renew_components())
    assert component.own().ends == attic.own().ends
    authority.renew(attic.path, days=30.0)
    list(HostAuthority(attic).renew_components())
    assert not component.own().half_over(), "it is renewed when half of its time has passed"


def test_the_components_of_a_host_are_renewed_together(
    authority: Authority, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The hub is opened anew each time."""
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic", days=0.5)
    attic = KeysFolder(tmp_path / "attic")
    lamp = KeysFolder(HostAuthority(attic).component(Principal.component(IRI("urn:lamp"))))
    authority.renew(attic.path)
    bell = KeysFolder(HostAuthority(attic).component(Principal.component(IRI("urn:bell"))))
    before = lamp.own(), bell.own()
    list(HostAuthority(attic).renew_components())
    assert (lamp.own(), bell.own()) == before
    later = datetime.now(timezone.utc) + timedelta(days=0.3)
    monkeypatch.setattr(certificates, "_now", lambda: later)
    assert [one.half_over() for one in before] == [True, False]
    list(HostAuthority(attic).renew_components())
    assert lamp.own() != before[0]
    assert bell.own() != before[1]


def test_a_component_is_not_renewed_again_and_again_as_its_site_expires(
    authority: Authority, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic", days=0.5)
    attic = KeysFolder(tmp_path / "attic")
    lamp = KeysFolder(HostAuthority(attic).component(Principal.component(IRI("urn:lamp"))))
    before, later = lamp.own(), datetime.now(timezone.utc) + timedelta(days=0.3)
    monkeypatch.setattr(certificates, "_now", lambda: later)
    assert before.half_over()
    list(HostAuthority(attic).renew_components())
    assert lamp.own() == before, "it would be good for no longer"


def test_a_site_whose_certificate_has_expired_issues_none_and_says_so(
    authority: Authority, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic", days=0.5)
    attic = HostAuthority(KeysFolder(tmp_path / "attic"))
    attic.component(Principal.component(IRI("urn:lamp")))

    class Later(datetime):
        @classmethod
        def now(cls, tz: tzinfo | None = None) -> Later:
            return cls.fromtimestamp(time.time() + 86400.0, tz)

    monkeypatch.setattr(host_authority, "datetime", Later)
    with pytest.raises(AuthorError, match=r"the certificate of site\.attic has expired at .*; renew it with"):
        attic.component(Principal.component(IRI("urn:bell")))
    monkeypatch.setattr(certificates, "_now", lambda: Later.now(timezone.utc))
    with pytest.raises(AuthorError, match=r"the certificate of site\.attic has expired"):
        list(attic.renew_components())


def test_of_many_components_none_is_looked_at_closely_that_is_not_due(
    authority: Authority, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    authority.issue(Principal(SITE, "attic"), tmp_path / "attic", days=0.5)
    attic = KeysFolder(tmp_path / "attic")
    folders = [HostAuthority(attic).component(Principal.component(IRI(f"urn:lamp{number}"))) for number in range(5)]
    keys_read: list[Path] = []
    monkeypatch.setattr(host_authority, "read_pair", lambda path: keys_read.append(path) or read_pair(path))
    list(HostAuthority(attic).renew_components())
    assert len(keys_read) == 1, "that of the authority"
    (folders[2] / "certificate.pem").unlink()
    (folders[3] / "certificate.pem").write_bytes((tmp_path / "authority/authority.pem").read_bytes())
    kept = [(folders[number] / "certificate.pem").read_bytes() for number in (0, 1, 4)]
    authority.renew(attic.path, days=0.25)
    list(HostAuthority(attic).renew_components())
    assert not set(kept) & {(folders[number] / "certificate.pem").read_bytes() for number in (0, 1, 4)}
    assert not (folders[2] / "certificate.pem").exists(), "it is made as its process is started"
