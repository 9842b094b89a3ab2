"""What one component issues and prints, for a client that looks at it: only meanwhile, and never much of it.

An output is *glanced* at: followed as an input does until a few signals have come, then let go for a while, the longer
the more bytes they were. So a camera that no input follows costs the network no more than a thermometer does, and
no component is called but a composite, which is asked what stands behind its outputs. The log is asked for
at the site, piece by piece.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial

from selfconf.api.living.echo import heard_signal
from selfconf.api.living.output_sources import follow_output
from selfconf.bus.port import Bus, Replies, Sample, Undo
from selfconf.bus.timer import Timer
from selfconf.discovery import FoundAdvertisement
from selfconf.errors import PeerError
from selfconf.model.wording import one_line
from selfconf.protocol.codec import decode, encode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import LogPart, LogQuestion
from selfconf.protocol.stamps import StampReader
from selfconf.serve.watching.change import Body
from selfconf.serve.watching.checked import finite_number

GLANCE = 10
"""How many signals end a glance."""
GLANCE_BYTES = 1 << 16
"""How many bytes end a glance, once its rate is known."""
RATE_KNOWN = 3
"""From how many signals of a glance its rate is known: the first may be an old one, which is issued anew."""
GLANCE_PAUSE = 0.5
"""Seconds between two glances, at least."""
BYTES_A_SECOND = 1 << 18
"""How many bytes of one output are taken in a second, on average over a glance and its pause."""
TOLD_AFTER = 0.25
"""Seconds for which what has come is collected."""
LARGEST_READ = 1 << 16
"""JSON of more bytes is described, as arrays are."""
LOG_LINES = 100
"""How many lines of the log are sent at once, at most: of more the latest."""
LONGEST_TOLD = 500
"""How many characters of a line of the log are sent."""
LOG_PAUSE = 1.0
"""Seconds between two questions for the log."""
LOG_PATIENCE = 3.0
"""Seconds that a site may take to answer."""
MOST_OUTPUTS = 64
"""How many outputs of one component are looked at."""


@dataclass(slots=True)
class _Glance:
    """What has come of one output since it was last followed anew."""

    stamps: StampReader = field(default_factory=StampReader)
    undo: Undo | None = None
    moments: list[float] = field(default_factory=list)
    size: int = 0


class Onlooker:
    """Onlookers at one component until it is ended; runs on the thread of its bus."""

    def __init__(self, bus: Bus, keys: Keys, found: FoundAdvertisement, tell: Callable[[str, Body], None]) -> None:
        """`tell` receives `signals`, which is the latest by output, and `log`, which is lines or why there are none."""
        self._bus, self._keys, self._tell, self._site = bus, keys, tell, found.site
        self._profile = found.advertisement.profile
        self._component = self._profile.component
        self._outputs = [port.name for port in self._profile.signal_outputs][:MOST_OUTPUTS]
        self._glances = {output: _Glance() for output in self._outputs}
        self._fresh: dict[str, Body] = {}
        self._tell_soon = Timer(bus, TOLD_AFTER, self._tell_signals)
        self._ended = False

    def begin(self) -> None:
        """Begin to look."""
        for output in self._outputs:
            self._look(output)
        self._ask_log("")

    def excuse(self) -> None:
        """Tell why nothing can be seen, in place of looking."""
        why = {"trouble": "the keys of this server are for looking on only; signals and logs take keys of conf.NAME"}
        self._tell("signals", dict.fromkeys(self._outputs, why))
        self._tell("log", why)

    def end(self) -> None:
        """Look no more."""
        self._ended = True
        for glance in self._glances.values():
            if glance.undo is not None:
                glance.undo()

    # Signals.

    def _look(self, output: str) -> None:
        if self._ended:
            return
        glance = self._glances[output]
        glance.moments, glance.size = [], 0
        heard = partial(self._heard, output)
        glance.undo = follow_output(self._bus, self._keys, self._profile, output, heard)

    def _heard(self, output: str, sample: Sample) -> None:
        glance = self._glances[output]
        if glance.undo is None:  # it came after the glance
            return
        glance.moments.append(self._bus.now())
        glance.size += len(sample.payload)
        moments = glance.moments[1:]
        span = moments[-1] - moments[0] if moments else 0.0
        rate = (len(moments) - 1) / span if span else None
        self._fresh[output] = {**_signal_body(glance.stamps, sample), "rate": rate}
        self._tell_soon.set()
        many = len(glance.moments)
        if many >= GLANCE or (many >= RATE_KNOWN and glance.size >= GLANCE_BYTES):
            glance.undo()
            glance.undo = None
            self._bus.later(max(GLANCE_PAUSE, glance.size / BYTES_A_SECOND), lambda: self._look(output))

    def _tell_signals(self) -> None:
        fresh, self._fresh = self._fresh, {}
        if not self._ended:
            self._tell("signals", fresh)

    # The log.

    def _ask_log(self, position: str) -> None:
        if not self._ended:
            question = LogQuestion(self._component, LOG_LINES, position)
            self._bus.ask(self._keys.log(self._site), encode(question), LOG_PATIENCE, partial(self._log_told, position))

    def _log_told(self, position: str, replies: Replies) -> None:
        if self._ended:
            return
        trouble = "; ".join(replies.errors) or f"the site {self._site} does not tell what its components have printed"
        part = None
        if replies.samples:
            try:
                part = decode(replies.samples[0].payload, LogPart)
            except PeerError as error:
                trouble = str(error)
        if part is None:
            self._tell("log", {"trouble": one_line(trouble, LONGEST_TOLD)})
        elif part.lines or not position:
            lines = [_line_body(*line) for line in part.lines[-LOG_LINES:]]
            self._tell("log", {"lines": lines, "anew": not position})
        # A component that prints more than is sent at once is followed from its present end on.
        after = position if part is None else "" if part.more else part.position
        self._bus.later(LOG_PAUSE, lambda: self._ask_log(after))


def _line_body(time: str, stream: str, components: object, text: str) -> Body:
    return {"time": time, "stream": stream, "text": one_line(text, LONGEST_TOLD)}


def _signal_body(stamps: StampReader, sample: Sample) -> Body:
    """A signal as the page shows it; for what is none, why."""
    try:
        signal = heard_signal(stamps, sample, largest=LARGEST_READ)
    except PeerError as error:
        return {"trouble": one_line(f"this is no signal: {error}", LONGEST_TOLD)}
    return {"text": signal.worded(), "time": finite_number(signal.stamp.time)}
