"""The camera on the ceiling: it issues what it sees, and asks for light where that is nothing."""

from __future__ import annotations

import os
import urllib.request

from selfconf.sdk import Component, Response, main

PERIOD = 0.1
"""Seconds from one picture to the next."""
DARK = 20
"""How bright a picture is on average, of 255, if there is something to be seen in it."""


class CeilingCamera(Component):
    """Issues pictures as messages of ROS 2; the bridge writes them as CDR."""

    advertisement = "astrid.ttl"
    component = "https://example.org/astrid#ceiling-camera"

    def started(self) -> None:
        self.asking = False
        self.every(PERIOD, self.look)

    def look(self) -> None:
        """Issue a picture, and ask for light if it is dark."""
        with urllib.request.urlopen(f"{os.environ['ROOM']}picture", timeout=1.8) as answer:
            head, pixels = answer.read().split(b"\n", 1)
        width, height = (int(word) for word in head.split()[1:3])
        if sum(pixels) < DARK * len(pixels) and not self.asking:
            self.asking = True
            print("it is dark", flush=True)
            self.call("light", {"on": True}, answered=self.lit, seconds=10.0)
        picture = {"height": height, "width": width, "encoding": "mono8", "step": width, "data": list(pixels)}
        self.emit("picture", picture)

    def lit(self, answer: Response) -> None:
        """Hear whether there is light; if not, the next picture is dark, and asks again."""
        self.asking = False
        print("there is light" if answer else f"there is no light: {answer.detail}", flush=True)


if __name__ == "__main__":
    main(CeilingCamera)
