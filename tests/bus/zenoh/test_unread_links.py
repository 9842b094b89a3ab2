"""A link of which nothing is read is ended; one that is read stays, however much comes."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from types import SimpleNamespace

import pytest

from selfconf.bus.loop import Loop
from selfconf.bus.zenoh.unread_links import UNREAD_CHECK, UNREAD_CHECKS, UnreadLinks


class Link:
    """A connection to a hub that sends what it is told to, and a session that reads it or does not."""

    def __init__(self, hub: socket.socket, session: socket.socket, monkeypatch: pytest.MonkeyPatch) -> None:
        self.hub, self.session = hub, session
        self._timers: list[tuple[float, object]] = []
        loop = Loop()
        monkeypatch.setattr(loop, "later", self._later)
        host, port = session.getsockname()
        self._unread_links = UnreadLinks(loop, lambda: [SimpleNamespace(src=f"tcp/{host}:{port}")])
        self._unread_links.watch()

    def _later(self, seconds: float, action: object) -> object:
        self._timers.append((seconds, action))
        return lambda: None

    def look(self) -> None:
        """Let the time of a look come."""
        ((seconds, action),) = self._timers
        assert seconds == UNREAD_CHECK
        self._timers.clear()
        assert callable(action)
        action()

    @property
    def is_looked_at(self) -> bool:
        """Whether another look follows."""
        return bool(self._timers)

    @property
    def is_there(self) -> bool:
        """Whether the connection is there: an end of file is none of what was sent."""
        self.session.setblocking(False)
        try:
            return bool(self.session.recv(1 << 16))
        except BlockingIOError:
            return True


@pytest.fixture
def link(monkeypatch: pytest.MonkeyPatch) -> Iterator[Link]:
    """A new link."""
    with (
        socket.create_server(("127.0.0.1", 0)) as listening,
        socket.create_connection(listening.getsockname()) as session,
        listening.accept()[0] as hub,
    ):
        yield Link(hub, session, monkeypatch)


def test_a_link_of_which_nothing_is_read_is_ended(link: Link) -> None:
    link.hub.sendall(b"first")
    for _ in range(UNREAD_CHECKS):
        assert link.is_looked_at
        link.look()
        link.hub.sendall(b"more")
    link.hub.settimeout(1.0)
    assert link.hub.recv(1) == b"", "the hub sees its end"
    assert not link.is_looked_at


def test_a_link_at_which_nothing_waits_is_looked_at_once(link: Link) -> None:
    link.look()
    assert not link.is_looked_at
    assert link.is_there


def test_a_link_that_is_read_stays_though_something_waits_at_each_look(link: Link) -> None:
    link.hub.sendall(b"0 is said")
    link.look()
    assert link.is_looked_at
    link.session.recv(100)
    link.hub.sendall(b"1 is said, and it is more than before")
    link.look()
    assert not link.is_looked_at
    assert link.is_there
