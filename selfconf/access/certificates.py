"""X.509 certificates: an authority makes them, programs show them to each other (RFC 5280, keys on EC P-256).

A certificate here is short-lived and names its holder in its common name (`principal`). Times are in UTC. What is
wrong with one is said in a sentence each, since Zenoh itself says only that it cannot connect.
"""

from __future__ import annotations

import ipaddress
import secrets
import warnings
from collections.abc import Iterable, Sequence
from datetime import datetime, timedelta, timezone
from functools import lru_cache
from typing import Any

from selfconf.access.principal import Principal
from selfconf.errors import AuthorError, InstallationError, PeerError
from selfconf.model.immutable import immutable
from selfconf.model.wording import utc_text

try:
    from cryptography import x509
    from cryptography.exceptions import InvalidSignature, UnsupportedAlgorithm
    from cryptography.hazmat.primitives import hashes, serialization
    from cryptography.hazmat.primitives.asymmetric import ec
    from cryptography.x509.oid import ExtendedKeyUsageOID, NameOID
except ImportError:  # an extra: not needed without keys
    raise InstallationError("keys need the package cryptography; install the extra `keys`") from None

AUTHORITY_DAYS = 3650.0
"""How long an authority lasts."""
CLOCKS_DIFFER = timedelta(minutes=5)
"""By how much the clocks of two hosts may differ: a certificate is valid from so long before it was made."""
LARGEST_PEM = 1 << 14
"""Bytes of a certificate at most: one with a hundred addresses has 4 KiB."""
CERTIFICATES_REMEMBERED = 1024
"""Of how many certificates it is remembered what is in them, and who has signed them: a site is shown those of all
others again and again, and each takes it milliseconds."""
EVERY_HOST = ("localhost", "127.0.0.1", "::1")
"""The addresses that every certificate is good for."""
_ALSO = "urn:selfconf:"
Key = ec.EllipticCurvePrivateKey
_MALFORMED = (
    ValueError,
    TypeError,
    UnsupportedAlgorithm,
    x509.InvalidVersion,
    x509.DuplicateExtension,
    x509.UnsupportedGeneralNameType,
)
"""What `cryptography` raises for what is no certificate, key or list, or is one that it does not know."""


def new_key() -> Key:
    """A new private key, on the curve P-256."""
    return ec.generate_private_key(ec.SECP256R1())


def key_pem(key: Key) -> bytes:
    """A private key as PEM (PKCS #8), not encrypted: the permissions of its file protect it."""
    return key.private_bytes(
        serialization.Encoding.PEM, serialization.PrivateFormat.PKCS8, serialization.NoEncryption()
    )


def read_key(pem: bytes) -> Key:
    """A private key from PEM. Raises AuthorError."""
    try:
        key = serialization.load_pem_private_key(pem, None)
    except _MALFORMED:
        raise AuthorError("holds no private key in PEM") from None
    if not isinstance(key, ec.EllipticCurvePrivateKey):
        raise AuthorError("holds a private key that is none on an elliptic curve")
    return key


