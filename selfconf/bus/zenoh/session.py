"""How a Zenoh session is set up: as a router or as the client of one. Only this room, `bus.zenoh`, speaks Zenoh.

Multicast is off, endpoints are explicit, and nothing listens anywhere but on loopback unless an endpoint says so. A
lease of one second: what is stopped or cut off counts as dead after about that time.

Hubs offer shared memory to the clients of their host, and the sessions of components take it: a large payload is then
copied into it once, and only a reference goes through the sockets (`docs/benchmarks/signals.md`). Where the other end
cannot see that memory, or all of it is in use, or a program may not lock as much memory as it likes, the payload itself
goes through the socket, as it always does for small ones. A hub has room for 350 such clients; others cost it nothing.

Zenoh divides its work among threads as it likes, but for one thing: what it does on the network has three threads in
place of one in programs that begin with a router or have keys: of these, routers may be opened anew, and elsewhere one
thread answers more evenly. The end of the last reference to a router waits for a task there, up to ten seconds, and no
other thread of Python runs; if the only thread was in a callback, as of a link that has come, it waited for Python: the
site stood still until the ten seconds were over. With the work of the application and the network handed over to the
threads that receive (`ZENOH_RUNTIME`), what comes wakes one thread and not two, and a bare cold round trip takes 0.85
times as long. But from FAIL to the first message it took as long as before, and fifty sites longer to recover from a
stall.
"""

from __future__ import annotations

import errno
import json
import os
import random
import re
import resource
import socket
from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import zenoh

from selfconf.bus.credentials import Credentials
from selfconf.bus.presented_certificate import presented
from selfconf.bus.zenoh.descriptors import open_descriptors
from selfconf.errors import NetworkError, ProgrammerError
from selfconf.model.immutable import immutable
from selfconf.model.setting_names import setting
from selfconf.protocol.endpoints import (
    LISTENING_PORTS,
    endpoint_host,
    endpoint_port,
    is_zenoh_endpoint,
    with_other_port,
    with_settings,
)

PANIC = "PanicException"
"""The class of a panic of Zenoh, which no module exports."""
LEASE_MS = 1000
"""After how long without a message a session counts as gone: what is stopped or cut off is noticed after that time."""
ANYWHERE_ON_LOOPBACK = "tcp/127.0.0.1:0"
GREETING = 1.5
"""Seconds that the end which accepts may take to greet, or to answer: beyond that it is no router, or a hung one."""
MOST_ACCEPTED = 2000
"""How many clients may be about to greet at once; one more is turned away. By default it is 100, which a stranger that
opens a hundred connections and stays silent would have all the time."""
SHARED_FROM = 1 << 15
"""From how many bytes on a payload goes through shared memory; smaller ones are as fast through a socket."""
SHARED_MEMORY = Path("/dev/shm")
ENOUGH_SHARED = 256_000_000
"""Bytes that have to be free there: in a container with 64 MB, a page that cannot be had would end the process."""
PROCESS_STATUS = Path("/proc/self/status")
"""What Linux says of this process (proc_pid_status(5))."""
CAP_IPC_LOCK = 14
"""The number of the capability to lock memory without a limit (capabilities(7))."""
_EFFECTIVE = re.compile(r"^CapEff:\s*([0-9a-f]+)$", re.MULTILINE)
FREE_DESCRIPTORS = 32
"""How many files a program must still be free to open: a session takes about twenty, and some for its first links.
With fewer Zenoh does not fail: it may hang, or abort the process."""
THREADS_VARIABLE = "ZENOH_RUNTIME"
"""What says of a process how Zenoh divides its work among threads; read once, by the first session."""
THREADS = "(net: (worker_threads: 3))"
PORT_TAKEN = "the port is in use; port 0 is any free one"
_PORTS_TRIED = 100
_RETRY = {
    # A client is cut off as long as it has no router, and its components rest after a second.
    "client": {"period_init_ms": 50, "period_max_ms": 200, "period_increase_factor": 1.5},
    # A router that is gone may stay away; many that look for each other at once must not take the machine.
    "router": {"period_init_ms": 200, "period_max_ms": 4000, "period_increase_factor": 2.0},
}


@immutable
class Security:
    """How the links of a session are secured: what it shows, and, at a router, who may do what there."""

    credentials: Credentials
    access_control: Mapping[str, Any] | None = None
    """The member `access_control` of a configuration of Zenoh; None: a client that is let in may do everything."""
    at_uplinks: Mapping[str, Any] | None = None
    """The member `access_control` for a session that connects a hub to others; None: as at the hub."""


_openers: set[int] = set()
"""This process, and those that it was forked from, as far as they have opened a session."""


def begin_log(what: str = "off") -> None:
    """Have Zenoh log something, by default nothing: it writes to stdout, among the results. RUST_LOG goes before.

    The first call counts: Zenoh has one log for a process.
    """
    zenoh.init_log_from_env_or(what)


