"""The sockets of this process, as the system lists them."""

from __future__ import annotations

import socket

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


def test_a_socket_that_is_found_stays_open() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        before = open_descriptors()
        for _ in sockets_at(listening.getsockname()[1]):
            assert open_descriptors() == before + 1
        assert open_descriptors() == before
        socket.create_connection(listening.getsockname()).close()
