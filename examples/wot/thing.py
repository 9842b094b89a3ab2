"""A Thing that knows nothing of selfconf: a lamp or a switch with an HTTP server, of the standard library alone.

    python examples/wot/thing.py lamp desk --port 8081

It describes itself at `/`. A lamp is switched by a write to its property `on`; a switch by hand, which is a POST to
`/press`, and tells each change to those who observe it.
"""

from __future__ import annotations

import argparse
import json
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any, ClassVar


class Thing(BaseHTTPRequestHandler):
    """Answers for the one Thing of this process."""

    protocol_version = "HTTP/1.1"
    kind, name = "lamp", "desk"
    on = False
    changed: ClassVar = threading.Condition()

    def do_GET(self) -> None:
        if self.path == "/":
            self.answer(200, self.description())
        elif self.path == "/on":
            self.answer(200, self.on)
        elif self.path == "/on/changes" and self.kind == "switch":
            self.tell_changes()
        else:
            self.answer(404)

    def do_PUT(self) -> None:
        said = json.loads(self.rfile.read(int(self.headers.get("Content-Length", 0))) or b"null")
        if self.path == "/on" and self.kind == "lamp" and isinstance(said, bool):
            self.become(said)
            self.answer(204)
        else:
            self.answer(400)

    def do_POST(self) -> None:
        if self.path == "/press" and self.kind == "switch":
            self.become(not self.on)
            self.answer(204)
        else:
            self.answer(404)

    def become(self, on: bool) -> None:
        """Be on or off from now on."""
        if on != Thing.on:
            print(f"{self.kind} {self.name} is {'on' if on else 'off'}", flush=True)
        with self.changed:
            Thing.on = on
            self.changed.notify_all()

    def tell_changes(self) -> None:
        """Send each change as a server-sent event, until the observer is gone."""
        before = self.on
        self.send_response(200)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Connection", "close")
        self.end_headers()
        while True:
            with self.changed:
                if Thing.on == before:
                    self.changed.wait(5.0)
                news, before = Thing.on != before, Thing.on
            try:
                self.wfile.write(f"data: {json.dumps(before)}\n\n".encode() if news else b": still here\n\n")
            except OSError:
                return

    def description(self) -> dict[str, Any]:
        """The Thing Description (W3C, version 1.1)."""
        forms = [{"href": "on", "op": ["readproperty", "writeproperty"] if self.kind == "lamp" else "readproperty"}]
        if self.kind == "switch":
            forms.append({"href": "on/changes", "op": "observeproperty", "subprotocol": "sse"})
        return {
            "@context": [
                "https://www.w3.org/2022/wot/td/v1.1",
                {"rob": "https://w3id.org/selfconf/robotics#", "home": "https://example.org/my-home#"},
            ],
            "id": f"https://example.org/my-home#{self.name}-{self.kind}",
            "@type": "rob:Lamp" if self.kind == "lamp" else "home:WallSwitch",
            "title": f"The {self.kind} {self.name}",
            "base": f"http://{self.headers.get('Host')}/",
            "securityDefinitions": {"none": {"scheme": "nosec"}},
            "security": "none",
            "properties": {
                "on": {"@type": "rob:Switch", "type": "boolean", "readOnly": self.kind == "switch", "forms": forms}
            },
        }

    def answer(self, status: int, value: Any = None) -> None:
        """Answer with a value as JSON, or with nothing."""
        body = b"" if value is None else json.dumps(value).encode()
        self.send_response(status)
        if body:
            self.send_header("Content-Type", "application/json")
        if status != 204:
            self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: Any) -> None:
        """Say nothing about each request."""


def main() -> None:
    """Be a Thing until SIGINT or SIGTERM."""
    parser = argparse.ArgumentParser(description="a Thing")
    parser.add_argument("kind", choices=["lamp", "switch"])
    parser.add_argument("name")
    parser.add_argument("--port", type=int, default=0, help="0 for any free one")
    given = parser.parse_args()
    Thing.kind, Thing.name = given.kind, given.name
    server = ThreadingHTTPServer(("127.0.0.1", given.port), Thing)
    server.daemon_threads = True
    print(f"http://127.0.0.1:{server.server_port}/", flush=True)
    server.serve_forever()


if __name__ == "__main__":
    main()
