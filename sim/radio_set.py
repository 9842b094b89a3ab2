"""The radio as programs: `python -m sim.radio_set tuner`, `python -m sim.radio_set left-speaker` and so on.

A speaker writes what it plays to `$SIM_SOUND/NAME.wav`, if that is set, when it is turned off. SIGUSR1 pulls its plug:
it notices, and raises FAIL. For measurements of a run it writes a line of JSON when it begins and ends to play.
"""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path
from typing import Any

from selfconf.sdk import Component, Refused, main
from selfconf.sdk import Signal as Received
from sim.radio import CHUNK, RATE, Speaker, StationError, Tuner
from sim.say import say

ADVERTISEMENTS = "../examples/radio"


class RadioTuner(Component):
    """A tuner that sends the sound of a station, a tenth of a second at a time."""

    advertisement = f"{ADVERTISEMENTS}/tuner.ttl"

    def __init__(self) -> None:
        self._tuner = Tuner("94.3")
        self._number = 0

    def started(self) -> None:
        """On the air."""
        self.every(CHUNK / RATE, self._send)

    def parameter_set(self, name: str, value: Any) -> None:
        """Take a station; refuse one that no station broadcasts on."""
        try:
            self._tuner = Tuner(str(value))
        except StationError as error:
            raise Refused(str(error)) from None

    def _send(self) -> None:
        self.emit("audio", self._tuner.chunk(self._number))
        self._number += 1


class RadioSpeaker(Component):
    """A speaker that renders the sound it is sent."""

    name = ""

    def __init__(self) -> None:
        self._speaker = Speaker()
        self._playing = False
        signal.signal(signal.SIGUSR1, lambda _, __: self.fail("a person has pulled the plug"))

    def started(self) -> None:
        """Plugged in again, and silent so far."""
        self._speaker = Speaker()
        self._playing = False

    def received(self, port: str, sound: Received) -> None:
        """Render a tenth of a second of sound."""
        self._speaker.render(sound.value)
        if not self._playing:
            self._playing = True
            say("plays", speaker=self.name, process=os.getpid())

    def stopped(self) -> None:
        """Silence; what was played is written to a file if the environment names one."""
        if self._playing:
            seconds, level = round(self._speaker.seconds, 1), round(self._speaker.level, 3)
            say("silent", speaker=self.name, process=os.getpid(), seconds=seconds, level=level)
        if self._playing and "SIM_SOUND" in os.environ:
            self._speaker.write(Path(os.environ["SIM_SOUND"]) / f"{self.name}.wav")


def speaker(file: str) -> type[RadioSpeaker]:
    """The class of the speaker that one of the advertisements describes."""
    return type("RadioSpeaker", (RadioSpeaker,), {"advertisement": f"{ADVERTISEMENTS}/{file}.ttl", "name": file})


if __name__ == "__main__":
    which = sys.argv[1] if len(sys.argv) > 1 else "tuner"
    main(RadioTuner if which == "tuner" else speaker(which))
