"""The sockets of this process, those of Zenoh included, as Linux lists them; elsewhere none are found."""

from __future__ import annotations

import os
import socket
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

_LISTED = Path("/proc/self/fd")


def open_descriptors() -> int:
    """How many descriptors this process has open; 0 where that is not known."""
    if not _LISTED.is_dir():
        return 0
    with os.scandir(_LISTED) as listed:
        return sum(1 for _ in listed)


def sockets_at(port: int, *, from_here: bool = False) -> Iterator[socket.socket]:
    """Each socket of TCP whose own end has a port, with the one that listens; it is closed after use, the original not.

    `from_here`: those that are connected to that port of the other end.
    """
    for path in list(_LISTED.iterdir()) if _LISTED.is_dir() else ():
        with suppress(OSError):  # it was closed meanwhile, or is not connected any more
            if not path.is_socket():
                continue
            with socket.fromfd(int(path.name), socket.AF_INET, socket.SOCK_STREAM) as found:
                address = found.getpeername() if from_here else found.getsockname()
                is_stream = found.getsockopt(socket.SOL_SOCKET, socket.SO_TYPE) == socket.SOCK_STREAM
                if is_stream and isinstance(address, tuple) and address[1] == port:  # a path, of another family
                    yield found
