"""Depth-first search over the slots of a reduced problem, in lexicographic order, within a number of steps.

The slots are filled in order, and each takes its options in order, so that the first solution met is the least. A
partial solution is left (forward checking) as soon as a need of an option in it can no longer be supported: no option
chosen supports it, and no slot left has an option that does; and, where roles share candidates, as soon as the slots
left cannot all have a component of their own; and, with needs that are counted (`need_counting`), as soon as there are
fewer slots left for some of them than these are. There is no recursion: ten thousand roles are ten thousand slots deep.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from selfconf.model.refusal import Undecided
from selfconf.model.term import IRI
from selfconf.search.budget import Budget
from selfconf.search.engines.matching import MaintainedMatching
from selfconf.search.engines.need_counting import CountedNeeds
from selfconf.search.reduction import Option, ReducedProblem

OPTION_HEADROOM = 32
"""For how many options more than those of the slots reached steps may be taken."""

FEW_SLOTS = 3
"""For how many slots of one role its options count."""


def first_solution(
    reduced: ReducedProblem,
    budget: Budget,
    distinct: bool = True,
    matching: MaintainedMatching[IRI] | None = None,
    pace: float | None = None,
    counted: Sequence[CountedNeeds] = (),
) -> list[Option] | Undecided | None:
    """Return the least solution, one option per slot; None if there is none; Undecided when the steps are used up.

    With a pace, it is undecided as soon as more steps were taken than that for each option of the slots reached.
    """
    search = (
        CountingSearch(reduced, counted, distinct, matching) if counted else ReducedSearch(reduced, distinct, matching)
    )
    return next(search.solutions(budget, pace), None)


class ReducedSearch:
    """A depth-first search that may be resumed after each solution; a subclass may reject options."""

    def __init__(
        self, reduced: ReducedProblem, distinct: bool = True, matching: MaintainedMatching[IRI] | None = None
    ) -> None:
        self.reduced, self.distinct, self.matching = reduced, distinct, matching
        slots = reduced.slots
        self.chosen: list[Option] = []
        self.taken: set[str] = set()
        self._options = ((),) * len(reduced.options) if 0 in reduced.values else reduced.options
        """The options of each role that may play: none where a variable has no value."""
        self.values = list(reduced.values)
        """The values that the variables may still have."""
        self.narrowed: list[Sequence[tuple[int, int]]] = []
        """For each option chosen the variables that have lost values to it, with those that they had before."""
        self.supports = [0] * len(reduced.needs)
        """How many options chosen support each need."""
        self.needed = [0] * len(reduced.needs)
        """How many options chosen have each need."""
        last_slot = {role: place for place, role in enumerate(slots)}
        self.last = [-1] * len(reduced.needs)
        """The last slot with an option that supports each need."""
        for role, place in last_slot.items():  # in the order of places
            for need in set[int]().union(*[option.kind.supports for option in reduced.options[role]]):
                self.last[need] = place
        self.expiring: list[list[int]] = [[] for _ in slots]
        """For each slot the needs that no later slot can support."""
        for need, place in enumerate(self.last):
            if place >= 0:
                self.expiring[place].append(need)

    def solutions(self, budget: Budget, pace: float | None = None) -> Iterator[list[Option] | Undecided]:
        """Yield solutions in lexicographic order; Undecided, and then no more, when the steps are used up."""
        slots, options = self.reduced.slots, self._options
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
                        # They are written down once for all slots of a role, so that they count for a few of many.
                        if place <= FEW_SLOTS or slots[place - 1 - FEW_SLOTS] != role:
                            reach += len(waiting)
                    # Slots of one role take options in ascending order: their permutations are the same solution.
                    cursor[place] = index if place < len(slots) and slots[place] == role else 0
                    continue
            else:
                # The budget is settled before each solution: it may be spent elsewhere before the search is resumed.
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
        """Put an option into a slot, unless no solution has it there beside the options chosen so far."""
        kind = option.kind
        if option.component in self.taken:
            return False
        if self.matching is not None and not self.matching.give(place, option.component):
            return False
        narrowed = self._narrow(kind.admits) if kind.admits else ()
        if narrowed is None:
            return False
        needed, supports = self.needed, self.supports
        for need in kind.needs:
            needed[need] += 1
        for need in kind.supports:
            supports[need] += 1
        self.narrowed.append(narrowed)
        if self.distinct and option.component:
            self.taken.add(option.component)
        self.chosen.append(option)
        if self._unsupportable(place, kind.needs):
            self.pop()
            return False
        return True

    def _narrow(self, admits: Mapping[int, int]) -> list[tuple[int, int]] | None:
        """Leave the variables the values that are admitted, and return which lost some; None if one would have none."""
        values = self.values
        narrowed: list[tuple[int, int]] = []
        for variable, mask in admits.items():
            before = values[variable]
            left = before & mask
            if not left:
                self._restore(narrowed)
                return None
            if left != before:
                values[variable] = left
                narrowed.append((variable, before))
        return narrowed

    def _restore(self, narrowed: Sequence[tuple[int, int]]) -> None:
        """Give variables the values back that they had before."""
        for variable, before in narrowed:
            self.values[variable] = before

    def _unsupportable(self, place: int, needs: tuple[int, ...]) -> bool:
        """Return whether a need has no support among the options chosen, nor in any slot left."""
        supports = self.supports
        for need in needs:
            if not supports[need] and self.last[need] <= place:
                return True
        for need in self.expiring[place]:  # noqa: SIM110  # in each step, where a generator costs more
            if self.needed[need] and not supports[need]:
                return True
        return False

    def pop(self) -> None:
        """Take the last option out again."""
        option = self.chosen.pop()
        self.taken.discard(option.component)
        narrowed = self.narrowed.pop()
        if narrowed:
            self._restore(narrowed)
        for need in option.kind.needs:
            self.needed[need] -= 1
        for need in option.kind.supports:
            self.supports[need] -= 1


class CountingSearch(ReducedSearch):
    """A depth-first search that leaves as many slots as there are needs not supplied yet, of those that are counted."""

    def __init__(
        self,
        reduced: ReducedProblem,
        counted: Sequence[CountedNeeds],
        distinct: bool,
        matching: MaintainedMatching[IRI] | None,
    ) -> None:
        super().__init__(reduced, distinct, matching)
        self.spare = [some.spare for some in counted]
        """For each part of the needs how many slots may still be filled without supplying one more."""
        self._part = {role: part for part, some in enumerate(counted) for role in some.slots}
        self._counted = {need for some in counted for need in some.needs}
        self._wasted: list[int | None] = []
        """For each slot filled the part of the needs of which it supplies none that was not supplied before."""

    def push(self, place: int, option: Option) -> bool:
        """Put an option into a slot, unless no solution has it there beside the options chosen so far."""
        if not super().push(place, option):
            return False
        part = self._part.get(option.kind.role)
        if part is not None:
            supports = self.supports
            for need in option.kind.supports:
                if supports[need] == 1 and need in self._counted:
                    part = None
                    break
        if part is not None:
            self.spare[part] -= 1
        self._wasted.append(part)
        if part is not None and self.spare[part] < 0:
            self.pop()
            return False
        return True

    def pop(self) -> None:
        """Take the last option out again."""
        if len(self._wasted) == len(self.chosen):  # else it was never counted
            part = self._wasted.pop()
            if part is not None:
                self.spare[part] += 1
        super().pop()
