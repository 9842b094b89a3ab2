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

from itertools import accumulate

from selfconf.model.configuration import Configuration
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Refusal, Undecided
from selfconf.search import explain
from selfconf.search.budget import Budget
from selfconf.search.cost_table import LEADING_LEVELS, CostTable, missing_of
from selfconf.search.engines import ClauseSolver, ReducedSearch, least_of_clauses, minimise, solver_available
from selfconf.search.extension import solved
from selfconf.search.problem import Problem
from selfconf.search.recruiting import refusal_of_recruits
from selfconf.search.reduction import LazyReduction, Option, ReducedProblem, assigned, in_order, pruned, reduced
from selfconf.search.strategies.best_recruited import best_with_recruits, slot_weights, with_priced_recruits
from selfconf.search.strategies.first import solution

BRANCHING_STEPS = 20_000
"""Steps of branch and bound before clauses are written."""
BEST_STEPS = 2_000_000
"""Steps until the search for the best answers with the cheapest solution met."""


def best_configuration(
    problem: Problem, steps: int = BEST_STEPS, running: Configuration | None = None
) -> Optimum | Refusal | Undecided:
    """Return the best configuration that is found within a number of steps, or why there is none.

    With a configuration that runs it is the best of those with the fewest newcomers. Where roles recruit, see
    `best_recruited`.
    """
    given = LazyReduction(problem)
    if not any(role.recruits for role in problem.roles):
        return _best_players(given, steps, running)
    if solver_available() and isinstance(solution(given, Budget(steps)), list):
        found = best_with_recruits(problem, steps, running)
    else:
        players = _best_players(given, steps, running)
        if not isinstance(players, Optimum):
            return players
        found = with_priced_recruits(problem, players, steps, running)
    return refusal_of_recruits(problem) if found is None else found


def _best_players(given: LazyReduction, steps: int, running: Configuration | None) -> Optimum | Refusal | Undecided:
    """Return the best configuration of players alone, or why there is none."""
    problem = given.problem
    playing = solution(given, Budget(steps))
    if isinstance(playing, Undecided):
        return Undecided(steps, unaided=not solver_available())
    if playing is None:
        return explain.refusal(given)
    costs = CostTable(problem, running)
    part = pruned(reduced(problem, order=costs.order))
    playing, bound, first = _cheapest(problem, part, costs, playing, steps)
    spent = costs.levels(playing)
    least = spent if first else costs.levels_of(bound, len(part.slots))
    # Where a leading level could be less, the bounds of the stated levels hold no more: all that is left to say of
    # these is what the cheapest candidates cost.
    tight = least[:LEADING_LEVELS] == spent[:LEADING_LEVELS]
    bounds = least if tight else costs.levels_of(0, len(part.slots))
    return Optimum(
        solved(problem, playing, running),
        spent[LEADING_LEVELS:],
        bounds[LEADING_LEVELS:],
        missing_of(problem, playing),
        proved=spent == least,
        first=first,
        unaided=not solver_available(),
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


class _BoundedSearch(ReducedSearch):
    """Leaves out options with which a solution would cost more than a limit."""

    def __init__(self, part: ReducedProblem, costs: CostTable, limit: int) -> None:
        super().__init__(part)
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
    first = next(_BoundedSearch(in_order(part), costs, least).solutions(budget), None)
    return (first, least, True) if isinstance(first, list) else (best, least, False)


def _by_cores(part: ReducedProblem, costs: CostTable, budget: Budget) -> tuple[list[Option] | None, int, bool]:
    """Return the first of the cheapest solutions, their cost and True, by clause learning.

    When the budget ends: the cheapest solution met, if any, a bound, and False.
    """
    ordered = in_order(part)
    with ClauseSolver(ordered) as clauses:
        weights, unavoidable = slot_weights(clauses, ordered, costs)
        more, proved, lightest = minimise(clauses, weights, budget)
        found = least_of_clauses(clauses, budget) if proved else None
        if isinstance(found, list):
            return found, unavoidable + more, True
        return lightest, unavoidable + more, False
