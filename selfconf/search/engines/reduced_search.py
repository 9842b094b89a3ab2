"""Depth first over the slots of a compact problem, in lexicographic order, within a number of steps.

The slots are filled in order, and each takes its options in order, so that the first solution met is the least. A
partial solution is given up as soon as a need of somebody in it can no longer be served: it is not served yet, and no
slot left has an option that gives it; and, where roles share candidates, as soon as the slots left cannot all have a
component of their own. No recursion: ten thousand roles are as deep as ten thousand slots.
"""

from __future__ import annotations

from collections.abc import Iterator

from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines.matching import FollowedMatching
from selfconf.search.reduction import Option, ReducedProblem

OPTION_HEADROOM = 32
"""How many options more than those of the slots that it has reached it may have taken steps for."""


def first_solution(
    compact: ReducedProblem,
    budget: Budget,
    distinct: bool = True,
    partners: FollowedMatching | None = None,
    pace: float | None = None,
) -> list[Option] | Undecided | None:
    """The least solution, one option per slot; None if there is none; Undecided when the steps are used up.

    With a pace it is undecided as soon as it has taken more steps than that for each option of the slots reached.
    """
    return next(ReducedSearch(compact, distinct, partners).solutions(budget, pace), None)


class ReducedSearch:
    """A depth-first search that may be resumed after each solution; a subclass may refuse options."""

    def __init__(
        self, compact: ReducedProblem, distinct: bool = True, partners: FollowedMatching | None = None
    ) -> None:
        self.compact, self.distinct, self.partners = compact, distinct, partners
        slots = compact.slots
        self.chosen: list[Option] = []
        self.taken: set[str] = set()
        self.values: list[tuple[int, ...]] = [compact.values]
        self.fed = [0] * len(compact.needs)
        self.needed = [0] * len(compact.needs)
        last_slot = {role: place for place, role in enumerate(slots)}
        self.last = [-1] * len(compact.needs)
        """The last slot with an option that gives this need."""
        for role, place in last_slot.items():  # in the order of places
            for need in {need for option in compact.options[role] for need in option.kind.gives}:
                self.last[need] = place
        self.expiring: list[list[int]] = [[] for _ in slots]
        for need, place in enumerate(self.last):
            if place >= 0:
                self.expiring[place].append(need)

    def solutions(self, budget: Budget, pace: float | None = None) -> Iterator[list[Option] | Undecided]:
        """Solutions in lexicographic order; Undecided, and then no more, when the steps are used up."""
        slots, options = self.compact.slots, self.compact.options
        reach = OPTION_HEADROOM
        furthest = 0
        cursor = [0] * (len(slots) + 1)
        place, steps = 0, 0
        limit = budget.steps
        while place >= 0:
            if place < len(slots):
                role = slots[place]
                waiting, index = options[role], cursor[place]
                pushed = False
                while index < len(waiting) and not pushed:
                    if steps == limit:
                        budget.spend(steps)
                        yield Undecided(steps)
                        return
                    steps += 1
                    pushed = self.push(place, waiting[index])
                    index += 1
                if pushed:
                    cursor[place] = index
                    place += 1
                    if place > furthest:
                        furthest = place
                        reach += len(waiting)
                    cursor[place] = index if place < len(slots) and slots[place] == role else 0
                    continue
            else:
                budget.spend(steps)
                limit, steps = budget.steps, 0
                yield list(self.chosen)
            if pace is not None and steps > pace * reach:
                budget.spend(steps)
                yield Undecided(steps)
                return
            place -= 1
            if place >= 0:
                self.pop()
        budget.spend(steps)

    def push(self, place: int, option: Option) -> bool:
        """Put an option into a slot, unless it cannot be there."""
        kind = option.kind
        if option.component in self.taken:
            return False
        values = self.values[-1]
        if self.partners is not None and not self.partners.give(place, option.component):
            return False
        if values:
            values = tuple(value & allowed for value, allowed in zip(values, kind.admits, strict=True))
            if not all(values):
                return False
        for need in kind.needs:
            self.needed[need] += 1
        for need in kind.gives:
            self.fed[need] += 1
        self.values.append(values)
        if self.distinct and option.component:
            self.taken.add(option.component)
        self.chosen.append(option)
        for need in kind.needs:
            if not self.fed[need] and self.last[need] <= place:
                self.pop()
                return False
        for need in self.expiring[place]:
            if self.needed[need] and not self.fed[need]:
                self.pop()
                return False
        return True

    def pop(self) -> None:
        """Take the last option out again."""
        option = self.chosen.pop()
        self.taken.discard(option.component)
        self.values.pop()
        for need in option.kind.needs:
            self.needed[need] -= 1
        for need in option.kind.gives:
            self.fed[need] -= 1
