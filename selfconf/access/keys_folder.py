"""A folder of keys: what `--keys DIR` names. Either an authority's own, or that of a holder that it has issued to.

    authority.pem     the certificate of the authority, which every holder has
    authority.key     its key, which makes certificates for any name, so it stays on one machine
    issued/           the certificates it has issued, by common name and serial, and into which folder it wrote each
    certificate.pem   the certificate of the holder of this folder, with certificate.key
    own/NAME/         in the folder of an authority: the certificates of programs that are given the folder itself
    components.pem    the authority of one host, with components.key: it issues to the components that its sites start
    components/NAME/  their certificates, each for all components of one process
    admitted/NAME/    certificates that others have shown to the sites of an ecology
    revoked.pem       what the authority has revoked: a copy in each folder that it has issued to

Keys have the mode 0600 and folders 0700; a folder that others may read is refused. The authority of a host is believed
by the hubs of that host alone: what a site issues to its components opens no door anywhere else. The sites of a user
there have it in common, whatever folders they are given, as the components of all connect to the hub of one of them.
"""

from __future__ import annotations

import fcntl
import hashlib
import os
from collections import defaultdict
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from datetime import datetime, timedelta, timezone
from pathlib import Path

from selfconf.access.certificates import (
    EVERY_HOST,
    Certificate,
    Key,
    issue,
    key_pem,
    new_authority,
    new_key,
    read_key,
    read_revocations,
    revocations,
)
from selfconf.access.principal import Principal, PrincipalKind
from selfconf.access.private_files import (
    check_private,
    content,
    make_private_folder,
    named_in_errors,
    read_file,
    write_private,
)
from selfconf.bus.credentials import Credentials
from selfconf.errors import AuthorError, PeerError, reason

DAYS = 7.0
"""For how many days a certificate is good unless told otherwise."""
COMPONENT_DAYS = 1.0
"""For how many days that of a component which a site starts is good; the site renews it."""
MAIN = "main"
"""The name of a program that is given the folder of an authority itself."""
KNOWN = (f"conf.{MAIN}", f"read.{MAIN}")
"""The principals that every site that is given that folder knows."""
_AUTHORITY, _HOST_AUTHORITY, _OWN = "authority", "components", "certificate"


