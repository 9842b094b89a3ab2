"""Certificates say whom they speak for, until when, and what is wrong with them; OpenSSL agrees."""

from __future__ import annotations

import ssl
from contextlib import suppress
from datetime import datetime, timedelta, timezone
from pathlib import Path

import pytest
from cryptography import x509
from cryptography.hazmat.primitives import hashes, serialization
from cryptography.x509.oid import NameOID
from hypothesis import given
from hypothesis import strategies as st

from selfconf.access import certificates
from selfconf.access.certificates import Certificate, issue, new_authority, new_key, read_key, read_revocations
from selfconf.access.principal import Principal, PrincipalKind
from selfconf.errors import AuthorError, PeerError
from selfconf.model.term import IRI

KITCHEN = Principal(PrincipalKind.SITE, "kitchen")
AUTHORITY, AUTHORITY_KEY = new_authority("a test")
OTHER, OTHER_KEY = new_authority("a test")


def issued(days: float = 1.0, hosts: tuple[str, ...] = (), also: tuple[Principal, ...] = ()) -> Certificate:
    """A certificate for the site of the kitchen."""
    return issue(AUTHORITY, AUTHORITY_KEY, KITCHEN, new_key().public_key(), hosts, days, also)


def test_a_certificate_says_whom_it_speaks_for_and_where() -> None:
    others = (Principal.component(IRI("urn:a")), Principal.component(IRI("urn:b")))
    certificate = Certificate.read(issued(2.0, ("192.168.1.7", "robot.local", "fe80::1"), others).pem)
    assert certificate.principal == KITCHEN
    assert certificate.principals == (KITCHEN, *others)
    assert set(certificate.hosts) == {"localhost", "127.0.0.1", "::1", "192.168.1.7", "robot.local", "fe80::1"}
    assert timedelta(days=1.9) < certificate.ends - certificate.begins < timedelta(days=2.1)
    assert certificate.fault((AUTHORITY,)) == ""


def test_each_way_to_be_wrong_has_its_sentence() -> None:
    certificate = issued()
    assert "another authority" in certificate.fault((OTHER,))
    assert certificate.fault((OTHER, AUTHORITY)) == ""
    assert "is not valid before" in certificate.fault((AUTHORITY,), certificate.begins - timedelta(seconds=1))
    assert "has expired" in certificate.fault((AUTHORITY,), certificate.ends + timedelta(seconds=1))
    assert certificate.half_over(certificate.begins + timedelta(hours=13))
    assert not certificate.half_over(certificate.begins + timedelta(hours=11))


def test_a_certificate_without_a_good_name_names_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Principal, "common_name", "boss")
    assert "names no principal" in issued().fault((AUTHORITY,))


def test_what_is_too_long_for_a_certificate_is_not_looked_at() -> None:
    pem = issued().pem
    Certificate.read(pem + b" " * (certificates.LARGEST_PEM - len(pem)))
    with pytest.raises(PeerError, match="bytes are too many for a certificate"):
        Certificate.read(pem + b" " * (certificates.LARGEST_PEM + 1 - len(pem)))


@pytest.mark.parametrize("names", [(), ("site.kitchen", "conf.alice")])
def test_a_certificate_of_no_name_or_of_several_names_nobody(names: tuple[str, ...]) -> None:
    """Of several another program might take another one."""
    subject = x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, name) for name in names])
    now = datetime.now(timezone.utc)
    begun = x509.CertificateBuilder(AUTHORITY.x509.subject, subject, AUTHORITY_KEY.public_key(), 7)
    begun = begun.not_valid_before(now).not_valid_after(now + timedelta(days=1))
    made = begun.sign(AUTHORITY_KEY, hashes.SHA256())
    certificate = Certificate.read(made.public_bytes(serialization.Encoding.PEM))
    assert certificate.common_name == ""
    with pytest.raises(PeerError):
        _ = certificate.principal
    assert certificate.fault((AUTHORITY,), now + timedelta(hours=1)).startswith("names no principal")


def test_authorities_of_one_name_are_told_apart() -> None:
    assert AUTHORITY.x509.subject != OTHER.x509.subject


@pytest.mark.parametrize("host", ["", "a b", "http://x", "ä.local", "x_y", "*"])
def test_what_is_no_host_is_refused(host: str) -> None:
    with pytest.raises(AuthorError, match="neither the name of a host nor an address"):
        issued(hosts=(host,))


def test_openssl_believes_what_an_authority_has_issued_though_it_is_strict(tmp_path: Path) -> None:
    """Python 3.13 asks for all that RFC 5280 does, as other programs may that look at these certificates."""
    key = new_key()
    certificate = issue(AUTHORITY, AUTHORITY_KEY, KITCHEN, key.public_key(), (), 1.0)
    (tmp_path / "c.pem").write_bytes(certificate.pem)
    (tmp_path / "k.pem").write_bytes(certificates.key_pem(key))
    assert certificate.belongs_to(read_key((tmp_path / "k.pem").read_bytes()))
    assert not certificate.belongs_to(new_key())
    offers = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    offers.load_cert_chain(tmp_path / "c.pem", tmp_path / "k.pem")
    believes = ssl.create_default_context(cadata=AUTHORITY.pem.decode())
    believes.verify_flags |= ssl.VERIFY_X509_STRICT
    there, back = ssl.MemoryBIO(), ssl.MemoryBIO()
    ends = offers.wrap_bio(there, back, server_side=True), believes.wrap_bio(back, there, server_hostname="127.0.0.1")
    for end in (*reversed(ends), *reversed(ends)):
        with suppress(ssl.SSLWantReadError):  # the other end has to say something first
            end.do_handshake()
    assert ends[1].getpeercert()


def test_revoked_serials_are_read_from_a_list_that_the_authority_has_signed() -> None:
    one, other = issued(), issued()
    listed = certificates.revocations(AUTHORITY, AUTHORITY_KEY, [one])
    assert read_revocations(listed, AUTHORITY) == {one.serial}
    assert other.serial not in read_revocations(listed, AUTHORITY)
    with pytest.raises(AuthorError, match="has not signed"):
        read_revocations(certificates.revocations(OTHER, OTHER_KEY, [other]), AUTHORITY)
    with pytest.raises(AuthorError, match="no list"):
        read_revocations(b"-----BEGIN X509 CRL-----\n", AUTHORITY)


@given(st.data())
def test_a_mangled_certificate_is_none_or_is_not_believed(data: st.DataObject) -> None:
    der = bytearray(GOOD)
    for _ in range(data.draw(st.integers(1, 4))):
        der[data.draw(st.integers(0, len(der) - 1))] ^= data.draw(st.integers(1, 255))
    try:
        certificate = Certificate(x509.load_der_x509_certificate(bytes(der)))
        fault = certificate.fault((AUTHORITY,))
    except (ValueError, PeerError, x509.InvalidVersion):
        return
    assert fault or bytes(der) == GOOD


GOOD = issued().x509.public_bytes(certificates.serialization.Encoding.DER)


@pytest.mark.parametrize(
    "pem", [b"", b"x", b"-----BEGIN CERTIFICATE-----\nAA==\n-----END CERTIFICATE-----\n", b"x" * 100_000]
)
def test_what_is_no_certificate_is_refused(pem: bytes) -> None:
    with pytest.raises(PeerError):
        Certificate.read(pem)
    with pytest.raises(AuthorError):
        read_key(pem)
