"""One input's subscription to one output: from the signal that arrives to the component's code, or to the word of loss.

What is known of the output is in `followed_output`; it is asked for its last signal by `last_signal`; whether it is
lost is for `source_watch` to say, and for `silence_watch`: an output that has promised a rate and issues nothing for
too long is reported, and lost.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial
from typing import Any

from selfconf.bus.port import Bus
from selfconf.errors import PeerError
from selfconf.protocol.keys import Keys
from selfconf.protocol.messages import Wire
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.component import Signal
from selfconf.sdk.inputs.followed_output import FollowedOutput
from selfconf.sdk.inputs.last_signal import LastSignal
from selfconf.sdk.inputs.signal_order import NONE
from selfconf.sdk.inputs.signal_queue import SignalQueue
from selfconf.sdk.inputs.silence_watch import SilenceWatch
from selfconf.sdk.inputs.source_watch import SourceWatch
from selfconf.sdk.outputs import SIGNALS_FIRST
from selfconf.sdk.payloads import read_payload

log = logging.getLogger(__name__)

PASSED_OVER = "passed over a signal on %s: %s"


class InputSubscription:
    """One input's subscription to one output, which is muted at first, as one that only stands by."""

    def __init__(
        self,
        bus: Bus,
        keys: Keys,
        code: CodeThread,
        wire: Wire,
        queue: SignalQueue,
        deliver: Callable[[Signal], None],
        silent: Callable[[float], None],
        lost: Callable[[], None],
        read: Callable[[Any, str], Any],
    ) -> None:
        """`deliver` is called on the code's thread; `silent`, with seconds, and `lost` on the bus's."""
        self._wire, self._deliver, self._silent, self._read_value = wire, deliver, silent, read
        key = keys.output(wire.component, wire.output)
        self._output = FollowedOutput(bus.now, queue, partial(code.signal, self._read))
        self._last_signal = LastSignal(bus, key, self._output)
        self._source = SourceWatch(bus, keys, wire, self._output, self._last_signal, lost)
        self._silence = SilenceWatch(
            bus, keys.lives(wire.component), wire.period, lambda: self._output.heard_at, self._be_silent
        )
        self._declared = [bus.subscribe(key, self._output.receive, direct=True)]
        bus.later(SIGNALS_FIRST, self._watch)

    @property
    def muted(self) -> bool:
        """Whether what the output issues is passed over."""
        return self._output.muted

    @property
    def lost(self) -> bool:
        """Whether the output can issue nothing any more, as far as is known."""
        return self._output.lost

    @property
    def dropped(self) -> int:
        """How many signals were dropped because the component's code was too slow."""
        return self._output.dropped

    @property
    def just_issued(self) -> bool:
        """Whether the output has just issued a signal, so that the input that follows it from now on is fed."""
        return self._output.just_issued

    def heard_since(self, moment: float) -> bool:
        """Whether the output has issued a signal at that moment, in seconds of the bus's clock, or later."""
        return self._output.heard_at >= moment

    def delivers_since(self, moment: float) -> bool:
        """Whether the output has issued a signal since a moment, and is not lost."""
        return self.heard_since(moment) and not self.lost

    def has_delivered_since(self, moment: float) -> bool:
        """Whether a signal that has come since a moment was read as well, and the output is not lost."""
        return self._output.understood_at >= moment and not self.lost

    def unmute(self) -> None:
        """Deliver what is received, from the newest signal on if that has only just come, else from the last one on."""
        if not self.muted:
            return
        just_issued = self._output.unmute()
        if self._last_signal.asked and not just_issued:
            self._last_signal.request_if_quiet()
        self._source.expect_life()
        self._silence.expect(first=self._output.order.newest is NONE)
        self._output.deliver()

    def say_again(self) -> None:
        """Deliver the last signal once more: the component's code has been started again."""
        if not (self.muted or self.lost):
            self._output.order.newest = NONE
            self._last_signal.ask()

    def mute(self) -> None:
        """Pass over what is received."""
        self._output.mute()
        self._silence.end()

    def end(self) -> None:
        """Follow the output no more."""
        self.mute()
        self._output.ended = True
        for undo in self._declared:
            undo()
        self._declared.clear()

    def _watch(self) -> None:
        """Ask for the last signal, and follow the life of the component; not before the signals that wait flow."""
        if self._output.ended:
            return
        self._last_signal.request()
        self._declared.extend(self._source.begin())

    def _read(self) -> None:
        """Deliver the oldest signal that waits, on the thread of the component's code."""
        output = self._output
        lost, sample = output.lost, output.pop()
        if sample is None:
            return
        try:
            raw, stamp = output.stamp(sample)
            value = self._read_value(read_payload(sample.payload, raw, stamp.encoding), stamp.encoding.media)
        except (PeerError, ValueError, RecursionError) as error:
            level = logging.WARNING if output.not_understood() else logging.DEBUG
            log.log(level, PASSED_OVER, sample.key, error)
            return
        output.understood()
        if stamp.component != self._wire.component:
            return
        if output.muted or (output.lost and not lost) or output.order.is_old(stamp, output.lost):
            return  # muted or lost while it was read
        if lost and stamp.life not in output.lives:  # on its way when that life ended, or its source is cut off
            self._source.expect_sign()
        output.order.newest, output.lost = stamp, False
        self._deliver(Signal(value, stamp.component, stamp.time, stamp.sequence, stamp.encoding.media))

    def _be_silent(self, seconds: float) -> None:
        """The output has not kept its promise."""
        self._silent(seconds)
        self._source.lose(self._output.heard_at)
        self._silence.expect(first=self._output.order.newest is NONE)
