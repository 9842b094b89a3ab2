"""The authority of an ecology: it issues, renews and revokes certificates by the folder that holds its key."""

from __future__ import annotations

import os
import shutil
from collections import defaultdict
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path

from selfconf.access.certificate_files import (
    AUTHORITY,
    OWN,
    REVOKED,
    exclusive,
    read_certificate,
    read_pair,
    write_holder,
    write_pair,
)
from selfconf.access.certificates import EVERY_HOST, Certificate, Key, issue, new_authority, new_key, revocations
from selfconf.access.keys_folder import MAIN, KeysFolder
from selfconf.access.principal import Principal, PrincipalKind
from selfconf.access.private_files import content, make_private_folder, read_file
from selfconf.atomic_write import write_atomically
from selfconf.bus.credentials import Credentials
from selfconf.errors import AuthorError, reason
from selfconf.model.immutable import replace
from selfconf.model.wording import as_typed

DAYS = 7.0
"""For how many days a certificate is good unless told otherwise."""
KNOWN = (Principal(PrincipalKind.CONFIGURATOR, MAIN), Principal(PrincipalKind.READER, MAIN))
"""The principals that every site that is given the folder of the authority knows."""


def open_keys(path: Path) -> KeysFolder:
    """Open a folder of keys as what it is: an authority's, or a holder's. Raises AuthorError."""
    return Authority(path) if (path / f"{AUTHORITY}.key").is_file() else KeysFolder(path)


