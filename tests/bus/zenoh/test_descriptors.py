"""The sockets of this process, as the system lists them."""

from __future__ import annotations

import os
import socket
from contextlib import ExitStack
from pathlib import Path

from selfconf.bus.zenoh.descriptors import open_descriptors, sockets_at


def test_the_sockets_of_either_end_of_a_port_are_found() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        port = listening.getsockname()[1]
        with socket.create_connection(("127.0.0.1", port)) as near, listening.accept()[0] as far:
            here = {found.getsockname() for found in sockets_at(port, from_here=True)}
            there = [found.getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN) for found in sockets_at(port)]
            assert here == {near.getsockname()} == {far.getpeername()}
            assert sorted(there) == [0, 1], "the one that listens, and the one that was accepted"
        assert list(sockets_at(port, from_here=True)) == []


def test_a_socket_of_datagrams_is_none_of_them() -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listening:
        listening.bind(("127.0.0.1", 0))
        assert list(sockets_at(listening.getsockname()[1])) == []


def test_a_socket_that_is_found_stays_open() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        found = []
        for one in sockets_at(listening.getsockname()[1]):
            assert one.fileno() not in (-1, listening.fileno()), "a descriptor of its own"
            found.append(one)
        assert [one.fileno() for one in found] == [-1], "which is closed afterwards"
        socket.create_connection(listening.getsockname()).close()


def test_the_descriptors_that_are_open_are_counted() -> None:
    before = open_descriptors()
    with ExitStack() as opened:
        for _ in range(100):
            opened.enter_context(Path(os.devnull).open())
        assert open_descriptors() > before + 50, "other threads may open and close some"
