"""The door of a hub with keys: it is nearly shut while too many strangers wait there.

After a TLS handshake that fails, Zenoh 1.10 waits for 100 ms before it looks at the next one (zenoh#2685), and it takes
connections much faster than that. So a stranger without a certificate who connects ten times a second keeps all others
out; a thousand failed connections keep them out for a hundred seconds after the last one, and each has a descriptor of
this process, which soon could not open a file any more.

Two things follow. A hub has a second endpoint, for its own host alone, where nothing of that is noticed
(`Hub.from_here`). And at the first one, as few as possible may wait: as long as there are more than `MOST_AT_DOOR`, the
system takes one connection in place of the hundreds that may else be about to be accepted, and drops the others, whose
ends try again. Programs of other hosts have to be lucky then; once the stranger has ceased, they get in within seconds.
"""

from __future__ import annotations

import logging
import math
import socket
import threading
import time
from collections.abc import Callable, Collection
from contextlib import suppress
from typing import Any

import zenoh

from selfconf.bus.zenoh.descriptors import open_descriptors, sockets_at
from selfconf.protocol.endpoints import endpoint_port

log = logging.getLogger(__name__)

MOST_AT_DOOR = 30
"""How many connections may wait for longer than a look: the last of them would wait for three seconds."""
BETWEEN_LOOKS = 0.1
"""Seconds between two looks."""
LOOKS_SHARE = 0.02
"""Which part of a processor may be spent on looks: where thousands are connected, there are fewer."""
BACKLOG = 50
"""How many connections the system takes before they are accepted; Zenoh would have it take 1024, and accepts all that
there are before it waits."""
SAID_AGAIN = 600.0
"""After how many seconds it is said again that too many wait."""


class Door:
    """Watches who waits at an endpoint of this process, on a thread of its own, until it is closed."""

    def __init__(self, endpoint: str, links: Callable[[], Collection[Any]]) -> None:
        """`links` are those of the session that listens; it may raise ZError while that is opened anew."""
        self._endpoint, self._links = endpoint, links
        self._port = endpoint_port(endpoint)
        self._said_at = -math.inf
        self._closed = threading.Event()
        self._judging = threading.Lock()
        self.opened()
        if self._port is not None and open_descriptors():
            threading.Thread(target=self._watch, daemon=True, name="door").start()

    def opened(self) -> None:
        """Begin to judge anew: the socket that listens at the endpoint is a new one. On any thread."""
        with self._judging:
            self._waiting = frozenset[str]()
            """The other ends of the connections that waited at the last look."""
            self._shut = False
            self._least = math.inf
            """How many descriptors that are no links there have been at least since it was last looked who waits."""
            self._take(BACKLOG)

    def close(self) -> None:
        """Look no more."""
        self._closed.set()

    def _take(self, connections: int) -> None:
        """Have the system take so many connections, and one more, before they are accepted."""
        for found in sockets_at(self._port or 0):
            if found.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN):
                found.listen(connections)

    def _watch(self) -> None:
        pause = BETWEEN_LOOKS
        while not self._closed.wait(pause):
            began = time.thread_time()  # a look that has to wait costs nothing
            with suppress(zenoh.ZError, OSError), self._judging:
                self.look()
            pause = max(BETWEEN_LOOKS, (time.thread_time() - began) / LOOKS_SHARE)

    def look(self) -> None:
        """Shut the door, or open it, as many or few wait; cheap as long as few descriptors have come."""
        links = self._links()
        others = open_descriptors() - len(links)
        self._least = min(self._least, others)
        if self._shut or self._waiting or others > self._least + MOST_AT_DOOR:
            admitted = {str(link.dst).rpartition("/")[2] for link in links}
            self._judge(frozenset(map(_other_end, sockets_at(self._port or 0))) - admitted - {""})
            self._least = others

    def _judge(self, waiting: frozenset[str]) -> None:
        shut = len(waiting & self._waiting) > MOST_AT_DOOR
        self._waiting = waiting if shut or len(waiting) > MOST_AT_DOOR else frozenset()
        if shut != self._shut:
            self._shut = shut
            self._take(0 if shut else BACKLOG)
            if shut and time.monotonic() - self._said_at > SAID_AGAIN:
                self._said_at = time.monotonic()
                log.error(
                    "more than %d connections without a trusted certificate wait at %s: until they are refused, others"
                    " that connect there may have to try for long; programs of this host are not concerned",
                    MOST_AT_DOOR,
                    self._endpoint,
                )


def _other_end(found: socket.socket) -> str:
    """The address of the other end as Zenoh writes it; empty for a socket that listens, or is not connected."""
    try:
        host, port, *_ = found.getpeername()
    except OSError:
        return ""
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"
