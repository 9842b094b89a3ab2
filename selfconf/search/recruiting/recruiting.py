"""Recruits: the fewest components outside of the roles that feed what the players of a configuration still need.

*Problem.* Given players with inputs that no role feeds, choose recruits so that each of these inputs has a source among
them, and each required input of a recruit a source among recruits and players, without a cycle among recruits; as few
as possible, and of equally few the first by preference and IRI. Whether there are any is a least fixpoint (`supply`);
the fewest are NP-hard to find, as a minimal set cover is (Karp, 1972).

*How.* Recruits that matter are those that are usable and lead to a need. A short chain of suppliers for each need is a
first answer (`recruit_choice`), which local search makes shorter (`fewest_recruits`). Then clauses prove how few are
enough: a literal for each recruit says that it is chosen, an input implies one of those that could feed it, and a set
of chosen recruits that only feed each other is excluded by a landmark (`engines.founded`). Without a solver library, or
where the steps end, the answer is what is left once none of them can be spared.
"""

from __future__ import annotations

from selfconf.model.configuration import Configuration
from selfconf.model.immutable import replace
from selfconf.model.partition import Candidate
from selfconf.model.refusal import Undecided
from selfconf.search.budget import Budget
from selfconf.search.engines import CandidateSearch, FoundedSolver, least_of_clauses, solver_available
from selfconf.search.extension import solved, with_further_players
from selfconf.search.problem import Problem
from selfconf.search.recruiting.fewest_recruits import fewest
from selfconf.search.recruiting.recruit_choice import Price, RecruitChoice
from selfconf.search.reduction import (
    ReducedProblem,
    assigned,
    needed_signals,
    pruned,
    signals_served,
    with_recruits,
)

RECRUIT_STEPS = 250_000
"""Steps spent at most on finding the fewest recruits, each a conflict of the solver or a call of it: two seconds."""
REPAIR_STEPS = 5_000
"""Steps spent at most on that while components wait to act again: a part of a second."""


def recruited(
    problem: Problem,
    configuration: Configuration,
    running: Configuration | None = None,
    steps: int = RECRUIT_STEPS,
    price: Price | None = None,
) -> tuple[Configuration, bool] | None:
    """Return a configuration with the recruits that it needs, and whether they are proved to be the fewest.

    None where its players have inputs that no recruits can feed. Of equally few recruits those of a lower `price` come
    before others, then those of the `running` configuration, and its players last; of the further players these come
    first.
    """
    if not any(role.recruits for role in problem.roles):
        return configuration, True
    recruits, players = ((), ()) if running is None else (running.recruits, running.players)
    choice = RecruitChoice(problem, configuration, recruits, price=price, busy=players)
    if not choice.possible:
        return None
    chosen, proved = fewest(choice, Budget(steps))
    return with_further_players(problem, choice.configuration(chosen), running), proved


def first_recruited(
    problem: Problem,
    steps: int = RECRUIT_STEPS,
    running: Configuration | None = None,
    price: Price | None = None,
) -> Configuration | Undecided | None:
    """Return the configuration of the first players that recruits can feed, or None.

    For when the first solution is not one of them: recruits may need what a player issues, or play a role themselves.
    With a configuration that runs they are the first of those that keep the most of its players in their roles. Without
    a solver, or where the steps end before that is known, others might keep more.
    """
    search = _by_clauses if solver_available() else _by_enumeration
    playing = None if problem.valueless else search(problem, Budget(steps), running)
    if isinstance(playing, Undecided):
        return Undecided(steps)
    if playing is None:
        return None
    found = recruited(problem, solved(problem, playing), running, steps, price)
    assert found is not None
    return found[0]


def possible_with_recruits(problem: Problem, steps: int) -> bool:
    """Return whether a configuration, with recruits for its players, is found within some steps."""
    budget = Budget(steps)
    if problem.valueless or not solver_available():
        return not problem.valueless and isinstance(_by_enumeration(problem, budget, None), list)
    with founded(problem, pruned(with_recruits(problem))) as clauses:
        return clauses.solve((), budget) is True


def founded(
    problem: Problem, reduced: ReducedProblem, irredundant: bool = False, guarded: bool = False
) -> FoundedSolver:
    """Return a solver for the players and recruits of a problem, given as options of one reduced problem."""
    recruits = {problem.supply.recruits[o.number].component: o.number for o in reduced.options[-1]}
    return FoundedSolver(reduced, components=recruits, irredundant=irredundant, guarded=guarded)


def _by_clauses(
    problem: Problem, budget: Budget, running: Configuration | None
) -> list[list[Candidate]] | Undecided | None:
    """Return the first players that recruits can feed, by clause learning."""
    with founded(problem, pruned(with_recruits(problem, () if running is None else running.players))) as clauses:
        found = clauses.solve((), budget)
        if isinstance(found, Undecided):
            return found
        if not found:
            return None
        if running is not None:
            clauses.maximise(_staying(clauses, running), budget)
            clauses.solve((), budget)
        chosen = least_of_clauses(clauses, budget)
        if isinstance(chosen, Undecided) and running is not None:
            # What runs is not given up for want of the steps to name the first: these are known to have recruits.
            chosen = [option for option in clauses.chosen() if option.kind.role < len(problem.roles)]
        return chosen if isinstance(chosen, Undecided) else assigned(problem, chosen)


def _staying(clauses: FoundedSolver, running: Configuration) -> list[int]:
    """Return the literals of the options by which a component that runs would play its role."""
    return [
        literal
        for assignment, options, literals in zip(
            running.assignments, clauses.reduced.options[:-1], clauses.plays[:-1], strict=True
        )
        for option, literal in zip(options, literals, strict=True)
        if option.component in assignment.components
    ]


def _by_enumeration(
    problem: Problem, budget: Budget, running: Configuration | None
) -> list[list[Candidate]] | Undecided | None:
    """Return the first players that recruits can feed, by depth-first search; those that run come first."""
    search = CandidateSearch(problem if running is None else _running_first(problem, running), budget)
    relevant = _relevant_roles(problem)
    search.matters = max((place for place, role in enumerate(search.slots) if role in relevant), default=-1)
    for playing in search.solutions():
        if RecruitChoice(problem, solved(problem, playing), ()).possible:
            return playing
    return None if budget.steps else Undecided(0)


def _relevant_roles(problem: Problem) -> set[int]:
    """Return the roles on whose players it depends whether there are recruits.

    These are the roles that recruit, those that feed them, and those with a candidate that issues what their players
    need, or what a component needs that could be recruited for that: as it plays a role, it cannot be recruited.
    """
    recruiting = {number for number, role in enumerate(problem.roles) if role.recruits}
    needed = needed_signals(problem, [c.profile for number in recruiting for c in problem.candidates[number]])
    found = recruiting.union(*(problem.sources[number] for number in recruiting))
    for number, some in enumerate(problem.candidates):
        if any(needed.intersection(signals_served(problem, candidate.profile)) for candidate in some):
            found.add(number)
    return found


def _running_first(problem: Problem, running: Configuration) -> Problem:
    """Return a problem in which the candidates that play their role come before all others."""
    plays = {(a.role, component) for a in running.assignments for component in a.components}
    candidates = tuple(
        tuple(sorted(some, key=lambda c, role=role.iri: (role, c.profile.component) not in plays))  # type: ignore[misc]  # the default is for the loop
        for role, some in zip(problem.roles, problem.candidates, strict=True)
    )
    return Problem(problem.task, replace(problem.partition, candidates=candidates), problem.hierarchy)
