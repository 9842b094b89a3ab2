"""The router of a site, in two sessions: a *hub* that listens, and an *uplink* that connects the hub to other hubs.

Nothing is declared on either; whatever a site has to say it says as a client of its own hub. So the uplink can be
replaced by a new session at any time, and no other session notices.

It has to be, for routers of Zenoh 1.10 do not survive being cut off for a moment. A router computes its trees 100 ms
after a change, and then sends what is declared to the *new* children in each. A router whose link is lost, and
made again within that time, was a child before and is one after: it receives nothing, while it has itself forgotten
everything at the loss; and the side that connects does so again at once. A host that was stopped for longer than the
lease was not seen again by some of the others, for good. So an uplink that has lost a hub and has it back is followed
by a new one, which no router knows yet. The old one stays for a while, and none comes just after one has left: a router
that computes its trees after both takes the one that came for the one that left, and it receives nothing either. Hubs
do not connect to each other, so each tree consists of hubs and uplinks in turn: every edge has an end that is replaced.
"""

from __future__ import annotations

import logging
import math
import random
import socket
import threading
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

import zenoh

from selfconf.bus.loop import Loop
from selfconf.bus.zenoh.descriptors import sockets_at
from selfconf.bus.zenoh.door import Door
from selfconf.bus.zenoh.receivers import callback
from selfconf.bus.zenoh.session import Security, check_free, open_session, with_port
from selfconf.errors import NetworkError
from selfconf.model.immutable import replace
from selfconf.protocol.endpoints import endpoint_port

log = logging.getLogger(__name__)

REOPENING = 2.0
"""Seconds for which a hub that is opened anew tries to have its port again."""
PORT_PAUSE = 0.02
"""Seconds between two such tries."""
QUIET = 0.3
"""Seconds without any change of its links after which an uplink is replaced: trees are computed in between."""
RETRY_SPREAD = 0.5
"""By how many seconds at most a replacement is delayed, by chance: others may have lost their links with this one."""
CLOSING = 3.0
"""Seconds for which the end of a session is waited for."""
LINGER = 3.0
"""Seconds for which an uplink that was replaced stays, up to twice that by chance; one that has the rules, or the
certificate, of before leaves as soon as the new one is known."""
NOTED = 0.05
"""Seconds that the other end of a new link may take to note it."""
AFTER_END = 0.2
"""Seconds after the end of an uplink for which none is opened: routers compute their trees in between."""
MOST_LINGERING = 3
"""How many replaced uplinks stay at most: as long as there are so many no new one is opened."""


class Hub:
    """The session of a router that listens on an endpoint; with keys also on one that its own host alone knows.

    To that no stranger of the network gets, so whatever goes on at the other, programs of this host join (`door`).
    """

    def __init__(self, listen: str, security: Security | None = None) -> None:
        """Port 0 means any free one. Raises NetworkError if the endpoint is taken, or none."""
        self.security = security
        attempts = 5 if endpoint_port(listen) == 0 or security is not None else 1
        for attempt in range(1, attempts + 1):
            self.endpoint = with_port(listen)
            self.from_here = self._reached_from_here()
            try:
                self._session = self._open()
                break
            except NetworkError:
                if attempt == attempts:
                    raise
        self._door = None if security is None else Door(self.endpoint, lambda: self._session.info.links())

    def _reached_from_here(self) -> str:
        """The endpoint by which programs of this host reach it: with keys one of their own."""
        if self.security is not None:
            return with_port("tls/127.0.0.1:0")
        return self.endpoint.replace("/0.0.0.0:", "/127.0.0.1:").replace("/[::]:", "/[::1]:")

    @property
    def _listens_at(self) -> list[str]:
        return [self.endpoint] if self.security is None else [self.endpoint, self.from_here]

    def _open(self) -> Any:
        """Open the session, and end the connections that were made meanwhile: they are made anew at once.

        What connects while a router of Zenoh 1.10 still begins, as clients do that have lost the hub before, may stay
        connected and hear nothing of it, for good.
        """
        for endpoint in self._listens_at:
            check_free(endpoint)
        session = open_session("router", listen=self._listens_at, shared_memory=True, security=self.security)
        for endpoint in self._listens_at:
            cut_connections(endpoint, listens_on=True)
        return session

    def secure(self, security: Security) -> None:
        """Have other rules, or another certificate: Zenoh reads them only as a session is opened, so it is opened anew.

        Those that are connected lose this hub for a moment. Raises NetworkError if its files cannot be read, and then
        nothing is changed; or if its port is taken meanwhile.
        """
        security.credentials.check()
        self.security = security
        _close(self._session)
        deadline = time.monotonic() + REOPENING
        while True:
            try:
                self._session = self._open()
                break
            except NetworkError:
                if time.monotonic() > deadline:
                    raise
                time.sleep(PORT_PAUSE)  # nothing says when the system gives the port back
        if self._door is not None:
            self._door.opened()

    def close(self) -> None:
        """Leave the network, and have no session stay connected, the client of the same process included.

        A router that has broken inside lets go of no connection when it is closed.
        """
        if self._door is not None:
            self._door.close()
        _close(self._session)
        for endpoint in self._listens_at:
            cut_connections(endpoint)


