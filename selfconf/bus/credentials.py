"""What a session shows to others, and by what it judges them: the files of mutual TLS."""

from __future__ import annotations

from pathlib import Path

from selfconf.errors import NetworkError
from selfconf.model.immutable import immutable


@immutable
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

    def check(self) -> None:
        """Raise NetworkError if one of the files cannot be read."""
        for file in (self.certificate, self.key, self.authorities):
            try:
                file.read_bytes()
            except OSError as error:
                raise NetworkError(f"{file} cannot be read: {error.strerror}") from None
