"""An input asks each output that it begins to follow for its last signal, whether or not others follow it.

It asks again, because the output may have nothing else to issue,

* when the output has stood by until now, unless it has just issued a signal;
* when the output was lost with the life of its component, and that is in sight again;
* when its own component has been at rest, and has passed over signals or forgotten them.

If neither an answer nor a signal comes in time although the component lives, it asks once more, and waits twice as long
for the answer.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from selfconf.bus.port import Bus, Replies
from selfconf.sdk.inputs.followed_output import FollowedOutput

BY_ITSELF = 0.02
"""Seconds for which an output that stood by is not asked for its last signal: one that is just being started issues its
first by itself, and who asks meanwhile takes its time."""
LAST_SIGNAL = 1.0
"""Seconds that an output may take to say its last signal; a later one comes by itself."""
LONGEST_ANSWER = 16.0
"""Seconds that the answer may take at most where questions were not answered in time, each with twice the time of the
one before: a signal that is large is longer on its way over a slow link, which new questions would but fill."""
ASK_FOR_LAST = (0.3, 1.0, 3.0)
"""Seconds after which an output that has issued nothing is asked once more: a question may be there before the output
has issued anything, and the signal before the subscription."""


class LastSignal:
    """The questions of an input for the last signal of one output, on the thread of the bus."""

    def __init__(self, bus: Bus, key: str, output: FollowedOutput) -> None:
        self._bus, self._key, self._output = bus, key, output
        self._questions = 0
        """How often it was asked for."""

    @property
    def asked(self) -> bool:
        """Whether it was ever asked for."""
        return self._questions > 0

    def request(self) -> None:
        """Ask now, and a few times more as long as the output has issued nothing."""
        self._request(ASK_FOR_LAST)

    def request_if_quiet(self) -> None:
        """Ask an output that has stood by, unless it issues something by itself in a moment."""
        self._bus.later(BY_ITSELF, partial(self._request_if_quiet, self._bus.now()))

    def ask(self, seconds: float = LAST_SIGNAL) -> None:
        """Ask once, and again if there is no answer in so many seconds."""
        self._questions += 1
        self.ask_once(partial(self._answered, self._questions, self._bus.now(), seconds), seconds)

    def ask_once(self, answered: Callable[[Replies], None], seconds: float = LAST_SIGNAL) -> None:
        """Ask once, and hand over the answer as it is."""
        self._bus.ask(self._key, b"", seconds, answered)

    def _request(self, again: tuple[float, ...]) -> None:
        if self._output.ended or (self._output.issued and again is not ASK_FOR_LAST):
            return
        self.ask()
        if again:
            self._bus.later(again[0], partial(self._request, again[1:]))

    def _request_if_quiet(self, since: float) -> None:
        if not self._output.muted and self._output.heard_at < since:
            self.request()

    def _answered(self, question: int, asked: float, seconds: float, replies: Replies) -> None:
        """Take the last signal; ask again where there was no answer in time to the newest question: that says nothing.

        Else an output that has one thing to say would never be heard again by an input that has missed it. One that
        has none does not act, or has just begun to: what it had issued before was for a task of which it has let go.
        An answer that is too large for the bus ends the question before its time, and would be so again.
        """
        output = self._output
        output.receive_again(replies)
        if output.heard_at >= asked or output.ended or replies.samples:
            return
        if replies.complete and output.muted:
            output.forget()
        in_vain = not replies.complete and self._bus.now() - asked > seconds / 2
        if in_vain and output.lives and question == self._questions:
            self.ask(min(2 * seconds, LONGEST_ANSWER))
