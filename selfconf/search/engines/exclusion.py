"""Groups of options of which at most one can play, read off needs and values; and what counting says about them.

*Conflicts.* Where a need can be fed by one role alone, which has one slot, an option with the need excludes the options
of that role which do not support it. So do two options that are one component, and two of a role that has one slot. A
*group* is a set of options that exclude each other pairwise (a clique of the graph of conflicts): "no two share a
frequency" may be wired by port names, pair by pair, and is a group for each frequency in the end. Groups are
grown greedily until each conflict that is counted here is in one of them, so that they say all that these needs say;
one constraint with many options propagates like all of its pairs, in a fraction of the space.
Where each role that constrains a free parameter admits other values of it than all other roles, the options that
constrain it are a group too: "who has the room at nine" lets one lecture have it.

*Counting.* Let each option of some roles be in one group. The slots of these roles then draw on the groups as on
components: if they have fewer groups than slots between them, there is no solution (Hall's theorem); an option whose
group is in no matching is in no solution; and if they have exactly as many, each of these groups is played. That is
what neither clause learning nor depth-first search sees in less than exponential time (pigeonholes, Latin squares).
Where nothing but components exclude each other, the groups are the components, and matching has counted all but this.
Nothing here depends on the order of options: what is removed or added is false or true of every solution.

*Which groups.* From a group, its roles; then the group, disjoint from those before, that has options not covered yet in
the most of these roles, which may bring in further roles; until all their options are covered, or there are more groups
than slots, or are going to be: an option has an equal part in the slots of its role, so that no more groups than slots
need a slot each between their options, on average.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import reduce
from itertools import accumulate, chain, pairwise
from operator import or_

from selfconf.model.immutable import immutable
from selfconf.model.partition import ANY_VALUE
from selfconf.model.term import IRI
from selfconf.search.engines.matching import HallSet, unmatchable
from selfconf.search.reduction import NeedScope, Option, ReducedProblem

SHARE_UNFIT = 2
"""A need says little if at most one in this number of the options that could feed it do not."""
SHARE_FED_BY_ONE = 8
"""One in this number of the needs at least has to be fed by one role alone, or they are not looked at."""
SHARE_APART = 2
"""The first options of roles have to differ in one in this number of the variables, or values are not looked at."""
CONFLICTS_PER_OPTION = 200
"""How many conflicts are looked at, for each option."""
SHARES_PER_OPTION = 2
"""How many groups are put together at most, for each option, before counting ends."""
ENOUGH = 1 - 1e-9
"""A share of one slot, but for rounding."""
SPREAD = 4
"""For each role of the group from which it began how many groups are put together at most."""


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
    uncounted: _Counting | None = None
    """What has not been counted yet, if counting was left."""

    @property
    def impossible(self) -> bool:
        """Whether there is no solution, by counting."""
        return bool(self.crowded)

    def all_counted(self) -> ExclusiveGroups:
        """Return the same groups, and what follows from them once all that was left is counted."""
        return self if self.uncounted is None else self.uncounted.counted(self.groups)


def exclusive_groups(reduced: ReducedProblem, distinct: bool = True, patience: int | None = None) -> ExclusiveGroups:
    """Return the groups of a reduced problem, and what counting them proves.

    If components need not be distinct, one component in two roles is no conflict. With patience, counting is left after
    so many groups from which nothing followed, if nothing has followed from any; `all_counted` then goes on.
    """
    needs = _fed_by_one(reduced)
    names = [option.component for options in reduced.options for option in options if option.component]
    shared = distinct and len(set(names)) < len(names)
    of_values = _groups_of_values(reduced)
    by_values = [some for some in of_values.values() if some]
    if not needs and not shared and not by_values:
        return ExclusiveGroups()
    graph = _Conflicts(reduced, needs)
    if not by_values and not any(graph.across):
        of_components = _groups_of_components(reduced) if shared else ExclusiveGroups()
        return replace(of_components, stated=frozenset(graph.stated))
    if shared:
        graph.add_components()
    graph.settled = frozenset(of_values)
    groups = [*by_values, *graph.groups()]
    return _Counting(graph, groups).counted(groups, patience)


def _groups_of_values(reduced: ReducedProblem) -> dict[int, list[int]]:
    """Return by variable the options that constrain it, where no value of it suits two roles, each of one slot.

    As each option has some value, that one of them plays at most is all that the variable says; where they are of one
    role that is nothing, and no options are returned.
    """
    if not _often_apart(reduced):
        return {}
    asked = Counter(reduced.slots)
    found: dict[int, list[int]] = {}
    for variable, some in enumerate(reduced.constraining()):
        admitted: dict[int, int] = {}
        for role, _, mask in some:
            admitted[role] = admitted.get(role, 0) | mask
        if (
            _disjoint(admitted.values())
            and all(asked[role] == 1 for role in admitted)
            and all(mask > 0 for _, _, mask in some)
        ):
            found[variable] = [number for _, number, _ in some] if len(admitted) > 1 else []
    return found


def _often_apart(reduced: ReducedProblem) -> bool:
    """Return whether the first options of the roles that constrain a variable mostly admit other values of it each."""
    firsts = zip(*[options[0].kind.admits for options in reduced.options if options], strict=True)
    apart = [_disjoint(masks) for masks in firsts if masks.count(ANY_VALUE) + 1 < len(masks)]
    return bool(apart) and SHARE_APART * sum(apart) >= len(apart)


def _disjoint(masks: Iterable[int]) -> bool:
    """Return whether no value is in two of some masks, but for those that have all values."""
    some = [mask for mask in masks if mask != ANY_VALUE]
    return reduce(or_, some, 0).bit_count() == sum([mask.bit_count() for mask in some])


def _groups_of_components(reduced: ReducedProblem) -> ExclusiveGroups:
    """Return the groups where only components exclude each other: one for each that several roles share.

    Counting then means components: where some roles share no component with any other, and have as many as slots.
    """
    same: dict[IRI, list[int]] = {}
    roles_of: dict[IRI, list[int]] = {}
    for number, option in enumerate(chain.from_iterable(reduced.options)):
        if option.component:
            same.setdefault(option.component, []).append(number)
            roles_of.setdefault(option.component, []).append(option.kind.role)
    groups = [some for some in same.values() if len(some) > 1]
    if not groups:
        return ExclusiveGroups()
    asked = Counter(reduced.slots)
    played: list[list[int]] = []
    for roles, components in _connected(roles_of):
        slots = sum(asked[role] for role in roles)
        options = sum(len(reduced.options[role]) for role in roles)
        if slots < len(components) or options > sum(len(same[component]) for component in components):
            continue
        if slots > len(components):
            return ExclusiveGroups(groups, crowded=frozenset(roles))
        if len(roles) > 1:
            played += [same[component] for component in components]
    return ExclusiveGroups(groups, played=played)


def _connected(roles_of: Mapping[IRI, Sequence[int]]) -> Iterator[tuple[set[int], list[IRI]]]:
    """Yield sets of roles that share components among themselves alone, given those of each, with these components."""
    having: dict[int, list[IRI]] = {}
    for component, roles in roles_of.items():
        for role in roles:
            having.setdefault(role, []).append(component)
    met: set[int] = set()
    for start in having:
        if start in met:
            continue
        found, waiting, components = {start}, [start], dict[IRI, None]()
        while waiting:
            for component in having[waiting.pop()]:
                if component not in components:
                    components[component] = None
                    waiting += set(roles_of[component]) - found
                    found.update(roles_of[component])
        met |= found
        yield found, list(components)


def _fed_by_one(reduced: ReducedProblem) -> dict[int, set[int]]:
    """Return for each role with one slot the needs of other roles that it alone can feed, if these are many."""
    scopes = reduced.needs.scopes
    asked = Counter(reduced.slots)
    alone: dict[NeedScope, int] = {}
    for scope in dict.fromkeys(scopes):
        role, *others = [source.role for source in scope.sources] or [scope.role]
        if role != scope.role and asked[role] == 1 and others.count(role) == len(others):
            alone[scope] = role
    if not alone:
        return {}
    found: defaultdict[int, set[int]] = defaultdict(set)
    used = set[int]().union(*[option.kind.needs for options in reduced.options for option in options])
    for number in used:
        if scopes[number] in alone:
            found[alone[scopes[number]]].add(number)
    return found if sum(map(len, found.values())) * SHARE_FED_BY_ONE >= len(used) else {}


class _Conflicts:
    """The graph of conflicts between options; sets of options are masks."""

    def __init__(self, reduced: ReducedProblem, needs: Mapping[int, set[int]]) -> None:
        self.reduced = reduced
        self.options: list[Option] = [option for options in reduced.options for option in options]
        self.asked = Counter(reduced.slots)
        self.role = [option.kind.role for option in self.options]
        self.start = [0, *accumulate(map(len, reduced.options))]
        """The number of the first option of each role, and of all."""
        self.of_role = [(1 << end) - (1 << start) for start, end in pairwise(self.start)]
        self.across = [0] * len(self.options)
        """For each option the options of other roles that it excludes."""
        self.stated: set[int] = set()
        self.settled = frozenset[int]()
        """The variables of whose values groups say all, beside the conflicts of this graph."""
        if needs:
            self._by_needs(needs)

    def _by_needs(self, fed_by: Mapping[int, set[int]]) -> None:
        fed_by = {source: often for source, needs in fed_by.items() if (often := self._often_supported(source, needs))}
        having = self._having(set[int]().union(*fed_by.values()))
        left = CONFLICTS_PER_OPTION * len(self.options)
        across = self.across
        for source, needs in fed_by.items():
            lacking = self._lacking(source, needs)
            few = self._few(source)
            self.stated |= needs - lacking.keys()
            for need, numbers in lacking.items():
                left -= len(numbers)
                if len(numbers) > few or left < 0:
                    continue
                self.stated.add(need)
                have = having[need]
                # Pairs are wired one by one: mostly one option lacks what one other needs.
                lack = 1 << numbers[0] if len(numbers) == 1 else _mask(numbers)
                need_it = 1 << have[0] if len(have) == 1 else _mask(have)
                for number in numbers:
                    across[number] |= need_it
                for number in have:
                    across[number] |= lack

    def _having(self, needs: set[int]) -> dict[int, list[int]]:
        """Return for some needs the options that have them."""
        having: dict[int, list[int]] = {need: [] for need in needs}
        for number, option in enumerate(self.options if needs else ()):
            for need in option.kind.needs:
                if need in having:
                    having[need].append(number)
        return having

    def _few(self, source: int) -> int:
        """Return how many options of a role do not support a need, at most, if it is to say much."""
        return max(1, len(self.reduced.options[source]) // SHARE_UNFIT)

    def _often_supported(self, source: int, needs: set[int]) -> set[int]:
        """Return the needs that enough options of a role support to say much; all, where counting takes too long."""
        supports = [option.kind.supports for option in self.reduced.options[source]]
        if SHARE_UNFIT * sum(map(len, supports)) >= len(supports) * len(needs):
            return needs
        enough = len(supports) - self._few(source)
        counted = Counter(chain.from_iterable(supports))
        return {need for need in needs if counted[need] >= enough}

    def _lacking(self, source: int, needs: set[int]) -> dict[int, list[int]]:
        """Return for each need that is not supported by all options of a role those that do not support it."""
        lacking: dict[int, list[int]] = {}
        missing_of: dict[int, set[int]] = {}
        for number, option in enumerate(self.reduced.options[source], self.start[source]):
            kind = option.kind
            missing = missing_of.get(id(kind))
            if missing is None:
                missing = missing_of[id(kind)] = needs.difference(kind.supports)
            for need in missing:
                if need in lacking:
                    lacking[need].append(number)
                else:
                    lacking[need] = [number]
        return lacking

    def add_components(self) -> None:
        """Add the conflicts between options that are one component."""
        same: dict[str, int] = {}
        for number, option in enumerate(self.options):
            if option.component:
                same[option.component] = same.get(option.component, 0) | 1 << number
        for mask in same.values():
            if mask & (mask - 1):
                for number in _bits(mask):
                    self.across[number] |= mask & ~(1 << number)

    def groups(self) -> Iterator[list[int]]:
        """Yield groups, their options in order, until each conflict across roles is in one; shared components first."""
        left = list(self.across)
        whole = [
            mask | (self.of_role[role] if self.asked[role] == 1 else 0) & ~(1 << number)
            for number, (mask, role) in enumerate(zip(self.across, self.role, strict=True))
        ]
        for number in range(len(left)):
            while left[number]:
                members = self._grown(number, left[number], whole)
                others = ~_mask(members)
                for member in members:
                    left[member] &= others
                yield members

    def _grown(self, start: int, uncovered: int, whole: Sequence[int]) -> list[int]:
        """Return a group with an option: of conflicts not covered yet first, then of any."""
        group, common = [start], whole[start]
        for wanted in (uncovered, -1):
            while fitting := common & wanted:
                group.append((fitting & -fitting).bit_length() - 1)
                common &= whole[group[-1]]
        return sorted(group)


class _Counting:
    """Looks for roles whose slots have no more groups than they need."""

    def __init__(self, graph: _Conflicts, groups: Sequence[Sequence[int]]) -> None:
        self.graph = graph
        self.groups: list[int] = []
        """The groups of more than two roles, as masks."""
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
        for members, weight in zip(groups, weights, strict=True) if max(weights, default=0) >= ENOUGH else ():
            roles = frozenset([graph.role[option] for option in members])
            if len(roles) > 2:
                for option in members:
                    self.having[option].append(len(self.groups))
                self.groups.append(_mask(members))
                self.roles.append(roles)
                self.weights.append(weight)
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

    def _roles(self, mask: int) -> Iterator[int]:
        return (self.graph.role[number] for number in _bits(mask))

    def counted(self, groups: Sequence[Sequence[int]], patience: int | None = None) -> ExclusiveGroups:
        """Count, and return the groups with what follows from them by now."""
        self._run(patience)
        return ExclusiveGroups(
            groups,
            frozenset(self.graph.stated),
            self.graph.settled,
            [list(_bits(group)) for group in self.played],
            frozenset(_bits(self.excluded)),
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

    def _cover(self, start: int, shares: dict[int, int]) -> bool:
        """Put together groups, by number, with disjoint shares of them, until these cover all options of their roles.

        Return whether they do, or are left as they would be too many.
        """
        graph = self.graph
        roles: set[int] = set()
        covered = wanted = slots = 0
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
            surplus += (self.weights[best] if whole else sum([self.part[option] for option in _bits(share)])) - 1
            if surplus + gain < ENOUGH - 1:
                return False
            for role in self.roles[best] - roles if whole else set(self._roles(share)) - roles:
                roles.add(role)
                wanted |= graph.of_role[role]
                slots += graph.asked[role]
            left = wanted & ~covered
            if not left:
                return True
            if len(shares) > min(slots, SPREAD * (8 + len(self.roles[start]))):
                return False
            best = self._next(left, covered)
        return False

    def _next(self, left: int, covered: int) -> int | None:
        """Return the group with the lowest of the options left that has the most of them, rather a disjoint one."""
        lowest = (left & -left).bit_length() - 1
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
        group_of = {number: name for name, share in shares.items() for number in _bits(share)}
        roles = sorted({graph.role[number] for number in group_of})
        drawn = {role: sorted({group_of[number] for number in _bits(graph.of_role[role])}) for role in roles}
        slots = [role for role in roles for _ in range(graph.asked[role])]
        found = unmatchable(slots, [drawn.get(role, []) for role in range(len(graph.of_role))])
        if isinstance(found, HallSet):
            self.crowded = frozenset(found.roles)
            return
        for role, name in found:
            self.excluded |= shares[name] & graph.of_role[role]
        if len(slots) == len(shares):
            self.played += shares.values()


def _mask(numbers: Sequence[int]) -> int:
    mask = 0
    for number in numbers:
        mask |= 1 << number
    return mask


def _bits(mask: int) -> Iterator[int]:
    """Yield the numbers of the bits that are set."""
    while mask:
        lowest = mask & -mask
        yield lowest.bit_length() - 1
        mask ^= lowest
