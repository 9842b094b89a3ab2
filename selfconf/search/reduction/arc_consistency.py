"""Arc consistency: interchangeability classes that are in no solution are removed, until nothing changes.

A class with a need that no class left supports is in no solution, nor is a class that admits only values of a variable
that some role cannot have. Each removal is recorded with its cause, so that a refusal can tell how a role ran out of
candidates. As in AC-4 (Mohr and Henderson 1986), each need counts its supports, so that the cost is linear in the
number of needs and supports of all classes.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence

from selfconf.model.partition import ANY_VALUE
from selfconf.search.reduction.reduced_problem import InterchangeabilityClass, Removal


def consistent(
    kinds: Sequence[InterchangeabilityClass], needs: int, values: Sequence[int], required: Collection[int]
) -> tuple[set[int], list[Removal]]:
    """Return the classes that are in no solution, by identity, and why, in the order of their removal.

    `required` are the roles that must be played; only they constrain the variables.
    """
    supports, needing = _counted(kinds, needs)
    removed: set[int] = set()
    removals: list[Removal] = []
    unsupported = [need for need in range(needs) if not supports[need]]
    while True:
        while unsupported:
            need = unsupported.pop()
            for kind in needing[need]:
                if id(kind) not in removed:
                    removed.add(id(kind))
                    removals.append(Removal(kind, need=need))
                    unsupported += _without_support_of(kind, supports)
        # Values come after needs: a pass over all classes for each variable costs more than following the counters.
        by_value = _valueless([kind for kind in kinds if id(kind) not in removed], values, required) if values else {}
        if not by_value:
            return removed, removals
        for removal in by_value.values():
            removed.add(id(removal.kind))
            removals.append(removal)
            unsupported += _without_support_of(removal.kind, supports)


def _counted(
    kinds: Sequence[InterchangeabilityClass], needs: int
) -> tuple[list[int], list[list[InterchangeabilityClass]]]:
    """Return for each need the number of classes that support it, and the classes that have it."""
    supports = [0] * needs
    needing: list[list[InterchangeabilityClass]] = [[] for _ in range(needs)]
    for kind in kinds:
        for need in kind.supports:
            supports[need] += 1
        for need in kind.needs:
            needing[need].append(kind)
    return supports, needing


def _without_support_of(kind: InterchangeabilityClass, supports: list[int]) -> Iterator[int]:
    """Count one support less for what a class supports, and yield the needs that have none left."""
    for need in kind.supports:
        supports[need] -= 1
        if not supports[need]:
            yield need


def _valueless(
    kinds: Sequence[InterchangeabilityClass], values: Sequence[int], required: Collection[int]
) -> dict[int, Removal]:
    """Return the classes, by identity, that admit only values of a variable that some role cannot have.

    None are returned once a required role has no class left: then there is no solution, and the cause is that role.
    """
    found: dict[int, Removal] = {}
    if not {kind.role for kind in kinds}.issuperset(required):
        return found
    for number, common in enumerate(values):
        by_role = dict.fromkeys(required, 0)
        for kind in kinds:
            if kind.role in by_role:
                by_role[kind.role] |= kind.admits[number]
        for allowed in by_role.values():
            common &= allowed
        if common != ANY_VALUE:
            for kind in kinds:
                if not kind.admits[number] & common:
                    # A class may fail on two variables; the first is its cause.
                    found.setdefault(id(kind), Removal(kind, variable=number))
    return found
