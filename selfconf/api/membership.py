"""How the program of a person becomes a member of an ecology: it connects, and with keys it shows a certificate."""

from __future__ import annotations

import secrets
from collections.abc import Callable

from selfconf.bus.credentials import Credentials
from selfconf.bus.zenoh import ZenohBus
from selfconf.discovery import Beliefs
from selfconf.errors import NetworkError
from selfconf.model.immutable import immutable
from selfconf.rendezvous import credentials, member_bus

MEMBERS = ("conf", "read", "site")
"""The kinds of certificates that a program of a person may show: what it does is more or less, and the sites judge."""


@immutable
class Membership:
    """In which ecology a program takes part, where it connects, and what it shows there."""

    ecology: str
    endpoints: tuple[str, ...]
    credentials: Credentials | None = None
    """None without keys."""

    def connect(self, distrusted: Callable[[], None] = lambda: None) -> ZenohBus:
        """A bus that is connected to a hub which lets this program in. Raises NetworkError.

        `distrusted` is called on its thread, each second, once the certificate of this program was revoked.
        """
        return member_bus(self.ecology, self.endpoints, self.credentials, distrusted=distrusted)

    def check_certificate(self) -> None:
        """Raise AuthorError where no hub lets this program in any more: its certificate has expired, or was revoked."""
        if self.credentials is not None:
            credentials(self.credentials.folder, *MEMBERS)

    def beliefs(self) -> Beliefs | None:
        """What says whose a disputed component is, by the folder of keys of this program; None without keys."""
        if self.credentials is None:
            return None
        from selfconf.access import believed  # what it needs is an extra

        folder = self.credentials.folder
        return lambda: believed(folder)

    @property
    def looks_on_only(self) -> bool:
        """Whether the keys, if there are any, are those of a reader: it hears no signals, and calls no component."""
        return self.credentials is not None and self.credentials.name.startswith("read.")

    def check_may_run(self) -> None:
        """Raise NetworkError where no task can be run or stopped, as the calls of a reader would not be delivered."""
        if self.credentials is not None and self.looks_on_only:
            name = self.credentials.name
            raise NetworkError(f"{name} may look on only; tasks are run and stopped with keys of conf.NAME")

    def configurator_name(self) -> str:
        """What a configurator calls itself: with keys its name begins with that of its certificate; empty: any name."""
        if self.credentials is None:
            return ""
        kind, _, name = self.credentials.name.partition(".")
        return f"{name}-{secrets.token_hex(4)}" if kind == "conf" else ""
