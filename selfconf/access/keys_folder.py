"""A folder of keys: what `--keys DIR` names. Either an authority's own, or that of a holder that it has issued to.

    authority.pem     the certificate of the authority, which every holder has
    authority.key     its key, which makes certificates for any name, so it stays on one machine
    issued/           the certificates it has issued, by common name and serial, and into which folder it wrote each
    certificate.pem   the certificate of the holder of this folder, with certificate.key
    own/NAME/         in the folder of an authority: the certificates of programs that are given the folder itself;
                      these and their records are removed once they have expired
    components.pem    the authority of one host, with components.key: it issues to the components that its sites start
    components/NAME/  their certificates, each for all components of one process
    admitted/NAME/    certificates that others have shown to the sites of an ecology
    revoked.pem       what the authority has revoked: a copy in each folder that it has issued to

Keys have the mode 0600 and folders 0700; a key that others may read is refused, and a folder that they may write into.
What an authority does with its folder is an `Authority`, what the sites of a host do for their components a
`HostAuthority`.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Sequence, Set
from pathlib import Path

from selfconf.access.certificate_files import AUTHORITY, HOST_AUTHORITY, OWN, REVOKED, read_certificate, read_pair
from selfconf.access.certificates import Certificate, Key, read_revocations
from selfconf.access.principal import Principal, PrincipalKind
from selfconf.access.private_files import (
    check_private,
    check_unwritable,
    make_private_folder,
    named_in_errors,
    read_file,
)
from selfconf.atomic_write import write_atomically
from selfconf.bus.credentials import Credentials
from selfconf.errors import AuthorError, PeerError, reason
from selfconf.files import FileStamp, stamp
from selfconf.model.wording import as_typed

MAIN = "main"
"""The name of a program that is given the folder of an authority itself."""


class KeysFolder:
    """A folder of keys, checked as it is opened, and what its holder does with it."""

    is_authority = False
    """Whether certificates can be issued with this folder."""

    def __init__(self, path: Path) -> None:
        """Raises AuthorError for no folder, one with a key that others may read, or one that they may write into.

        So it is with the certificate of an authority that it believes.
        """
        self.path = path
        if not path.is_dir():
            missing = f"there is no folder {path}{'' if path.is_absolute() else ' here'}"
            raise AuthorError(
                f"{missing}; name that of your keys, or make an authority with `selfconf keys init {as_typed(path)}`"
            )
        check_unwritable(path)
        self.authority = read_certificate(path / f"{AUTHORITY}.pem")
        for believed in (AUTHORITY, HOST_AUTHORITY):
            check_unwritable(path / f"{believed}.pem")
        for key in (AUTHORITY, HOST_AUTHORITY, OWN):
            check_private(path / f"{key}.key")

    @property
    def serves_a_host(self) -> bool:
        """Whether certificates can be issued with this folder to the components of this host."""
        return self.is_authority or (self.path / f"{HOST_AUTHORITY}.key").is_file()

    def own(self) -> Certificate:
        """The certificate that this folder speaks by. Raises AuthorError if it holds none."""
        return read_certificate(self.path / f"{OWN}.pem")

    def pair(self) -> tuple[Certificate, Key]:
        """The certificate that this folder speaks by, and its key. Raises AuthorError for what is wrong with either."""
        return read_pair(self.path / OWN)

    def principal(self) -> Principal:
        """The holder of this folder. Raises AuthorError for a certificate that names none, and if there is none."""
        try:
            return self.own().principal
        except PeerError as error:
            raise AuthorError(f"{self.path}: {error}") from None

    def revoked(self) -> frozenset[int]:
        """The serials of revoked certificates, as far as this folder knows. Raises AuthorError for a forged list."""
        path = self.path / REVOKED
        if not path.is_file():
            return frozenset()
        return named_in_errors(path, lambda: read_revocations(read_file(path), self.authority))

    def believed_authorities(self) -> tuple[Certificate, ...]:
        """Who can have issued what this folder holds: the authority, and that of its host, if it knows of one."""
        host = self.path / f"{HOST_AUTHORITY}.pem"
        return (self.authority, *([read_certificate(host)] if host.is_file() else []))

    def credentials(self, kinds: Sequence[PrincipalKind], name: str = MAIN) -> Credentials:
        """What a program of some kinds shows. Raises AuthorError for what is wrong.

        The `name` is chosen by an authority alone; other folders show what was issued to them.
        """
        certificate, _ = self.pair()
        fault = certificate.fault(self.believed_authorities())
        if not fault and certificate.serial in self.revoked():
            fault = "was revoked"
        if fault:
            raise AuthorError(f"{self.path}: the certificate of {certificate.common_name} {fault}")
        principal = self.principal()
        if principal.kind not in kinds:
            wanted = " or ".join(f"{kind.value}.NAME" for kind in kinds)
            raise AuthorError(f"{self.path} speaks for {principal}; this takes a certificate of {wanted}")
        own, authorities = self.path / OWN, self.path / f"{AUTHORITY}.pem"
        return Credentials(
            principal.common_name, own.with_suffix(".pem"), own.with_suffix(".key"), authorities, self.path
        )

    def is_stale(self, folder: Path) -> bool:
        """Whether the folder of a program lacks a certificate, or has one that is to be renewed."""
        try:
            certificate = read_certificate(folder / f"{OWN}.pem")
        except AuthorError:
            return True
        return certificate.half_over() or certificate.serial in self.revoked()

    # What a site lets in.

    def stamps(self, ecology: str) -> dict[Path, FileStamp]:
        """The stamps of what says who is let in by a site: that changes with one of them, or as a certificate expires.

        Raises AuthorError where the folder cannot be read.
        """
        try:
            return {path: stamp(path) for path in (self.path, self._admitted(ecology), *self.path.iterdir())}
        except OSError as error:
            raise AuthorError(reason(error)) from None

    def _admitted(self, ecology: str) -> Path:
        """The folder of the certificates that were shown to sites of an ecology."""
        return self.path / "admitted" / ecology

    def admitted(self, ecology: str) -> dict[str, Certificate]:
        """The certificates that sites of an ecology let in, by their principals: shown once, and good until now."""
        revoked = self.revoked()
        return {holder_name(one.principals): one for one in self._shown(ecology) if self._is_good(one, revoked)}

    def _shown(self, ecology: str) -> Iterable[Certificate]:
        """The certificates that were shown to sites of an ecology."""
        return map(read_certificate, self._admitted(ecology).glob("*.pem"))

    def admit(self, ecology: str, pem: bytes) -> Certificate:
        """Keep a certificate that a client has shown to a site. Raises PeerError for one that is not good.

        AuthorError is raised where the folder cannot be read, or not be written.
        """
        certificate = Certificate.read(pem)
        fault = certificate.fault(self._authorities_for(certificate))
        if fault:
            raise PeerError(f"the certificate of {certificate.common_name[:80]!r} {fault}")
        if certificate.serial in self.revoked():
            raise PeerError(f"the certificate of {certificate.common_name} was revoked")
        path = self._admitted(ecology) / f"{holder_name(certificate.principals)}.pem"
        if not self._has_later(path, certificate):
            try:
                make_private_folder(path.parent)
                write_atomically(path, certificate.pem)
            except OSError as error:
                raise AuthorError(f"cannot be written: {error.strerror}", file=str(path)) from None
        return certificate

    def _has_later(self, path: Path, certificate: Certificate) -> bool:
        """Whether a good certificate for the same is kept that was issued no earlier than this one.

        Certificates are no secret: one that is shown by another than its holder must not bring the end forward.
        """
        try:
            kept = read_certificate(path)
        except AuthorError:
            return False
        good = self._is_good(kept, self.revoked())
        return good and (kept.begins, kept.ends) >= (certificate.begins, certificate.ends)

    def _is_good(self, certificate: Certificate, revoked: Set[int]) -> bool:
        """Whether a certificate opens doors now."""
        return certificate.serial not in revoked and not certificate.fault(self._authorities_for(certificate))

    def _authorities_for(self, certificate: Certificate) -> tuple[Certificate, ...]:
        """Who may have issued a certificate: to components of this host, its own authority too."""
        is_component = certificate.common_name.startswith(f"{PrincipalKind.COMPONENT.value}.")
        return self.believed_authorities() if is_component else (self.authority,)


def holder_name(principals: Sequence[Principal]) -> str:
    """The name of a file about the principals of a certificate.

    A component may be the first of several processes, with other components each, in different ecologies or one after
    the other; the certificate of one must not take the place of that of another.
    """
    first, *others = (one.common_name for one in principals)
    return f"{first}~{hashlib.blake2s(' '.join(others).encode(), digest_size=8).hexdigest()}" if others else first