class Authority(KeysFolder):
    """The folder of an authority. A program that is given it gets a certificate of its own."""

    is_authority = True

    def __init__(self, path: Path) -> None:
        """Raises AuthorError for what is refused as a `KeysFolder`, or holds no key of an authority."""
        super().__init__(path)
        if not (path / f"{AUTHORITY}.key").is_file():
            raise AuthorError(f"{path} is not the folder of an authority: there is no {AUTHORITY}.key in it")

    @classmethod
    def init(cls, path: Path) -> Authority:
        """Make the folder of a new authority. Raises AuthorError where there is one, or anything else."""
        if path.exists() and (not path.is_dir() or any(path.iterdir())):
            raise AuthorError(f"{path} exists and is not empty; an authority gets a folder of its own")
        try:
            path.mkdir(mode=0o700, parents=True, exist_ok=True)
            path.chmod(0o700)
            write_pair(path / AUTHORITY, *new_authority("the authority of an ecology"))
        except OSError as error:
            raise AuthorError(reason(error)) from None
        folder = cls(path)
        folder._known()  # before any program asks
        return folder

    def issue(self, principal: Principal, out: Path, hosts: Sequence[str] = (), days: float = DAYS) -> Certificate:
        """Issue a certificate with a new key into a folder of its own. Raises AuthorError."""
        if out.exists() and (not out.is_dir() or any(out.iterdir())):
            renewal = f"`selfconf keys renew {as_typed(out)}`"
            raise AuthorError(f"{out} exists and is not empty; to renew what is in it: {renewal}")
        self._check_name(principal)
        return self._issued(principal, out, new_key(), hosts, days)

    def renew(self, folder: Path, days: float = DAYS) -> Certificate:
        """Issue anew what a folder has, for the same key. Raises AuthorError."""
        old = open_keys(folder)
        if old.is_authority or not (folder / f"{OWN}.pem").is_file():
            raise AuthorError(f"{folder} holds no certificate that was issued; nothing to renew")
        if old.authority != self.authority:
            raise AuthorError(f"{folder} is of another authority than {self.path}")
        certificate, key = read_pair(folder / OWN)
        principal = old.principal()
        if self._has_revoked(principal):
            raise AuthorError(f"the certificate of {principal} was revoked")
        hosts = [host for host in certificate.hosts if host not in EVERY_HOST]
        return self._issued(principal, folder, key, hosts, days)

    def revoke(self, principal: Principal) -> int:
        """Revoke all certificates of a name that have not expired; how many. Raises AuthorError if there are none.

        The folders of keys that were issued on this host have the list at once, as far as they are where they were.
        """
        with exclusive(self.path):  # else, of two lists that are made at once, one would lack what the other has
            authority, key = read_pair(self.path / AUTHORITY)
            current = [one for one in self.issued() if not self._expired(one)]
            found = [one for one in current if one.common_name == principal.common_name]
            if not found:
                raise AuthorError(f"there is no certificate of {principal} that has not expired; nothing to revoke")
            before = self.revoked()
            listed = revocations(authority, key, [one for one in current if one.serial in before or one in found])
            write_atomically(self.path / REVOKED, listed)
            for folder in dict.fromkeys(self._folders().values()):
                if self._is_of_mine(folder):
                    with suppress(OSError):  # `unaware` names the folder
                        write_atomically(folder / REVOKED, listed)
            return len(found)

    def issued(self) -> list[Certificate]:
        """The certificates that this authority has issued, by name and time."""
        found = map(read_certificate, (self.path / "issued").glob("*.pem"))
        return sorted(found, key=lambda one: (one.common_name, one.begins))

    # Who knows what is revoked.

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
        return self._is_of_mine(folder) and content(folder / REVOKED) == content(self.path / REVOKED)

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
        return content(folder / f"{AUTHORITY}.pem") == content(self.path / f"{AUTHORITY}.pem")

    # What programs that are given this folder show.

    def credentials(self, kinds: Sequence[PrincipalKind], name: str = MAIN) -> Credentials:
        """What a program of some kinds shows: a certificate of the first, of a name, made or renewed now.

        Raises AuthorError for a name that was revoked, besides what is wrong with the folder.
        """
        principal = Principal(kinds[0], name)
        folder = self.path / "own" / principal.common_name
        with exclusive(self.path):
            if self.is_stale(folder):
                if name != MAIN:  # the folder itself is to be of use in any case
                    self._check_name(principal)
                self._issued(principal, folder, new_key(), (), DAYS)
                self._forget_expired()
        return replace(KeysFolder(folder).credentials(kinds), folder=self.path)

    def _forget_expired(self) -> None:
        """Remove what has expired of programs that were given this folder: a site of a random name comes with each run.

        What was issued into other folders stays on record.
        """
        own, known = self.path / "own", {principal.common_name for principal in KNOWN}
        for folder in own.iterdir():
            if folder.name not in known and self._has_expired(folder / f"{OWN}.pem"):
                shutil.rmtree(folder, ignore_errors=True)
        for noted in (self.path / "issued").glob("*.folder"):
            issued = noted.with_suffix(".pem")
            if Path(os.fsdecode(content(noted))).parent == own.resolve() and self._has_expired(issued):
                issued.unlink(missing_ok=True)
                noted.unlink(missing_ok=True)

    def _has_expired(self, path: Path) -> bool:
        """Whether there is a certificate in a file that has expired."""
        with suppress(AuthorError):
            return self._expired(read_certificate(path))
        return False

    def _shown(self, ecology: str) -> Iterable[Certificate]:
        """What was shown to sites of an ecology, and what programs that are given this folder need not show."""
        return [*super()._shown(ecology), *self._known()]

    def _known(self) -> list[Certificate]:
        """What is known without being shown; made now if it is not there, as `init` may have been broken off."""
        found = []
        for principal in KNOWN:
            own = self.path / "own" / principal.common_name / f"{OWN}.pem"
            if not own.is_file():
                self.credentials((principal.kind,), MAIN)
            found.append(read_certificate(own))
        return found

    # How it is kept.

    def _issued(self, principal: Principal, folder: Path, key: Key, hosts: Sequence[str], days: float) -> Certificate:
        authority, authority_key = read_pair(self.path / AUTHORITY)
        certificate = issue(authority, authority_key, principal, key.public_key(), hosts, days)
        try:
            make_private_folder(self.path / "issued")
            noted = self.path / "issued" / f"{certificate.common_name}~{certificate.serial:x}.pem"
            write_atomically(noted, certificate.pem)
            write_atomically(noted.with_name(f"{noted.stem}.folder"), os.fsencode(folder.resolve()))
            write_holder(folder, authority, certificate, key)
            if (self.path / REVOKED).is_file():
                write_atomically(folder / REVOKED, read_file(self.path / REVOKED))
        except OSError as error:
            raise AuthorError(reason(error)) from None
        return certificate

    def _check_name(self, principal: Principal) -> None:
        """Raise AuthorError for a name that was revoked, until its certificates have expired."""
        if self._has_revoked(principal):
            raise AuthorError(
                f"a certificate of {principal} was revoked and has not expired: choose another name until it has"
            )

    def _has_revoked(self, principal: Principal) -> bool:
        """Whether a certificate of a name that has not expired was revoked."""
        revoked = self.revoked()
        mine = (one for one in self.issued() if one.common_name == principal.common_name)
        return any(one.serial in revoked and not self._expired(one) for one in mine)

    def _expired(self, certificate: Certificate) -> bool:
        return "expired" in certificate.fault((self.authority,))
