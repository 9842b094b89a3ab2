"""A solver that looks for the least solution, and about how many slots its next question is.

To ask a solver whether a slot can have an option takes it as long as to find a model, even where there is no conflict
to be met; to propagate takes a fiftieth of that. Where roles are bound to each other, what propagation leaves first is
mostly possible, for one slot after the other. So a question is about several slots at once: each has the first option
that propagation leaves it, given those of the slots before it. If all of them can play together, all of these slots are
settled, as each option before was refuted. If not, fewer are asked about, down to one. How many follows from how the
last questions went.
"""

from __future__ import annotations

from collections.abc import Sequence

from selfconf.search.budget import Budget
from selfconf.search.engines.clause_learning import ClauseSolver

FURTHEST = 16
"""How many slots a question is about at most: by then, finding models is a small part of the time."""
EASY = 60
"""How many conflicts an answer may take if the next question is to be about more slots, or about more than one."""


class Turn:
    """A solver, how far it knows what is settled, and how far it looks ahead."""

    def __init__(self, clauses: ClauseSolver, modelled: bool = False) -> None:
        self.clauses, self.modelled = clauses, modelled
        """`modelled`: whether the last model has all that is settled."""
        self.fixed = 0
        """How many slots are settled in its clauses."""
        self.rejected = 0
        """Up to which option of the next slot none is possible, by its clauses."""
        self.reach = 1
        """How many slots the next question is about, at most."""

    def ahead(self, slots: Sequence[int], plays: Sequence[Sequence[int]], budget: Budget) -> list[int]:
        """Return for some of the next slots the first options that propagation leaves, each given those before it.

        Each option that it refutes is a step. The role of each slot is given, and the literals of the options of each
        role.
        """
        numbers = [self.rejected]
        assumed = [plays[slots[self.fixed]][self.rejected]]
        if self.reach == 1:
            return numbers
        implied = self.clauses.implied(assumed) or set()
        for slot in range(self.fixed + 1, min(self.fixed + self.reach, len(slots))):
            literals = plays[slots[slot]]
            # Slots of one role take options in ascending order.
            number = numbers[-1] + 1 if slots[slot] == slots[slot - 1] else 0
            while number < len(literals):
                beside = self._beside(assumed, literals[number], implied)
                if beside is not None:
                    implied = beside
                    break
                if budget.steps == 0:
                    return numbers
                budget.spend(1)
                number += 1
            if number == len(literals):
                return numbers[: (1 + len(numbers)) // 2]  # all together they lead to nothing
            numbers.append(number)
            assumed.append(literals[number])
        return numbers

    def _beside(self, assumed: Sequence[int], literal: int, implied: set[int]) -> set[int] | None:
        """Return what follows from one more literal beside others, given what does without it; None if it is refuted.

        To propagate all of them takes long, so that it is done last: of nine in ten literals it is known without.
        """
        if literal in implied:
            return implied
        if -literal in implied or self.clauses.refutes(literal):
            return None
        return self.clauses.implied([*assumed, literal])

    def answered(self, slots: int, possible: bool | None, conflicts: int) -> None:
        """Note how a question about so many slots went; None if it was left."""
        if conflicts > EASY or possible is None:
            self.reach = 1
        else:
            self.reach = min(2 * slots, FURTHEST) if possible else max(1, slots // 2)
