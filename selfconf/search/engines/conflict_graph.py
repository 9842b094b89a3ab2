"""The graph of conflicts between options, and groups that cover it: cliques, grown greedily.

Where a need can be fed by one role alone, which has one slot, an option with the need excludes the options of that role
which do not support it. So do two options that are one component, and two of a role that has one slot.

A need that many options do not support, or that comes after many others, is left out: it stays a need. So do all needs
that a role alone feeds where most of them are such ones, as in a net of components that want what few others issue.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from itertools import accumulate, chain, pairwise

from selfconf.search.reduction import Option, ReducedProblem

SHARE_UNFIT = 2
"""A need says little if at most one in this number of the options that could feed it do not."""
SHARE_OFTEN = 2
"""Of the needs that one role alone feeds one in this number has to be often supported, or none of them is looked at."""
FEW_BITS = 8
"""Fewer bits than this are set one by one."""
CONFLICTS_PER_OPTION = 200
"""How many conflicts are looked at, for each option."""


class ConflictGraph:
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
        having = self._having(set[int]().union(*fed_by.values()))
        left = CONFLICTS_PER_OPTION * len(self.options)
        across = self.across
        for source, needs in fed_by.items():
            lacking = self._lacking(source, needs)
            few = _few(self.reduced.options[source])
            self.stated |= needs - lacking.keys()
            for need, numbers in lacking.items():
                left -= len(numbers)
                if len(numbers) > few or left < 0:
                    continue
                self.stated.add(need)
                have = having[need]
                # Pairs are wired one by one: mostly one option lacks what one other needs.
                lack = 1 << numbers[0] if len(numbers) == 1 else mask_of(numbers)
                need_it = 1 << have[0] if len(have) == 1 else mask_of(have)
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
                for number in numbers_of(mask):
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
                others = ~mask_of(members)
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


def often_supported(options: Sequence[Option], needs: set[int]) -> set[int]:
    """Return the needs that enough options of a role support to say much; all, where counting takes too long.

    None are returned if they are few: what few options issue is wanted of a role, and no conflict with all others.
    """
    supports = [option.kind.supports for option in options]
    enough = len(supports) - _few(options)
    most = sum(map(len, supports))
    if SHARE_UNFIT * most >= len(supports) * len(needs):
        return needs
    if most * SHARE_OFTEN < enough * len(needs):
        return set()
    counted = Counter(chain.from_iterable(supports))
    often = {need for need in needs if counted[need] >= enough}
    return often if len(often) * SHARE_OFTEN >= len(needs) else set()


def _few(options: Sequence[Option]) -> int:
    """Return how many options of a role do not support a need, at most, if it is to say much."""
    return max(1, len(options) // SHARE_UNFIT)


def mask_of(numbers: Sequence[int]) -> int:
    """Return a set of numbers as the bits of one."""
    if len(numbers) < FEW_BITS:
        mask = 0
        for number in numbers:
            mask |= 1 << number
        return mask
    # One pass over bytes: to set a bit of an integer copies all of it.
    found = bytearray((max(numbers) >> 3) + 1)
    for number in numbers:
        found[number >> 3] |= 1 << (number & 7)
    return int.from_bytes(found, "little")


def numbers_of(mask: int) -> Iterator[int]:
    """Yield the numbers of the bits that are set."""
    while mask:
        lowest = mask & -mask
        yield lowest.bit_length() - 1
        mask ^= lowest