@immutable
class Certificate:
    """An X.509 certificate."""

    x509: x509.Certificate

    @classmethod
    def read(cls, pem: bytes) -> Certificate:
        """A certificate from PEM, the first where there are several. Raises PeerError for what is none."""
        if len(pem) > LARGEST_PEM:
            raise PeerError(f"{len(pem)} bytes are too many for a certificate")
        try:
            return cls(_loaded(pem))
        except _MALFORMED:
            raise PeerError("that is no certificate in PEM") from None

    @property
    def pem(self) -> bytes:
        """The certificate as PEM."""
        return self.x509.public_bytes(serialization.Encoding.PEM)

    @property
    def common_name(self) -> str:
        """The common name of its subject; empty if it has none, or several."""
        names = self.x509.subject.get_attributes_for_oid(NameOID.COMMON_NAME)
        return str(names[0].value) if len(names) == 1 else ""

    @property
    def principal(self) -> Principal:
        """The principal that its subject names. Raises PeerError."""
        return Principal.of(self.common_name)

    @property
    def principals(self) -> tuple[Principal, ...]:
        """The principals of a certificate: its subject, and components of the same process. Raises PeerError."""
        others = (name.removeprefix(_ALSO) for name in self._names(x509.UniformResourceIdentifier) if _ALSO in name)
        return (self.principal, *(Principal.of(name) for name in others))

    @property
    def serial(self) -> int:
        """The number that its authority has given to it, and to no other."""
        return self.x509.serial_number

    @property
    def public_key(self) -> bytes:
        """The public key of its holder (RFC 5280, subjectPublicKeyInfo), which stays as it is renewed."""
        return self.x509.public_key().public_bytes(
            serialization.Encoding.DER, serialization.PublicFormat.SubjectPublicKeyInfo
        )

    @property
    def begins(self) -> datetime:
        """From when it is valid."""
        return self.x509.not_valid_before_utc

    @property
    def ends(self) -> datetime:
        """Until when it is valid."""
        return self.x509.not_valid_after_utc

    def seconds_left(self) -> float:
        """For how many seconds from now it is valid; less than zero if it is not any more."""
        return (self.ends - _now()).total_seconds()

    @property
    def hosts(self) -> tuple[str, ...]:
        """The names and addresses of hosts that it is good for."""
        return (*self._names(x509.DNSName), *self._names(x509.IPAddress))

    def _names(self, kind: type[Any]) -> list[str]:
        """The alternative names of the certificate that are of one kind (RFC 5280, section 4.2.1.6)."""
        try:
            names = self.x509.extensions.get_extension_for_class(x509.SubjectAlternativeName).value
        except (x509.ExtensionNotFound, ValueError):
            return []
        return [str(name) for name in names.get_values_for_type(kind)]

    @property
    def issued(self) -> datetime:
        """When it was made, as certificates here are."""
        return min(self.begins + CLOCKS_DIFFER, self.ends)

    def half_over(self, now: datetime | None = None) -> bool:
        """Whether it is time to renew it: half of its time has passed, or none, as the clock of its host was ahead."""
        now = now or _now()
        return now < self.begins or now > self.issued + (self.ends - self.issued) / 2

    def belongs_to(self, key: Key) -> bool:
        """Whether it is the certificate of a private key."""
        return self.x509.public_key() == key.public_key()

    def fault(self, authorities: Iterable[Certificate], now: datetime | None = None) -> str:
        """What is wrong with it, in words that follow "the certificate of NAME"; empty if nothing is."""
        if not any(_is_signed_by(self.x509, authority.x509) for authority in authorities):
            return "was issued by another authority"
        untimely = self.untimely(now)
        if untimely:
            return untimely
        try:
            _ = self.principals
        except PeerError as error:
            return f"names no principal: {error}"
        return ""

    def untimely(self, now: datetime | None = None) -> str:
        """Words that say that the certificate is not valid yet, or not any more; empty if it is valid now."""
        now = now or _now()
        if now < self.begins:
            return f"is not valid before {utc_text(self.begins)}; is the clock of this host right?"
        if now > self.ends:
            return f"has expired at {utc_text(self.ends)}; renew it with `selfconf keys renew`"
        return ""


