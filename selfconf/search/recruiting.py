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

from collections.abc import Collection
from dataclasses import replace
from fractions import Fraction

from selfconf.model.configuration import Configuration
from selfconf.model.cost import cost, unknown
from selfconf.model.optimum import Optimum
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


def first_recruited(problem: Problem, steps: int = RECRUIT_STEPS) -> Configuration | Undecided | None:
    """Return the configuration of the first players for whom there are recruits, or None.

    For when the first solution is not one of them: recruits may need what a player issues, or play a role themselves.
    """
    budget = Budget(steps)
    for playing in CandidateSearch(problem, budget).solutions():
        found = recruited(problem, problem.solved(playing), steps=steps)
        if found is not None:
            return found[0]
    return None if budget.steps else Undecided(steps)


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
        cost=tuple(sum(level, Fraction(0)) for level in zip(*amounts, strict=True)),
        missing=tuple(
            (one.component, wanted) for role, one in counted for wanted in unknown(levels, role, one, hierarchy)
        ),
        proved=optimum.proved and not configuration.recruits and not cheaper,
    )
