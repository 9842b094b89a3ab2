"""The fewest recruits that are enough, by clauses; see `recruiting` for how."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack

from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines import ClauseSolver, solver_available
from selfconf.search.recruit_choice import RecruitChoice
from selfconf.search.reduction import ReducedProblem


def fewest(choice: RecruitChoice, budget: Budget) -> tuple[list[int], bool]:
    """Return the fewest recruits that are enough, the first of them by preference, and whether that is proved."""
    met = choice.without_spare(choice.chain())
    if not met or not solver_available():
        return met, not met
    with _Clauses(choice, met) as search:
        return search.best(budget)


class _Clauses:
    """The choice of recruits as clauses; use it in a `with` statement."""

    def __init__(self, choice: RecruitChoice, met: list[int]) -> None:
        self.choice, self.met = choice, met
        self._stack = ExitStack()
        self._clauses = self._stack.enter_context(ClauseSolver(ReducedProblem((), (), (), ())))
        self._chosen = {number: self._clauses.literal() for number in choice.ordered(choice.needs)}
        for need in choice.wanted:
            self._clauses.add(self._literals(need.suppliers))
        for number, needs in choice.needs.items():
            for need in needs:
                self._clauses.add([-self._chosen[number], *self._literals(need.suppliers)])
        self._clauses.prefer(-literal for literal in self._chosen.values())
        self._counter = self._clauses.counter(list(self._chosen.values()), self._stack) if self._chosen else None

    def __enter__(self) -> _Clauses:
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def _literals(self, numbers: Sequence[int]) -> list[int]:
        return [self._chosen[number] for number in numbers]

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
        if most < 1:
            return None
        bound = [-self._clauses.at_least(self._counter, most + 1)] if 0 < most < len(self._chosen) else []
        while True:
            found = self._clauses.solve([*assumed, *bound], budget)
            if isinstance(found, Undecided):
                return found
            if not found:
                return None
            chosen = [number for number, literal in self._chosen.items() if self._clauses.holds(literal)]
            unfounded = set(chosen).difference(self.choice.placed(chosen))
            if not unfounded:
                return self.choice.without_spare(chosen)
            self._exclude(unfounded)

    def _exclude(self, loop: set[int]) -> None:
        """Add the loop formula of recruits that only feed each other: one of them is fed from outside."""
        outside: list[int] = []
        for number in sorted(loop):
            fed = self._clauses.literal()
            for need in self.choice.needs[number]:
                others = [supplier for supplier in need.suppliers if supplier not in loop]
                self._clauses.add([-fed, *self._literals(others)])
            outside.append(fed)
        for number in loop:
            self._clauses.add([-self._chosen[number], *outside])
