"""Which signals of one output are news to an input, by the lives of the component that issues them and their numbers.

A signal may come late or twice. It may come after the message that its source has failed or has let go of its task, for
urgent messages overtake signals. The last signal, which an input asks for, may have been delivered before.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from selfconf.protocol.messages import Stamp

LATE = 10_000
"""By how many signals one that is late can be behind the newest. One that is further behind is not late: the number of
the newest was none of its source's, and may not mute it."""


class SignalNumber(NamedTuple):
    """One signal of an output: the life of its component, and its number there, from 1 on."""

    life: str
    sequence: int

    def covers(self, stamp: Stamp | SignalNumber) -> bool:
        """Whether a signal is this one, or was issued before it by the same life."""
        return _covers(self, stamp)


def _covers(last: Stamp | SignalNumber, stamp: Stamp | SignalNumber) -> bool:
    return stamp.life == last.life and 0 <= last.sequence - stamp.sequence < LATE


NONE = SignalNumber("", 0)
"""No signal."""


class SignalOrder:
    """What an input knows of the order of an output's signals; several threads read it, and write a number at once."""

    def __init__(self) -> None:
        self.newest: Stamp | SignalNumber = NONE
        """The newest signal that was delivered, by its stamp as it was read."""
        self.over = NONE
        """The last signal of a source that has failed since, or has let go of its task: what comes late of those up to
        that is no sign that it issues, and the input stays unfed."""
        self.said_again = NONE
        """What the output has answered since it was lost, if anything: that counts also if it was delivered before."""
        self.doubted: SignalNumber | None = None
        """The last signal of a source that has let go of a task, until it has said whether it acts for another one, and
        while nothing newer has come."""

    @property
    def is_in_question(self) -> bool:
        """Whether a signal that comes may be over, or may settle a doubt."""
        return self.over is not NONE or self.doubted is not None

    def is_over(self, stamp: Stamp) -> bool:
        """Whether a signal was issued before its source failed, or let go of its task."""
        return self.over.covers(stamp)

    def is_past(self, last: SignalNumber) -> bool:
        """Whether something was delivered that its source has issued after a signal; number 0 says nothing of that."""
        return self.newest.life == last.life and 0 < last.sequence < self.newest.sequence

    def settle(self, stamp: Stamp, lives: Callable[[str], bool]) -> None:
        """Doubt the source no more if a signal is newer: of the life in doubt, or of another that `lives`."""
        doubted = self.doubted
        if doubted is not None:
            newer = stamp.sequence > doubted.sequence if stamp.life == doubted.life else lives(stamp.life)
            if newer:
                self.doubted = None

    def is_old(self, stamp: Stamp, lost: bool) -> bool:
        """Whether a signal is late, doubled, or a latched one that was issued again for another input.

        Of an output that is `lost` also what is over is old, and what it has said again is not.
        """
        if lost and (self.is_over(stamp) or (stamp.life, stamp.sequence) == self.said_again):
            return self.is_over(stamp)
        return _covers(self.newest, stamp)
