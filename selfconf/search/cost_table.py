"""What candidates and recruits cost, level by level and combined into one integer that is ordered as the levels are."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from math import lcm

from selfconf.model.configuration import Configuration
from selfconf.model.cost import cost, unknown
from selfconf.model.partition import Candidate
from selfconf.model.profile import Profile
from selfconf.model.term import IRI
from selfconf.search.problem import Problem

LEADING_LEVELS = 2
"""Levels before those that the template states: how many newcomers there are, and how many terms are unknown."""
NO_ROLE = IRI.unchecked("")
"""The role of a recruit, which no term of a cost names."""
Amounts = tuple[Fraction, ...]
"""What something costs, level by level."""


class CostTable:
    """What each candidate costs in each role, and each recruit, level by level and combined into one integer.

    Each level becomes a digit of a number with mixed radix: scaled to be whole, and with a base beyond what all slots
    and recruits can differ by on it. So integers are ordered as the levels are. What candidates cost is shifted to
    begin at zero, as each slot has one of them.
    """

    def __init__(self, problem: Problem, running: Configuration | None = None, recruits: Iterable[int] = ()) -> None:
        """`recruits` are those that may be chosen, by number."""
        self._exact_recruits: dict[int, Amounts] = {
            number: recruit_cost(problem, number, running) for number in recruits
        }
        self.exact = _exact_costs(problem, running)
        """For each role the cost of its candidates by number, level by level; nothing for a role without slots."""
        rows = [row for role in self.exact for row in role]
        brought = list(self._exact_recruits.values())
        width = range(LEADING_LEVELS + len(problem.task.template.cost))
        self.scale = [lcm(*(row[k].denominator for row in (*rows, *brought))) for k in width]
        self.lowest: Amounts = tuple(min((row[k] for row in rows), default=Fraction(0)) for k in width)
        self.rewards = [self._rewarded(k, brought) for k in width]
        """What recruits could make a solution cheaper at most, digit by digit: zero or less."""
        self.base = self._bases(rows, brought, sum(role.minimum for role in problem.roles))
        self.of: list[list[int]] = [[self._combined(row, self.lowest) for row in role] for role in self.exact]
        """For each role the combined cost of its candidates by number."""
        unshifted = (Fraction(0),) * len(width)
        self.of_recruit = {number: self._combined(row, unshifted) for number, row in self._exact_recruits.items()}
        """The combined cost of each recruit by number."""
        self._number = [
            {c.profile.component: number for number, c in enumerate(candidates)} for candidates in problem.candidates
        ]

    @property
    def order(self) -> dict[int, list[int]]:
        """For each role that has slots its candidates by number, the cheapest first, else as they come."""
        return {role: sorted(range(len(row)), key=row.__getitem__) for role, row in enumerate(self.of) if row}

    def _whole(self, level: int, amount: Fraction) -> int:
        """Return an amount of a level as a whole number of its units."""
        return int(amount * self.scale[level])

    def _rewarded(self, level: int, brought: Sequence[Amounts]) -> int:
        return sum(self._whole(level, min(row[level], Fraction(0))) for row in brought)

    def _bases(self, rows: Sequence[Amounts], brought: Sequence[Amounts], slots: int) -> list[int]:
        """Return for each level what one unit of it is worth: more than all that solutions can differ by below it."""
        base = [1] * len(self.scale)
        for k in range(len(base) - 1, 0, -1):
            span = max((row[k] for row in rows), default=Fraction(0)) - self.lowest[k]
            of_recruits = sum(self._whole(k, abs(row[k])) for row in brought)
            base[k - 1] = base[k] * (1 + slots * self._whole(k, span) + of_recruits)
        return base

    def _combined(self, row: Amounts, lowest: Amounts) -> int:
        levels = zip(row, lowest, self.base, strict=True)
        return sum(self._whole(k, value - low) * base for k, (value, low, base) in enumerate(levels))

    def total(self, playing: Sequence[Sequence[Candidate]], recruits: Iterable[int] = ()) -> int:
        """Return the combined cost of a solution."""
        return sum(
            self.of[role][self._number[role][c.profile.component]] for role, some in enumerate(playing) for c in some
        ) + sum(self.of_recruit[number] for number in recruits)

    def levels(self, playing: Sequence[Sequence[Candidate]], recruits: Iterable[int] = ()) -> tuple[Fraction, ...]:
        """Return the cost of a solution, level by level, with the newcomers and the unknown before all others."""
        rows = [
            self.exact[role][self._number[role][c.profile.component]] for role, some in enumerate(playing) for c in some
        ]
        rows += [self._exact_recruits[number] for number in recruits]
        return tuple(sum((row[k] for row in rows), Fraction(0)) for k in range(len(self.base)))

    def levels_of(self, combined: int, slots: int) -> tuple[Fraction, ...]:
        """Return the levels that a combined cost of a number of slots stands for."""
        found = []
        # Without what recruits could make cheaper, no digit is below zero.
        combined -= sum(reward * base for reward, base in zip(self.rewards, self.base, strict=True))
        for low, scale, base, reward in zip(self.lowest, self.scale, self.base, self.rewards, strict=True):
            digit, combined = divmod(combined, base)
            found.append(Fraction(digit + reward, scale) + low * slots)
        return tuple(found)


def _exact_costs(problem: Problem, running: Configuration | None) -> list[list[tuple[Fraction, ...]]]:
    levels = problem.task.template.cost
    played = {a.role: frozenset(a.components) for a in running.assignments} if running is not None else {}
    none: frozenset[IRI] = frozenset()

    def row(role: IRI, candidate: Candidate) -> tuple[Fraction, ...]:
        newcomer = bool(played) and candidate.profile.component not in played.get(role, none)
        return Fraction(newcomer), *cost(levels, role, candidate.profile, problem.hierarchy)

    return [
        [row(role.iri, candidate) for candidate in candidates] if role.minimum else []
        for role, candidates in zip(problem.roles, problem.candidates, strict=True)
    ]


def missing_of(
    problem: Problem, playing: Sequence[Sequence[Candidate]], recruits: Iterable[Profile] = ()
) -> tuple[tuple[IRI, IRI], ...]:
    """Return the components of a solution, each with a property that a term of the cost asks of it in vain."""
    players = [(role.iri, c.profile) for role, some in zip(problem.roles, playing, strict=True) for c in some]
    return tuple(
        (profile.component, wanted)
        for role, profile in (*players, *((NO_ROLE, profile) for profile in recruits))
        for wanted in unknown(problem.task.template.cost, role, profile, problem.hierarchy)
    )


def recruit_cost(problem: Problem, number: int, running: Configuration | None) -> tuple[Fraction, ...]:
    """Return what a recruit, by number, costs level by level, with whether it is a newcomer before all others."""
    recruit = problem.supply.recruits[number]
    newcomer = running is not None and bool(running.assignments) and recruit.component not in running.recruits
    levels = problem.task.template.cost
    return Fraction(newcomer), *cost(levels, NO_ROLE, recruit.profile, problem.hierarchy)
