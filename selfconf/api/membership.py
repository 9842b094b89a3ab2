"""How the program of a person becomes a member of an ecology: it connects, and with keys it shows a certificate."""

from __future__ import annotations

import secrets
from collections.abc import Sequence

from selfconf.bus.credentials import Credentials
from selfconf.bus.zenoh_bus import ZenohBus, client
from selfconf.discovery import Beliefs
from selfconf.errors import NetworkError

MEMBERS = ("conf", "read", "site")
"""The kinds of certificates that a program of a person may show: what it does is more or less, and the sites judge."""


def member(ecology: str, endpoints: Sequence[str], credentials: Credentials | None) -> ZenohBus:
    """A bus that is connected to a hub which lets this program in. Raises NetworkError."""
    bus = client(list(endpoints), credentials=credentials)
    if credentials is not None:
        from selfconf.access import CertificateWatch, introduce  # what it needs is an extra

        try:
            introduce(bus, ecology, credentials)
            CertificateWatch(bus, ecology, credentials)
        except BaseException:
            bus.close()
            raise
    return bus


def beliefs(credentials: Credentials | None) -> Beliefs | None:
    """Whose disputed components are for a program, by the folder of keys that it was given; None without keys."""
    if credentials is None:
        return None
    from selfconf.access import believed  # what it needs is an extra

    folder = credentials.folder
    return lambda: believed(folder)


def check_may_run(credentials: Credentials | None) -> None:
    """Raises NetworkError for credentials by which no task can be run or stopped: its calls would not be delivered."""
    if credentials is not None and credentials.name.startswith("read."):
        raise NetworkError(f"{credentials.name} may look on only; tasks are run and stopped with keys of conf.NAME")


def configurator_name(credentials: Credentials | None) -> str:
    """What a configurator calls itself: with keys its name begins with that of its certificate; empty: any name."""
    if credentials is None:
        return ""
    kind, _, name = credentials.name.partition(".")
    return f"{name}-{secrets.token_hex(4)}" if kind == "conf" else ""
