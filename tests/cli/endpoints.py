"""SPARQL endpoints on this machine: a real Oxigraph server, and one that answers whatever a test tells it to."""

from __future__ import annotations

import socket
import subprocess
import sys
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from urllib.error import URLError
from urllib.request import Request, urlopen

PATIENCE = 20.0


@contextmanager
def oxigraph(default: str, named: Mapping[str, str]) -> Iterator[str]:
    """The query URL of an Oxigraph server that holds Turtle in its default graph and in named ones."""
    program = Path(sys.executable).with_name("oxigraph")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{probe.getsockname()[1]}"
    server = subprocess.Popen(
        [program, "serve", "--bind", address], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )
    try:
        posted = False
        deadline = time.monotonic() + PATIENCE
        while not posted and time.monotonic() < deadline:
            try:
                _post(address, "default", default)
                posted = True
            except URLError:
                assert server.poll() is None, "the server has ended"
        for name, text in named.items():
            _post(address, f"graph={name}", text)
        yield f"http://{address}/query"
    finally:
        server.terminate()
        server.wait(PATIENCE)


def _post(address: str, graph: str, text: str) -> None:
    request = Request(f"http://{address}/store?{graph}", text.encode(), {"Content-Type": "text/turtle"})
    urlopen(request, timeout=PATIENCE).close()


class Scripted:
    """A server that answers every request with the same bytes, and keeps what it was asked."""

    def __init__(self, answer: bytes, *, hold: bool = False) -> None:
        self.requests: list[bytes] = []
        self._answer, self._hold = answer, hold
        self._over = threading.Event()
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self._listening.getsockname()[1]}/query"
        self._thread = threading.Thread(target=self._serve)

    def __enter__(self) -> Scripted:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._over.set()
        self._listening.shutdown(socket.SHUT_RDWR)
        self._thread.join(PATIENCE)
        self._listening.close()

    def _serve(self) -> None:
        while not self._over.is_set():
            try:
                connection, _ = self._listening.accept()
            except OSError:
                return
            with connection:
                self.requests.append(self._whole(connection))
                connection.sendall(self._answer)
                if self._hold:
                    self._over.wait(PATIENCE)

    @staticmethod
    def _whole(connection: socket.socket) -> bytes:
        """A request with its body, so that closing the connection afterwards does not reset it."""
        connection.settimeout(PATIENCE)
        with connection.makefile("rb") as stream:
            head = b"".join(iter(stream.readline, b"\r\n"))
            length = next(line for line in head.splitlines() if line.lower().startswith(b"content-length:"))
            return head + b"\r\n" + stream.read(int(length.split(b":")[1]))


def http(
    body: bytes | str, kind: str = "application/sparql-results+json", status: str = "200 OK", more: str = ""
) -> bytes:
    """An HTTP answer with a body and its length."""
    octets = body.encode() if isinstance(body, str) else body
    head = f"HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {len(octets)}\r\n{more}\r\n"
    return head.encode() + octets
