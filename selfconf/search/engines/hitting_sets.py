"""The smallest set of constraints that cannot hold together, by hitting sets (Ignatiev et al., CP 2015).

What is left out of a set that can hold together and no further constraint can join is a *correction set*: each set that
cannot hold together has one of its members. So it is no smaller than the smallest set that hits all correction sets
met so far. That one is asked about: if it cannot hold together, it is a smallest one; if it can, it is grown, and what
is left out is a further correction set. An irreducible set that is known bounds the size from above.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
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
    place = {one: number for number, one in enumerate(universe)}
    corrections: list[frozenset[int]] = []
    size = 1
    while size < len(known):
        hitting = _hitting_set(corrections, size, budget)
        if isinstance(hitting, Undecided):
            return known, False
        if hitting is None:
            size += 1
            continue
        answer = held([universe[number] for number in hitting])
        if isinstance(answer, Undecided):
            return known, False
        if answer is None:
            return [universe[number] for number in sorted(hitting)], True
        corrections.append(frozenset(range(len(universe))) - {place[one] for one in answer})
        corrections.sort(key=len)
    return known, True


def _hitting_set(sets: Sequence[frozenset[int]], size: int, budget: Budget) -> set[int] | Undecided | None:
    """Return a set of at most this size that has a member of each set, depth first; None if there is none.

    The sets are sorted by size, so those of one member come first: these members are in every such set.
    """
    chosen = set[int]().union(*(some for some in sets if len(some) == 1))
    rest = [some for some in sets if some.isdisjoint(chosen)]
    if len(chosen) + _disjoint(rest) > size:
        return None
    trying: list[tuple[int, list[int]]] = []
    """For each set that was open: its member that is chosen, and those to be tried after it, the next one last."""
    while True:
        if budget.steps == 0:
            return Undecided(0)
        budget.spend(1)
        open_ = next((some for some in rest if some.isdisjoint(chosen)), None)
        if open_ is None:
            return chosen
        left = sorted(open_, reverse=True) if len(chosen) < size else []
        while not left:
            if not trying:
                return None
            member, left = trying.pop()
            chosen.discard(member)
        chosen.add(left[-1])
        trying.append((left.pop(), left))


def _disjoint(sets: Sequence[frozenset[int]]) -> int:
    """Return how many sets have no member in common, taken one after the other: so many members hit them at least."""
    met: set[int] = set()
    found = 0
    for some in sets:
        if met.isdisjoint(some):
            met |= some
            found += 1
    return found
