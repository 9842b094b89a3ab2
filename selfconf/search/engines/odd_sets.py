"""Sets of groups that options meet several times over: how many of these options can play at most.

Let at most one option of each group play, and let some groups be such that each option that is in one of them is in two
of them at least. Then half of the groups, rounded down, is the most of these options that can play. Where options are
in two groups each, these are the odd sets by which Edmonds described all matchings of a graph (1965): of a triangle of
fields no two dominoes fit, though each field has one half of two of them. Counting groups as they stand sees nothing of
that, nor does clause learning in less than exponential time. It is a cut of Chvatal and Gomory: the groups are added
up, divided, and rounded.

*Which sets.* From a group and another one of its options: the group that has the most of the options met but once,
until there is none, or no group has any.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Mapping, Sequence

LARGEST_SET = 32
"""How many groups a set has at most."""
MET_PER_OPTION = 100
"""How many options of groups are met at most, one by one, for each option that there is."""
FRUITLESS = 16
"""From how many groups at most sets are begun, if all of these become too large."""


def odd_sets(groups: Sequence[Sequence[int]], having: Sequence[Sequence[int]]) -> dict[frozenset[int], int]:
    """Return sets of options with how many of each can play at most, given groups, and by option those that have it."""
    found: dict[frozenset[int], int] = {}
    left, fruitless = MET_PER_OPTION * len(having), 0
    for start, members in enumerate(groups):
        for second in having[members[0]]:
            if second == start or left <= 0 or fruitless == FRUITLESS:
                continue
            size, met = _grown(start, second, groups, having)
            left -= met.total()
            times = min(met.values())
            if times > 1:
                found[frozenset(met)] = size // times
            elif not found and size == LARGEST_SET:
                fruitless += 1
    return found


def _grown(
    start: int, second: int, groups: Sequence[Sequence[int]], having: Sequence[Sequence[int]]
) -> tuple[int, Counter[int]]:
    """Put groups together until no option is met but once; return their number, and how often each option is met."""
    chosen: set[int] = set()
    met: Counter[int] = Counter()
    votes: Counter[int] = Counter()
    best: int | None = start
    while best is not None and len(chosen) < LARGEST_SET:
        chosen.add(best)
        for option in groups[best]:
            met[option] += 1
            change = {1: 1, 2: -1}.get(met[option], 0)
            for group in having[option] if change else ():
                votes[group] += change
        best = second if len(chosen) == 1 else _most_voted(votes, chosen)
    return len(chosen), met


def _most_voted(votes: Mapping[int, int], chosen: Container[int]) -> int | None:
    """Return the group that has the most of the options that are met but once; of equal ones the first."""
    return min(
        (group for group, some in votes.items() if some > 0 and group not in chosen),
        key=lambda group: (-votes[group], group),
        default=None,
    )
