"""One input's subscription to one output: what waits to be read, whether the output keeps its promises, and its end.

*Queues.* What arrives waits in a queue of its own for each output that an input follows, until the component's code
has time. The queue is bounded: the newest signal counts of an output that promises a rate, and of one that does not as
many are kept as events may need (`signal_queue`); `sc:depth` of the input says otherwise. What is dropped is counted.

*Silence.* An output that has promised a rate and issues nothing for too long (`silence_watch`) is reported, and lost.

*Latching.* An input asks each output that it begins to follow for its last signal, whether or not others follow it,
and once more one that has stood by, unless that has just issued one, or that was lost with the life of its component
and is in sight again: it may have nothing else to issue. So it asks for what a component that has been at rest passed
over, or knew before it was stopped. It asks again where no answer comes in time, nor a signal, and the component lives,
and waits twice as long for the next answer.
"""

from __future__ import annotations

import logging
from collections.abc import Callable
from functools import partial
from typing import Any

from selfconf.bus.port import Bus, Replies, Sample
from selfconf.errors import PeerError
from selfconf.model.immutable import immutable
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys, life_of
from selfconf.protocol.messages import Cause, Fail, Stamp, Wire
from selfconf.protocol.stamps import StampReader
from selfconf.sdk.code_thread import CodeThread
from selfconf.sdk.component import Signal
from selfconf.sdk.inputs.signal_order import NONE, SignalNumber, SignalOrder
from selfconf.sdk.inputs.signal_queue import SignalQueue
from selfconf.sdk.inputs.silence_watch import SilenceWatch
from selfconf.sdk.outputs import SIGNALS_FIRST
from selfconf.sdk.payloads import read_payload

log = logging.getLogger(__name__)

JUST_COME = 0.5
"""Seconds for which the newest signal of an output that stood by counts when the output becomes an input's own."""
UNSEEN = 1.0
"""Seconds until the component of an output has to have shown that it lives, unless the output issues something."""
BY_ITSELF = 0.02
"""Seconds for which an output that stood by is not asked for its last signal: one that is just being started issues its
first by itself, and who asks meanwhile takes its time."""
PASSED_OVER = "passed over a signal on %s: %s"
LAST_SIGNAL = 1.0
"""Seconds that an output may take to say its last signal; a later one comes by itself."""
LONGEST_ANSWER = 16.0
"""Seconds that the answer may take at most where questions were not answered in time, each with twice the time of the
one before: a signal that is large is longer on its way over a slow link, which new questions would but fill."""
ASK_FOR_LAST = (0.3, 1.0, 3.0)
"""Seconds after which an output that has issued nothing is asked once more: a question may be there before the output
has issued anything, and the signal before the subscription."""


@immutable
class InputEvents:
    """What the inputs of a component report: on the code's thread what arrives, on the bus's thread the rest."""

    deliver: Callable[[str, Signal], None]
    """A signal has arrived on an input; called on the thread of the component's code."""
    silent: Callable[[Wire, float], None]
    """An output that has promised a rate has issued nothing for so many seconds."""
    unfed: Callable[[str], None]
    """An input has lost its last source."""


