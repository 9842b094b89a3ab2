"""What follows from groups of options of which at most one can play, by counting them.

Let each option of some roles be in one group. The slots of these roles then draw on the groups as on components: if
they have fewer groups than slots between them, there is no solution (Hall's theorem); an option whose group is in no
matching is in no solution; and if they have exactly as many, each of these groups is played. That is what neither
clause learning nor depth-first search sees in less than exponential time (pigeonholes, Latin squares). Nothing here
depends on the order of options: what is removed or added is false or true of every solution.

An option of a role may also be in several groups, as a domino is in those of two fields. Each slot of a role then takes
as many groups as the options of the role are in at least; all slots together take no more than there are; and if they
take exactly as many, each group is played, and no option that is in more. The same is counted of sets of groups that
options meet several times over (`odd_sets`).

*Which groups.* From a group, its roles; then the group, disjoint from those before, that has options not covered yet in
the most of these roles, which may bring in further roles; until all their options are covered, or there are more groups
than slots, or are going to be: an option has an equal part in the slots of its role, so that no more groups than slots
need a slot each between their options, on average.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain

from selfconf.model.immutable import immutable
from selfconf.search.engines.conflict_graph import ConflictGraph, mask_of, numbers_of
from selfconf.search.engines.matching import HallSet, unmatchable
from selfconf.search.engines.odd_sets import odd_sets

SHARES_PER_OPTION = 2
"""How many groups are put together at most, for each option, before counting ends."""
ENOUGH = 1 - 1e-9
"""A share of one slot, but for rounding."""
SPREAD = 4
"""For each slot of the roles of the group from which it began how many groups are put together at most."""


@immutable
class ExclusiveGroups:
    """Groups of options by their numbers, counted through all roles, and what follows from them."""

    groups: Sequence[Sequence[int]] = ()
    stated: frozenset[int] = frozenset()
    """The needs of which the groups say all."""
    settled: frozenset[int] = frozenset()
    """The variables of whose values the groups say all."""
    played: Sequence[Sequence[int]] = ()
    """Sets of options of which at least one plays in every solution."""
    excluded: frozenset[int] = frozenset()
    """Options that play in no solution."""
    crowded: frozenset[int] = frozenset()
    """Roles that have fewer groups than slots, if there are any: then there is no solution."""
    uncounted: GroupCounting | None = None
    """What has not been counted yet, if counting was left."""

    @property
    def impossible(self) -> bool:
        """Whether there is no solution, by counting."""
        return bool(self.crowded)

    def all_counted(self) -> ExclusiveGroups:
        """Return the same groups, and what follows from them once all that was left is counted."""
        return self if self.uncounted is None else self.uncounted.counted(self.groups)


class GroupCounting:
    """Looks for roles whose slots have no more groups than they need."""

    def __init__(self, graph: ConflictGraph, groups: Sequence[Sequence[int]]) -> None:
        self.graph = graph
        self.groups: list[int] = []
        """The groups of which more than two slots could have an option, as masks."""
        self.roles: list[frozenset[int]] = []
        """The roles of each of these."""
        self.having: list[list[int]] = [[] for _ in graph.options]
        """For each option the groups that have it."""
        self.weights: list[float] = []
        """The share of each of these in the slots: an option has an equal part in the slots of its role."""
        part = [graph.asked[role] / graph.of_role[role].bit_count() for role in graph.role]
        weights = [sum([part[option] for option in members]) for members in groups]
        self.part = part
        """The part of each option in the slots of its role."""
        self.several = [role for role, slots in graph.asked.items() if slots > 1 and graph.of_role[role]]
        """The roles of several slots that have options."""
        if self.several or max(weights, default=0) >= ENOUGH:
            for members, weight in zip(groups, weights, strict=True):
                self._add(members, weight)
        self.gain = sum([weight - 1 for weight in self.weights if weight > 1])
        """By how much all groups that have more than one slot between them have more."""
        self.left = SHARES_PER_OPTION * len(graph.options)
        """How many groups may still be put together."""
        # Of no more groups than slots, one at least has a share of one slot or more.
        self.starts = [number for number, weight in enumerate(self.weights) if weight >= ENOUGH]
        """From which groups counting has still to begin, the first one last."""
        self.starts.sort(key=lambda number: (len(self.roles[number]), -number))
        self._known: set[int] = set()
        self.played: list[int] = []
        self.excluded = 0
        self.crowded: frozenset[int] = frozenset()

    def _add(self, members: Sequence[int], weight: float) -> None:
        """Count a group if more than two slots could have an option of it."""
        graph = self.graph
        roles = frozenset([graph.role[option] for option in members])
        if sum([graph.asked[role] for role in roles]) > 2:
            for option in members:
                self.having[option].append(len(self.groups))
            self.groups.append(mask_of(members))
            self.roles.append(roles)
            self.weights.append(weight)

    def _roles(self, mask: int) -> Iterator[int]:
        return (self.graph.role[number] for number in numbers_of(mask))

    def counted(self, groups: Sequence[Sequence[int]], patience: int | None = None) -> ExclusiveGroups:
        """Count, and return the groups with what follows from them by now."""
        begins = not self._known
        if begins:
            self._count_at_once()
        self._run(patience)
        if begins and not self.crowded:
            self._count_odd_sets()
        return ExclusiveGroups(
            groups,
            frozenset(self.graph.stated),
            self.graph.settled,
            [list(numbers_of(group)) for group in self.played],
            frozenset(numbers_of(self.excluded)),
            self.crowded,
            self if self.starts and self.left > 0 and not self.crowded else None,
        )

    def _run(self, patience: int | None) -> None:
        """Count from one group after the other, the largest first, but for those that were put together before.

        These are played for sure by then; or they were left with others that go with them, and mostly would be again.
        """
        while self.starts and not self.crowded and self.left > 0 and patience != 0:
            start = self.starts.pop()
            if start in self._known:
                continue
            shares: dict[int, int] = {}
            if self._cover(start, shares):
                self._count(shares)
            self._known |= shares.keys()
            if patience is not None:
                patience = None if self.played or self.excluded else patience - 1

    def _count_at_once(self) -> None:
        """Count the groups that all slots of a role take between them, whose options are in several groups each."""
        graph = self.graph
        for role in self.several:
            taken = {number: len(self.having[number]) for number in numbers_of(graph.of_role[role])}
            least = min(taken.values())
            if least < 2:
                continue
            met = {group for number in taken for group in self.having[number]}
            spare = len(met) - least * graph.asked[role]
            if spare < 0:
                self.crowded = frozenset((role,))
                return
            self.excluded |= mask_of([number for number, groups in taken.items() if groups > least + spare])
            if not spare:
                self.played += [self.groups[group] & graph.of_role[role] for group in sorted(met)]
                for group in met:
                    self.excluded |= self.groups[group] & ~graph.of_role[role]

    def _count_odd_sets(self) -> None:
        """Count how many options play at most, by sets of groups, where slots take several groups each."""
        graph = self.graph
        several = [
            role
            for role in self.several
            if all(len(self.having[number]) > 1 for number in numbers_of(graph.of_role[role]))
        ]
        if not several:
            return
        sets = odd_sets([list(numbers_of(group)) for group in self.groups], self.having)
        in_sets = Counter(chain.from_iterable(sets))
        for role in several:
            least = min(in_sets[number] for number in numbers_of(graph.of_role[role]))
            if sum(sets.values()) < least * graph.asked[role]:
                self.crowded = frozenset((role,))

    def _cover(self, start: int, shares: dict[int, int]) -> bool:
        """Put together groups, by number, with disjoint shares of them, until these cover all options of their roles.

        Return whether they do, or are left as they would be too many.
        """
        graph = self.graph
        roles: set[int] = set()
        covered = wanted = slots = beside = 0
        surplus, gain = 0.0, self.gain
        best: int | None = start
        while best is not None:
            self.left -= 1
            share = self.groups[best] & ~covered
            shares[best] = share
            covered |= share
            whole = share == self.groups[best]
            # Shares that cover all have as many slots between them as there are, so that for no more groups than slots
            # they need one each, on average; none can have more than its group.
            gain -= max(0.0, self.weights[best] - 1)
            surplus += (self.weights[best] if whole else sum([self.part[option] for option in numbers_of(share)])) - 1
            if surplus + gain < ENOUGH - 1:
                return False
            for role in self.roles[best] - roles if whole else set(self._roles(share)) - roles:
                roles.add(role)
                wanted |= graph.of_role[role]
                slots += graph.asked[role]
            left = wanted & ~covered
            if not left:
                return True
            if len(shares) > min(slots, SPREAD * (8 + sum([graph.asked[role] for role in self.roles[start]]))):
                return False
            beside |= self._beside(share)
            best = self._next(left & beside or left, left, covered)
        return False

    def _beside(self, share: int) -> int:
        """Return the options that are in groups with options of a share, where roles have several slots.

        There all options are of few roles, and groups that have next to nothing to do with each other would be put
        together: fields of both colours of a board that dominoes cover.
        """
        beside = 0
        for number in numbers_of(share) if self.several else ():
            for group in self.having[number]:
                beside |= self.groups[group]
        return beside

    def _next(self, first: int, left: int, covered: int) -> int | None:
        """Return the group with the lowest of the first options that has the most of those left, rather a disjoint one.

        None if that option is in no group.
        """
        lowest = (first & -first).bit_length() - 1
        found, most = None, -1
        whole = left.bit_count() + 1
        for number in self.having[lowest]:
            group = self.groups[number]
            fits = (group & left).bit_count() + (0 if group & covered else whole)
            if fits > most:
                found, most = number, fits
        return found

    def _count(self, shares: dict[int, int]) -> None:
        """Match the slots of the roles with the groups that cover their options."""
        graph = self.graph
        group_of = {number: name for name, share in shares.items() for number in numbers_of(share)}
        roles = sorted({graph.role[number] for number in group_of})
        drawn = {role: sorted({group_of[number] for number in numbers_of(graph.of_role[role])}) for role in roles}
        slots = [role for role in roles for _ in range(graph.asked[role])]
        found = unmatchable(slots, [drawn.get(role, []) for role in range(len(graph.of_role))])
        if isinstance(found, HallSet):
            self.crowded = frozenset(found.roles)
            return
        for role, name in found:
            self.excluded |= shares[name] & graph.of_role[role]
        if len(slots) == len(shares):
            self.played += shares.values()