@lru_cache(CERTIFICATES_REMEMBERED)
def _loaded(pem: bytes) -> x509.Certificate:
    """A certificate, of which every part was looked at: each is parsed only then, and what is wrong with it raised."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of a serial that is not positive, which is refused here
        one = x509.load_pem_x509_certificate(pem)
        _ = one.subject, one.issuer, one.public_key(), one.extensions, one.signature_hash_algorithm
        _ = one.not_valid_before_utc, one.not_valid_after_utc
    if one.serial_number <= 0:
        raise ValueError("a serial is above zero")
    return one


@lru_cache(CERTIFICATES_REMEMBERED)
def _is_signed_by(certificate: x509.Certificate, authority: x509.Certificate) -> bool:
    try:
        certificate.verify_directly_issued_by(authority)
    except (*_MALFORMED, InvalidSignature):
        return False
    return True


def new_authority(name: str) -> tuple[Certificate, Key]:
    """An authority that can issue certificates, but no further authorities, with its key.

    A random text makes its name differ from those of others: a program that finds a name that it knows would blame the
    signature.
    """
    key, subject = new_key(), _subject(f"{name} {secrets.token_hex(4)}")
    usage = x509.KeyUsage(
        digital_signature=True,
        key_cert_sign=True,
        crl_sign=True,
        content_commitment=False,
        key_encipherment=False,
        data_encipherment=False,
        key_agreement=False,
        encipher_only=False,
        decipher_only=False,
    )
    begun = _begun(subject, subject, key.public_key(), key.public_key(), AUTHORITY_DAYS)
    begun = begun.add_extension(x509.BasicConstraints(ca=True, path_length=0), critical=True)
    return Certificate(begun.add_extension(usage, critical=True).sign(key, hashes.SHA256())), key


def issue(
    authority: Certificate,
    authority_key: Key,
    principal: Principal,
    key: ec.EllipticCurvePublicKey,
    hosts: Sequence[str],
    days: float,
    also: Sequence[Principal] = (),
) -> Certificate:
    """A certificate for a public key, good for loopback and some hosts, for some days. Raises AuthorError.

    `also` are components that share a process with the one that it is for.
    """
    names = [_host(host) for host in dict.fromkeys((*EVERY_HOST, *hosts))]
    names += [x509.UniformResourceIdentifier(_ALSO + principal.common_name) for principal in also]
    begun = _begun(_subject(principal.common_name), authority.x509.subject, key, authority_key.public_key(), days)
    for extension, critical in (
        (x509.BasicConstraints(ca=False, path_length=None), True),
        (x509.SubjectAlternativeName(names), False),
        (x509.ExtendedKeyUsage([ExtendedKeyUsageOID.SERVER_AUTH, ExtendedKeyUsageOID.CLIENT_AUTH]), False),
    ):
        begun = begun.add_extension(extension, critical)
    return Certificate(begun.sign(authority_key, hashes.SHA256()))


def revocations(authority: Certificate, key: Key, revoked: Iterable[Certificate]) -> bytes:
    """A list of revoked certificates, signed by their authority, as PEM (RFC 5280, section 5)."""
    now = _now()
    builder = x509.CertificateRevocationListBuilder().issuer_name(authority.x509.subject).last_update(now)
    builder = builder.next_update(now + timedelta(days=AUTHORITY_DAYS))
    for certificate in revoked:
        one = x509.RevokedCertificateBuilder().serial_number(certificate.serial).revocation_date(now).build()
        builder = builder.add_revoked_certificate(one)
    return builder.sign(key, hashes.SHA256()).public_bytes(serialization.Encoding.PEM)


def read_revocations(pem: bytes, authority: Certificate) -> frozenset[int]:
    """The serials of revoked certificates. Raises AuthorError for a list that the authority has not signed."""
    try:
        revoked = x509.load_pem_x509_crl(pem)
        genuine = revoked.is_signature_valid(authority.x509.public_key())  # type: ignore[arg-type]  # an EC key, as made here
    except _MALFORMED:
        raise AuthorError("holds no list of revoked certificates in PEM") from None
    if not genuine:
        raise AuthorError("holds a list of revoked certificates that this authority has not signed")
    return frozenset(one.serial_number for one in revoked)


def _begun(
    subject: x509.Name,
    issuer: x509.Name,
    key: ec.EllipticCurvePublicKey,
    issuer_key: ec.EllipticCurvePublicKey,
    days: float,
) -> x509.CertificateBuilder:
    """A certificate with what all have, the identifiers of both keys among it (RFC 5280, section 4.2.1.1)."""
    now = _now()
    try:
        ends = now + timedelta(days=days)
    except OverflowError:
        raise AuthorError(f"{days} days are too many") from None
    builder = x509.CertificateBuilder().subject_name(subject).issuer_name(issuer).public_key(key)
    builder = builder.serial_number(x509.random_serial_number())
    for identifier in (
        x509.SubjectKeyIdentifier.from_public_key(key),
        x509.AuthorityKeyIdentifier.from_issuer_public_key(issuer_key),
    ):
        builder = builder.add_extension(identifier, critical=False)
    return builder.not_valid_before(now - CLOCKS_DIFFER).not_valid_after(ends)


def _subject(name: str) -> x509.Name:
    return x509.Name([x509.NameAttribute(NameOID.COMMON_NAME, name)])


def _host(host: str) -> x509.GeneralName:
    try:
        return x509.IPAddress(ipaddress.ip_address(host))
    except ValueError:
        pass
    try:
        host.encode("ascii")
        if not host or any(not (c.isalnum() or c in ".-") for c in host):
            raise ValueError(host)
        return x509.DNSName(host)
    except ValueError:
        raise AuthorError(f"{host!r} is neither the name of a host nor an address") from None


def _now() -> datetime:
    return datetime.now(timezone.utc)