class InputSubscription:
    """One input's subscription to one output, with a watch for its end, and for silence where a rate is promised.

    While it is muted, because the output only stands by or the connection is about to end, it passes over what it
    receives, but for the newest signal: that counts if it is unmuted right after.
    """

    def __init__(
        self,
        bus: Bus,
        keys: Keys,
        code: CodeThread,
        port: str,
        wire: Wire,
        queue: SignalQueue,
        events: InputEvents,
        lost: Callable[[str], None],
        read: Callable[[Any, str], Any],
    ) -> None:
        self._read_value = read
        self._bus, self._keys, self._code, self._port, self._wire = bus, keys, code, port, wire
        self._events, self._report_lost = events, lost
        self.muted = True
        self.lost = False
        """Whether the output can issue nothing any more, as far as is known."""
        self._order = SignalOrder()
        self._queue = queue
        self._stamps = StampReader()
        self._heard_at = -JUST_COME
        """When the newest signal came, in seconds of the bus's clock."""
        self._understood_at = self._heard_at
        """When the newest signal was read that could be: what cannot be read is no sign that the output issues."""
        self._complained = False
        self._lives: set[str] = set()
        self._asked = self._ended = False
        """Whether the output was asked for its last signal, and whether it is followed no more."""
        self._questions = 0
        """How often it was asked for its last signal."""
        self._silence = SilenceWatch(bus, wire.period, lambda: self._heard_at, self._be_silent)
        self._declared = [bus.subscribe(keys.output(wire.component, wire.output), self._received, direct=True)]
        bus.later(SIGNALS_FIRST, self._watch)

    @property
    def dropped(self) -> int:
        """How many signals were dropped because the component's code was too slow."""
        return self._queue.dropped

    @property
    def issued(self) -> bool:
        """Whether the output has issued a signal since it is listened to."""
        return self._heard_at >= 0.0

    def heard_since(self, moment: float) -> bool:
        """Whether the output has issued a signal at that moment, in seconds of the bus's clock, or later."""
        return self._heard_at >= moment

    @property
    def heard(self) -> bool:
        """Whether the output has just issued a signal, so that the input that follows it from now on is fed.

        None that it may have issued for a task of which it has let go.
        """
        return bool(self._queue) and self._order.doubted is None and self._bus.now() - self._heard_at < JUST_COME

    def unmute(self) -> None:
        """Deliver what is received, from the newest signal on if that has only just come, else from the last one on."""
        if not self.muted:
            return
        heard = self.heard
        self._queue.keep(1 if heard else 0)
        self.muted = False
        if self._asked and not heard:
            self._bus.later(BY_ITSELF, partial(self._ask_if_quiet, self._bus.now()))
        self._bus.later(UNSEEN, partial(self._look_for_life, self._bus.now()))
        self._silence.expect(first=self._order.newest is NONE)
        if self._queue:
            self._code.signal(self._read)

    def say_again(self) -> None:
        """Deliver the last signal once more: the component's code has been started again."""
        if not (self.muted or self.lost):
            self._order.newest = NONE
            self._ask()

    def mute(self) -> None:
        """Pass over what is received."""
        self.muted = True
        self._queue.keep(0)
        self._order.newest = NONE  # what the input follows it again for may be what it has had before
        self._silence.end()

    def end(self) -> None:
        """Follow the output no more."""
        self.mute()
        self._ended = True
        for undo in self._declared:
            undo()
        self._declared.clear()

    # What arrives: on whatever thread it does.

    def _received(self, sample: Sample) -> None:
        stamp = self._stamp_of(sample) if self._order.is_in_question else None
        if stamp is not None:
            if self._order.is_over(stamp):
                return
            self._order.settle(stamp, self._shows)
        self._heard_at = self._bus.now()
        if self.muted:
            self._queue.keep(0)
        grown = self._queue.append(sample)
        if grown and not self.muted:  # as many reads are due as there are signals
            self._code.signal(self._read)

    def _stamp_of(self, sample: Sample) -> Stamp | None:
        """The stamp of a signal as it comes; None if that cannot be read."""
        try:
            return self._stamps.read(sample.attachment)[1]
        except PeerError:
            return None

    # What the component's code gets, on its thread.

    def _read(self) -> None:
        """Deliver the oldest signal that waits; none may be left, as the queue keeps the newest only."""
        lost = self.lost
        sample = None if self.muted else self._queue.pop()
        if sample is None:
            return
        try:
            raw, stamp = self._stamps.read(sample.attachment)
            value = self._read_value(read_payload(sample.payload, raw, stamp.encoding), stamp.encoding.media)
        except (PeerError, ValueError, RecursionError) as error:
            log.log(logging.DEBUG if self._complained else logging.WARNING, PASSED_OVER, sample.key, error)
            self._complained, self._heard_at = True, self._understood_at
            return
        if self._complained:
            self._complained, self._heard_at = False, self._bus.now()
        self._understood_at = self._heard_at
        if stamp.component != self._wire.component:
            return
        if (
            self.muted or (self.lost and not lost) or self._order.is_old(stamp, self.lost)
        ):  # muted or lost while it was read
            return
        if lost and not self._shows(stamp.life):  # it was on its way when that life ended, or its source is cut off
            self._bus.later(UNSEEN, partial(self._look_for_sign, self._heard_at))
        self._order.newest, self.lost = SignalNumber(stamp.life, stamp.sequence), False
        self._events.deliver(
            self._port, Signal(value, stamp.component, stamp.time, stamp.sequence, stamp.encoding.media)
        )

    # What is noticed of the output, on the bus's thread.

    def _watch(self) -> None:
        """Ask for the last signal, and follow the life of the component; not before the signals that wait flow."""
        if self._ended:
            return
        self._asked = True
        self._ask_for_last(ASK_FOR_LAST)
        self._declared.append(self._bus.watch(self._keys.lives(self._wire.component), self._life_changed))
        self._declared.append(self._bus.subscribe(self._keys.fail(self._wire.component), self._failed))

    def _ask_for_last(self, again: tuple[float, ...]) -> None:
        if self._ended or (self.issued and again is not ASK_FOR_LAST):
            return
        self._ask()
        if again:
            self._bus.later(again[0], partial(self._ask_for_last, again[1:]))

    def _ask_if_quiet(self, since: float) -> None:
        if not self.muted and self._heard_at < since:
            self._ask_for_last(ASK_FOR_LAST)

    def _ask(self, seconds: float = LAST_SIGNAL) -> None:
        self._questions += 1
        answered = partial(self._answered, self._questions, self._bus.now(), seconds)
        self._bus.ask(self._keys.output(self._wire.component, self._wire.output), b"", seconds, answered)

    def _answered(self, question: int, asked: float, seconds: float, replies: Replies) -> None:
        """Take the last signal; ask again where there was no answer in time to the newest question: that says nothing.

        Else an output that has one thing to say would never be heard again by an input that has missed it. One that
        has none does not act, or has just begun to: what it had issued before was for a task of which it has let go.
        An answer that is too large for the bus ends the question before its time, and would be so again.
        """
        self._latched(replies)
        if self._heard_at >= asked or self._ended or replies.samples:
            return
        if replies.complete and self.muted:
            self._queue.keep(0)
        in_vain = not replies.complete and self._bus.now() - asked > seconds / 2
        if in_vain and self._lives and question == self._questions:
            self._ask(min(2 * seconds, LONGEST_ANSWER))

    def _latched(self, replies: Replies) -> None:
        for sample in () if self._ended else replies.samples:
            stamp = self._stamp_of(sample)
            if stamp is not None:
                self._order.said_again = SignalNumber(stamp.life, stamp.sequence)
            if not self._queue or (self.muted and stamp is not None and not self._has_come(stamp)):
                self._received(sample)

    def _has_come(self, stamp: Stamp) -> bool:
        """Whether a signal, or one that was issued after it, is the newest that waits."""
        waiting = self._queue.newest()
        newest = self._stamp_of(waiting) if waiting is not None else None
        return newest is not None and SignalNumber(newest.life, newest.sequence).covers(stamp)

    def _life_changed(self, key: str, alive: bool) -> None:
        if alive:
            self._lives.add(key)
            self._ask_if_lost()
            return
        self._lives.discard(key)
        if not self._lives or life_of(key) == self._heard_life:  # another process may be the component, and not act
            self._bus.later(0.0, partial(self._end_life, self._heard_at))

    def _end_life(self, heard: float) -> None:
        """The output is lost, unless a signal has come after that time; its component may be in sight again.

        Such a signal may have been on its way when that life ended, and be the last for ever.
        """
        self._lose(heard)
        if self._heard_at > heard:
            self._bus.later(UNSEEN, partial(self._look_for_sign, self._heard_at))
        if self._lives:
            self._ask_if_lost()

    def _ask_if_lost(self) -> None:
        """Ask an output that is in sight again for its last signal; one that promises a rate issues the next anyway."""
        if self.lost and self._wire.period is None:
            self._ask_for_last(ASK_FOR_LAST)

    def _look_for_life(self, began: float) -> None:
        """An output that promises no rate is lost as well if nothing shows that its component lives, or is in reach.

        Of one that has issued a signal that is the life which did: another process may be the component, and not act.
        """
        if self._ended or self._shows(self._heard_life):
            return
        if self._heard_at >= began:  # it may have been on its way when the component ended
            self._bus.later(UNSEEN, partial(self._look_for_sign, self._heard_at))
        elif not self._lives:
            self._lose(self._heard_at)

    def _shows(self, life: str) -> bool:
        """Whether a life of the component is seen to live."""
        return self._keys.life(self._wire.component, life) in self._lives

    @property
    def _heard_life(self) -> str:
        """The life that has issued the newest signal, which may still wait: the code may be busy, as in `started`."""
        waiting = self._queue.newest()
        stamp = self._stamp_of(waiting) if waiting is not None else None
        return self._order.newest.life if stamp is None else stamp.life

    def _look_for_sign(self, heard: float) -> None:
        """An output of which no life is seen, and that has issued a signal, as of some time, is lost without a sign.

        That is the life that has issued it, or another signal, and so on.
        """
        if self._ended or self.lost or self._shows(self._heard_life):
            return
        if self._heard_at > heard:
            self._bus.later(UNSEEN, partial(self._look_for_sign, self._heard_at))
        else:
            self._lose(heard)

    def _failed(self, sample: Sample) -> None:
        try:
            fail = decode(sample.payload, Fail)
        except PeerError:
            return
        if fail.component != self._wire.component or not fail.life or fail.cause is Cause.YIELD:
            return
        if fail.cause is Cause.LET_GO:
            self._look_whether_it_acts(fail)
            return
        last = self._order.over = SignalNumber(fail.life, fail.sequence)
        heard = self._heard_life
        # It may be that of another life, such as that of a process which was frozen, and goes on.
        is_anothers = fail.life != heard and self._shows(heard)
        if not (is_anothers or self._order.is_past(last)):  # past: it comes late, of a source that acts again
            self._lose(self._heard_at)

    def _look_whether_it_acts(self, fail: Fail) -> None:
        """The component has let go of a task: it may act for another one, and then it answers with its last signal.

        Or with an error, if it has issued none: a button that was never pressed is no lost source. But nothing that it
        issued before it was stopped, and started anew, is true any more.

        Until then no signal of before counts as one that has just come, and what comes later answers the question. The
        answer takes the place of what waits and was issued before it: that may have been for the task of before.
        """
        last = self._order.doubted = SignalNumber(fail.life, fail.sequence)

        def answered(replies: Replies) -> None:
            if self._ended or self._order.doubted != last:
                return
            if not replies.complete:
                self._look_whether_it_acts(fail)
                return
            self._order.doubted = None
            if self.muted:
                self._latched(replies)
            if not (replies.samples or (replies.errors and not self.issued)):
                self._order.over = last
                if self.muted:
                    self._queue.keep(0)
                self._be_lost()  # also where a signal has come meanwhile: it was on its way when the task was let go of

        self._bus.ask(self._keys.output(self._wire.component, self._wire.output), b"", LAST_SIGNAL, answered)

    def _lose(self, heard: float) -> None:
        """The output is lost, unless it has issued a signal after that time; one that stands by may act again later."""
        if self.lost or self._heard_at > heard:
            return
        self._queue.keep(0)  # before the input hears of it: what comes after that is news, and feeds it
        self._be_lost()

    def _be_lost(self) -> None:
        if not self.lost and not self.muted:
            self.lost, self._order.said_again = True, NONE
            self._report_lost(self._port)

    def _be_silent(self, seconds: float) -> None:
        """The output has not kept its promise."""
        self._events.silent(self._wire, seconds)
        self._lose(self._heard_at)
        self._silence.expect(first=self._order.newest is NONE)
