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
    corrections: list[list[Member]] = []
    size = 1
    while size < len(known):
        hitting = _hitting_set(corrections, size, budget)
        if isinstance(hitting, Undecided):
            return known, False
        if hitting is None:
            size += 1
            continue
        answer = held(hitting)
        if isinstance(answer, Undecided):
            return known, False
        if answer is None:
            return [one for one in universe if one in hitting], True
        corrections.append([one for one in universe if one not in answer])
        corrections.sort(key=len)
    return known, True


def _hitting_set(sets: Sequence[Sequence[Member]], size: int, budget: Budget) -> list[Member] | Undecided | None:
    """Return a set of at most this size that has a member of each set, depth first; None if there is none."""
    chosen: list[Member] = []
    trying: list[list[Member]] = []
    while True:
        if budget.steps == 0:
            return Undecided(0)
        budget.spend(1)
        open_ = next((some for some in sets if not any(one in chosen for one in some)), None)
        if open_ is None:
            return chosen
        trying.append(list(open_) if len(chosen) < size else [])
        while trying and not trying[-1]:
            trying.pop()
            if trying:
                chosen.pop()
        if not trying:
            return None
        chosen.append(trying[-1].pop(0))
