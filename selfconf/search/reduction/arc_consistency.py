"""Arc consistency: interchangeability classes that are in no solution are removed, until nothing changes.

A class with a need that no class left supports is in no solution, nor is a class that admits only values of a variable
that some role cannot have. Each removal is recorded with its cause, so that a refusal can tell how a role ran out of
candidates. As in AC-4 (Mohr and Henderson 1986), each need counts its supports, so that the cost is linear in the
number of needs and supports of all classes.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Sequence, Set
from functools import cached_property, reduce
from operator import or_

from selfconf.model.partition import ANY_VALUE
from selfconf.search.reduction.reduced_problem import InterchangeabilityClass, Removal


def consistent(
    kinds: Sequence[InterchangeabilityClass], needs: int, values: Sequence[int], required: Collection[int]
) -> tuple[set[int], list[Removal]]:
    """Return the classes that are in no solution, by identity, and why, in the order of their removal.

    `required` are the roles that must be played; only they constrain the variables.
    """
    return ArcConsistency(kinds, needs, values, required).without(())


class ArcConsistency:
    """Arc consistency of some classes, from which others may be taken out on trial: supports are counted but once.

    The arguments are those of `consistent`.
    """

    def __init__(
        self, kinds: Sequence[InterchangeabilityClass], needs: int, values: Sequence[int], required: Collection[int]
    ) -> None:
        self._kinds, self._needs, self._values, self._required = kinds, needs, values, required
        supported = set[int]().union(*[kind.supports for kind in kinds])
        self._unsupported = [need for need in range(needs) if need not in supported] if len(supported) < needs else []

    # Where nothing is removed, as mostly, nothing has to be counted.
    @cached_property
    def _supports(self) -> list[int]:
        """For each need the number of classes that support it."""
        supports = [0] * self._needs
        for kind in self._kinds:
            for need in kind.supports:
                supports[need] += 1
        return supports

    @cached_property
    def _needing(self) -> list[list[InterchangeabilityClass]]:
        """For each need the classes that have it."""
        needing: list[list[InterchangeabilityClass]] = [[] for _ in range(self._needs)]
        for kind in self._kinds:
            for need in kind.needs:
                needing[need].append(kind)
        return needing

    def without(self, taken: Iterable[InterchangeabilityClass]) -> tuple[set[int], list[Removal]]:
        """Return the classes that are in no solution without some others; by identity, with these, and why."""
        supports: list[int] = []
        unsupported = self._unsupported.copy()
        removed: set[int] = set()
        removals: list[Removal] = []

        def remove(kind: InterchangeabilityClass) -> None:
            nonlocal supports
            supports = supports or self._supports.copy()
            removed.add(id(kind))
            for need in kind.supports:
                supports[need] -= 1
                if not supports[need]:
                    unsupported.append(need)

        for kind in taken:
            remove(kind)
        admitted = _Admitted(self._kinds, self._values, self._required) if self._values else None
        roles: set[int] = set(self._required)
        while True:
            while unsupported:
                need = unsupported.pop()
                for kind in self._needing[need]:
                    if id(kind) not in removed:
                        removals.append(Removal(kind, need=need))
                        roles.add(kind.role)
                        remove(kind)
            # Values come after needs: a pass over all classes for each variable costs more than following the counters.
            by_value = admitted.valueless(removed, roles) if admitted else {}
            if not by_value:
                return removed, removals
            roles.clear()
            for removal in by_value.values():
                removals.append(removal)
                roles.add(removal.kind.role)
                remove(removal.kind)


class _Admitted:
    """The values that are left to the variables, as classes are removed."""

    def __init__(
        self, kinds: Sequence[InterchangeabilityClass], values: Sequence[int], required: Collection[int]
    ) -> None:
        self.values = list(values)
        self._narrowed = {number for number, common in enumerate(values) if common != ANY_VALUE}
        """The variables that have lost values since it was last asked about them."""
        self._of_role: dict[int, list[InterchangeabilityClass]] = {role: [] for role in sorted(required)}
        self._optional: list[InterchangeabilityClass] = []
        """The classes of roles that need not be played."""
        for kind in kinds:
            self._of_role.get(kind.role, self._optional).append(kind)
        self._constraining: list[dict[int, list[InterchangeabilityClass]]] = [{} for _ in values]
        """For each variable the classes that do not admit all values, by required role; some may be removed by now."""

    def valueless(self, removed: Set[int], roles: Iterable[int]) -> dict[int, Removal]:
        """Return the classes left, by identity, that admit only values of a variable that some role cannot have.

        Only `roles` have lost classes since it was last asked about them, all of them being asked about at first. None
        are returned once a required role has no class left: then there is no solution, and the cause is that role.
        """
        self._narrow(removed, roles)
        found: dict[int, Removal] = {}
        if not all(self._of_role.values()):
            return found
        self._optional = [kind for kind in self._optional if id(kind) not in removed]
        for number in sorted(self._narrowed):
            common = self.values[number]
            concerned = self._constraining[number] if common else self._of_role
            for some in (*concerned.values(), self._optional):
                for kind in [kind for kind in some if not kind.admits.get(number, ANY_VALUE) & common]:
                    if id(kind) not in removed:
                        # A class may fail on two variables; the first is its cause.
                        found.setdefault(id(kind), Removal(kind, variable=number))
        self._narrowed.clear()
        return found

    def _narrow(self, removed: Set[int], roles: Iterable[int]) -> None:
        """Take from the variables the values that the classes left of some roles do not admit."""
        for role in sorted(self._of_role.keys() & roles):
            left = self._of_role[role] = [kind for kind in self._of_role[role] if id(kind) not in removed]
            constraining: defaultdict[int, list[InterchangeabilityClass]] = defaultdict(list)
            for kind in left:
                for number in kind.admits:
                    constraining[number].append(kind)
            for number, some in constraining.items():
                self._constraining[number][role] = some
                if len(some) < len(left):
                    continue  # some class admits any value
                common = self.values[number] & reduce(or_, [kind.admits[number] for kind in some])
                if common != self.values[number]:
                    self.values[number] = common
                    self._narrowed.add(number)
