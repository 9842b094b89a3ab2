"""Depth first over the slots of a compact problem, in lexicographic order, within a number of steps.

The slots are filled in order, and each takes its options in order, so that the first solution met is the least. A
partial solution is given up as soon as a need of somebody in it can no longer be served: it is not served yet, and no
slot left has an option that gives it. No recursion: ten thousand roles are as deep as ten thousand slots.
"""

from __future__ import annotations

from dataclasses import dataclass

from selfconf.model.refusal import Undecided
from selfconf.search.compact import Compact, Option


@dataclass(slots=True)
class Budget:
    """How many steps are left, one for each option tried; shared by the engines that work on one question."""

    steps: int | None = None

    def part(self, most: int) -> Budget:
        """A budget of at most so many of the steps that are left."""
        return Budget(most if self.steps is None else min(most, self.steps))

    def spend(self, steps: int) -> None:
        """Take away steps that were done; at zero the budget is used up."""
        if self.steps is not None:
            self.steps = max(0, self.steps - steps)


def walk(compact: Compact, budget: Budget, distinct: bool = True) -> list[Option] | Undecided | None:
    """The least solution, one option per slot; None if there is none; Undecided when the steps are used up."""
    return _Walk(compact, distinct).run(budget)


class _Walk:
    def __init__(self, compact: Compact, distinct: bool) -> None:
        self.compact, self.distinct = compact, distinct
        slots = compact.slots
        self.chosen: list[Option] = []
        self.taken: set[str] = set()
        self.values: list[tuple[int, ...]] = [compact.values]
        self.fed = [0] * len(compact.needs)
        self.needed = [0] * len(compact.needs)
        last_slot = {role: place for place, role in enumerate(slots)}
        self.last = [-1] * len(compact.needs)
        """The last slot with an option that gives this need."""
        for role, place in last_slot.items():
            for kind in {id(option.kind): option.kind for option in compact.options[role]}.values():
                for need in kind.gives:
                    self.last[need] = max(self.last[need], place)
        self.expiring: list[list[int]] = [[] for _ in slots]
        for need, place in enumerate(self.last):
            if place >= 0:
                self.expiring[place].append(need)

    def run(self, budget: Budget) -> list[Option] | Undecided | None:
        slots, options = self.compact.slots, self.compact.options
        cursor = [0] * (len(slots) + 1)
        place, steps = 0, 0
        limit = budget.steps
        while place < len(slots):
            role = slots[place]
            waiting, index = options[role], cursor[place]
            while index < len(waiting):
                if steps == limit:
                    budget.spend(steps)
                    return Undecided(steps)
                steps += 1
                index += 1
                if self._push(place, waiting[index - 1]):
                    break
            else:
                if not place:
                    budget.spend(steps)
                    return None
                place -= 1
                self._pop()
                continue
            cursor[place] = index
            place += 1
            if place < len(slots):
                cursor[place] = index if slots[place] == role else 0
        budget.spend(steps)
        return self.chosen

    def _push(self, place: int, option: Option) -> bool:
        kind = option.kind
        if option.component in self.taken:
            return False
        values = self.values[-1]
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
                self._pop()
                return False
        for need in self.expiring[place]:
            if self.needed[need] and not self.fed[need]:
                self._pop()
                return False
        return True

    def _pop(self) -> None:
        option = self.chosen.pop()
        self.taken.discard(option.component)
        self.values.pop()
        for need in option.kind.needs:
            self.needed[need] -= 1
        for need in option.kind.gives:
            self.fed[need] -= 1
