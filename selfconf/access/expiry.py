"""A program's certificate while the program runs: shown again when it is renewed, and spoken of before it expires.

Links have to be made anew with another certificate, and Zenoh does that by itself: the other end closes a link as the
certificate of this end expires, and the next link is made with what lies in the file by then. But sites let in a
client that has *shown* a good certificate, so a renewed one is shown as soon as it is there. The hub is then opened
anew (`doorkeeper`), with a warning, as the end of the old certificate would come without one. One that is not good is
withheld from Zenoh, which would try to make links with it all the time.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from datetime import datetime, timezone

from selfconf.access.authority import open_keys
from selfconf.access.certificate_files import REVOKED, read_pair
from selfconf.access.certificates import Certificate
from selfconf.access.introduction import ANSWER
from selfconf.access.principal import Principal
from selfconf.access.private_files import check_private
from selfconf.bus.credentials import Credentials
from selfconf.bus.port import Bus
from selfconf.bus.presented_certificate import withhold
from selfconf.errors import AuthorError, PeerError, SelfconfError, reason
from selfconf.files import FileStamp, stamp
from selfconf.model.wording import utc_text
from selfconf.protocol.codec import encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Introduction

log = logging.getLogger(__name__)

CERTIFICATE_CHECK = 1.0
"""How often, in seconds, the certificate is looked at."""
LAST_PART = 4
"""A certificate is spoken of in the last quarter of its time, if it has not been renewed by then."""


def is_in_time(credentials: Credentials) -> bool:
    """Whether the certificate of a program is good now, by the clock of this host; one that cannot be read is not."""
    try:
        return not Certificate.read(credentials.certificate.read_bytes()).untimely()
    except (OSError, PeerError):
        return False


class CertificateWatch:
    """Keeps an eye on the certificate of a program, from its making until its bus is closed."""

    def __init__(
        self,
        bus: Bus,
        ecology: str,
        credentials: Credentials,
        complain: Callable[[str], None] = log.error,  # a person has to do something
        now: Callable[[], datetime] = lambda: datetime.now(timezone.utc),
        distrusted: Callable[[], None] = lambda: None,
    ) -> None:
        """To be made before the bus runs on its own thread, or on that thread.

        `distrusted` is called there, after each look, once the certificate was revoked.
        """
        self._bus, self._key, self._credentials = bus, Keys(ecology).introduce("*"), credentials
        self._complain, self._now, self._distrusted = complain, now, distrusted
        self._certificate = Certificate.read(credentials.certificate.read_bytes())
        self._changed_at, self._link = self._modified(), bus.link
        self._revoked = False
        self._read_at: tuple[FileStamp, int] = ((), 0)
        """The stamp of the list of what was revoked, and when the certificate had changed, as the two were compared."""
        self._said = ""
        bus.later(CERTIFICATE_CHECK, self._look)

    def _modified(self) -> int:
        return self._credentials.certificate.stat().st_mtime_ns

    def _look(self) -> None:
        self._bus.later(CERTIFICATE_CHECK, self._look)
        try:
            self._renew_own()
            changed, link = self._modified(), self._bus.link
            if changed != self._changed_at:
                self._certificate = self._read()
            if (changed, link) != (self._changed_at, self._link) and link:  # by another link, another site may hear it
                self._changed_at, self._link = changed, link
                self._show()
            self._look_at_list()
            sentence = self._sentence()
            if not sentence:
                check_private(self._credentials.key)  # else it cannot be renewed, nor this program begin again
            withhold(self._credentials.certificate, self._revoked or bool(self._certificate.untimely(self._now())))
        except (OSError, SelfconfError) as error:
            why = reason(error) if isinstance(error, OSError) else str(error)
            sentence = f"{self._whose} cannot be renewed: {why}"
        self._tell(sentence)
        if self._revoked:
            self._distrusted()

    def _read(self) -> Certificate:
        """The certificate as it lies in its file now. Raises AuthorError where it is of another key or holder."""
        path = self._credentials.certificate
        certificate, _ = read_pair(path.with_suffix(""))
        if certificate.common_name != self._credentials.name:
            raise AuthorError(f"{path} is that of {certificate.common_name} now")
        return certificate

    def _renew_own(self) -> None:
        """A program that is given the folder of an authority renews its certificate by itself."""
        if self._certificate.half_over(self._now()):
            folder = open_keys(self._credentials.folder)
            if folder.is_authority:
                own = Principal.of(self._credentials.name)
                folder.credentials((own.kind,), own.name)

    def _look_at_list(self) -> None:
        """See whether the list of what was revoked names the certificate, when one of the two has changed."""
        path = self._credentials.folder / REVOKED
        changed = stamp(path), self._changed_at
        if changed != self._read_at:
            self._revoked = self._certificate.serial in open_keys(self._credentials.folder).revoked()
            self._read_at = changed  # after it: a list that cannot be read now is looked at again

    def _show(self) -> None:
        shown = Introduction(self._certificate.pem.decode())
        self._bus.ask(self._key, encode(shown), ANSWER, lambda replies: None)

    def _sentence(self) -> str:
        """What is to be said of the certificate; nothing most of the time."""
        ends, now = self._certificate.ends, self._now()
        folder = self._credentials.certificate.parent
        its_site = (folder / "components.pem").is_file() and not (folder / "components.key").is_file()
        renew = (
            "its site renews it, while it has a certificate" if its_site else f"renew it: selfconf keys renew {folder}"
        )
        if self._revoked:
            return f"{self._whose} was revoked: it is not trusted any more; have another name issued to you"
        if now < self._certificate.begins:
            return f"{self._whose} {self._certificate.untimely(now)}"
        if ends < now:
            return f"{self._whose} has expired at {utc_text(ends)}: it is not trusted any more; {renew}"
        if ends - now < (ends - self._certificate.issued) / LAST_PART:
            return f"{self._whose} expires at {utc_text(ends)}; {renew}"
        return ""

    def _tell(self, sentence: str) -> None:
        """Say it once; when it is over, say that."""
        if sentence != self._said:
            self._said = sentence
            self._complain(sentence or f"{self._whose} is good until {utc_text(self._certificate.ends)}")

    @property
    def _whose(self) -> str:
        return f"the certificate of {self._credentials.name}"
