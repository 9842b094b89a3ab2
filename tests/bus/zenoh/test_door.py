"""The door of a hub: shut while many strangers wait, and open again once few do."""

from __future__ import annotations

import logging
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack
from types import SimpleNamespace

import pytest

from selfconf.bus.zenoh.door import BACKLOG, MOST_AT_DOOR, Door

MANY = MOST_AT_DOOR + 5


class Entrance:
    """A socket that listens as that of a hub does, and connections that were accepted there."""

    def __init__(self, stack: ExitStack) -> None:
        self._stack = stack
        self._listening = stack.enter_context(socket.create_server(("127.0.0.1", 0), backlog=100))
        self.address = self._listening.getsockname()
        self.links: list[SimpleNamespace] = []
        self.door = Door(f"tls/127.0.0.1:{self.address[1]}", lambda: self.links)
        self.door.close()  # the tests look themselves
        self.door.look()

    def knocked(self, number: int) -> list[socket.socket]:
        """Connections that were accepted, as this end has them."""
        accepted = []
        for _ in range(number):
            self._stack.enter_context(socket.create_connection(self.address))
            accepted.append(self._stack.enter_context(self._listening.accept()[0]))
        return accepted

    def takes(self, number: int) -> bool:
        """Whether the system takes so many connections while none is accepted."""
        with ExitStack() as stack:
            try:
                for _ in range(number):
                    stack.enter_context(socket.create_connection(self.address, timeout=0.2))
            except TimeoutError:
                return False
            finally:
                self._listening.setblocking(False)
                while self._has_accepted():
                    pass
                self._listening.setblocking(True)
            return True

    def _has_accepted(self) -> bool:
        try:
            self._listening.accept()[0].close()
        except BlockingIOError:
            return False
        return True


@pytest.fixture
def entrance() -> Iterator[Entrance]:
    """One to which nothing is connected."""
    with ExitStack() as stack:
        yield Entrance(stack)


def test_a_look_that_has_to_wait_puts_off_no_other() -> None:
    """Else a stranger would be through before the next one: it is when many come that a look takes long."""
    looks = threading.Semaphore(0)

    def links() -> list[SimpleNamespace]:
        looks.release()
        time.sleep(0.2)  # what the session does before it answers
        return []

    door = Door("tls/127.0.0.1:1", links)
    try:
        assert all(looks.acquire(timeout=5.0) for _ in range(3))
    finally:
        door.close()


def test_it_is_shut_while_many_wait_for_longer_than_a_look(
    entrance: Entrance, caplog: pytest.LogCaptureFixture
) -> None:
    waiting = entrance.knocked(MANY)
    entrance.door.look()
    assert entrance.takes(10), "a moment ago they may have been about to be admitted"
    with caplog.at_level(logging.ERROR):
        entrance.door.look()
        assert not entrance.takes(10)
        assert f"more than {MOST_AT_DOOR} connections" in caplog.text
        for gone in waiting[:10]:
            gone.close()
        entrance.door.look()
        assert entrance.takes(10)
        entrance.knocked(MANY)
        caplog.clear()
        for _ in range(2):
            entrance.door.look()
        assert not entrance.takes(10)
        assert not caplog.text, "it was said a moment ago"


def test_a_socket_that_listens_anew_is_not_shut(entrance: Entrance) -> None:
    entrance.knocked(MANY)
    for _ in range(2):
        entrance.door.look()
    assert not entrance.takes(10)
    entrance.door.opened()
    assert entrance.takes(10)


def test_the_system_takes_no_crowd_at_once(entrance: Entrance) -> None:
    assert entrance.takes(BACKLOG)
    assert not entrance.takes(BACKLOG + 10)


def test_those_that_are_admitted_do_not_wait(entrance: Entrance) -> None:
    for admitted in entrance.knocked(MANY):
        host, port = admitted.getpeername()
        entrance.links.append(SimpleNamespace(dst=f"tls/{host}:{port}"))
    for _ in range(3):
        entrance.door.look()
    assert entrance.takes(10)


def test_connections_that_come_and_go_do_not_shut_it(entrance: Entrance) -> None:
    for _ in range(3):
        waiting = entrance.knocked(MANY)
        entrance.door.look()
        for gone in waiting:
            gone.close()
    assert entrance.takes(10)


def test_what_else_this_process_opens_does_not_shut_it(entrance: Entrance) -> None:
    with ExitStack() as stack:
        for _ in range(MANY):
            near, far = socket.socketpair()
            stack.enter_context(near)
            stack.enter_context(far)
        for _ in range(3):
            entrance.door.look()
        assert entrance.takes(10)
