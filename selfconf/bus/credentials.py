"""What a session shows to others, and by what it judges them: the files of mutual TLS."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True, slots=True)
class Credentials:
    """A certificate with its key, and the authorities whose certificates are believed; each a file in PEM."""

    name: str
    """The common name of the certificate, such as `site.kitchen`."""
    certificate: Path
    key: Path
    authorities: Path
    """Who must have issued the certificate of the other end."""
    folder: Path
    """The keys folder that they are from: what `--keys` was given, for a program that hands it on."""
