"""The smallest set of constraints that cannot hold together, by hitting sets (Ignatiev et al., CP 2015).

What is left out of a set that can hold together and no further constraint can join is a *correction set*: each set that
cannot hold together has one of its members. So it is no smaller than the smallest set that hits all correction sets
met so far. That one is asked about: if it cannot hold together, it is a smallest one; if it can, it is grown, and what
is left out is a further correction set. An irreducible set that is known bounds the size from above.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from functools import reduce
from operator import or_
from typing import TypeVar

from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget

Member = TypeVar("Member")


def smallest_core(
    known: Sequence[Member],
    universe: Sequence[Member],
    held: Callable[[Collection[Member]], Collection[Member] | Undecided | None],
    budget: Budget,
) -> tuple[Sequence[Member], bool]:
    """Return a smallest set that cannot hold together, and True; or the set that is known, when the budget ends.

    `held` returns a set that can hold together and that nothing can join, with the members asked for; None if these
    cannot.
    """
    bit_of = {one: 1 << number for number, one in enumerate(universe)}
    everything = (1 << len(universe)) - 1
    corrections: list[int] = []
    """Each as a bit mask of the members that are left out."""
    size = 1
    while size < len(known):
        hitting = _hitting_set(corrections, size, budget)
        if isinstance(hitting, Undecided):
            return known, False
        if hitting is None:
            size += 1
            continue
        members = [one for one, bit in bit_of.items() if bit & hitting]
        answer = held(members)
        if isinstance(answer, Undecided):
            return known, False
        if answer is None:
            return members, True
        corrections.append(everything & ~sum(bit_of[one] for one in answer))
        corrections.sort(key=int.bit_count)
    return known, True


def _hitting_set(sets: Sequence[int], size: int, budget: Budget) -> int | Undecided | None:
    """Return a set of at most this size that has a member of each set, depth first; None if there is none.

    All of them are bit masks. The sets are sorted by size, so those of one member come first: these members are in
    every such set.
    """
    chosen = reduce(or_, (some for some in sets if some.bit_count() == 1), 0)
    rest = [some for some in sets if not some & chosen]
    if chosen.bit_count() + _disjoint(rest) > size:
        return None
    trying: list[tuple[int, int, int]] = []
    """For each set that was open: its place, its members that are yet to be tried, and what was chosen before."""
    place = 0
    while True:
        if budget.steps == 0:
            return Undecided(0)
        budget.spend(1)
        while place < len(rest) and rest[place] & chosen:
            place += 1
        if place == len(rest):
            return chosen
        left = rest[place] if chosen.bit_count() < size else 0
        while not left:
            if not trying:
                return None
            place, left, chosen = trying.pop()
        trying.append((place, left & (left - 1), chosen))
        chosen |= left & -left


def _disjoint(sets: Sequence[int]) -> int:
    """Return how many sets have no member in common, taken one after the other: so many members hit them at least."""
    met = found = 0
    for some in sets:
        if not met & some:
            met |= some
            found += 1
    return found