class Relay:
    """A hub that listens on an endpoint, and its uplink to other hubs; it lives on the thread of a loop."""

    def __init__(self, hub: Hub, loop: Loop, connect: Sequence[str]) -> None:
        self._loop, self._hub = loop, hub
        self._others: list[str] = []
        self._uplink: _Uplink | None = None
        self._lingering: list[_Uplink] = []
        self._left_at = -math.inf
        """When an uplink was let go last, by the loop's clock."""
        self._undo_replacement: Callable[[], None] = lambda: None
        self.connect(connect)

    def connect(self, others: Sequence[str]) -> None:
        """Be connected to these hubs and to those from before, by a new uplink."""
        self._others = [e for e in dict.fromkeys([*self._others, *others]) if e != self._hub.endpoint]
        if self._others:
            self._replace()

    @property
    def reached(self) -> frozenset[str]:
        """The endpoints, with an address for their host, at the other ends of the uplink. On any thread."""
        uplink = self._uplink
        return frozenset() if uplink is None else uplink.reached

    def secure(self, security: Security) -> None:
        """Have other rules, or another certificate, at the hub and at the uplink. Raises NetworkError."""
        self._hub.secure(security)
        if self._uplink is not None:
            self._replace()

    def close(self) -> None:
        """Leave the network."""
        self._undo_replacement()
        uplink, self._uplink = self._uplink, None
        for one in (*self._lingering, uplink):
            if one is not None:
                one.close()
        self._lingering.clear()
        self._hub.close()

    def link_changed(self, uplink: _Uplink, other: str, up: bool) -> None:
        """An uplink has gained or lost a link; once there is quiet, replace what others may have lost sight of."""
        uplink.note(other, up)
        if uplink is self._uplink and uplink.regained:
            self._replace_after(QUIET + random.uniform(0.0, RETRY_SPREAD))
        for outdated in self._outdated:
            self._let_go_after(NOTED, outdated)

    def _replace_after(self, seconds: float) -> None:
        """Replace the uplink after a while; where no new one can be opened, the old one stays until it can."""

        def replace_it() -> None:
            try:
                self._replace()
            except NetworkError as error:
                log.warning("no new link to other hubs can be opened yet: %s", error)
                self._replace_after(QUIET + random.uniform(0.0, RETRY_SPREAD))

        self._undo_replacement()
        self._undo_replacement = self._loop.later(seconds, replace_it)

    def _replace(self) -> None:
        """Replace the uplink: at once, unless another one has just left or has to leave before."""
        if len(self._lingering) >= MOST_LINGERING:
            self._let_go(self._lingering[0])
        now = self._loop.now()
        if len(self._lingering) >= MOST_LINGERING or now < self._left_at + AFTER_END:
            self._replace_after(AFTER_END)
            return
        old, self._uplink = self._uplink, _Uplink(self, self._hub.security, now)
        self._undo_replacement()
        if old is not None:
            self._lingering.append(old)
            self._let_go_after(LINGER * random.uniform(1.0, 2.0), old)
        for outdated in self._outdated:
            self._let_go_after(QUIET, outdated)

    @property
    def _outdated(self) -> list[_Uplink]:
        """The replaced uplinks that have the rules, or the certificate, of before."""
        return [old for old in self._lingering if old.security is not self._hub.security]

    def _let_go_after(self, seconds: float, old: _Uplink) -> None:
        self._loop.later(seconds, partial(self._let_go, old))

    def _let_go(self, old: _Uplink) -> None:
        """Close an uplink that was replaced, once the new one is known; elsewhere, as Zenoh may take its time."""
        if old not in self._lingering or self._uplink is None:
            return
        now = self._loop.now()
        known = self._uplink.opened_at + QUIET
        if now < known and not old.hubs <= self._uplink.hubs:
            self._let_go_after(known - now, old)
            return
        self._left_at = now
        self._lingering.remove(old)
        threading.Thread(target=old.close, daemon=True).start()

    def open_uplink(self) -> list[Any]:
        """The sessions that connect the hub to the others: one, or with keys one for each of them.

        A session that connects two others with each other is a way between them as short as their own, and Zenoh may
        choose it. With keys nothing would get through there: no site speaks for another.
        """
        security = self._hub.security
        if security is not None and security.at_uplinks is not None:
            security = replace(security, access_control=security.at_uplinks)
        reached = [self._others] if security is None else [[other] for other in self._others]
        here = self._hub.from_here
        opened: list[Any] = []
        try:
            for others in reached:
                opened.append(open_session("router", connect=[here, *others], security=security))
        except NetworkError:
            for session in opened:
                threading.Thread(target=_close, args=(session,), daemon=True).start()
            raise
        return opened

    def tell(self, uplink: _Uplink, other: str, up: bool) -> None:
        """Have the change of a link noted on the loop's thread."""
        self._loop.wake_up(lambda: self.link_changed(uplink, other, up))


