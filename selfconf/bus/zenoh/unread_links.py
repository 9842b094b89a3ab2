"""Links of which a session reads nothing: it has one to its hub, and is deaf all the same.

When a hub goes on that was suspended for some seconds, a client of Zenoh 1.10 that connects to it at that moment may
read nothing of the connection, for good (once in about sixty connections), though what it says is heard: to all others
it lives, and answers nothing, and it sees no life end. The first bytes that wait in its socket stay the same then,
however long they wait. Such a connection is ended, and Zenoh makes another one.
"""

from __future__ import annotations

import logging
import socket
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

from selfconf.bus.loop import Loop
from selfconf.bus.port import Undo
from selfconf.bus.zenoh.descriptors import sockets_at
from selfconf.protocol.endpoints import endpoint_port

log = logging.getLogger(__name__)

UNREAD_CHECK = 0.4
"""After how many seconds a new link is looked at, and then again; a hub sends something every third of a second."""
UNREAD_CHECKS = 4
"""How many looks in a row have to find the same bytes first."""
FIRST_BYTES = 64
"""How many of the bytes that wait are compared: of a session that reads, others come first at the next look."""
_PEEK = socket.MSG_PEEK | socket.MSG_DONTWAIT


class UnreadLinks:
    """Looks at the links of one session each time that it has a new one, until they are seen to be read."""

    def __init__(self, loop: Loop, links: Callable[[], Sequence[Any]]) -> None:
        """`links` are those that the session has now, as `zenoh.Link` says them."""
        self._loop, self._links = loop, links
        self._undo_look: Undo = lambda: None

    def watch(self) -> None:
        """Watch the links, as one has come; on any thread."""
        self._look_again(None, 1)

    def _look_again(self, before: dict[str, bytes] | None, look: int) -> None:
        self._undo_look()
        self._undo_look = self._loop.later(UNREAD_CHECK, partial(self._look, before, look))

    def _look(self, before: dict[str, bytes] | None, look: int) -> None:
        """See which links are unread; `before` is what has waited first in each at the last look, None at first."""
        unread = {}
        for link in self._links():
            end = str(link.src)
            waits = _first_bytes(end)
            if waits and (before is None or (end in before and waits.startswith(before[end]))):
                unread[end] = waits
        if unread and look < UNREAD_CHECKS:
            self._look_again(unread, look + 1)
            return
        for end in unread:
            log.warning("nothing is read of what the hub sends; connecting to it anew")
            for connection in sockets_at(endpoint_port(end) or 0):
                with suppress(OSError):  # it is not connected any more
                    connection.shutdown(socket.SHUT_RDWR)


def _first_bytes(end: str) -> bytes:
    """What waits to be read first at one's own end of a connection, such as `tcp/127.0.0.1:40000`; empty if nothing."""
    for connection in sockets_at(endpoint_port(end) or 0):
        with suppress(OSError):  # nothing waits, or it is not connected any more
            return connection.recv(FIRST_BYTES, _PEEK)
    return b""
