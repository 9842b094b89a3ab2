"""The radio: a tuner that makes real sound out of melodies, and a speaker that renders it.

Sound is 16-bit PCM on one channel, 8000 samples a second, in chunks of 100 ms. A chunk is a pure function
of the station and the chunk's number: two tuners on one station play the same samples.
"""

from __future__ import annotations

import math
import wave
from array import array
from pathlib import Path

from sim.signals import Audio

RATE = 8000
CHUNK = 800
LOUDEST = 32767

# Melodies by semitones above middle C, one number a beat; None is a rest.
ODE_TO_JOY = (4, 4, 5, 7, 7, 5, 4, 2, 0, 0, 2, 4, 4, 2, 2, None)
FRERE_JACQUES = (0, 2, 4, 0, 0, 2, 4, 0, 4, 5, 7, None, 4, 5, 7, None)

STATIONS: dict[str, tuple[int | None, ...]] = {"94.3": ODE_TO_JOY, "101.9": FRERE_JACQUES}
"""Melody by frequency in MHz."""


class StationError(ValueError):
    """No station broadcasts there: the author of the task can mend it. `station` is what was asked for."""

    def __init__(self, station: str) -> None:
        super().__init__(station)
        self.station = station

    def __str__(self) -> str:
        return f"no station at {self.station!r}: try {' or '.join(STATIONS)} (MHz)"


class Tuner:
    """A tuner set to a station, a frequency in MHz as text; raises StationError if it would hear nothing."""

    beat = 0.4

    def __init__(self, station: str) -> None:
        if station not in STATIONS:
            raise StationError(station)
        self._melody = STATIONS[station]

    def chunk(self, number: int) -> Audio:
        """Return the 100 ms of sound that begin `number` tenths of a second into the broadcast."""
        first = number * CHUNK
        return {"rate": float(RATE), "samples": [self._sample(first + k) for k in range(CHUNK)]}

    def _sample(self, index: int) -> int:
        time = index / RATE
        note = self._melody[int(time / self.beat) % len(self._melody)]
        if note is None:
            return 0
        since = time % self.beat
        pitch = 261.63 * 2 ** (note / 12)
        # A plucked tone: a quick rise, a slow decay, and an octave on top.
        envelope = min(1.0, since / 0.01) * math.exp(-4.0 * since)
        tone = 0.7 * math.sin(math.tau * pitch * since) + 0.3 * math.sin(2 * math.tau * pitch * since)
        return round(0.8 * LOUDEST * envelope * tone)


class Speaker:
    """A speaker with a volume from 0 to 1: it keeps what it has rendered."""

    def __init__(self, volume: float = 1.0) -> None:
        if not 0.0 <= volume <= 1.0:
            raise ValueError(f"a volume lies between 0 and 1, not at {volume}")
        self.volume = volume
        self._rate = RATE
        self._rendered = array("h")
        self._level = 0.0

    @property
    def seconds(self) -> float:
        """How much sound it has rendered."""
        return len(self._rendered) / self._rate

    @property
    def level(self) -> float:
        """How loud the last chunk was: its root mean square, from 0 to 1."""
        return self._level

    def render(self, audio: Audio) -> None:
        """Play a chunk, cut to 16 bits; a chunk at another rate begins a new recording."""
        if round(audio["rate"]) != self._rate:
            self._rate, self._rendered = round(audio["rate"]), array("h")
        played = [max(-LOUDEST, min(LOUDEST, round(self.volume * sample))) for sample in audio["samples"]]
        self._rendered.extend(played)
        power = sum(sample * sample for sample in played) / max(1, len(played))
        self._level = math.sqrt(power) / LOUDEST

    def write(self, path: Path) -> None:
        """Write everything rendered so far to a WAV file."""
        samples = array("h", self._rendered)
        with wave.open(str(path), "wb") as file:
            file.setnchannels(1)
            file.setsampwidth(2)
            file.setframerate(self._rate)
            file.writeframes(samples.tobytes())
