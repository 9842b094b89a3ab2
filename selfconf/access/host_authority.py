"""The authority of one host, which issues to the components that its sites start.

It is believed by the hubs of that host alone: what a site issues to its components opens no door anywhere else. The
sites of a user there have it in common, whatever folders of keys they are given, as the components of all connect to
the hub of one of them.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Sequence
from datetime import datetime, timedelta, timezone
from pathlib import Path

from selfconf.access.certificate_files import (
    HOST_AUTHORITY,
    OWN,
    exclusive,
    read_certificate,
    read_pair,
    read_pair_of_this_user,
    write_holder,
    write_pair,
)
from selfconf.access.certificates import Certificate, Key, issue, new_authority, new_key
from selfconf.access.keys_folder import KeysFolder, holder_name
from selfconf.access.principal import Principal
from selfconf.access.private_files import make_private_folder, read_file
from selfconf.atomic_write import write_atomically
from selfconf.errors import AuthorError, PeerError

COMPONENT_DAYS = 1.0
"""For how many days the certificate of a component which a site starts is good; the site renews it."""


class HostAuthority:
    """What a site does with its folder of keys for the components of its host."""

    def __init__(self, keys: KeysFolder) -> None:
        self._keys, self._pair_path = keys, keys.path / HOST_AUTHORITY

    def _pair(self) -> tuple[Certificate, Key]:
        """The certificate of this authority and its key, made now where there are none."""
        if not all(self._pair_path.with_suffix(ending).is_file() for ending in (".key", ".pem")):
            write_pair(self._pair_path, *new_authority("the components of a host"))
        return read_pair(self._pair_path)

    def hub_authorities(self) -> Path:
        """The file of the authorities that the hub of a site here believes: the ecology's, and that of this host."""
        trusted = self._keys.path / "trusted.pem"
        with exclusive(self._keys.path):
            self._pair()
            together = self._keys.authority.pem + read_file(self._pair_path.with_suffix(".pem"))
            if not trusted.is_file() or trusted.read_bytes() != together:
                write_atomically(trusted, together)
        return trusted

    def share(self, shared: Path) -> None:
        """Issue to components as the other sites of this user on this host do, by what they share in a folder.

        The first site with keys of an ecology's authority gives what it has; the others take that instead of their own.
        """
        digest = hashlib.blake2s(self._keys.authority.pem, digest_size=8).hexdigest()
        common = shared / f"{HOST_AUTHORITY}-{digest}"
        with exclusive(shared), exclusive(self._keys.path):
            given = read_pair_of_this_user(common)
            if given is not None:
                write_pair(self._pair_path, *given)
            else:
                write_pair(common, *self._pair())

    def component(self, principal: Principal, also: Sequence[Principal] = ()) -> Path:
        """The folder of a process on this host, by its first component, with a certificate made or renewed now.

        `also` are the other components of the process. Raises AuthorError, as where the site's own has expired.
        """
        folder = self._keys.path / "components" / holder_name((principal, *also))
        with exclusive(self._keys.path):
            authority, _ = self._pair()
            ends = self._component_ends()
            kept = _certificate(folder)
            if kept is None or _is_due(kept, authority, ends):
                self._issue(folder, (principal, *also), ends)
        return folder

    def _issue(self, folder: Path, principals: Sequence[Principal], ends: datetime) -> None:
        """Issue a certificate into the folder of a process; the folder of keys is locked."""
        (authority, authority_key), key = self._pair(), new_key()
        days = (ends - datetime.now(timezone.utc)) / timedelta(days=1)
        certificate = issue(authority, authority_key, principals[0], key.public_key(), (), days, principals[1:])
        make_private_folder(folder)
        write_atomically(folder / f"{HOST_AUTHORITY}.pem", authority.pem)
        write_holder(folder, self._keys.authority, certificate, key)  # last: what has it has all of it

    def _component_ends(self) -> datetime:
        """Until when a component gets a certificate: for no longer than its site has one. Raises AuthorError."""
        now = datetime.now(timezone.utc)
        ends = now + timedelta(days=COMPONENT_DAYS)
        if (self._keys.path / f"{OWN}.pem").is_file():
            own = self._keys.own()
            if own.ends < now:
                raise AuthorError(f"the certificate of {own.common_name} {own.untimely(now)}")
            ends = min(ends, own.ends)
        return ends

    def renew_components(self) -> Iterator[None]:
        """Renew the certificates of all processes of this host, one at each step, if one of them is due.

        All, because the hub is opened anew for it; in steps, as each takes some 20 ms. Where none is due, it takes some
        0.1 ms for each process. Raises AuthorError.
        """
        found = {folder: _certificate(folder) for folder in (self._keys.path / "components").glob("*")}
        kept = {folder: certificate for folder, certificate in found.items() if certificate is not None}
        if not kept:
            return
        with exclusive(self._keys.path):
            authority, _ = self._pair()
        ends = self._component_ends()
        if any(_is_due(certificate, authority, ends) for certificate in kept.values()):
            for folder, certificate in kept.items():
                with exclusive(self._keys.path):
                    self._issue(folder, certificate.principals, self._component_ends())
                yield


def _certificate(folder: Path) -> Certificate | None:
    """The certificate of a process; None for one that has none, or none that names principals: it is made anew."""
    try:
        certificate = read_certificate(folder / f"{OWN}.pem")
        _ = certificate.principals
    except (AuthorError, PeerError):
        return None
    return certificate


def _is_due(certificate: Certificate, authority: Certificate, ends: datetime) -> bool:
    """Whether the certificate of a process is to be made anew; `ends` is until when it would be good."""
    expires = certificate.half_over() and certificate.ends < ends
    return expires or certificate.ends > ends or bool(certificate.fault((authority,)))
