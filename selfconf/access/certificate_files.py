"""Certificates and their keys in files: NAME.pem beside NAME.key, written at once, and checked as they are read."""

from __future__ import annotations

import fcntl
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from selfconf.access.certificates import Certificate, Key, key_pem, read_key
from selfconf.access.private_files import check_private, make_private_folder, named_in_errors, read_file
from selfconf.atomic_write import write_atomically
from selfconf.errors import AuthorError, reason

AUTHORITY, HOST_AUTHORITY, OWN = "authority", "components", "certificate"
"""The names of the pairs of a folder of keys: the authority's, that of the components of a host, and the holder's."""
REVOKED = "revoked.pem"
"""The list of what the authority has revoked, in each folder of keys."""


def read_certificate(path: Path) -> Certificate:
    """Return the certificate in a file. Raises AuthorError that names the file."""
    return named_in_errors(path, lambda: Certificate.read(read_file(path)))


def read_pair(path: Path) -> tuple[Certificate, Key]:
    """Return a certificate and its key, by their path without an ending. Raises AuthorError where they do not fit."""
    secret = path.with_suffix(".key")
    key = named_in_errors(secret, lambda: read_key(read_file(secret)))
    certificate = read_certificate(path.with_suffix(".pem"))
    if not certificate.belongs_to(key):
        raise AuthorError(f"{secret} is not the key of {path.name}.pem beside it")
    return certificate, key


def read_pair_of_this_user(path: Path) -> tuple[Certificate, Key] | None:
    """Return a pair, if there is a good one whose key this user has written and no other user may read."""
    secret = path.with_suffix(".key")
    try:
        check_private(secret)
        return read_pair(path) if secret.stat().st_uid == os.getuid() else None
    except (AuthorError, OSError):
        return None


def write_pair(path: Path, certificate: Certificate, key: Key) -> None:
    """Write a certificate and its key, by their path without an ending."""
    write_atomically(path.with_suffix(".key"), key_pem(key))
    write_atomically(path.with_suffix(".pem"), certificate.pem)


def write_holder(folder: Path, authority: Certificate, certificate: Certificate, key: Key) -> None:
    """Write what a holder needs. The certificate comes last: a program that reads meanwhile finds a pair that fits."""
    make_private_folder(folder)
    write_atomically(folder / f"{AUTHORITY}.pem", authority.pem)
    write_pair(folder / OWN, certificate, key)


@contextmanager
def exclusive(folder: Path) -> Iterator[None]:
    """Have programs that share a folder write into it one at a time. Raises AuthorError."""
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
