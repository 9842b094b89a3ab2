"""The Thinking Cap as a program: a reactive navigator that takes a behavioural goal and drives by poses.

It answers each pose with a set-point, so that it falls silent when poses cease, and the drive then stops. For
measurements of a run it writes one line of JSON to stdout when the first pose of a new source arrives.
"""

from __future__ import annotations

from typing import Any

from selfconf.sdk import Component, Refused, Signal, main
from sim.home.apartment import read_apartment
from sim.home.goal import GoalError
from sim.robot.navigator import Navigator
from sim.say import say


class ThinkingCap(Component):
    """Drives a robot to a behavioural goal."""

    advertisement = "../examples/peis-home/thinking-cap.ttl"

    def __init__(self) -> None:
        self._apartment = read_apartment()
        self._newest: dict[str, Signal] = {}
        self._navigator: Navigator | None = None
        self._source = ""

    def started(self) -> None:
        """A new configuration, with a goal of its own: nothing is known yet."""
        self._newest.clear()
        self._source = ""

    def parameter_set(self, name: str, value: Any) -> None:
        """Take a goal such as `(AT BEDROOM)`; refuse one that this apartment does not know."""
        try:
            self._navigator = Navigator(self._apartment, str(value))
        except GoalError as error:
            raise Refused(str(error)) from None

    def received(self, port: str, signal: Signal) -> None:
        """Keep the newest scan and odometry; answer a pose with a set-point."""
        self._newest[port] = signal
        if port != "position":
            return
        if signal.source != self._source:
            self._source = signal.source
            say("first pose", source=signal.source)
        if self._navigator is None or not {"sonar", "localize"} <= self._newest.keys():
            return
        scan, wheels = self._newest["sonar"].value, self._newest["localize"].value
        decision = self._navigator.update(signal.value, scan, wheels, signal.time)
        self.emit("set.velocity", decision.velocity, signal.time)
        if decision.state == "stuck":
            self.fail(decision.reason or "stuck")


if __name__ == "__main__":
    main(ThinkingCap)
