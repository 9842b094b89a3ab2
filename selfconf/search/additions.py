"""Roles that ask for no component, used when that is what it takes.

A role with `sc:minCount 0` that feeds another may be left unplayed. Where there is no solution without its components,
but one with some of them, the fewest are asked for: by their number, and of equally few by the order of the roles.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations_with_replacement

from selfconf.search.budget import Budget
from selfconf.search.problem import Problem
from selfconf.search.recruiting import possible_with_recruits
from selfconf.search.strategies import possible

MOST_ADDITIONS = 3
"""How many components are added at most."""
MOST_CHOICES = 60
"""How many choices of roles are tried at most."""
CHOICE_STEPS = 20_000
"""Steps for the question whether a choice makes a solution possible."""


def with_additions(problem: Problem) -> Problem | None:
    """Return a problem that has no solution with the fewest of its optional roles asked for that give it one.

    None where no choice was found that does.
    """
    if any(role.minimum and not some for role, some in zip(problem.roles, problem.candidates, strict=True)):
        return None
    for number, minima in enumerate(_choices(problem)):
        if number == MOST_CHOICES:
            return None
        raised = asking_for(problem, minima)
        if possible(raised, Budget(CHOICE_STEPS)) and (
            not any(role.recruits for role in problem.roles) or possible_with_recruits(raised, CHOICE_STEPS)
        ):
            return raised
    return None


def _choices(problem: Problem) -> Iterator[Counter[int]]:
    """Yield how many components are asked for of which optional roles, the fewest first."""
    optional = [
        number
        for number, role in enumerate(problem.roles)
        if role.minimum == 0 and problem.sinks[number] and problem.candidates[number]
    ]
    for size in range(1, MOST_ADDITIONS + 1):
        for chosen in combinations_with_replacement(optional, size):
            minima = Counter(chosen)
            if all(count <= _room(problem, number) for number, count in minima.items()):
                yield minima


def _room(problem: Problem, number: int) -> int:
    """Return how many components may play a role at most."""
    maximum, candidates = problem.roles[number].maximum, len(problem.candidates[number])
    return candidates if maximum is None else min(maximum, candidates)


def asking_for(problem: Problem, minima: Counter[int]) -> Problem:
    """Return a problem with other minima for some roles, by number."""
    roles = tuple(replace(role, minimum=minima.get(number, role.minimum)) for number, role in enumerate(problem.roles))
    template = replace(problem.task.template, roles=roles)
    return Problem(replace(problem.task, template=template), problem.partition, problem.hierarchy)
