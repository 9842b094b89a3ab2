"""An HTTP server whose answers a test decides: paths with functions, and what was sent there."""

from __future__ import annotations

import json
import socket
import ssl
import threading
from collections.abc import Callable
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, NamedTuple

CONTEXT = ["https://www.w3.org/2022/wot/td/v1.1", {"rob": "https://w3id.org/selfconf/robotics#"}]
ROB = "https://w3id.org/selfconf/robotics#"


class Received(NamedTuple):
    """A request that has come."""

    method: str
    path: str
    headers: dict[str, str]
    body: bytes


class ThingServer:
    """A server on a port of its own."""

    def __init__(self, port: int = 0, tls: ssl.SSLContext | None = None) -> None:
        self.received: list[Received] = []
        self.values: dict[str, Any] = {}
        """What is answered as JSON to GET, by path; a PUT or POST changes it."""
        self.answers: dict[str, Callable[[BaseHTTPRequestHandler], None]] = {}
        """What answers to GET in another way, by path."""
        self.posts: dict[str, Callable[[BaseHTTPRequestHandler], None]] = {}
        """What answers to POST in another way, by path."""
        self.released = threading.Event()
        """Set at the end; what an answer that takes its time waits for."""
        self._open: set[socket.socket] = set()
        owner = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def setup(self) -> None:
                super().setup()
                owner._open.add(self.connection)

            def handle(self) -> None:
                with suppress(OSError):
                    super().handle()

            def finish(self) -> None:
                with suppress(OSError, ValueError):
                    super().finish()

            def do_GET(self) -> None:
                owner._note(self, b"")
                path = self.path.partition("?")[0]
                if path in owner.answers:
                    owner.answers[path](self)
                elif path in owner.values:
                    reply(self, json.dumps(owner.values[path]).encode())
                else:
                    reply(self, b"", 404)

            def do_PUT(self) -> None:
                body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
                owner._note(self, body)
                if self.command == "PUT":
                    owner.values[self.path] = json.loads(body)
                if self.command == "POST" and self.path in owner.posts:
                    owner.posts[self.path](self)
                else:
                    reply(self, b"", 204)

            do_POST = do_PUT

            def log_message(self, *_: Any) -> None:
                pass

        class Server(ThreadingHTTPServer):
            daemon_threads = True

            def handle_error(self, *_: Any) -> None:
                pass

        self._server = Server(("127.0.0.1", port), Handler)
        self.port = self._server.server_port
        self.url = f"http://127.0.0.1:{self.port}"
        if tls is not None:
            self._server.socket = tls.wrap_socket(self._server.socket, server_side=True)
            self.url = f"https://127.0.0.1:{self.port}"
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.02,))
        self._thread.start()

    def _note(self, handler: BaseHTTPRequestHandler, body: bytes) -> None:
        self.received.append(Received(handler.command, handler.path, dict(handler.headers), body))

    def say_nothing(self, _: BaseHTTPRequestHandler) -> None:
        """Answer a request never, until the test ends."""
        self.released.wait(60.0)

    def sent(self, method: str) -> list[bytes]:
        """The bodies that came with a method."""
        return [one.body for one in self.received if one.method == method]

    def close(self) -> None:
        """End, with every connection, as a process does that is killed."""
        self.released.set()
        self._server.shutdown()
        self._server.server_close()
        for one in self._open:
            with suppress(OSError):
                one.shutdown(socket.SHUT_RDWR)
            one.close()
        self._thread.join()

    def describe(self, name: str = "lamp", **members: Any) -> dict[str, Any]:
        """A Thing Description: by default of a lamp with a property `on`."""
        return {
            "@context": CONTEXT,
            "id": f"urn:thing:{name}",
            "@type": "rob:Lamp",
            "title": name,
            "base": f"{self.url}/",
            "securityDefinitions": {"none": {"scheme": "nosec"}},
            "security": "none",
            "properties": {"on": {"@type": "rob:Switch", "type": "boolean", "forms": [{"href": "on"}]}},
            **members,
        }


def reply(
    handler: BaseHTTPRequestHandler, body: bytes, status: int = 200, media: str = "application/json", **headers: str
) -> None:
    """Answer a request."""
    handler.send_response(status)
    if status != 204:
        handler.send_header("Content-Type", media)
        handler.send_header("Content-Length", str(len(body)))
    for name, value in headers.items():
        handler.send_header(name.replace("_", "-"), value)
    handler.end_headers()
    handler.wfile.write(body)
