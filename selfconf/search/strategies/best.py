"""The strategy `best`: a solution of least cost, with a proof.

*What is best.* The cost of a solution is the sum of what its components cost in their roles (`model.cost`), level by
level. The answer is the lexicographically first of the solutions of least cost, extended as usual; components that
are added by the extension do not count. `first` ignores cost: it takes the least solution in the order of preference.
With no cost stated, or one that is the same for all, both give the same answer.

*After a failure.* With a configuration that runs, newcomers are the first level of the cost: a component that did not
play the role costs one. So the answer starts as few components as possible, and is the cheapest of the solutions that
do. Components beyond the minima do not count, nor do connections, unlike in a reconfiguration by `reconfigure`.

*How it is found.* Levels are combined into one integer that is ordered as they are. Options of a role are sorted by
cost, then by their order, for which the argument of dominance holds as it does for the order alone: a member of a group
that is beyond the first k can be replaced by one that costs no more. Branch and bound goes depth first, cheapest first,
and leaves a partial solution that costs, together with the cheapest options of the slots to come, no less than the
incumbent. It has a solution and a bound at any time; when it is exhausted, the bound is the cost. A second search, in
the order of the candidates and bounded by the least cost, finds the first of the best.
After some steps clause learning takes over, guided by cores (`max_sat`): what a role costs at least is a bound from
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
from selfconf.search.engines import ClauseSolver, ReducedSearch, least_of_clauses, minimise, solver_available
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, Option, ReducedProblem, assigned, pruned, reduced
from selfconf.search.strategies.first import solution

BRANCHING_STEPS = 20_000
"""Steps of branch and bound before clauses are written."""
LEADING_LEVELS = 2
"""Levels before those that the template states: how many newcomers there are, and how many terms are unknown."""
BEST_STEPS = 2_000_000
"""Steps until the search for the best answers with the cheapest solution met."""


def best_configuration(
    problem: Problem, steps: int = BEST_STEPS, running: Configuration | None = None
) -> Optimum | Refusal | Undecided:
    """Return the best configuration that is found within a number of steps, or why there is none.

    With a configuration that runs it is the best of those with the fewest newcomers.
    """
    given = LazyReduction(problem)
    playing = solution(given, Budget(steps))
    if isinstance(playing, Undecided):
        return Undecided(steps, unaided=not solver_available())
    if playing is None:
        return explain.refusal(given)
    costs = CostTable(problem, running)
    order = {
        role: sorted(range(len(problem.candidates[role])), key=costs.of[role].__getitem__)
        for role, asked in enumerate(problem.roles)
        if asked.minimum
    }
    part = pruned(reduced(problem, order=order))
    playing, bound, proved = _cheapest(problem, part, costs, playing, steps)
    spent = costs.levels(playing)
    least = spent if proved else costs.levels_of(bound, len(part.slots))
    missing = [
        (candidate.profile.component, wanted)
        for role, some in zip(problem.roles, playing, strict=True)
        for candidate in some
        for wanted in unknown(problem.task.template.cost, role.iri, candidate.profile, problem.hierarchy)
    ]
    # Where a leading level could be less, the bounds of the stated levels hold no more: all that is left to say of
    # these is what the cheapest candidates cost.
    tight = least[:LEADING_LEVELS] == spent[:LEADING_LEVELS]
    bounds = least if tight else costs.levels_of(0, len(part.slots))
    configuration = problem.solved(playing, running)
    return Optimum(
        configuration, spent[LEADING_LEVELS:], bounds[LEADING_LEVELS:], tuple(missing), proved=spent == least
    )


def _cheapest(
    problem: Problem, part: ReducedProblem, costs: CostTable, playing: list[list[Candidate]], steps: int
) -> tuple[list[list[Candidate]], int, bool]:
    """Return the cheapest solution that is met, a bound of the cost, and whether it is the first of the best for sure.

    `playing` is a solution to begin with.
    """
    branching = Budget(min(steps, BRANCHING_STEPS) if solver_available() else steps)
    chosen, bound, proved = _by_branch_and_bound(part, costs, costs.total(playing), branching)
    if chosen is not None:
        playing = assigned(problem, chosen)
    if proved or not solver_available():
        return playing, bound, proved
    better, bound, proved = _by_cores(part, costs, Budget(steps))
    if better is not None:
        other = assigned(problem, better)
        # What clause learning has met when its budget ends may cost more than what branch and bound has met.
        if proved or costs.total(other) < costs.total(playing):
            playing = other
    return playing, bound, proved


class CostTable:
    """What each candidate costs in each role, level by level and combined into one integer.

    Each level becomes a digit of a number with mixed radix: shifted to begin at zero, scaled to be whole, and with a
    base beyond what all slots can cost on it. So integers are ordered as the levels are.
    """

    def __init__(self, problem: Problem, running: Configuration | None = None) -> None:
        self.exact = _exact_costs(problem, running)
        """For each role the cost of its candidates by number, level by level; nothing for a role without slots."""
        rows = [row for role in self.exact for row in role]
        slots = sum(role.minimum for role in problem.roles)
        width = LEADING_LEVELS + len(problem.task.template.cost)
        self.scale = [lcm(*(row[k].denominator for row in rows)) for k in range(width)]
        self.lowest = [min((row[k] for row in rows), default=Fraction(0)) for k in range(width)]
        self.base = [1] * width
        for k in range(width - 1, 0, -1):
            span = max((row[k] for row in rows), default=Fraction(0)) - self.lowest[k]
            self.base[k - 1] = self.base[k] * (1 + slots * int(span * self.scale[k]))
        self.of: list[list[int]] = [[self._combined(row) for row in role] for role in self.exact]
        """For each role the combined cost of its candidates by number."""
        self._number = [
            {c.profile.component: number for number, c in enumerate(candidates)} for candidates in problem.candidates
        ]

    def _combined(self, row: Sequence[Fraction]) -> int:
        return sum(
            int((value - low) * scale) * base
            for value, low, scale, base in zip(row, self.lowest, self.scale, self.base, strict=True)
        )

    def total(self, playing: Sequence[Sequence[Candidate]]) -> int:
        """Return the combined cost of a solution."""
        return sum(
            self.of[role][self._number[role][c.profile.component]] for role, some in enumerate(playing) for c in some
        )

    def levels(self, playing: Sequence[Sequence[Candidate]]) -> tuple[Fraction, ...]:
        """Return the cost of a solution, level by level, with the newcomers and the unknown before all others."""
        rows = [
            self.exact[role][self._number[role][c.profile.component]] for role, some in enumerate(playing) for c in some
        ]
        return tuple(sum((row[k] for row in rows), Fraction(0)) for k in range(len(self.base)))

    def levels_of(self, combined: int, slots: int) -> tuple[Fraction, ...]:
        """Return the levels that a combined cost of a number of slots stands for."""
        found = []
        for low, scale, base in zip(self.lowest, self.scale, self.base, strict=True):
            digit, combined = divmod(combined, base)
            found.append(Fraction(digit, scale) + low * slots)
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


class _BoundedSearch(ReducedSearch):
    """Leaves out options with which a solution would cost more than a limit."""

    def __init__(self, part: ReducedProblem, costs: CostTable, limit: int) -> None:
        super().__init__(part, True)
        self.of, self.limit = costs.of, limit
        self.spent = [0]
        """What the options chosen so far cost, by slot."""
        cheapest = [min((costs.of[r][o.number] for o in part.options[r]), default=0) for r in part.slots]
        self.to_come = list(accumulate(reversed(cheapest), initial=0))[-2::-1]
        """What the slots after each cost at least: the bound takes each slot by itself, whatever it needs."""
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
        # Not one less in any case: the search also takes out an option that it has put in and then rejected.
        del self.spent[1 + len(self.chosen) :]


def _by_branch_and_bound(
    part: ReducedProblem, costs: CostTable, known: int, budget: Budget
) -> tuple[list[Option] | None, int, bool]:
    """Return the first of the cheapest solutions, their cost and True.

    When the budget ends: the cheapest solution met that costs less than what is known, if any, a bound, and False.
    """
    best: list[Option] | None = None
    search = _BoundedSearch(part, costs, known - 1)
    for found in search.solutions(budget):
        if isinstance(found, Undecided):
            return best, search.least, False
        best, search.limit = found, search.spent[-1] - 1
    least = search.limit + 1
    first = next(_BoundedSearch(_in_order(part), costs, least).solutions(budget), None)
    return (first, least, True) if isinstance(first, list) else (best, least, False)


def _by_cores(part: ReducedProblem, costs: CostTable, budget: Budget) -> tuple[list[Option] | None, int, bool]:
    """Return the first of the cheapest solutions, their cost and True, by clause learning.

    When the budget ends: the cheapest solution met, if any, a bound, and False.
    """
    ordered = _in_order(part)
    with ClauseSolver(ordered) as clauses:
        weights: dict[int, int] = {}
        unavoidable = 0
        for role in dict.fromkeys(ordered.slots):
            of_role = [costs.of[role][option.number] for option in ordered.options[role]]
            unavoidable += min(of_role) * ordered.slots.count(role)
            for literal, amount in zip(clauses.plays[role], of_role, strict=True):
                weights[literal] = amount - min(of_role)
        more, proved, lightest = minimise(clauses, weights, budget)
        found = least_of_clauses(clauses, budget) if proved else None
        if isinstance(found, list):
            return found, unavoidable + more, True
        return lightest, unavoidable + more, False


def _in_order(part: ReducedProblem) -> ReducedProblem:
    """Return the problem with the options in the order of the candidates."""
    return replace(part, options=tuple(tuple(sorted(o, key=_number)) for o in part.options))


def _number(option: Option) -> int:
    return option.number