def open_session(
    mode: str,
    listen: Sequence[str] = (),
    connect: Sequence[str] = (),
    connect_seconds: float = 0.0,
    shared_memory: bool = False,
    security: Security | None = None,
    wanted: str = "site",
) -> Any:
    """Open a session. Raises NetworkError for an endpoint that is none or taken, and where no router answers a client.

    It names what is `wanted` at the endpoints of a client. It is raised as well where this program may not open enough
    files, and ProgrammerError in a process that was forked from one that had opened a session: Zenoh's threads are
    missing there, and it would wait for them forever.

    With `connect_seconds` a client tries for that long, otherwise each endpoint once. A router does not wait for those
    that it connects to. With `shared_memory` large payloads go through that to others on this machine that have it too.
    With `security` all links are mutual TLS.
    """
    for endpoint in (*listen, *connect):
        check_endpoint(endpoint, security)
    _check_descriptors()
    _check_process()
    begin_log()
    config = _config(mode, listen, connect, connect_seconds, shared_memory and _has_shared_memory(), security)
    try:
        return _opened(config) if mode == "router" or security is not None else zenoh.open(config)
    except zenoh.ZError as error:
        where = ", ".join(connect if mode == "client" else listen[:1])
        if "Address already in use" in str(error):
            raise NetworkError(f"cannot listen on {where}: {PORT_TAKEN}") from None
        what = f"no {wanted} answers at" if mode == "client" else "cannot listen on"
        raise NetworkError(f"{what} {where}; is the endpoint right? ({_first_sentence(error)})") from None
    except BaseException as error:  # a panic of Zenoh is no Exception
        if type(error).__name__ != PANIC:
            raise
        raise NetworkError(
            f"Zenoh cannot begin ({error}); may this program start threads (`ulimit -u`), and is the clock right?"
        ) from None


def _opened(config: zenoh.Config) -> Any:
    """A session of a program that may let a router go; with the first one of a process its threads begin.

    What this program starts may divide its work otherwise.
    """
    if THREADS_VARIABLE in os.environ:
        return zenoh.open(config)
    os.environ[THREADS_VARIABLE] = THREADS
    try:
        return zenoh.open(config)
    finally:
        os.environ.pop(THREADS_VARIABLE, None)


def with_port(endpoint: str) -> str:
    """The endpoint with a free port in place of port 0; Zenoh would not say which one it has taken."""
    if endpoint_port(endpoint) != 0:
        return endpoint
    host = endpoint_host(endpoint)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    for port in (*random.sample(LISTENING_PORTS, _PORTS_TRIED), 0):
        with socket.socket(family, socket.SOCK_STREAM) as probe:
            try:
                probe.bind((host, port))
            except OSError as error:
                if error.errno != errno.EADDRINUSE:
                    raise NetworkError(f"cannot listen on {endpoint}: {error.strerror or error}") from None
            else:
                return with_other_port(endpoint, probe.getsockname()[1])
    raise NetworkError(f"cannot listen on {endpoint}: no port is free")


def check_free(endpoint: str) -> None:
    """Raise NetworkError if another listens at an endpoint of TCP, without reading what a session would be opened with.

    Zenoh reads the rules of a hub first, which takes a millisecond for each component that they name.
    """
    host, port = endpoint_host(endpoint), endpoint_port(endpoint)
    if not (port and endpoint.partition("/")[0] in ("tcp", "tls") and is_zenoh_endpoint(endpoint)):
        return  # what is no endpoint is refused as the session is opened
    try:
        with socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET, socket.SOCK_STREAM) as probe:
            probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            probe.bind((host, port))
    except OSError as error:
        if error.errno == errno.EADDRINUSE:
            raise NetworkError(f"cannot listen on {endpoint}: {PORT_TAKEN}") from None


def _has_shared_memory() -> bool:
    """Whether this process can share memory: else Zenoh would open no session at all, or lose signals."""
    try:
        there = os.statvfs(SHARED_MEMORY)
    except OSError:
        return False
    has_room = there.f_bavail * there.f_frsize >= ENOUGH_SHARED and os.access(SHARED_MEMORY, os.W_OK | os.X_OK)
    return has_room and _locks_any_memory()


def _locks_any_memory() -> bool:
    """Whether this process may lock as much memory as it likes: by its limit, or as it has CAP_IPC_LOCK.

    Zenoh locks 16 MiB for what a program sends and as much for each other that it hears; a signal in memory that cannot
    be locked is lost.
    """
    if resource.getrlimit(resource.RLIMIT_MEMLOCK)[0] == resource.RLIM_INFINITY:
        return True
    with suppress(OSError):
        may = _EFFECTIVE.search(PROCESS_STATUS.read_text("utf-8", "replace"))
        return may is not None and bool(int(may[1], 16) >> CAP_IPC_LOCK & 1)
    return False


