"""The certificate of this program as Zenoh finds it: not at all while it is not good, so that no link is tried in vain.

Zenoh reads the files of mutual TLS for each link that it makes, and tries again and again. A hub that refuses a
handshake lets none in for a tenth of a second (zenoh#2685): one program whose certificate has expired would keep the
others of its host out. So Zenoh is given a path through a descriptor of the folder, and the descriptor is of another
folder as long as the certificate is withheld.
"""

from __future__ import annotations

import os
from pathlib import Path

DESCRIPTORS = Path("/proc/self/fd")
"""The descriptors of this process, where Linux has them (proc(5)); nothing in there is called like a certificate."""

_folders: dict[Path, int] = {}
"""The descriptor for each folder with a certificate that this process shows; kept until it ends."""


def presented(certificate: Path) -> Path:
    """The path at which Zenoh finds a certificate unless that is withheld; without /proc nothing can be."""
    number = _folders.get(certificate.parent)
    if number is None:
        if not DESCRIPTORS.is_dir():
            return certificate
        try:
            number = _folders[certificate.parent] = _opened(certificate.parent)
        except OSError:  # it is not there: Zenoh will say what it misses
            return certificate
    return DESCRIPTORS / str(number) / certificate.name


def withhold(certificate: Path, withheld: bool) -> None:
    """Have Zenoh find a certificate or not. Raises OSError where the folder cannot be opened any more."""
    number = _folders.get(certificate.parent)
    if number is None:
        return
    folder = _opened(DESCRIPTORS if withheld else certificate.parent)  # anew: it may have been replaced
    try:
        os.dup2(folder, number, inheritable=False)
    finally:
        os.close(folder)


def _opened(folder: Path) -> int:
    return os.open(folder, os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)
