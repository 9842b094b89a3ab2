"""An input that follows an output: a subscription, and a watch for silence where a rate is promised."""

from __future__ import annotations

import json
import logging
from typing import TYPE_CHECKING

from selfconf.bus.port import Sample, Undo
from selfconf.errors import PeerError
from selfconf.protocol.codec import decode
from selfconf.protocol.messages import Stamp, Wire
from selfconf.sdk.component import Signal

if TYPE_CHECKING:
    from selfconf.sdk.body import Body

log = logging.getLogger(__name__)

PATIENCE = 4.0
"""After how many promised periods without a signal an output counts as silent."""
BEGINNING = 20.0
"""Seconds that an output may take to issue its first signal: its component may have to be started by its site."""
JUST_COME = 0.5
"""Seconds for which the signal of an output that stood by counts once it is heeded."""
RAW = b"raw"
"""What stands before the stamp of a signal that is bytes and not JSON."""


class Following:
    """An input following one output: a subscription, and a watch for silence where a rate is promised.

    While it is muted, because the output only stands by or the connection is about to end, it passes over what it
    hears, but for the newest signal: that counts if the output is heeded right after.
    """

    def __init__(self, body: Body, port: str, wire: Wire) -> None:
        self._body, self._port, self._wire = body, port, wire
        self._life, self._sequence = "", 0
        self._deadline: Undo | None = None
        self._muted = True
        self._newest: tuple[float, Sample] | None = None
        self._undo = body.bus.subscribe(body.keys.output(wire.component, wire.output), self._heard)

    def heed(self) -> None:
        """Hand on what is heard, from the newest signal on if that has only just come."""
        if not self._muted:
            return
        self._muted = False
        self._expect()
        if self._newest is not None and self._body.bus.now() - self._newest[0] < JUST_COME:
            self._heard(self._newest[1])
        self._newest = None

    def mute(self) -> None:
        """Pass over what is heard."""
        self._muted = True
        if self._deadline is not None:
            self._deadline()

    def end(self) -> None:
        """Follow no more."""
        self.mute()
        self._undo()

    def _heard(self, sample: Sample) -> None:
        if self._muted:
            self._newest = self._body.bus.now(), sample
            return
        raw = sample.attachment.startswith(RAW)
        try:
            stamp = decode(sample.attachment[len(RAW) :] if raw else sample.attachment, Stamp)
            value = sample.payload if raw else json.loads(sample.payload)
        except (PeerError, ValueError, RecursionError) as error:
            log.warning("%s: passed over a signal: %s", self._body.profile.component.short, error)
            return
        if stamp.component != self._wire.component:
            return
        if stamp.life == self._life and stamp.sequence <= self._sequence:
            return
        self._life, self._sequence = stamp.life, stamp.sequence
        self._expect()
        self._body.deliver(self._port, Signal(value, stamp.component, stamp.time, stamp.sequence))

    def _expect(self) -> None:
        if self._wire.period is None:
            return
        if self._deadline is not None:
            self._deadline()
        usual = max(PATIENCE * self._wire.period, 0.1)
        seconds = usual if self._sequence else max(usual, BEGINNING)

        def silent() -> None:
            self._body.report_silence(self._wire, seconds)
            self._expect()

        self._deadline = self._body.bus.later(seconds, silent)