def _config(
    mode: str,
    listen: Sequence[str],
    connect: Sequence[str],
    connect_seconds: float,
    shared_memory: bool,
    security: Security | None,
) -> zenoh.Config:
    config: zenoh.Config = zenoh.Config()  # which Python 3.10 cannot tell from the stubs
    settings: dict[str, Any] = {
        "mode": mode,
        "scouting/multicast/enabled": False,
        "scouting/gossip/enabled": False,
        "scouting/delay": 0,  # there is nothing to be scouted; by default a router opens half a second later
        "listen/endpoints": [_listening(endpoint, security) for endpoint in listen],
        "connect/endpoints": list(connect),
        "connect/retry": _RETRY[mode],
        "connect/exit_on_failure": mode == "client",
        "connect/timeout_ms": int(connect_seconds * 1000) if mode == "client" else -1,
        "transport/link/tx/lease": LEASE_MS,
        # Three messages in a lease: an idle link costs a quarter less than with four, and two may be late.
        "transport/link/tx/keep_alive": 3,
        "transport/unicast/open_timeout": int(GREETING * 1000),
        "transport/unicast/accept_timeout": int(GREETING * 1000),
        "transport/unicast/accept_pending": MOST_ACCEPTED,
        "transport/shared_memory/enabled": shared_memory,
        "transport/shared_memory/transport_optimization/message_size_threshold": SHARED_FROM,
        "timestamping/enabled": {"router": True, "peer": True, "client": True},
        **({} if security is None else _secured(security)),
    }
    for key, value in settings.items():
        try:
            config.insert_json5(key, json.dumps(value))
        except zenoh.ZError:
            raise _no_endpoint(", ".join(value)) from None
    return config


def _listening(endpoint: str, security: Security | None) -> str:
    """An endpoint to listen at, where a handshake of TLS may take as long as that of Zenoh after it."""
    return endpoint if security is None else with_settings(endpoint, f"tls_handshake_timeout_ms={int(GREETING * 1000)}")


def _secured(security: Security) -> dict[str, Any]:
    """The settings of mutual TLS, and of access control where there is any.

    Zenoh takes an expired certificate off its links only if it is set to.
    """
    own = security.credentials
    settings: dict[str, Any] = {
        "transport/link/protocols": ["tls"],
        "transport/link/tls": {
            "root_ca_certificate": _path_setting(own.authorities),
            "enable_mtls": True,
            "listen_certificate": _path_setting(own.certificate),
            "listen_private_key": _path_setting(own.key),
            "connect_certificate": _path_setting(presented(own.certificate)),
            "connect_private_key": _path_setting(own.key),
            "close_link_on_expiration": True,
        },
    }
    if security.access_control is not None:
        settings["access_control"] = security.access_control
    return settings


def _path_setting(file: Path) -> str:
    """The path of a file of keys as a setting. Raises NetworkError for one that Zenoh would take apart."""
    path = str(file)
    if re.search("[?;\ud800-\udfff]", path):
        raise NetworkError(
            f"Zenoh cannot read {path}: it takes a path apart at ? and ;, and knows none that is not UTF-8;"
            " give the folder of keys another name"
        )
    return path


def check_endpoint(endpoint: str, security: Security | None = None) -> None:
    """Raise NetworkError for what is no endpoint, or is not of what is spoken: TLS with keys, TCP without."""
    if not is_zenoh_endpoint(endpoint):
        raise _no_endpoint(endpoint)
    protocol = endpoint.partition("/")[0]
    if security is None and protocol == "tls":
        raise NetworkError(f"{endpoint} is reached with keys only; give {setting('keys', 'DIR')}, or set SELFCONF_KEYS")
    if security is not None and protocol == "tcp":
        raise NetworkError(f"{endpoint} is without keys, and keys are given; write tls/{endpoint.partition('/')[2]}")


def _check_process() -> None:
    _openers.add(os.getpid())
    if len(_openers) > 1:
        raise ProgrammerError(
            "this process was forked from one that was in an ecology, and cannot join any; spawn it instead, as"
            ' `multiprocessing.get_context("spawn")` does'
        )


def _check_descriptors() -> None:
    most, opened = resource.getrlimit(resource.RLIMIT_NOFILE)[0], open_descriptors()
    if most != resource.RLIM_INFINITY and most - opened < FREE_DESCRIPTORS:
        raise NetworkError(
            f"Zenoh cannot begin: this program may open {most} files, has opened {opened}, and needs "
            f"{FREE_DESCRIPTORS} more; allow more with `ulimit -n`"
        )


def _no_endpoint(said: str) -> NetworkError:
    return NetworkError(f"{said} is no endpoint; write it like tcp/127.0.0.1:7447")


def _first_sentence(error: Exception) -> str:
    return str(error).split(" at ")[0][:120]
