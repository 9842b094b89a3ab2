"""The fewest recruits that are enough, by clauses; see `recruiting` for how."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import ExitStack

from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines import FoundedSolver, solver_available
from selfconf.search.recruit_choice import RecruitChoice

WithoutSpare = Callable[[Sequence[int]], list[int]]
"""Recruits that are enough, by number, without those that can be spared."""


def fewest(choice: RecruitChoice, budget: Budget) -> tuple[list[int], bool]:
    """Return the fewest recruits that are enough, the first of them by preference, and whether that is proved."""
    met = choice.without_spare(choice.chain())
    if not met or not solver_available():
        return met, not met
    reduced, wanted = choice.reduced()
    with FoundedSolver(reduced, wanted) as clauses:
        order = [option.number for option in reduced.options[-1]]
        return fewest_of(clauses, order, met, choice.without_spare, budget)


def fewest_of(
    clauses: FoundedSolver, order: Sequence[int], met: list[int], without_spare: WithoutSpare, budget: Budget
) -> tuple[list[int], bool]:
    """Return the fewest recruits that the clauses allow, the first of them in an order, and whether that is proved.

    `met` are recruits that they allow.
    """
    with ExitStack() as stack:
        search = _Counting(clauses, order, met, without_spare, stack)
        return search.best(budget)


class _Counting:
    """A solver with a counter of the recruits that are chosen."""

    def __init__(
        self, clauses: FoundedSolver, order: Sequence[int], met: list[int], spare: WithoutSpare, stack: ExitStack
    ) -> None:
        self.met, self._clauses, self._without_spare = met, clauses, spare
        self._chosen = {number: clauses.recruits[number] for number in order}
        clauses.prefer(-literal for literal in self._chosen.values())
        self._counter = clauses.counter(list(self._chosen.values()), stack) if self._chosen else None

    def best(self, budget: Budget) -> tuple[list[int], bool]:
        """The fewest, and of these the first by preference; and whether both are proved."""
        while True:
            fewer = self._answer([], len(self.met) - 1, budget)
            if not isinstance(fewer, list):
                break
            self.met = fewer
        if fewer is not None:
            return self.met, False
        return self._first(budget)

    def _first(self, budget: Budget) -> tuple[list[int], bool]:
        """Of the sets of the number that was met, the one with the first recruits."""
        most, fixed = len(self.met), list[int]()
        for number, literal in self._chosen.items():
            if len(fixed) == most:
                break
            if number in self.met:
                fixed.append(literal)
                continue
            other = self._answer([*fixed, literal], most, budget)
            if isinstance(other, Undecided):
                return self.met, False
            if other is None:
                self._clauses.add([-literal] if not fixed else [-literal, *(-one for one in fixed)])
            else:
                self.met = other
                fixed.append(literal)
        return self.met, True

    def _answer(self, assumed: list[int], most: int, budget: Budget) -> list[int] | Undecided | None:
        """At most a number of recruits that are enough; None if there are none."""
        if most < 0 or (most == 0 and assumed):
            return None
        bound = [-self._clauses.at_least(self._counter, most + 1)] if 0 < most < len(self._chosen) else []
        bound += [-literal for literal in self._chosen.values()] if not most else []
        found = self._clauses.solve([*assumed, *bound], budget)
        if isinstance(found, Undecided):
            return found
        return self._without_spare(self._clauses.recruited()) if found else None
