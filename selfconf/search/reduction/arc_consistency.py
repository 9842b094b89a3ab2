"""Arc consistency: kinds that are in no solution leave, until nothing changes.

A kind that needs what no kind left gives is in no solution, nor is a kind whose variables could only have values that
some role cannot have. Each leaving is recorded with its cause, so that a refusal can tell how a role ran out of
candidates. Counting the givers of each need makes it linear in the number of needs and gifts of all kinds.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from selfconf.model.partition import ANY_VALUE
from selfconf.search.reduction.reduced_problem import InterchangeabilityClass, Removal


def consistent(
    kinds: Sequence[InterchangeabilityClass], needs: int, values: Sequence[int], required: Collection[int]
) -> tuple[set[int], list[Removal]]:
    """The kinds that are in no solution, by identity, and why, in the order in which they left.

    `required` are the roles that somebody must play; only they constrain the variables.
    """
    givers = [0] * needs
    needing: list[list[InterchangeabilityClass]] = [[] for _ in range(needs)]
    for kind in kinds:
        for need in kind.gives:
            givers[need] += 1
        for need in kind.needs:
            needing[need].append(kind)
    gone: set[int] = set()
    departures: list[Removal] = []
    waiting = [need for need in range(needs) if not givers[need]]
    while True:
        while waiting:
            need = waiting.pop()
            for kind in needing[need]:
                if id(kind) not in gone:
                    gone.add(id(kind))
                    departures.append(Removal(kind, need=need))
                    waiting += _leave(kind, givers)
        by_value = list(_valueless([kind for kind in kinds if id(kind) not in gone], values, required))
        if not by_value:
            return gone, departures
        for departure in by_value:
            if id(departure.kind) not in gone:
                gone.add(id(departure.kind))
                departures.append(departure)
                waiting += _leave(departure.kind, givers)


def _leave(kind: InterchangeabilityClass, givers: list[int]) -> Iterator[int]:
    for need in kind.gives:
        givers[need] -= 1
        if not givers[need]:
            yield need


def _valueless(
    kinds: Sequence[InterchangeabilityClass], values: Sequence[int], required: Collection[int]
) -> Iterator[Removal]:
    """The kinds that allow a variable only values that some role cannot have; none once a role has nobody left."""
    if not {kind.role for kind in kinds}.issuperset(required):
        return
    for number, common in enumerate(values):
        some = dict.fromkeys(required, 0)
        for kind in kinds:
            if kind.role in some:
                some[kind.role] |= kind.admits[number]
        for allowed in some.values():
            common &= allowed
        if common != ANY_VALUE:
            for kind in kinds:
                if not kind.admits[number] & common:
                    yield Removal(kind, variable=number)
