"""Recruits: the fewest components outside of the roles that feed what the players of a configuration still need.

*Problem.* Given players with inputs that no role feeds, choose recruits so that each of these inputs has a source among
them, and each required input of a recruit a source among recruits and players, without a cycle among recruits; as few
as possible, and of equally few the first by preference and IRI. Whether there are any is a least fixpoint (`supply`);
the fewest are NP-hard to find, as a minimal set cover is (Karp, 1972).

*How.* Recruits that matter are those that are usable and lead to a need. A literal for each says that it is chosen; an
input implies one of those that could feed it. The clauses allow cycles, so each answer is checked by forward chaining,
and a set of chosen recruits that only feed each other is excluded by its loop formula: one of the set is fed from
outside of it (Lin and Zhao, 2004). The bound on their number is lowered until there is no answer. Without a solver
library, or where the steps end, the answer is what is left of a chain of suppliers once none of them can be spared.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from dataclasses import replace
from fractions import Fraction

from selfconf.model.configuration import Configuration
from selfconf.model.cost import cost, unknown
from selfconf.model.optimum import Optimum
from selfconf.model.profile import Profile
from selfconf.model.refusal import Undecided
from selfconf.model.term import IRI
from selfconf.search.budget import Budget
from selfconf.search.engines import CandidateSearch
from selfconf.search.fewest_recruits import fewest
from selfconf.search.problem import Problem
from selfconf.search.recruit_choice import RecruitChoice, players_of

_NO_ROLE = IRI("")
"""The role of a recruit, which no term of a cost names."""
RECRUIT_STEPS = 200_000
"""Steps spent at most on finding the fewest recruits, each a conflict of the solver or a call of it."""


def recruited(
    problem: Problem, configuration: Configuration, running: Collection[IRI] = (), steps: int = RECRUIT_STEPS
) -> tuple[Configuration, bool] | None:
    """Return a configuration with the recruits that it needs, and whether they are proved to be the fewest.

    None where its players have inputs that no recruits can feed. Of equally few recruits those that are `running` come
    before all others.
    """
    if not any(role.recruits for role in problem.roles):
        return configuration, True
    choice = RecruitChoice(problem, configuration, running)
    if not choice.possible:
        return None
    chosen, proved = fewest(choice, Budget(steps))
    return problem.with_further_players(choice.configuration(chosen)), proved


def first_recruited(
    problem: Problem, steps: int = RECRUIT_STEPS, running: Configuration | None = None
) -> Configuration | Undecided | None:
    """Return the configuration of the first players for whom there are recruits, or None.

    For when the first solution is not one of them: recruits may need what a player issues, or play a role themselves.
    With a configuration that runs, its players and recruits come before all others.
    """
    budget = Budget(steps)
    search = CandidateSearch(problem if running is None else _running_first(problem, running), budget)
    relevant = _relevant_roles(problem)
    search.matters = max((place for place, role in enumerate(search.slots) if role in relevant), default=-1)
    kept = () if running is None else running.recruits
    for playing in search.solutions():
        found = recruited(problem, problem.solved(playing), kept, steps)
        if found is not None:
            return found[0]
    return None if budget.steps else Undecided(steps)


def _relevant_roles(problem: Problem) -> set[int]:
    """Return the roles on whose players it depends whether there are recruits.

    These are the roles that recruit, those that feed them, and those with a candidate that issues what their players
    need, or what somebody needs who could be recruited for that: as it plays a role, it cannot be recruited.
    """
    recruiting = {number for number, role in enumerate(problem.roles) if role.recruits}
    needed = _needed(problem, [c.profile for number in recruiting for c in problem.candidates[number]])
    found = recruiting.union(*(problem.sources[number] for number in recruiting))
    for number, some in enumerate(problem.candidates):
        if any(needed.intersection(_issued(problem, candidate.profile)) for candidate in some):
            found.add(number)
    return found


def _needed(problem: Problem, profiles: Iterable[Profile]) -> set[IRI]:
    """Return the signals that some components need, and those that recruits for these need in turn."""
    suppliers: dict[IRI, list[Profile]] = {}
    for recruit in problem.supply.recruits:
        for signal in _issued(problem, recruit.profile):
            suppliers.setdefault(signal, []).append(recruit.profile)
    waiting = [port for profile in profiles for port in profile.required]
    needed: set[IRI] = set()
    while waiting:
        for signal in waiting.pop().signals:
            if signal not in needed:
                needed.add(signal)
                waiting += [port for profile in suppliers.get(signal, ()) for port in profile.required]
    return needed


def _issued(problem: Problem, profile: Profile) -> Iterator[IRI]:
    """Yield the signals that the outputs of a component serve."""
    return (signal for output in profile.outputs for signal in problem.hierarchy.served(output.signals))


def _running_first(problem: Problem, running: Configuration) -> Problem:
    """Return a problem in which the candidates that play their role come before all others."""
    plays = {(a.role, component) for a in running.assignments for component in a.components}
    candidates = tuple(
        tuple(sorted(some, key=lambda c, role=role.iri: (role, c.profile.component) not in plays))  # type: ignore[misc]  # the default is for the loop
        for role, some in zip(problem.roles, problem.candidates, strict=True)
    )
    return Problem(problem.task, replace(problem.partition, candidates=candidates), problem.hierarchy)


def priced(problem: Problem, optimum: Optimum, configuration: Configuration) -> Optimum:
    """Return an optimum with a configuration that has recruits: these cost as players do, in no role.

    What a solution costs is what its first players cost, as many as each role asks for, and its recruits. That nothing
    costs less is proved only where there are no recruits, and none could make a solution cheaper.
    """
    levels, hierarchy = problem.task.template.cost, problem.hierarchy
    profiles = {recruit.component: recruit.profile for recruit in problem.supply.recruits}
    minima = {
        c
        for a, role in zip(configuration.assignments, problem.roles, strict=True)
        for c in a.components[: role.minimum]
    }
    counted = [
        (problem.roles[number].iri, profile)
        for component, (number, profile) in players_of(problem, configuration)
        if component in minima
    ]
    counted += [(_NO_ROLE, profiles[component]) for component in configuration.recruits]
    amounts = [cost(levels, role, profile, hierarchy)[1:] for role, profile in counted]
    cheaper = any(amount < 0 for one in profiles.values() for amount in cost(levels, _NO_ROLE, one, hierarchy))
    return replace(
        optimum,
        configuration=configuration,
        bound=_with_cheapest(problem, optimum.bound),
        cost=tuple(sum(level, Fraction(0)) for level in zip(*amounts, strict=True)),
        missing=tuple(
            (one.component, wanted) for role, one in counted for wanted in unknown(levels, role, one, hierarchy)
        ),
        proved=optimum.proved and not configuration.recruits and not cheaper,
    )


def _with_cheapest(problem: Problem, bound: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
    """Return a bound of what players cost, less all that recruits could make a solution cheaper."""
    levels, hierarchy = problem.task.template.cost, problem.hierarchy
    profiles = (recruit.profile for recruit in problem.supply.recruits)
    amounts = [cost(levels, _NO_ROLE, profile, hierarchy)[1:] for profile in profiles]
    return tuple(
        least + sum((min(one[number], Fraction(0)) for one in amounts), Fraction(0))
        for number, least in enumerate(bound)
    )
