"""Why a handshake fails, against Python's own TLS server; against a site it is in the table of attacks."""

from __future__ import annotations

import socket
import ssl
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest

from selfconf.access import Authority, Principal, PrincipalKind, certificates
from selfconf.bus.credentials import Credentials
from selfconf.bus.handshake import why_refused
from selfconf.bus.zenoh import Security, open_session, with_port


@contextmanager
def server(folder: Path | None, trusts: Path | None = None) -> Iterator[str]:
    """A server by some keys, that wants certificates of an authority; without keys it speaks no TLS."""
    listening = socket.create_server(("127.0.0.1", 0))
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    if folder is not None:
        context.load_cert_chain(folder / "certificate.pem", folder / "certificate.key")
        context.load_verify_locations(trusts or folder / "authority.pem")
        context.verify_mode = ssl.CERT_REQUIRED

    def serve() -> None:
        try:
            while True:
                plain, _ = listening.accept()
                with plain:
                    if folder is None:
                        plain.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n")
                        plain.recv(1000)
                        continue
                    try:
                        with context.wrap_socket(plain, server_side=True) as link:
                            link.sendall(b"x")
                    except OSError:  # the other end does not believe it
                        continue
        except OSError:  # the listening socket was closed
            return

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    yield f"tls/127.0.0.1:{listening.getsockname()[1]}"
    listening.shutdown(socket.SHUT_RDWR)
    listening.close()
    thread.join(5.0)


@pytest.fixture
def authority(tmp_path: Path) -> Authority:
    """A new authority."""
    return Authority.init(tmp_path / "authority")


def site_of(authority: Authority) -> Path:
    """The keys of a site."""
    authority.credentials((PrincipalKind.SITE,), "home")
    return authority.path / "own/site.home"


def shown(authority: Authority) -> Credentials:
    """What a reader shows."""
    return authority.credentials((PrincipalKind.READER,))


def test_who_is_welcome_finds_nothing_wrong(authority: Authority) -> None:
    with server(site_of(authority)) as endpoint:
        assert why_refused(endpoint, shown(authority)) == ""


def test_another_authority_is_named_at_either_end(authority: Authority, tmp_path: Path) -> None:
    other = Authority.init(tmp_path / "other")
    with server(site_of(other)) as endpoint:
        assert "its certificate was issued by another authority" in why_refused(endpoint, shown(authority))
    with server(site_of(authority), trusts=other.path / "authority.pem") as endpoint:
        assert "does not know the authority that has issued read.main" in why_refused(endpoint, shown(authority))


def test_an_expired_certificate_is_named_at_either_end(authority: Authority, tmp_path: Path) -> None:
    authority.issue(Principal(PrincipalKind.SITE, "old"), tmp_path / "old", days=-1e-5)
    with server(tmp_path / "old") as endpoint:
        assert "its certificate has expired" in why_refused(endpoint, shown(authority))
    old = tmp_path / "old"
    mine = Credentials("site.old", old / "certificate.pem", old / "certificate.key", old / "authority.pem", old)
    with server(site_of(authority)) as endpoint:
        assert "the certificate of site.old has expired" in why_refused(endpoint, mine)


def test_a_hub_says_of_a_certificate_that_is_not_valid_yet_the_same_as_of_an_expired_one(
    authority: Authority, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    site_of(authority)
    hub = authority.credentials((PrincipalKind.SITE,), "home")
    ahead = datetime.now(timezone.utc) + timedelta(days=1)
    monkeypatch.setattr(certificates, "_now", lambda: ahead)
    authority.issue(Principal(PrincipalKind.READER, "alice"), tmp_path / "alice")
    monkeypatch.undo()
    early = tmp_path / "alice"
    mine = Credentials("read.alice", early / "certificate.pem", early / "certificate.key", hub.authorities, early)
    endpoint = with_port("tls/127.0.0.1:0")
    session = open_session("router", listen=[endpoint], security=Security(hub))
    try:
        said = why_refused(endpoint, mine)
    finally:
        session.close()
    assert "by its clock, the certificate of read.alice has expired or is not valid yet" in said


def test_a_host_that_the_certificate_does_not_name_is_named(authority: Authority) -> None:
    with server(site_of(authority)) as endpoint, pytest.MonkeyPatch.context() as patch:
        real = socket.create_connection
        patch.setattr(socket, "create_connection", lambda place, wait: real(("127.0.0.1", place[1]), wait))
        assert "host='10.0.0.7'" in why_refused(endpoint.replace("127.0.0.1", "10.0.0.7"), shown(authority))


def test_what_else_is_wrong_with_a_certificate_is_told_as_it_was_found(
    authority: Authority, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(certificates.ExtendedKeyUsageOID, "SERVER_AUTH", certificates.ExtendedKeyUsageOID.TIME_STAMPING)
    with server(site_of(authority)) as endpoint:
        assert "of its certificate it is said: uns" in why_refused(endpoint, shown(authority))  # uitable, or upported


def test_what_speaks_no_tls_is_named(authority: Authority) -> None:
    with server(None) as endpoint:
        assert "does not speak TLS" in why_refused(endpoint, shown(authority))


def test_where_nobody_listens_nothing_is_found(authority: Authority) -> None:
    assert why_refused("tls/127.0.0.1:1", shown(authority)) == ""
    assert why_refused("tls/nonsense", shown(authority)) == ""
