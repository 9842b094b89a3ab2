"""What an output issues, as it comes, for a reader.

The reader follows the output as an input does, and takes part in nothing. What it cannot take in time is passed over
here, and counted: neither the component nor another reader waits for it.
"""

from __future__ import annotations

import json
import sys
from collections import deque
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from selfconf.api.synchronous_bus import SynchronousBus
from selfconf.bus.port import Sample, Undo
from selfconf.errors import PeerError
from selfconf.protocol.messages import Stamp
from selfconf.protocol.stamps import StampReader

SIGNALS_HELD = 256
"""How many signals may wait for the reader; then the oldest are passed over."""
LONGEST_VALUE = 400
"""Characters of a value that are shown, in text."""
RATE_OVER = 2.0
"""Seconds over which the rate is taken."""


class HeardSignal(NamedTuple):
    """A signal as a reader hears it."""

    stamp: Stamp
    rate: float
    """Signals a second, as they came during the last seconds; zero for the first two."""
    size: int
    """The bytes of its payload."""
    raw: bool
    """Whether it is bytes, or an array, and no JSON: then there is no value, and the stamp says what it is."""
    value: Any = None
    passed_over: int = 0
    """How many signals before this one the reader has missed."""

    def worded(self, longest: int = LONGEST_VALUE) -> str:
        """The value as JSON, shortened to so many characters; bytes and arrays are described."""
        encoding = self.stamp.encoding
        if not self.raw:
            text = json.dumps(self.value, ensure_ascii=False)
            left_out = len(text) - longest
            return text if left_out <= 0 else f"{text[:longest]}... ({left_out} characters more)"
        what = f"{encoding.media} of " if encoding.media else ""
        if not encoding.datatype:
            return f"<{what}{self.size} bytes>"
        return f"<{what}{encoding.datatype} {' x '.join(map(str, encoding.shape))}, {self.size} bytes>"

    def body(self) -> dict[str, Any]:
        """The signal as JSON; bytes and arrays are described, and what holds NaN or infinity, which JSON has not."""
        stamp, encoding = self.stamp, self.stamp.encoding
        said: dict[str, Any] = {"value": self.value}
        if self.raw or not _is_of_json(self.value):
            said = {"bytes": self.size, "media": encoding.media, "datatype": encoding.datatype}
            said["shape"] = list(encoding.shape)
        return {
            "component": stamp.component,
            "life": stamp.life,
            "sequence": stamp.sequence,
            "time": stamp.time,
            "rate": round(self.rate, 3),
            "passed_over": self.passed_over,
            **said,
        }


def _is_of_json(value: Any) -> bool:
    """Whether all numbers in what was read have a place in JSON."""
    try:
        json.dumps(value, allow_nan=False)
    except ValueError:
        return False
    return True


def heard_signal(
    stamps: StampReader, sample: Sample, rate: float = 0.0, passed_over: int = 0, largest: int = sys.maxsize
) -> HeardSignal:
    """A sample as the signal that it is; `stamps` reads those of its output.

    JSON of more bytes than `largest` is not read, and described as bytes are. Raises PeerError for what is no signal.
    """
    raw, stamp = stamps.read(sample.attachment)
    raw = raw or len(sample.payload) > largest
    try:
        value = None if raw else json.loads(sample.payload)
    except (ValueError, RecursionError) as error:
        raise PeerError(str(error)) from None
    return HeardSignal(stamp, rate, len(sample.payload), raw, value, passed_over)


def echo(
    bus: SynchronousBus,
    follow: Callable[[Callable[[Sample], None]], Undo],
    complain: Callable[[str], None] = lambda _: None,
) -> Iterator[HeardSignal]:
    """The signals of an output from now on, without an end; `complain` hears of what is no signal.

    `follow` begins to hand the samples of the output to what it is given, while the bus runs. Raises ProgrammerError
    once the ecology was left.
    """
    arrived: deque[tuple[float, Sample]] = deque(maxlen=SIGNALS_HELD)
    stamps, moments = StampReader(), deque[float]()
    taken = heard = 0

    def receive(sample: Sample) -> None:
        nonlocal taken
        taken += 1
        arrived.append((bus.now(), sample))

    undo = follow(receive)
    try:
        while True:
            bus.run(lambda: bool(arrived))
            missed = taken - heard - len(arrived)
            moment, sample = arrived.popleft()
            heard += missed + 1
            if heard > 1:  # the first may be an old one, which is issued anew
                moments.append(moment)
            while moments and moment - moments[0] > RATE_OVER:
                moments.popleft()
            span = moments[-1] - moments[0] if moments else 0.0
            rate = (len(moments) - 1) / span if span else 0.0
            try:
                yield heard_signal(stamps, sample, rate, missed)
            except PeerError as error:
                complain(f"passed over what is no signal: {error}")
    finally:
        undo()
