"""How a Zenoh session is set up: as a router or as the client of one. Only this room, `bus`, speaks Zenoh.

Multicast is off, endpoints are explicit, and nothing listens anywhere but on loopback unless an endpoint says so. A
lease of one second: what is stopped or cut off counts as dead after about that time.
"""

from __future__ import annotations

import json
import socket
from collections.abc import Sequence
from typing import Any

import zenoh

from selfconf.errors import NetworkError

LEASE_MS = 1000
"""After how long without a message a session counts as gone: what is stopped or cut off is noticed after that time."""
ANYWHERE_ON_LOOPBACK = "tcp/127.0.0.1:0"
HANDSHAKE_MS = 1500
"""How long whoever accepts a connection may take to greet, or to answer: beyond that it is no router, or a hung one."""
_RETRY = {
    # A client is cut off as long as it has no router, and its components rest after a second.
    "client": {"period_init_ms": 50, "period_max_ms": 200, "period_increase_factor": 1.5},
    # A router that is gone may stay away; many that look for each other at once must not take the machine.
    "router": {"period_init_ms": 200, "period_max_ms": 4000, "period_increase_factor": 2.0},
}

zenoh.init_log_from_env_or("off")  # it would write to stdout, among the results; RUST_LOG=error turns it on


def open_session(
    mode: str, listen: Sequence[str] = (), connect: Sequence[str] = (), connect_seconds: float = 0.0
) -> Any:
    """Open a session. Raises NetworkError for an endpoint that is none or taken, and where no router answers a client.

    With `connect_seconds` a client tries for that long, otherwise each endpoint once. A router does not wait for those
    that it connects to.
    """
    config = _config(mode, listen, connect, connect_seconds)
    try:
        return zenoh.open(config)
    except zenoh.ZError as error:
        where = ", ".join(connect if mode == "client" else listen)
        if "Address already in use" in str(error):
            raise NetworkError(f"cannot listen on {where}: the port is in use; port 0 is any free one") from None
        what = "nobody answers at" if mode == "client" else "cannot listen on"
        raise NetworkError(f"{what} {where}; is the endpoint right? ({_first_sentence(error)})") from None


def with_port(endpoint: str) -> str:
    """The endpoint with a free port in place of port 0; Zenoh would not say which one it has taken."""
    head, _, port = endpoint.rpartition(":")
    if port != "0":
        return endpoint
    host = head.partition("/")[2].strip("[]")
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    with socket.socket(family, socket.SOCK_STREAM) as probe:
        try:
            probe.bind((host, 0))
        except OSError as error:
            raise NetworkError(f"cannot listen on {endpoint}: {error.strerror or error}") from None
        return f"{head}:{probe.getsockname()[1]}"


def _config(mode: str, listen: Sequence[str], connect: Sequence[str], connect_seconds: float) -> zenoh.Config:
    config = zenoh.Config()
    settings: dict[str, Any] = {
        "mode": mode,
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "scouting/delay": 0,  # there is nothing to be scouted; by default a router opens half a second later
        "listen/endpoints": list(listen),
        "connect/endpoints": list(connect),
        "connect/retry": _RETRY[mode],
        "connect/exit_on_failure": mode == "client",
        "connect/timeout_ms": int(connect_seconds * 1000) if mode == "client" else -1,
        "transport/link/tx/lease": LEASE_MS,
        # Three messages in a lease: an idle link costs a quarter less than with four, and two may be late.
        "transport/link/tx/keep_alive": 3,
        "transport/unicast/open_timeout": HANDSHAKE_MS,
        "transport/unicast/accept_timeout": HANDSHAKE_MS,
        "transport/shared_memory/enabled": False,
        "timestamping/enabled": {"router": True, "peer": True, "client": True},
    }
    for key, value in settings.items():
        try:
            config.insert_json5(key, json.dumps(value))
        except zenoh.ZError:
            raise NetworkError(f"{', '.join(value)} is no endpoint; write it like tcp/127.0.0.1:7447") from None
    return config


def _first_sentence(error: Exception) -> str:
    return str(error).split(" at ")[0][:120]
