"""How one output takes over from another without a gap, if a call asks for that (`gently`).

An input goes on following the old output until the new one has issued a signal. A new output that is lost right after
its first signal has not taken over.

*Silence.* If the new output issues nothing in time although the old one does, it is reported as silent, again and again
while both are so; the configurator decides what becomes of that. If the old one has issued nothing in that time either,
and both live, the new one takes over: an output may have nothing to issue, such as that of a doorbell.

*Opening.* If such a call starts the component, the input has followed nothing before. Then it waits for the first
signal of an output that promises a rate: the component that is being replaced acts until then.
"""

from __future__ import annotations

from selfconf.model.immutable import immutable
from selfconf.protocol.messages import Wire
from selfconf.sdk.inputs.silence_watch import BEGINNING, PATIENCE

HANDOVER = 2.0
"""Seconds in which an output that an input is handed over to has to issue a signal: more where it promises one only in
`PATIENCE` longer periods, but not more than `BEGINNING`."""


@immutable
class Handover:
    """The change of an input to other outputs: it follows the old and the new until one of the new has issued a signal.

    An output that it follows before and afterwards is neither old nor new. An input that opens has no old ones. `due`
    is the next time at which new outputs that have issued nothing are reported, if the old ones issue or if they have
    promised a rate.
    """

    old: frozenset[Wire]
    new: tuple[Wire, ...]
    began: float
    due: float

    @classmethod
    def beginning(cls, now: float, old: frozenset[Wire], new: tuple[Wire, ...]) -> Handover:
        """Return a handover that begins now; one of the new outputs may take as long as the slowest promises."""
        seconds = max(HANDOVER, *(PATIENCE * (wire.period or 0.0) for wire in new))
        return cls(old, new, now, now + min(seconds, BEGINNING))

    @property
    def opens(self) -> bool:
        """Whether the input has followed nothing before."""
        return not self.old
