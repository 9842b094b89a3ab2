"""Whether an output that an input follows is lost, so that its last signal must not be taken for true any more.

It is lost when the life that has issued its newest signal has ended, when no life of its component is ever seen, or
when its component raises FAIL, or lets go of a task and acts for no other. A signal that comes afterwards may have been
on its way. It counts for a moment; the output stays lost unless a life is seen, or another signal comes, within it.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from selfconf.bus.port import Bus, Replies, Sample
from selfconf.errors import PeerError
from selfconf.protocol.codec import decode
from selfconf.protocol.keys import Keys, life_of
from selfconf.protocol.messages import Cause, Fail, Wire
from selfconf.sdk.inputs.followed_output import FollowedOutput
from selfconf.sdk.inputs.last_signal import LastSignal
from selfconf.sdk.inputs.signal_order import NONE, SignalNumber

UNSEEN = 1.0
"""Seconds until the component of an output has to have shown that it lives, unless the output issues something."""


class SourceWatch:
    """The lives and failures of the component of one output that an input follows, on the thread of the bus."""

    def __init__(
        self,
        bus: Bus,
        keys: Keys,
        wire: Wire,
        output: FollowedOutput,
        last_signal: LastSignal,
        lost: Callable[[], None],
    ) -> None:
        """`lost` is called when the output is lost."""
        self._bus, self._keys, self._wire, self._output = bus, keys, wire, output
        self._last_signal, self._report_lost = last_signal, lost

    def begin(self) -> list[Callable[[], None]]:
        """Watch from now on; return what ends it."""
        component = self._wire.component
        return [
            self._bus.watch(self._keys.lives(component), self._life_changed),
            self._bus.subscribe(self._keys.fail(component), self._failed),
        ]

    def expect_life(self) -> None:
        """An output that promises no rate is lost as well if nothing shows that its component lives, or is in reach.

        Of one that has issued a signal that is the life which did: another process may be the component, and not act.
        """
        self._bus.later(UNSEEN, partial(self._look_for_life, self._bus.now()))

    def expect_sign(self) -> None:
        """A signal has come, as of now, of a life that is not seen: a sign is to come that the output still acts."""
        self._bus.later(UNSEEN, partial(self._look_for_sign, self._output.heard_at))

    def lose(self, heard: float) -> None:
        """The output is lost, unless it has issued a signal after that time; one that stands by may act again later."""
        if self._output.lost or self._output.heard_at > heard:
            return
        self._output.forget()  # before the input hears of it: what comes after that is news, and feeds it
        self._be_lost()

    def _life_changed(self, key: str, alive: bool) -> None:
        life, lives = life_of(key), self._output.lives
        if alive:
            lives.add(life)
            self._ask_if_lost()
            return
        lives.discard(life)
        if not lives or life == self._output.heard_life:  # another process may be the component, and not act
            self._bus.later(0.0, partial(self._end_life, self._output.heard_at))

    def _end_life(self, heard: float) -> None:
        """The output is lost, unless a signal has come after that time; its component may be in sight again.

        Such a signal may have been on its way when that life ended, and be the last forever.
        """
        self.lose(heard)
        if self._output.heard_at > heard:
            self.expect_sign()
        if self._output.lives:
            self._ask_if_lost()

    def _ask_if_lost(self) -> None:
        """Ask an output that is in sight again for its last signal; one that promises a rate issues the next anyway."""
        if self._output.lost and self._wire.period is None:
            self._last_signal.request()

    def _look_for_life(self, began: float) -> None:
        output = self._output
        if output.ended or output.heard_life in output.lives:
            return
        if output.heard_at >= began:  # it may have been on its way when the component ended
            self.expect_sign()
        elif not output.lives:
            self.lose(output.heard_at)

    def _look_for_sign(self, heard: float) -> None:
        """An output of which no life is seen, and that has issued a signal, as of some time, is lost without a sign.

        That is the life that has issued it, or another signal, and so on.
        """
        output = self._output
        if output.ended or output.lost or output.heard_life in output.lives:
            return
        if output.heard_at > heard:
            self.expect_sign()
        else:
            self.lose(heard)

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
        output = self._output
        last = output.order.over = SignalNumber(fail.life, fail.sequence)
        heard = output.heard_life
        # It may be that of another life, such as that of a process which was frozen, and goes on.
        is_anothers = fail.life != heard and heard in output.lives
        if not (is_anothers or output.order.is_past(last)):  # past: it comes late, of a source that acts again
            self.lose(output.heard_at)

    def _look_whether_it_acts(self, fail: Fail) -> None:
        """The component has let go of a task: it may act for another one, and then it answers with its last signal.

        Or with an error, if it has issued none: a button that was never pressed is no lost source. But nothing that it
        issued before it was stopped, and started anew, is true any more.

        Until then no signal of before counts as one that has just come, and what comes later answers the question. The
        answer takes the place of what waits and was issued before it: that may have been for the task of before.
        """
        output = self._output
        last = output.order.doubted = SignalNumber(fail.life, fail.sequence)

        def answered(replies: Replies) -> None:
            if output.ended or output.order.doubted != last:
                return
            if not replies.complete:
                self._look_whether_it_acts(fail)
                return
            output.order.doubted = None
            if output.muted:
                output.receive_again(replies)
            if not (replies.samples or (replies.errors and not output.issued)):
                output.order.over = last
                if output.muted:
                    output.forget()
                self._be_lost()  # also where a signal has come meanwhile: it was on its way when the task was let go of

        self._last_signal.ask_once(answered)

    def _be_lost(self) -> None:
        if not self._output.lost and not self._output.muted:
            self._output.lost, self._output.order.said_again = True, NONE
            self._report_lost()
