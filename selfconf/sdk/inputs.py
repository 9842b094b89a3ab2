"""The inputs of a component: which outputs they follow, and whether these keep their promises.

*Silence.* An input that follows an output with a promised rate reports when no signal has come for `PATIENCE` of the
promised periods, and again as long as none comes.
"""

from __future__ import annotations

import json
import logging
from collections.abc import Callable

from selfconf.bus.port import Bus, Sample, Undo
from selfconf.errors import PeerError
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Apply, Stamp, Wire
from selfconf.sdk.component import Signal
from selfconf.sdk.outputs import RAW

log = logging.getLogger(__name__)

PATIENCE = 4.0
"""After how many promised periods without a signal an output counts as silent."""
LEAST_PATIENCE = 0.1
"""Seconds without a signal that no output is blamed for: less than that is the network's and the scheduler's."""
BEGINNING = 20.0
"""Seconds that an output may take to issue its first signal: its component may have to be started by its site."""
JUST_COME = 0.5
"""Seconds for which the newest signal of an output that stood by counts when the output becomes an input's own."""

Deliver = Callable[[str, Signal], None]
"""Hands a signal that has arrived on an input to the component."""
ReportSilence = Callable[[Wire, float], None]
"""Hears of an output that has promised a rate and has issued nothing for so many seconds."""


class Inputs:
    """The subscriptions of one component, by input and output."""

    def __init__(self, bus: Bus, keys: Keys, deliver: Deliver, report_silence: ReportSilence) -> None:
        self._bus, self._keys, self._deliver, self._report_silence = bus, keys, deliver, report_silence
        self._subscriptions: dict[tuple[str, Wire], InputSubscription] = {}

    def follow(self, message: Apply) -> None:
        """Follow exactly the outputs that a call names, and listen to those that stand by.

        New connections are made first, because others wait for what flows over them; the old ones end when the call
        has been answered.
        """
        wanted = dict.fromkeys((port, wire) for port, wires in message.inputs.items() for wire in wires)
        spare = dict.fromkeys((port, wire) for port, wires in message.standby.items() for wire in wires)
        for port, wire in (*wanted, *spare):
            if (port, wire) not in self._subscriptions:
                self._subscriptions[port, wire] = InputSubscription(
                    self._bus, self._keys, port, wire, self._deliver, self._report_silence
                )
        for key, subscription in list(self._subscriptions.items()):
            if key in wanted:
                subscription.unmute()
                continue
            subscription.mute()
            if key not in spare:
                del self._subscriptions[key]
                self._bus.wake_up(subscription.end)

    def end(self) -> None:
        """Follow nothing."""
        for subscription in self._subscriptions.values():
            subscription.end()
        self._subscriptions.clear()

    @property
    def followed(self) -> set[tuple[str, Wire]]:
        """Which output each input follows, those that only stand by left out."""
        return {key for key, subscription in self._subscriptions.items() if not subscription.muted}


class InputSubscription:
    """One input's subscription to one output, with a watch for silence where a rate is promised.

    While it is muted, because the output only stands by or the connection is about to end, it passes over what it
    receives, but for the newest signal: that counts if it is unmuted right after.
    """

    def __init__(
        self, bus: Bus, keys: Keys, port: str, wire: Wire, deliver: Deliver, report_silence: ReportSilence
    ) -> None:
        self._bus, self._port, self._wire = bus, port, wire
        self._deliver, self._report_silence = deliver, report_silence
        self.muted = True
        self._life, self._sequence = "", 0
        """The newest signal that was delivered, by the life of its source and its number in it."""
        self._newest: tuple[float, Sample] | None = None
        """The newest signal that came while muted, and when."""
        self._deadline: Undo | None = None
        self._undo = bus.subscribe(keys.output(wire.component, wire.output), self._received)

    def unmute(self) -> None:
        """Deliver what is received, from the newest signal on if that has only just come."""
        if not self.muted:
            return
        self.muted = False
        self._expect()
        if self._newest is not None and self._bus.now() - self._newest[0] < JUST_COME:
            self._received(self._newest[1])
        self._newest = None

    def mute(self) -> None:
        """Pass over what is received."""
        self.muted = True
        if self._deadline is not None:
            self._deadline()

    def end(self) -> None:
        """Follow the output no more."""
        self.mute()
        self._undo()

    def _received(self, sample: Sample) -> None:
        if self.muted:
            self._newest = self._bus.now(), sample
            return
        raw = sample.attachment.startswith(RAW)
        try:
            stamp = decode(sample.attachment[len(RAW) :] if raw else sample.attachment, Stamp)
            value = sample.payload if raw else json.loads(sample.payload)
        except (PeerError, ValueError, RecursionError) as error:
            log.warning("passed over a signal on %s: %s", sample.key, error)
            return
        if stamp.component != self._wire.component:
            return
        if stamp.life == self._life and stamp.sequence <= self._sequence:
            return  # late, doubled, or a latched signal that was issued again for another input
        self._life, self._sequence = stamp.life, stamp.sequence
        self._expect()
        self._deliver(self._port, Signal(value, stamp.component, stamp.time, stamp.sequence))

    def _expect(self) -> None:
        """Expect a signal within the promised time, from now on."""
        if self._wire.period is None:
            return
        if self._deadline is not None:
            self._deadline()
        usual = max(PATIENCE * self._wire.period, LEAST_PATIENCE)
        seconds = usual if self._sequence else max(usual, BEGINNING)

        def silent() -> None:
            self._report_silence(self._wire, seconds)
            self._expect()

        self._deadline = self._bus.later(seconds, silent)