class KeysFolder:
    """A folder of keys, checked as it is opened."""

    def __init__(self, path: Path) -> None:
        """Raises AuthorError for a folder that is none, or that others may read."""
        self.path = path
        if not path.is_dir():
            raise AuthorError(f"there is no folder {path}; make an authority with `selfconf keys init {path}`")
        self.authority = _certificate(path / f"{_AUTHORITY}.pem")
        for key in (_AUTHORITY, _HOST_AUTHORITY, _OWN):
            check_private(path / f"{key}.key")

    @classmethod
    def init(cls, path: Path) -> KeysFolder:
        """Make the folder of a new authority. Raises AuthorError where there is one, or anything else."""
        if path.exists() and (not path.is_dir() or any(path.iterdir())):
            raise AuthorError(f"{path} exists and is not empty; an authority gets a folder of its own")
        try:
            path.mkdir(mode=0o700, parents=True, exist_ok=True)
            path.chmod(0o700)
            _write(path / _AUTHORITY, *new_authority("the authority of an ecology"))
        except OSError as error:
            raise AuthorError(reason(error)) from None
        folder = cls(path)
        for kind in (PrincipalKind.CONFIGURATOR, PrincipalKind.READER):  # known before any program asks
            folder.credentials((kind,), MAIN)
        return folder

    @property
    def is_authority(self) -> bool:
        """Whether certificates can be issued with this folder."""
        return (self.path / f"{_AUTHORITY}.key").is_file()

    @property
    def serves_a_host(self) -> bool:
        """Whether certificates can be issued with this folder to the components of this host."""
        return self.is_authority or (self.path / f"{_HOST_AUTHORITY}.key").is_file()

    # What the authority does.

    def issue(self, principal: Principal, out: Path, hosts: Sequence[str] = (), days: float = DAYS) -> Certificate:
        """Issue a certificate with a new key into a folder of its own. Raises AuthorError."""
        if out.exists() and (not out.is_dir() or any(out.iterdir())):
            raise AuthorError(f"{out} exists and is not empty; to renew what is in it: `selfconf keys renew {out}`")
        if self._revoked_serials(principal):
            raise AuthorError(
                f"a certificate of {principal} was revoked and has not expired: choose another name until it has"
            )
        return self._issued(principal, out, new_key(), hosts, days)

    def renew(self, folder: Path, days: float = DAYS) -> Certificate:
        """Issue anew what a folder has, for the same key. Raises AuthorError."""
        old = KeysFolder(folder)
        if old.is_authority or not (folder / f"{_OWN}.pem").is_file():
            raise AuthorError(f"{folder} holds no certificate that was issued; nothing to renew")
        if old.authority != self.authority:
            raise AuthorError(f"{folder} is of another authority than {self.path}")
        certificate, key = _pair(folder / _OWN)
        principal = _principal(certificate, folder)
        if self._revoked_serials(principal):
            raise AuthorError(f"the certificate of {principal} was revoked")
        hosts = [host for host in certificate.hosts if host not in EVERY_HOST]
        return self._issued(principal, folder, key, hosts, days)

    def revoke(self, principal: Principal) -> int:
        """Revoke all certificates of a name that have not expired; how many. Raises AuthorError if there are none.

        The folders of keys that were issued on this host have the list at once, as far as they are where they were.
        """
        authority, key = self._authority_pair()
        found = [one for one in self.issued() if one.common_name == principal.common_name and not self._expired(one)]
        if not found:
            raise AuthorError(f"there is no certificate of {principal} that has not expired; nothing to revoke")
        before = self.revoked()
        known = [one for one in self.issued() if one.serial in before and not self._expired(one)]
        listed = revocations(authority, key, [*known, *found])
        write_private(self.path / "revoked.pem", listed)
        for folder in dict.fromkeys(self._folders().values()):
            if self._is_of_mine(folder):
                with suppress(OSError):  # `unaware` names the folder
                    write_private(folder / "revoked.pem", listed)
        return len(found)

    def aware(self) -> list[Path]:
        """The folders that it has issued to and that have what it has revoked, besides those within its own."""
        folders = dict.fromkeys(self._folders().values())
        return [one for one in folders if self.path.resolve() not in one.parents and self._has_list(one)]

    def unaware(self) -> list[tuple[str, Path | None]]:
        """The sites whose folders lack what this authority has revoked, by common name, each with its folder.

        The folder is one that is not where it was issued any more, or that this user may not write; or it is not known.
        Of a certificate that was renewed, which has the same key, one folder with the list is enough: the one that was
        renewed may have been elsewhere before.
        """
        folders = self._folders()
        written: dict[tuple[str, bytes], list[Path | None]] = defaultdict(list)
        for one in filter(self._is_site, self.issued()):
            written[one.common_name, one.public_key].append(folders.get(one.serial))
        lacking = {key: some for key, some in written.items() if not any(one and self._has_list(one) for one in some)}
        return list(dict.fromkeys((name, some[-1]) for (name, _), some in lacking.items()))

    def _has_list(self, folder: Path) -> bool:
        """Whether a folder has keys of this authority, and what it has revoked."""
        return self._is_of_mine(folder) and content(folder / "revoked.pem") == content(self.path / "revoked.pem")

    def _is_site(self, certificate: Certificate) -> bool:
        """Whether a certificate is that of a site, which is good until now."""
        is_site = certificate.common_name.startswith(f"{PrincipalKind.SITE.value}.")
        return is_site and certificate.serial not in self.revoked() and not self._expired(certificate)

    def _folders(self) -> dict[int, Path]:
        """Into which folder each certificate was written, by its serial."""
        found = ((path.stem.rpartition("~")[2], content(path)) for path in (self.path / "issued").glob("*.folder"))
        return {int(serial, 16): Path(os.fsdecode(folder)) for serial, folder in found if folder}

    def _is_of_mine(self, folder: Path) -> bool:
        """Whether a folder is there and has keys of this authority."""
        return content(folder / f"{_AUTHORITY}.pem") == content(self.path / f"{_AUTHORITY}.pem")

    def issued(self) -> list[Certificate]:
        """The certificates that this authority has issued, by name and time."""
        found = [_certificate(path) for path in (self.path / "issued").glob("*.pem")]
        return sorted(found, key=lambda one: (one.common_name, one.begins))

    def revoked(self) -> frozenset[int]:
        """The serials of revoked certificates, as far as this folder knows. Raises AuthorError for a forged list."""
        path = self.path / "revoked.pem"
        if not path.is_file():
            return frozenset()
        return named_in_errors(path, lambda: read_revocations(read_file(path), self.authority))

    # What holders do.

    def own(self) -> Certificate:
        """The certificate that this folder speaks by. Raises AuthorError if it holds none."""
        return _certificate(self.path / f"{_OWN}.pem")

    def credentials(self, kinds: Sequence[PrincipalKind], name: str = MAIN) -> Credentials:
        """What a program of some kinds shows: of the first if it can be chosen. Raises AuthorError for what is wrong.

        With the folder of an authority it is a certificate of its own, made or renewed now, where a site has the
        `name` that is given.
        """
        shown = KeysFolder(self._self_issued(Principal(kinds[0], name))) if self.is_authority else self
        return shown._credentials(kinds, self)

    def believed_authorities(self) -> tuple[Certificate, ...]:
        """Who can have issued what this folder holds: the authority, and that of its host, if it knows of one."""
        host = self.path / f"{_HOST_AUTHORITY}.pem"
        return (self.authority, *([_certificate(host)] if host.is_file() else []))

    def hub_authorities(self) -> Path:
        """The file of the authorities that the hub of a site here believes: the ecology's, and that of this host."""
        trusted = self.path / "trusted.pem"
        with _turn(self.path):
            self._host_authority()
            together = self.authority.pem + read_file(self.path / f"{_HOST_AUTHORITY}.pem")
            if not trusted.is_file() or trusted.read_bytes() != together:
                write_private(trusted, together)
        return trusted

    def share_host_authority(self, shared: Path) -> None:
        """Issue to components as the other sites of this user on this host do, by what they share in a folder.

        The first site with keys of an ecology's authority gives what it has; the others take that instead of their own.
        """
        digest = hashlib.blake2s(self.authority.pem, digest_size=8).hexdigest()
        common, own = shared / f"{_HOST_AUTHORITY}-{digest}", self.path / _HOST_AUTHORITY
        with _turn(shared), _turn(self.path):
            given = _pair_of_this_user(common)
            if given is not None:
                _write(own, *given)
            else:
                _write(common, *self._host_authority())

    def component(self, principal: Principal, also: Sequence[Principal] = ()) -> Path:
        """The folder of a process on this host, by its first component, with a certificate made or renewed now.

        `also` are the other components of the process.
        """
        folder = self.path / "components" / _whose((principal, *also))
        with _turn(self.path):
            authority, key = self._host_authority()
            ends = self._component_ends()
            kept = None if self._stale(folder) else _certificate(folder / f"{_OWN}.pem")
            if kept is None or kept.ends > ends or kept.fault((authority,)):
                mine, days = new_key(), (ends - datetime.now(timezone.utc)) / timedelta(days=1)
                certificate = issue(authority, key, principal, mine.public_key(), (), days, also)
                _write_holder(folder, self.authority, certificate, mine)
                write_private(folder / f"{_HOST_AUTHORITY}.pem", authority.pem)
        return folder

    def _component_ends(self) -> datetime:
        """Until when a component gets a certificate: for no longer than its site has one."""
        ends = datetime.now(timezone.utc) + timedelta(days=COMPONENT_DAYS)
        return min(ends, self.own().ends) if (self.path / f"{_OWN}.pem").is_file() else ends

    def renew_components(self) -> None:
        """Renew the certificates of the processes of this host that are to be. Raises AuthorError."""
        for folder in (self.path / "components").glob("*"):
            try:
                first, *others = _certificate(folder / f"{_OWN}.pem").principals
            except (AuthorError, PeerError):
                continue  # it is made anew when its process is started
            self.component(first, others)

    def admitted(self, ecology: str) -> dict[str, Certificate]:
        """The certificates that sites of an ecology let in, by their principals: shown once, and good until now.

        With the folder of an authority also those of the programs that are given it, which need not be shown.
        """
        shown = [_certificate(path) for path in (self.path / "admitted" / ecology).glob("*.pem")]
        shown += [_certificate(self.path / "own" / name / f"{_OWN}.pem") for name in KNOWN if self.is_authority]
        revoked = self.revoked()
        good = (one for one in shown if one.serial not in revoked and not one.fault(self._authorities_for(one)))
        return {_whose(one.principals): one for one in good}

    def admit(self, ecology: str, pem: bytes) -> Certificate:
        """Keep a certificate that a client has shown to a site. Raises PeerError for one that is not good."""
        certificate = Certificate.read(pem)
        fault = certificate.fault(self._authorities_for(certificate))
        if fault:
            raise PeerError(f"the certificate of {certificate.common_name[:80]!r} {fault}")
        if certificate.serial in self.revoked():
            raise PeerError(f"the certificate of {certificate.common_name} was revoked")
        path = self.path / "admitted" / ecology / f"{_whose(certificate.principals)}.pem"
        if not self._has_later(path, certificate):
            make_private_folder(path.parent)
            write_private(path, certificate.pem)
        return certificate

    def _has_later(self, path: Path, certificate: Certificate) -> bool:
        """Whether a good certificate for the same is kept that was issued no earlier than this one.

        Certificates are no secret: one that is shown by another than its holder must not bring the end forward.
        """
        try:
            kept = _certificate(path)
        except AuthorError:
            return False
        good = kept.serial not in self.revoked() and not kept.fault(self._authorities_for(kept))
        return good and (kept.begins, kept.ends) >= (certificate.begins, certificate.ends)

    def _authorities_for(self, certificate: Certificate) -> tuple[Certificate, ...]:
        """Who may have issued a certificate: to components of this host, its own authority too."""
        is_component = certificate.common_name.startswith(f"{PrincipalKind.COMPONENT.value}.")
        return self.believed_authorities() if is_component else (self.authority,)

    # How it is kept.

    def _issued(self, principal: Principal, folder: Path, key: Key, hosts: Sequence[str], days: float) -> Certificate:
        authority, authority_key = self._authority_pair()
        certificate = issue(authority, authority_key, principal, key.public_key(), hosts, days)
        try:
            make_private_folder(self.path / "issued")
            noted = self.path / "issued" / f"{certificate.common_name}~{certificate.serial:x}.pem"
            write_private(noted, certificate.pem)
            write_private(noted.with_name(f"{noted.stem}.folder"), os.fsencode(folder.resolve()))
            _write_holder(folder, authority, certificate, key)
            if (self.path / "revoked.pem").is_file():
                write_private(folder / "revoked.pem", read_file(self.path / "revoked.pem"))
        except OSError as error:
            raise AuthorError(reason(error)) from None
        return certificate

    def _self_issued(self, principal: Principal) -> Path:
        folder = self.path / "own" / principal.common_name
        with _turn(self.path):
            if self._stale(folder):
                self._issued(principal, folder, new_key(), (), DAYS)
        return folder

    def _stale(self, folder: Path) -> bool:
        """Whether a folder lacks a certificate, or has one that is to be renewed."""
        try:
            certificate = _certificate(folder / f"{_OWN}.pem")
        except AuthorError:
            return True
        return certificate.half_over() or certificate.serial in self.revoked()

    def _host_authority(self) -> tuple[Certificate, Key]:
        path = self.path / _HOST_AUTHORITY
        if not path.with_suffix(".key").is_file():
            _write(path, *new_authority("the components of a host"))
        return _pair(path)

    def _authority_pair(self) -> tuple[Certificate, Key]:
        if not self.is_authority:
            raise AuthorError(f"{self.path} is not the folder of an authority: there is no {_AUTHORITY}.key in it")
        return _pair(self.path / _AUTHORITY)

    def _credentials(self, kinds: Sequence[PrincipalKind], given: KeysFolder) -> Credentials:
        """What this folder shows, checked; `given` is the folder that the program was given."""
        certificate, _ = _pair(self.path / _OWN)
        fault = certificate.fault(self.believed_authorities())
        if not fault and certificate.serial in given.revoked() | self.revoked():
            fault = "was revoked"
        if fault:
            raise AuthorError(f"{self.path}: the certificate of {certificate.common_name} {fault}")
        principal = certificate.principal
        if principal.kind not in kinds:
            wanted = " or ".join(f"{kind.value}.NAME" for kind in kinds)
            raise AuthorError(f"{self.path} speaks for {principal}; this takes a certificate of {wanted}")
        own = self.path / _OWN
        authorities = self.path / f"{_AUTHORITY}.pem"
        return Credentials(
            principal.common_name, own.with_suffix(".pem"), own.with_suffix(".key"), authorities, given.path
        )

    def _revoked_serials(self, principal: Principal) -> set[int]:
        """The serials of revoked certificates of a name that have not expired."""
        revoked = self.revoked()
        mine = (one for one in self.issued() if one.common_name == principal.common_name)
        return {one.serial for one in mine if one.serial in revoked and not self._expired(one)}

    def _expired(self, certificate: Certificate) -> bool:
        return "expired" in certificate.fault((self.authority,))


