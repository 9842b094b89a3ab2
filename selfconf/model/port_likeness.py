"""How near the ports of a component come to those that are wanted: an assignment of signals, and their likeness.

Each wanted signal is paired with at most one that is offered, the most alike first (a greedy matching, at least half as
good as the best one); but what is offered as it is wanted, or serves for it in the reasoning mode, serves all that want
it, as an output feeds many inputs.
Outputs and inputs count alike, as in LOG4SWS (Schulte et al., 2010): of the outputs, how well what is wanted is issued;
of the inputs, how well what the component requires is given. Ports that are left over on the offering side do no harm,
and count against it a little: the nearest is what is wanted and nothing else.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.obstacle import UnlikePorts
from selfconf.model.profile import Ports
from selfconf.model.signal_likeness import SignalLikeness, SignalMatch
from selfconf.model.term import IRI

Types = tuple[IRI, ...]
"""The signal types of a port: an output is of all of them, an input takes any one."""
SPARE = 0.2
"""What a port that is left over weighs, beside 1 of one that is wanted."""


class WantedPorts(NamedTuple):
    """What is wanted of the ports of a component: `issued` by its outputs, and `given` to its inputs.

    None where nothing is known of that side, which then does not count.
    """

    issued: tuple[Types, ...] | None = None
    given: tuple[Types, ...] | None = None


class PortLikeness:
    """How near ports come to those that are wanted, in one of several ways; what was worked out is remembered."""

    def __init__(self, ways: Iterable[WantedPorts], signals: SignalLikeness, seen: Hierarchy = NOTHING_ABOVE) -> None:
        """`seen` is the hierarchy by which signals match in the reasoning mode."""
        self._ways, self._signals, self._seen = tuple(dict.fromkeys(ways)), signals, seen
        self._known: dict[tuple[tuple[Types, ...], tuple[Types, ...]], tuple[float, UnlikePorts]] = {}
        self.compared = 0
        """How many pairs of ports have been compared, which takes two microseconds each."""

    def of(self, ports: Ports) -> tuple[float, UnlikePorts]:
        """How near ports come, from 0 to 1, and what they lack."""
        key = tuple(port.signals for port in ports.outputs), tuple(p.signals for p in ports.inputs if not p.optional)
        if key not in self._known:
            self._known[key] = max((self._compared(*key, way) for way in self._ways), key=lambda found: found[0])
        return self._known[key]

    def _compared(
        self, outputs: tuple[Types, ...], inputs: tuple[Types, ...], way: WantedPorts
    ) -> tuple[float, UnlikePorts]:
        issued: tuple[SignalMatch, ...] = ()
        given: tuple[SignalMatch, ...] = ()
        parts: list[float] = []
        if way.issued is not None:
            issued = self._assigned(outputs, way.issued)
            parts.append(_share(issued, len(outputs)))
        if way.given is not None:
            given = self._assigned(way.given, inputs)
            parts.append(_share(given, len(way.given)))
        return sum(parts) / len(parts), UnlikePorts(issued, given)

    def _assigned(self, offered: Sequence[Types], wanted: Sequence[Types]) -> tuple[SignalMatch, ...]:
        """For each wanted signal the offered one that it is paired with."""
        self.compared += len(offered) * len(wanted)
        pairs = sorted(
            (-match.likeness, at, number, match)
            for at, types in enumerate(wanted)
            for number, some in enumerate(offered)
            if (match := self._signals.nearest(some, types)).likeness
        )
        found: dict[int, SignalMatch] = {}
        taken: set[int] = set()
        for _, at, number, match in pairs:
            if at not in found and (number not in taken or self.serves(match)):
                found[at] = match
                taken.add(number)
        return tuple(found.get(at) or self._signals.nearest((), types) for at, types in enumerate(wanted))

    def serves(self, match: SignalMatch) -> bool:
        """Whether what is offered serves as what is wanted."""
        if match.exact or match.offered is None or match.wanted is None:
            return match.exact
        return self._seen.matches(match.offered, match.wanted)


def _share(matches: Sequence[SignalMatch], offered: int) -> float:
    """How well signals are matched: the mean of their likeness, a little less for each offered one left over."""
    spare = max(0, offered - len(matches))
    if not matches:
        return 1 / (1 + SPARE * spare)
    return sum(match.likeness for match in matches) / (len(matches) + SPARE * spare)
