"""A clock: it tells the time of day, once a second."""

import time

from selfconf.sdk import Component, main


class Clock(Component):
    advertisement = "clock.ttl"

    def started(self) -> None:
        self.every(1.0, self.tick)

    def tick(self) -> None:
        self.emit("time", {"text": time.strftime("%H:%M:%S")})


if __name__ == "__main__":
    main(Clock)
