"""An endpoint of Zenoh as text: `PROTOCOL/ADDRESS`, which `?METADATA` and `#SETTINGS` of the link may follow.

The address of `tcp/127.0.0.1:7447#so_rcvbuf=65536` has a host and a port; that of a local socket is a path.
"""

from __future__ import annotations

import re

_PARTS = re.compile(r"(?P<protocol>[^/?#]*/?)(?P<address>[^?#]*)(?P<settings>.*)", re.DOTALL)
_PROTOCOL = re.compile(r"[\w.-]+/", re.ASCII)
"""A protocol with its slash; `http:/`, which a URL begins with, is none."""
_PORT = re.compile(r"\+?[0-9]+", re.ASCII)
MOST_PORT = (1 << 16) - 1
LISTENING_PORTS = range(20000, 32768)
"""The ports that hubs take where none is given: below those that Linux takes for outgoing connections.

Else a client that tries to connect to a port where nothing listens might be given that very port for its own end.
"""
_WITH_PORT = frozenset(("tcp/", "tls/", "udp/", "quic/", "ws/"))
# The protocols whose addresses have a host and a port.


def is_zenoh_endpoint(text: str) -> bool:
    """Whether a text can be an endpoint: a protocol and an address, which has a port where the protocol wants one.

    Zenoh itself would try for as long as it is given to reach one without its port.
    """
    protocol, address, settings = _parts(text)
    if protocol in _WITH_PORT:
        port = endpoint_port(text)
        return port is not None and port <= MOST_PORT
    return _PROTOCOL.fullmatch(protocol) is not None and bool(address) and settings not in ("?", "#")


def endpoint_port(endpoint: str) -> int | None:
    """The port of an endpoint; None for one that has none, such as a path, or a word in its place."""
    _, address, _ = _parts(endpoint)
    port = address.rpartition(":")[2]
    return int(port) if _PORT.fullmatch(port) and not address.startswith("/") else None


def endpoint_host(endpoint: str) -> str:
    """What stands before the port of an endpoint, an address of IPv6 without its brackets; empty if there is none."""
    return _parts(endpoint)[1].rpartition(":")[0].strip("[]")


def with_other_port(endpoint: str, port: int) -> str:
    """An endpoint with another port in place of its own."""
    protocol, address, settings = _parts(endpoint)
    return f"{protocol}{address.rpartition(':')[0]}:{port}{settings}"


def with_settings(endpoint: str, settings: str) -> str:
    """An endpoint with further settings of its link, such as `so_rcvbuf=65536`."""
    return f"{endpoint}{';' if '#' in endpoint else '#'}{settings}"


def _parts(endpoint: str) -> tuple[str, str, str]:
    """The protocol with its slash, the address, and what follows."""
    found = _PARTS.fullmatch(endpoint)
    assert found is not None  # each of the three may be empty
    return found["protocol"], found["address"], found["settings"]
