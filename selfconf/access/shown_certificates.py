"""The certificates that clients and other sites show to a site: good ones are kept, and let their holders in."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime

from selfconf.access.certificates import Certificate
from selfconf.access.keys_folder import KeysFolder
from selfconf.access.principal import Principal

NOT_AGAIN = 1.0
"""For how many seconds a certificate that is shown again is not looked at again: it takes milliseconds each time."""

Process = tuple[Principal, ...]
"""The principals of the certificate of a process, its subject first."""


def holders(folder: KeysFolder, ecology: str) -> list[Process]:
    """Who has shown a good certificate."""
    return [one.principals for one in folder.admitted(ecology).values()]


class ShownCertificates:
    """What was shown to one site, of one ecology."""

    def __init__(self, folder: KeysFolder, ecology: str, now: Callable[[], float]) -> None:
        self._folder, self._ecology, self._now = folder, ecology, now
        self._admitted, self._admitted_at = set[Certificate](), now()
        """The good ones that were shown in these moments, and since when that is noted."""
        self._latest: dict[Process, tuple[datetime, datetime]] = {}
        """From and until when the latest one is valid that each holder has shown."""

    def admit(self, pem: str) -> Certificate:
        """Let the holder of a certificate in, and return that. Raises PeerError for one that is not good.

        AuthorError is raised for what is wrong with the folder of keys.
        """
        if self._now() - self._admitted_at > NOT_AGAIN:
            self._admitted, self._admitted_at = set(), self._now()
        shown = Certificate.read(pem.encode())
        if shown not in self._admitted:
            self._folder.admit(self._ecology, shown.pem)
            self._admitted.add(shown)
        return shown

    def renews(self, shown: Certificate) -> bool:
        """Whether a certificate is later than the ones that its holder has shown so far, if there is one; note it."""
        validity = (shown.begins, shown.ends)
        before = self._latest.setdefault(shown.principals, validity)
        self._latest[shown.principals] = max(before, validity)
        return validity > before
