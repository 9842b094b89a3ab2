"""The strategy `best`: a solution of least cost, with a proof.

*What is best.* The cost of a solution is the sum of what its components cost in their roles (`model.cost`), level by
level. The answer is the lexicographically first of the solutions of least cost, extended as usual; components that
are added by the extension are a gift and do not count. `first` ignores cost: it takes the least solution in the order
of preference. With no cost stated, or one that is the same for all, both give the same answer.

*After a failure.* With a configuration that runs, newcomers are the first level of the cost: who did not play the role
costs one. So the answer starts as few components as can be, and is the cheapest of the solutions that do. What is
beyond the minima does not count, nor do connections, unlike in a repair (`repair`).

*How.* Levels are folded into one integer that is ordered as they are. Options of a role are sorted by cost, then by
their order, for which the argument of the kernel holds as it does for the order alone: a member of a group that is
beyond the first k can be replaced by one that costs no more. Branch and bound walks depth first, cheapest first, and
leaves what costs, together with the cheapest options of the slots to come, no less than the best solution so far.
What it has at any time is a solution and a bound; when it is through, the bound is the cost. A second walk, in the
order of the candidates and bounded by the least cost, finds the first of the best.
After some steps clause learning takes over, guided by cores (`maxsat`): what a role costs at least is a bound from
the start, each core raises it, and the first of the best is found as it is for `first`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import accumulate
from math import lcm

from selfconf.model.configuration import Configuration
from selfconf.model.cost import cost, unknown
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Refusal, Undecided
from selfconf.model.term import IRI
from selfconf.search import explain
from selfconf.search.budget import Budget
from selfconf.search.engines import ClauseSolver, ReducedSearch, minimise, solver_available
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, Option, ReducedProblem, assigned, pruned, reduced
from selfconf.search.strategies.first import solution

BRANCHING_STEPS = 20_000
"""Steps of branch and bound before clauses are written."""
BEFORE = 2
"""Levels before those that the template states: how many newcomers there are, and how many terms are unknown."""
BEST_STEPS = 2_000_000
"""Steps until the search for the best is content with a good one."""


def best_configuration(
    problem: Problem, steps: int = BEST_STEPS, running: Configuration | None = None
) -> Optimum | Refusal | Undecided:
    """The best configuration that was found within so many steps, or why there is none.

    With a configuration that runs it is the best of those with the fewest newcomers.
    """
    given = LazyReduction(problem)
    playing = solution(given, Budget(steps))
    if isinstance(playing, Undecided):
        return Undecided(steps, unaided=not solver_available())
    if playing is None:
        return explain.refusal(given)
    prices = CostTable(problem, running)
    order = {
        role: sorted(range(len(problem.candidates[role])), key=prices.of[role].__getitem__)
        for role, asked in enumerate(problem.roles)
        if asked.minimum
    }
    part = pruned(reduced(problem, order=order))
    total = prices.total(playing)
    chosen, bound, done = _by_walking(
        part, prices, total, Budget(min(steps, BRANCHING_STEPS) if solver_available() else steps)
    )
    if chosen is not None:
        playing = assigned(problem, chosen)
    if not done and solver_available():
        better, bound, done = _by_clauses(part, prices, Budget(steps))
        other = playing if better is None else assigned(problem, better)
        # What clause learning has met when its budget ends may cost more than what branch and bound has met.
        if done or prices.total(other) < prices.total(playing):
            playing = other
    spent = prices.levels(playing)
    least = spent if done else prices.unfolded(bound, len(part.slots))
    missing = [
        (candidate.profile.component, wanted)
        for role, some in zip(problem.roles, playing, strict=True)
        for candidate in some
        for wanted in unknown(problem.task.template.cost, role.iri, candidate.profile, problem.hierarchy)
    ]
    # What comes before the levels and could be less leaves no more to be said of them than what candidates cost.
    bounds = least if least[:BEFORE] == spent[:BEFORE] else prices.unfolded(0, len(part.slots))
    configuration = problem.solved(playing, running)
    return Optimum(configuration, spent[BEFORE:], bounds[BEFORE:], tuple(missing), proved=spent == least)


class CostTable:
    """What each candidate costs in each role, folded into an integer."""

    def __init__(self, problem: Problem, running: Configuration | None = None) -> None:
        levels = problem.task.template.cost
        played = {a.role: frozenset(a.components) for a in running.assignments} if running is not None else {}
        nobody: frozenset[IRI] = frozenset()

        def price(role: IRI, candidate: Candidate) -> tuple[Fraction, ...]:
            newcomer = bool(played) and candidate.profile.component not in played.get(role, nobody)
            return Fraction(newcomer), *cost(levels, role, candidate.profile, problem.hierarchy)

        self.exact: list[list[tuple[Fraction, ...]]] = [
            [price(role.iri, candidate) for candidate in candidates] if role.minimum else []
            for role, candidates in zip(problem.roles, problem.candidates, strict=True)
        ]
        rows = [row for role in self.exact for row in role]
        slots = sum(role.minimum for role in problem.roles)
        width = BEFORE + len(levels)
        self.scale = [lcm(*(row[k].denominator for row in rows)) for k in range(width)]
        self.lowest = [min((row[k] for row in rows), default=Fraction(0)) for k in range(width)]
        self.base = [1] * width
        for k in range(width - 1, 0, -1):
            span = max((row[k] for row in rows), default=Fraction(0)) - self.lowest[k]
            self.base[k - 1] = self.base[k] * (1 + slots * int(span * self.scale[k]))
        self.of: list[list[int]] = [[self._folded(row) for row in role] for role in self.exact]
        """For each role the folded cost of its candidates by number."""
        self._number = [
            {c.profile.component: number for number, c in enumerate(candidates)} for candidates in problem.candidates
        ]

    def _folded(self, row: Sequence[Fraction]) -> int:
        return sum(
            int((value - low) * scale) * base
            for value, low, scale, base in zip(row, self.lowest, self.scale, self.base, strict=True)
        )

    def total(self, playing: Sequence[Sequence[Candidate]]) -> int:
        """The folded cost of a solution."""
        return sum(
            self.of[role][self._number[role][c.profile.component]] for role, some in enumerate(playing) for c in some
        )

    def levels(self, playing: Sequence[Sequence[Candidate]]) -> tuple[Fraction, ...]:
        """The cost of a solution, level by level, with the newcomers and the unknown before all others."""
        rows = [
            self.exact[role][self._number[role][c.profile.component]] for role, some in enumerate(playing) for c in some
        ]
        return tuple(sum((row[k] for row in rows), Fraction(0)) for k in range(len(self.base)))

    def unfolded(self, folded: int, slots: int) -> tuple[Fraction, ...]:
        """The levels that a folded cost of so many slots stands for."""
        found = []
        for low, scale, base in zip(self.lowest, self.scale, self.base, strict=True):
            digit, folded = divmod(folded, base)
            found.append(Fraction(digit, scale) + low * slots)
        return tuple(found)


class _Bounded(ReducedSearch):
    """Leaves out options that would make a solution cost more than a limit."""

    def __init__(self, part: ReducedProblem, prices: CostTable, limit: int) -> None:
        super().__init__(part, True)
        self.of, self.limit = prices.of, limit
        self.spent = [0]
        """What the options chosen so far cost, by slot."""
        cheapest = [min((prices.of[r][o.number] for o in part.options[r]), default=0) for r in part.slots]
        self.to_come = list(accumulate(reversed(cheapest), initial=0))[-2::-1]
        """What the slots after each cost at least."""
        self.least = sum(cheapest)

    def push(self, place: int, option: Option) -> bool:
        """Put an option into a slot, unless it cannot be there or costs too much."""
        spent = self.spent[-1] + self.of[option.kind.role][option.number]
        if spent + self.to_come[place] > self.limit or not super().push(place, option):
            return False
        self.spent.append(spent)
        return True

    def pop(self) -> None:
        """Take the last option out again."""
        super().pop()
        del self.spent[1 + len(self.chosen) :]


def _by_walking(
    part: ReducedProblem, prices: CostTable, known: int, budget: Budget
) -> tuple[list[Option] | None, int, bool]:
    """The first of the cheapest solutions, their cost and True; or else what is cheaper than known, and a bound."""
    best: list[Option] | None = None
    walk = _Bounded(part, prices, known - 1)
    for found in walk.solutions(budget):
        if isinstance(found, Undecided):
            return best, walk.least, False
        best, walk.limit = found, walk.spent[-1] - 1
    least = walk.limit + 1
    first = next(_Bounded(_in_order(part), prices, least).solutions(budget), None)
    return (first, least, True) if isinstance(first, list) else (best, least, False)


def _by_clauses(part: ReducedProblem, prices: CostTable, budget: Budget) -> tuple[list[Option] | None, int, bool]:
    """The same by cores; no solution if the budget ends before."""
    ordered = _in_order(part)
    with ClauseSolver(ordered) as clauses:
        weights: dict[int, int] = {}
        unavoidable = 0
        for role in dict.fromkeys(ordered.slots):
            costs = [prices.of[role][option.number] for option in ordered.options[role]]
            unavoidable += min(costs) * ordered.slots.count(role)
            for literal, amount in zip(clauses.plays[role], costs, strict=True):
                weights[literal] = amount - min(costs)
        more, done, lightest = minimise(clauses, weights, budget)
        found = clauses.least(budget) if done else None
        if isinstance(found, list):
            return found, unavoidable + more, True
        return lightest, unavoidable + more, False


def _in_order(part: ReducedProblem) -> ReducedProblem:
    """The same options in the order of the candidates."""
    return replace(part, options=tuple(tuple(sorted(o, key=_number)) for o in part.options))


def _number(option: Option) -> int:
    return option.number
