"""The fewest recruits that are enough, by clauses; see `recruiting` for how."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines import FoundedSolver, minimise, solver_available
from selfconf.search.recruiting.recruit_choice import RecruitChoice

MOST_RECRUITS_LOOKED_AT = 250_000
"""How many recruits are looked at, at most, to exchange one after the other: a part of a second."""
LONG_CHAIN = 4_000
"""From how many recruits on a look takes longer: a chain has a bit for each."""
LITERAL_STEPS = 50_000_000
"""Steps of the solver times the suppliers of all needs, at most: a conflict takes the longer the more there are."""
FEWEST_STEPS = 40
"""With how many steps the solver is asked at least: where it may have fewer, its clauses alone take longer."""
WithoutSpare = Callable[[Sequence[int]], list[int]]
"""Recruits that are enough, by number, without those that can be spared."""


def fewest(choice: RecruitChoice, budget: Budget) -> tuple[list[int], bool]:
    """Return the fewest recruits that are enough, the first of them by preference, and whether that is proved."""
    met = _improved(choice, choice.without_spare(choice.chain()), budget)
    if not met or not solver_available():
        return met, not met
    steps = LITERAL_STEPS // max(1, choice.number_of_suppliers)
    if steps < FEWEST_STEPS:
        return met, False
    reduced, wanted = choice.reduced()
    budget = budget.part(steps)
    with FoundedSolver(reduced, wanted) as clauses:
        order = [option.number for option in reduced.options[-1]]
        return fewest_of(clauses, order, met, choice.without_spare, budget)


def _improved(choice: RecruitChoice, met: list[int], budget: Budget) -> list[int]:
    """Return recruits that are enough, fewer than some if one of these can be exchanged for what the others feed.

    Local search, which finds in a moment what the solver would take long for where most recruits can be fed. Which are
    found does not matter where their number is proved to be the least: then the first of all such are taken.
    """
    number = max(1, len(choice.needs))
    looks = budget.part(MOST_RECRUITS_LOOKED_AT // (number * (1 + number // LONG_CHAIN)))
    tried: set[int] = set()
    while looks.steps and (left := [number for number in reversed(met) if number not in tried]):
        looks.spend(1)
        tried.add(left[0])
        other = choice.exchanged(met, left[0])
        fewer = met if other is None else choice.without_spare(other)
        if len(fewer) < len(met):
            met, tried = fewer, set()
    return met


def fewest_of(
    clauses: FoundedSolver, order: Sequence[int], met: list[int], without_spare: WithoutSpare, budget: Budget
) -> tuple[list[int], bool]:
    """Return the fewest recruits that the clauses allow, the first of them in an order, and whether that is proved.

    `met` are recruits that they allow.
    """
    return _Fewest(clauses, order, met, without_spare).best(budget)


class _Fewest:
    """What is known of the fewest recruits that a solver allows."""

    def __init__(self, clauses: FoundedSolver, order: Sequence[int], met: list[int], spare: WithoutSpare) -> None:
        self.met, self._clauses, self._without_spare = met, clauses, spare
        self._chosen = {number: clauses.recruits[number] for number in order}
        clauses.prefer(-literal for literal in self._chosen.values())

    def best(self, budget: Budget) -> tuple[list[int], bool]:
        """The fewest, and of these the first by preference; and whether both are proved."""
        # Guided by cores: what each part of a chain needs at least adds up, but there is no answer until the end.
        half = Budget(None if budget.steps is None else budget.steps // 2)
        proved = minimise(self._clauses, dict.fromkeys(self._chosen.values(), 1), half).proved
        if not proved:
            self._descend(budget)
            return self.met, False
        self.met = self._without_spare(self._clauses.recruited())
        return self._first(budget)

    def _descend(self, budget: Budget) -> None:
        """Look for fewer than were met, again and again, until there are none or the budget ends."""
        while self.met:
            self._clauses.at_most(list(self._chosen.values()), len(self.met) - 1)
            fewer = self._answer([], budget)
            if not isinstance(fewer, list):
                return
            self.met = fewer

    def _first(self, budget: Budget) -> tuple[list[int], bool]:
        """Of the sets of the number that was met, the one with the first recruits."""
        order = list(self._chosen)
        place = {number: at for at, number in enumerate(order)}
        fixed: list[int] = []
        settled = 0
        """Up to which place of the order it is known what is chosen."""
        while len(fixed) < len(self.met):
            following = min(place[number] for number in self.met if place[number] >= settled)
            # One question for all that come before the next that is chosen: mostly none of them can be.
            earlier = self._clauses.literal()
            self._clauses.add([-earlier, *(self._chosen[number] for number in order[settled:following])])
            other = self._answer([*fixed, earlier], budget)
            if isinstance(other, Undecided):
                return self.met, False
            if other is None:
                fixed.append(self._chosen[order[following]])
                settled = following + 1
            else:
                self.met = other
        return self.met, True

    def _answer(self, assumed: list[int], budget: Budget) -> list[int] | Undecided | None:
        """Return the fewest recruits that are enough, some of which are given; None if no recruits are."""
        found = self._clauses.solve(assumed, budget)
        if isinstance(found, Undecided):
            return found
        return self._without_spare(self._clauses.recruited()) if found else None
