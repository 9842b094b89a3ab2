"""The room that Astrid is in, as physics has it, and the lamp that stands there: a Thing of the W3C's Web of Things.

    python examples/astrid/room.py --port 8081

It knows nothing of selfconf. The lamp describes itself at `/`, and shines when its action `shine` is called. The rest
is no part of the Thing, but what lenses and wheels are subject to: `/picture` is what the camera on the ceiling would
see, dark while the lamp does not shine; `/wheels` is how far the wheels have turned; what is posted to `/velocity` is
what the motors do, for half a second at most.
"""

from __future__ import annotations

import argparse
import json
import math
import threading
import time
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

WIDTH, HEIGHT, METRES = 96, 36, 1 / 30
"""The picture: its columns and rows, and how many metres a pixel is wide. The bedroom is beyond its right edge."""
DARK, FLOOR, BACK, FRONT = 4, 60, 160, 250
"""How bright things are: everything without light; with it the floor, and the plates on Astrid's back and front."""
PLATES = 0.15
"""Metres from the middle of Astrid to the middle of either plate."""
HELD = 0.5
"""Seconds that the motors do what they were told last."""
BEDROOM = 4.5
"""Metres along the x axis at which the bedroom begins."""


class Room:
    """Astrid and the light, in real time."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.light = False
        self.x, self.y, self.theta = 0.4, 0.4, 0.0
        self.turned = [0.0, 0.0]
        """Metres that Astrid has gone forward, and radians that she has turned, as her wheels have it."""
        self._linear = self._angular = 0.0
        self._until = self._at = time.monotonic()
        self._arrived = False

    def let_pass(self) -> None:
        """Move Astrid to where she is by now."""
        now = time.monotonic()
        seconds = max(0.0, min(now, self._until) - self._at)
        self._at = now
        self.theta += self._angular * seconds
        self.x += self._linear * math.cos(self.theta) * seconds
        self.y += self._linear * math.sin(self.theta) * seconds
        self.turned[0] += self._linear * seconds
        self.turned[1] += self._angular * seconds
        if self.x > BEDROOM and not self._arrived:
            self._arrived = True
            print("Astrid is in the bedroom", flush=True)

    def drive(self, linear: float, angular: float) -> None:
        """Set the motors."""
        self.let_pass()
        self._linear, self._angular, self._until = linear, angular, time.monotonic() + HELD

    def shine(self, on: bool) -> None:
        """Switch the lamp."""
        if on != self.light:
            print(f"the lamp is {'on' if on else 'off'}", flush=True)
        self.light = on

    def picture(self) -> bytes:
        """What the camera sees, as a portable graymap (PGM)."""
        plates = [
            (self.x + side * PLATES * math.cos(self.theta), self.y + side * PLATES * math.sin(self.theta), bright)
            for side, bright in ((-1, BACK), (1, FRONT))
        ]
        pixels = bytearray([FLOOR if self.light else DARK]) * (WIDTH * HEIGHT)
        for row in range(HEIGHT) if self.light else ():
            for column in range(WIDTH):
                for x, y, bright in plates:
                    if math.hypot((column + 0.5) * METRES - x, (row + 0.5) * METRES - y) < PLATES / 2:
                        pixels[row * WIDTH + column] = bright
        return b"P5 %d %d 255\n" % (WIDTH, HEIGHT) + bytes(pixels)


class Door(BaseHTTPRequestHandler):
    """HTTP into the room."""

    protocol_version = "HTTP/1.1"
    room: Room

    def do_GET(self) -> None:
        with self.room.lock:
            self.room.let_pass()
            if self.path == "/":
                self.answer(200, json.dumps(self.description()).encode())
            elif self.path == "/on":
                self.answer(200, json.dumps(self.room.light).encode())
            elif self.path == "/picture":
                self.answer(200, self.room.picture(), "image/x-portable-graymap")
            elif self.path == "/wheels":
                self.answer(200, json.dumps(self.room.turned).encode())
            else:
                self.answer(404)

    def do_POST(self) -> None:
        said = json.loads(self.rfile.read(int(self.headers.get("Content-Length", 0))) or b"null")
        with self.room.lock:
            if self.path == "/shine" and isinstance(said, bool):
                self.room.shine(said)
                self.answer(204)
            elif self.path == "/velocity" and isinstance(said, dict):
                self.room.drive(said["linear"], said["angular"])
                self.answer(204)
            else:
                self.answer(400)

    def description(self) -> dict[str, Any]:
        """The Thing Description of the lamp (W3C, version 1.1)."""
        switch = {"@type": "rob:Switch", "type": "boolean"}
        return {
            "@context": ["https://www.w3.org/2022/wot/td/v1.1", {"rob": "https://w3id.org/selfconf/robotics#"}],
            "id": "https://example.org/astrid#floor-lamp",
            "@type": "rob:Lamp",
            "title": "The floor lamp",
            "base": f"http://{self.headers.get('Host')}/",
            "securityDefinitions": {"none": {"scheme": "nosec"}},
            "security": "none",
            "properties": {"on": {**switch, "readOnly": True, "forms": [{"href": "on"}]}},
            "actions": {"shine": {"input": switch, "forms": [{"href": "shine"}]}},
        }

    def answer(self, status: int, body: bytes = b"", media: str = "application/json") -> None:
        """Answer with some bytes, or with none."""
        self.send_response(status)
        if status != 204:
            self.send_header("Content-Type", media)
            self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: Any) -> None:
        """Say nothing about each request."""


def main() -> None:
    """Be the room until the process is ended."""
    parser = argparse.ArgumentParser(description="a room with a lamp")
    parser.add_argument("--port", type=int, default=0, help="0 for any free one")
    Door.room = Room()
    server = ThreadingHTTPServer(("127.0.0.1", parser.parse_args().port), Door)
    server.daemon_threads = True
    print(f"http://127.0.0.1:{server.server_port}/", flush=True)
    server.serve_forever()


if __name__ == "__main__":
    main()
