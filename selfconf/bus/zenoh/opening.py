"""How a bus over Zenoh is opened: that of a site with its hub, and that of a program which is a client of one."""

from __future__ import annotations

import socket
import time
from collections.abc import Sequence

from selfconf.bus.credentials import Credentials
from selfconf.bus.zenoh.bus import ZenohBus
from selfconf.bus.zenoh.relay import Hub
from selfconf.bus.zenoh.session import ANYWHERE_ON_LOOPBACK, GREETING, Security, open_session
from selfconf.errors import NetworkError
from selfconf.protocol.endpoints import endpoint_host, endpoint_port

LISTENS = 0.5
"""Seconds that the host of an endpoint may take to take a connection."""


def router(
    listen: str = ANYWHERE_ON_LOOPBACK,
    connect: Sequence[str] = (),
    otherwise: Sequence[str] = (),
    security: Security | None = None,
) -> ZenohBus:
    """Open a relay that listens on `listen` and connects to others, and a bus that is its client.

    Port 0 means any free one; `endpoint` is the one that was taken. The bus becomes a client of those that are named
    `otherwise` if it relays no more. Raises NetworkError if the endpoint is taken.
    """
    hub = Hub(listen, security)
    own = None if security is None else Security(security.credentials)
    try:
        connected = open_session("client", connect=[hub.from_here, *otherwise], connect_seconds=5.0, security=own)
        bus = ZenohBus(connected)
        bus.relay(hub, connect)
    except NetworkError:
        hub.close()
        raise
    return bus


def client(
    connect: Sequence[str],
    seconds: float = 4.0,
    shared_memory: bool = False,
    credentials: Credentials | None = None,
    wanted: str = "site",
) -> ZenohBus:
    """Open the session of anything that is not a site. Raises NetworkError if none of the endpoints answers.

    Each endpoint is tried once first: with a time-out, Zenoh would spend all of it on the first one. Where nothing
    listens it is tried again for that long, as a site may be about to; what listens and stays silent is no site. With
    `shared_memory` large payloads go through that, unless so many clients have it already that the hub refuses. What is
    `wanted` there stands in the sentence of the error.
    """
    began = time.monotonic()
    security = None if credentials is None else Security(credentials)
    for shared in (True, False) if shared_memory else (False,):
        try:
            return ZenohBus(
                open_session("client", connect=connect, shared_memory=shared, security=security, wanted=wanted)
            )
        except NetworkError:
            if credentials is not None:
                _raise_if_refused(connect, credentials)
            elif time.monotonic() - began > GREETING:
                where = ", ".join(filter(listens, connect)) or ", ".join(connect)
                raise NetworkError(
                    f"what listens at {where} stays silent; is the endpoint that of a {wanted}?"
                ) from None
    return ZenohBus(open_session("client", (), connect, seconds, shared_memory, security, wanted))


def listens(endpoint: str) -> bool:
    """Whether a connection to an endpoint such as `tcp/127.0.0.1:7447` is taken, whatever comes after that."""
    port = endpoint_port(endpoint)
    try:
        socket.create_connection((endpoint_host(endpoint), port or 0), LISTENS).close()
    except (OSError, ValueError, OverflowError):
        return False
    return True


def _raise_if_refused(connect: Sequence[str], credentials: Credentials) -> None:
    """Raise NetworkError if this end and an endpoint do not believe each other; a hub may also be opened anew."""
    from selfconf.bus.handshake import why_refused  # loads TLS, of which programs without keys have no need

    why = next((found for endpoint in connect if (found := why_refused(endpoint, credentials))), "")
    if why:
        raise NetworkError(why) from None