class _Uplink:
    """The sessions of a relay's uplink at a time, and which links they have lost and regained."""

    def __init__(self, relay: Relay, security: Security | None, now: float) -> None:
        self._relay, self._lost = relay, set[str]()
        self.security, self.opened_at = security, now
        self.hubs = set[str]()
        """The hubs that it has a link to."""
        self.regained = False
        """Whether it has lost a hub and has it again: what is declared does not get through to it any more."""
        self._sessions = relay.open_uplink()
        self._listeners = [
            session.info.declare_transport_events_listener(callback(self._changed), history=True)
            for session in self._sessions
        ]

    def _changed(self, event: zenoh.TransportEvent) -> None:
        """Called by Zenoh, on a thread of its own."""
        self._relay.tell(self, str(event.transport.zid), event.kind == zenoh.SampleKind.PUT)

    def note(self, other: str, up: bool) -> None:
        """Remember that a link was lost, or that one has come, perhaps back."""
        if not up:
            self._lost.add(other)
            self.hubs.discard(other)
            return
        self.hubs.add(other)
        self.regained |= other in self._lost

    @property
    def reached(self) -> frozenset[str]:
        """The endpoints at the other ends of its links; none where it is just replaced."""
        with suppress(zenoh.ZError):
            return frozenset(str(link.dst) for session in self._sessions for link in session.info.links())
        return frozenset()

    def close(self) -> None:
        """Leave the network."""
        for session in self._sessions:
            _close(session)


def cut_connections(endpoint: str, *, from_here: bool = False, listens_on: bool = False) -> None:
    """End what is left of the connections that others have made to an endpoint of this process.

    `from_here`: those that this process has made to an endpoint of another one; `listens_on`: it can be connected to
    as before. Nothing is done where it has no port.
    """
    port = endpoint_port(endpoint)
    for connection in () if port is None else sockets_at(port, from_here=from_here):
        with suppress(OSError):  # it is not connected any more
            if not (listens_on and connection.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN)):
                connection.shutdown(socket.SHUT_RDWR)


def _close(session: Any) -> None:
    """Close a session elsewhere, and wait for that for a while: one that has broken inside may never be closed."""

    def close() -> None:
        # It takes too long, or Zenoh panics, which is no Exception; the process, or the lease, will end it.
        with suppress(BaseException):
            session.close()

    closing = threading.Thread(target=close, daemon=True, name="closing")
    closing.start()
    closing.join(CLOSING)
