"""What interactions ask of the ports of a role: what the roles that it feeds lack, and what it is given itself.

It depends on the players of the other roles, so that there are several *ways*: one for each choice of ports that their
candidates have. Of an input that other roles could feed as well nothing is asked.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import islice, product

from selfconf.model.port_likeness import Types, WantedPorts
from selfconf.search.problem import Problem

CHOICES_OF_PORTS = 16
"""How many choices of ports are looked at for each other role."""
WAYS = 64
"""How many ways are looked at in all."""


def ways_along_interactions(problem: Problem, role: int) -> list[WantedPorts]:
    """Return the ways in which interactions ask for ports of a role, by number; none if they ask for no output."""
    wanted = [choices for sink in problem.sinks[role] if (choices := list(_lacking(problem, sink, role)))]
    given = [choices for source in problem.sources[role] if (choices := list(_issued(problem, source)))]
    if not wanted:
        return []
    ways = product(_joined(wanted), _joined(given) if given else [None])
    return [WantedPorts(issued, taken) for issued, taken in islice(ways, WAYS)]


def _joined(choices: Sequence[Sequence[tuple[Types, ...]]]) -> Iterator[tuple[Types, ...]]:
    """Yield what several roles ask for together, one choice of each."""
    return islice((tuple(one for some in way for one in some) for way in product(*choices)), WAYS)


def _lacking(problem: Problem, sink: int, role: int) -> Iterator[tuple[Types, ...]]:
    """Yield for the candidates of a sink what its inputs want of a role, as no other role issues it."""
    links = [link for link in problem.links[sink] if link.source == role]
    others = [problem.served(source) for source in problem.sources[sink] if source != role]
    return _distinct(
        tuple(
            port.signals
            for port in candidate.profile.required
            if any(link.input in (None, port.name) for link in links)
            and all(served.isdisjoint(port.signals) for served in others)
        )
        for candidate in problem.candidates[sink]
    )


def _issued(problem: Problem, source: int) -> Iterator[tuple[Types, ...]]:
    """Yield what the candidates of a source issue."""
    return _distinct(
        tuple(port.signals for port in candidate.profile.outputs) for candidate in problem.candidates[source]
    )


def _distinct(choices: Iterable[tuple[Types, ...]]) -> Iterator[tuple[Types, ...]]:
    """Yield the first choices that are not empty, each once."""
    return islice(dict.fromkeys(some for some in choices if some), CHOICES_OF_PORTS)
