"""The strategy `best` where roles recruit: players and recruits of least cost together, with a proof.

*What is best.* A solution is players, and recruits that are enough for them and of which none can be spared. It costs
what its players cost in their roles and its recruits in no role. The answer is the first of the solutions of least
cost: that of the lexicographically first players, of these the one with the fewest recruits, and of these the first by
preference and IRI. After a failure newcomers are the first level, among players and recruits alike.

*How it is found.* Players and recruits are options of one reduced problem (`with_recruits`), whose clauses a solver has
that excludes recruits which only feed each other (`FoundedSolver`). Weighted optimisation guided by cores finds the
least cost, and a bound at any time; then the players are minimised, and with these the number of recruits. A weight
below zero is the weight of doing without.

Without a solver library, players and recruits are chosen one after the other, of as few recruits the cheaper ones, and
nothing is proved.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from fractions import Fraction
from functools import cache, partial

from selfconf.model.configuration import Configuration
from selfconf.model.cost import cost
from selfconf.model.immutable import immutable, replace
from selfconf.model.optimum import Optimum
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.cost_table import LEADING_LEVELS, NO_ROLE, CostTable, missing_of, recruit_cost
from selfconf.search.engines import ClauseSolver, FoundedSolver, least_of_clauses, minimise
from selfconf.search.extension import solved, with_further_players
from selfconf.search.problem import Problem
from selfconf.search.recruiting import (
    RECRUIT_STEPS,
    RecruitChoice,
    fewest_of,
    first_recruited,
    founded,
    recruited,
)
from selfconf.search.reduction import Option, ReducedProblem, assigned, in_order, pruned, with_recruits


@immutable
class _Chosen:
    """Players, and recruits by number."""

    players: list[list[Candidate]]
    recruits: list[int]


def best_with_recruits(
    problem: Problem, steps: int, running: Configuration | None = None
) -> Optimum | Undecided | None:
    """Return the best configuration with recruits that is found within a number of steps; None if there is none."""
    if problem.valueless:
        return None
    candidates = CostTable(problem, running)
    kept = frozenset(() if running is None else running.recruits)

    def preference(number: int) -> tuple[bool, int]:
        return problem.supply.recruits[number].component not in kept, number

    def rank(number: int) -> tuple[Fraction, ...]:
        return *recruit_cost(problem, number, running), *map(Fraction, preference(number))

    part = in_order(pruned(with_recruits(problem, (), candidates.order, rank)))
    numbers = [option.number for option in part.options[-1]]
    costs = CostTable(problem, running, numbers)
    rewarded = any(amount < 0 for amount in costs.of_recruit.values())
    with founded(problem, part, irredundant=rewarded) as clauses:
        search = _CheapestSearch(problem, part, costs, clauses, sorted(numbers, key=preference))
        found = search.run(Budget(steps))
    if not isinstance(found, _Chosen):
        return Undecided(steps) if found is None else None
    choice = RecruitChoice(problem, solved(problem, found.players), kept, found.recruits)
    brought = [number for number in found.recruits if number in choice.needs]
    spent = costs.levels(found.players, brought)
    least = spent if search.proved else costs.levels_of(search.bound, len(part.slots))
    # Where a leading level could be less, the bounds of the stated levels hold no more.
    tight = least[:LEADING_LEVELS] == spent[:LEADING_LEVELS]
    bounds = least if tight else costs.levels_of(_lowest(costs), len(part.slots))
    return Optimum(
        with_further_players(problem, choice.configuration(brought), running),
        spent[LEADING_LEVELS:],
        bounds[LEADING_LEVELS:],
        missing_of(problem, found.players, [problem.supply.recruits[number].profile for number in brought]),
        proved=spent == least,
        first=search.first,
    )


def _lowest(costs: CostTable) -> int:
    """Return what no solution can cost less than, on any level, combined."""
    return sum(reward * base for reward, base in zip(costs.rewards, costs.base, strict=True))


def slot_weights(clauses: ClauseSolver, part: ReducedProblem, costs: CostTable) -> tuple[dict[int, int], int]:
    """Return by literal by how much a candidate costs more than the cheapest of its role, and what these cost."""
    weights: dict[int, int] = {}
    unavoidable = 0
    for role in dict.fromkeys(part.slots):
        of_role = [costs.of[role][option.number] for option in part.options[role]]
        unavoidable += min(of_role) * part.slots.count(role)
        for literal, amount in zip(clauses.plays[role], of_role, strict=True):
            weights[literal] = amount - min(of_role)
    return weights, unavoidable


class _CheapestSearch:
    """Players and recruits of least cost by clause learning, with a bound and what was met so far."""

    def __init__(
        self, problem: Problem, part: ReducedProblem, costs: CostTable, clauses: FoundedSolver, order: Sequence[int]
    ) -> None:
        self.problem, self.part, self.costs, self.clauses, self.order = problem, part, costs, clauses, order
        """`order` is that in which recruits are preferred."""
        self.bound = _lowest(costs)
        self.proved = self.first = False
        """Whether nothing costs less for sure, and whether none that costs as little comes before."""

    def run(self, budget: Budget) -> _Chosen | bool | None:
        """Return the cheapest that is met; False if there is no solution, None if none is met within the budget."""
        clauses = self.clauses
        possible = clauses.solve((), budget)
        if possible is not True:
            return None if isinstance(possible, Undecided) else False
        met = [self._cleaned(clauses.chosen())]
        weights, unavoidable = self._weights()
        more, proved, lightest = minimise(clauses, weights, budget)
        self.bound = unavoidable + more
        if lightest is not None:
            met.append(self._cleaned(lightest))
        if not proved:
            return min(met, key=lambda chosen: self.costs.total(chosen.players, chosen.recruits))
        self.proved = True
        least = least_of_clauses(clauses, budget)
        return met[-1] if isinstance(least, Undecided) else self._with_fewest_recruits(least, budget)

    def _weights(self) -> tuple[Mapping[int, int], int]:
        """Return the weights of literals, none below zero, and what every solution costs beside them."""
        clauses, costs = self.clauses, self.costs
        weights, unavoidable = slot_weights(clauses, self.part, costs)
        for number, literal in clauses.recruits.items():
            amount = costs.of_recruit[number]
            weights[literal if amount > 0 else -literal] = abs(amount)
            unavoidable += min(amount, 0)
        return weights, unavoidable

    def _cleaned(self, options: Sequence[Option]) -> _Chosen:
        """Return what options stand for, without recruits that can be spared."""
        playing = [option for option in options if option.kind.role < len(self.problem.roles)]
        recruits = {option.number for option in options if option.kind.role == len(self.problem.roles)}
        return _Chosen(assigned(self.problem, playing), self._without_spare(playing, recruits))

    def _without_spare(self, playing: Sequence[Option], recruits: Collection[int]) -> list[int]:
        return self.clauses.without_spare(playing, [number for number in self.order if number in recruits])

    def _with_fewest_recruits(self, playing: Sequence[Option], budget: Budget) -> _Chosen:
        """Return the first of the best players with the fewest recruits of least cost, the first of these."""
        clauses = self.clauses
        for option in playing:
            place = self.part.options[option.kind.role].index(option)
            clauses.add([clauses.plays[option.kind.role][place]])
        spare = partial(self._without_spare, playing)
        found, self.first = fewest_of(clauses, self.order, spare(clauses.recruited()), spare, budget)
        return _Chosen(assigned(self.problem, playing), found)


def with_priced_recruits(
    problem: Problem, optimum: Optimum, steps: int, running: Configuration | None
) -> Optimum | Undecided | None:
    """Return the best players with few recruits for them, cheap ones first, or the first that have some; None if none.

    For when there is no solver library: then nothing is proved that recruits could make cheaper.
    """
    steps = min(steps, RECRUIT_STEPS)
    price = cache(partial(recruit_cost, problem, running=running))
    whole = recruited(problem, optimum.configuration, running, steps, price)
    if whole is not None:
        return _priced(problem, optimum, whole[0], running)
    other = first_recruited(problem, steps, running, price)
    # Of these players nothing is known but that they come first.
    unproved = replace(optimum, proved=False)
    return _priced(problem, unproved, other, running) if isinstance(other, Configuration) else other


def _priced(problem: Problem, optimum: Optimum, configuration: Configuration, running: Configuration | None) -> Optimum:
    """Return an optimum with a configuration that has recruits: these cost as players do, in no role.

    What a solution costs is what its first players cost, as many as each role asks for, and its recruits. That nothing
    costs less is proved only where there are no recruits, and none could make a solution cheaper.
    """
    chosen = [n for n, recruit in enumerate(problem.supply.recruits) if recruit.component in configuration.recruits]
    costs = CostTable(problem, running, chosen)
    players = _first_players(problem, configuration)
    spent, alone = costs.levels(players, chosen), costs.levels(_first_players(problem, optimum.configuration))
    # Where a leading level could be less, the bounds of the stated levels hold no more.
    tight = spent[:LEADING_LEVELS] == alone[:LEADING_LEVELS]
    lowest = tuple(amount * sum(map(len, players)) for amount in costs.lowest)
    profiles = [recruit.profile for recruit in problem.supply.recruits]
    levels, hierarchy = problem.task.template.cost, problem.hierarchy
    cheaper = any(amount < 0 for one in profiles for amount in cost(levels, NO_ROLE, one, hierarchy))
    return replace(
        optimum,
        configuration=configuration,
        bound=_with_cheapest(problem, optimum.bound if tight else lowest[LEADING_LEVELS:]),
        cost=spent[LEADING_LEVELS:],
        missing=missing_of(problem, players, [profiles[number] for number in chosen]),
        proved=optimum.proved and not configuration.recruits and not cheaper,
    )


def _first_players(problem: Problem, configuration: Configuration) -> list[list[Candidate]]:
    """Return the players of a configuration without those beyond what the roles ask for."""
    return [
        [c for one in a.components[: role.minimum] for c in candidates if c.profile.component == one]
        for a, role, candidates in zip(configuration.assignments, problem.roles, problem.candidates, strict=True)
    ]


def _with_cheapest(problem: Problem, bound: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    """Return a bound of what players cost, less all that recruits could make a solution cheaper."""
    levels, hierarchy = problem.task.template.cost, problem.hierarchy
    profiles = (recruit.profile for recruit in problem.supply.recruits)
    amounts = [cost(levels, NO_ROLE, profile, hierarchy)[1:] for profile in profiles]
    return tuple(
        least + sum((min(one[number], Fraction(0)) for one in amounts), Fraction(0))
        for number, least in enumerate(bound)
    )