def _whose(principals: Sequence[Principal]) -> str:
    """The name of a file about the principals of a certificate.

    A component may be the first of several processes, with other components each, in different ecologies or one after
    the other; the certificate of one must not take the place of that of another.
    """
    first, *others = (one.common_name for one in principals)
    return f"{first}~{hashlib.blake2s(' '.join(others).encode(), digest_size=8).hexdigest()}" if others else first


def _principal(certificate: Certificate, folder: Path) -> Principal:
    try:
        return certificate.principal
    except PeerError as error:
        raise AuthorError(f"{folder}: {error}") from None


def _write_holder(folder: Path, authority: Certificate, certificate: Certificate, key: Key) -> None:
    """Write what a holder needs. The certificate comes last: a program that reads meanwhile finds a pair that fits."""
    make_private_folder(folder)
    write_private(folder / f"{_AUTHORITY}.pem", authority.pem)
    _write(folder / _OWN, certificate, key)


def _certificate(path: Path) -> Certificate:
    return named_in_errors(path, lambda: Certificate.read(read_file(path)))


def _pair(path: Path) -> tuple[Certificate, Key]:
    """A certificate and its key, by their path without an ending."""
    secret = path.with_suffix(".key")
    key = named_in_errors(secret, lambda: read_key(read_file(secret)))
    certificate = _certificate(path.with_suffix(".pem"))
    if not certificate.belongs_to(key):
        raise AuthorError(f"{secret} is not the key of {path.name}.pem beside it")
    return certificate, key


def _pair_of_this_user(path: Path) -> tuple[Certificate, Key] | None:
    """A certificate and its key, if there is a good pair whose key this user has written and no other may read."""
    secret = path.with_suffix(".key")
    try:
        check_private(secret)
        return _pair(path) if secret.stat().st_uid == os.getuid() else None
    except (AuthorError, OSError):
        return None


@contextmanager
def _turn(folder: Path) -> Iterator[None]:
    """Programs that share a folder write into it one at a time."""
    try:
        descriptor = os.open(folder, os.O_RDONLY)
    except OSError as error:
        raise AuthorError(reason(error)) from None
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    except OSError as error:
        raise AuthorError(reason(error)) from None
    finally:
        os.close(descriptor)


def _write(path: Path, certificate: Certificate, key: Key) -> None:
    write_private(path.with_suffix(".key"), key_pem(key))
    write_private(path.with_suffix(".pem"), certificate.pem)
