"""How one output takes over from another, where a call asks for that (`gently`): none is lost before the next delivers.

An input goes on following the old output until the new one has issued a signal, also where it follows others before and
afterwards. One that is lost right after its first has taken no place yet. A new output that issues nothing in time
while the old one does is reported as silent, and again as long as both is so; what becomes of that is for the
configurator to say. An output that has nothing to issue, such as a doorbell, looks like one that never will: where the
old one has issued nothing in that time either, and both live, the new one takes its place, and the input has lost
nothing.

*Opening.* Where such a call starts the component, an input has followed nothing before. Then it waits for the first
signal of an output that promises a rate, as what the component takes the place of goes on until then.
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

    What it goes on following is neither. There are no old ones where it opens. `due` is when it is looked next whether
    the new ones issue nothing although the old ones do, or although they promise a rate.
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
