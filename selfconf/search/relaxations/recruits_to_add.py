"""What could be added for roles to recruit, so that a refused task becomes possible.

A component that needs nothing itself and issues all that the players of a role want is the most helpful that could be
recruited for it; but what has to conform to an `sc:accepts` gets a component of its own, as one may not be able to
conform to several. If these make the task possible, their outputs are taken away one by one, as long as it stays so.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from selfconf.model.immutable import replace
from selfconf.model.partition import Recruit
from selfconf.model.profile import Output, Ports, Profile
from selfconf.model.relaxation import Addition, AddRecruits
from selfconf.model.term import IRI
from selfconf.search.problem import Problem
from selfconf.search.relaxations.relaxation_effort import RelaxationEffort
from selfconf.search.relaxations.supposed_outputs import supposed

MOST_LACKING = 24
"""How many outputs are looked at, at most, each of which takes a trial."""
NEWCOMER = "urn:selfconf:recruit:"
"""What the names of added recruits begin with, which do not exist yet."""


def recruits_to_add(
    problem: Problem, effort: RelaxationEffort, possible: Callable[[AddRecruits], bool]
) -> AddRecruits | None:
    """Return recruits that make a problem possible, none of whose outputs can be spared; None if there are none.

    `possible` says whether the problem with them has a solution.
    """
    issued = {number: _wanted(problem, number) for number, role in enumerate(problem.roles) if role.recruits}
    every = [(number, output) for number, outputs in issued.items() for output in outputs]
    looked_at = list(effort.first_of(every, MOST_LACKING))
    if not looked_at or len(looked_at) < len(every) or not possible(_asked(problem, issued)):
        return None
    for number, output in looked_at:
        fewer = {**issued, number: tuple(other for other in issued[number] if other is not output)}
        if possible(_asked(problem, fewer)):
            issued = fewer
    found = _asked(problem, issued)
    return found if found.additions else None


def with_more_recruits(problem: Problem, added: AddRecruits) -> Problem:
    """Return a problem in which recruits are added, each for its role."""
    index = {role.iri: number for number, role in enumerate(problem.roles)}
    more = [
        Recruit(
            Profile(IRI.unchecked(f"{NEWCOMER}{number}"), ports=Ports(outputs=supposed(one.outputs))),
            frozenset((index[one.role],)),
        )
        for number, one in enumerate(added.additions)
    ]
    partition = replace(problem.partition, recruits=(*problem.partition.recruits, *more))
    return Problem(problem.task, partition, problem.hierarchy)


def _wanted(problem: Problem, role: int) -> tuple[Output, ...]:
    """Return an output for each signal that a candidate of a role requires, under names of its own."""
    wanted = {port.wanted: None for c in problem.candidates[role] for port in c.profile.required if port.signals}
    issued = (one for one in wanted if (None, None, one) not in problem.partition.unissuable)
    return tuple(one.output(f"{one.signals[0].short}{number}") for number, one in enumerate(issued))


def _asked(problem: Problem, issued: Mapping[int, tuple[Output, ...]]) -> AddRecruits:
    """Return recruits for each role that together issue what they have to, if that is anything."""
    found = []
    for role, some in issued.items():
        anyhow = tuple(output for output in some if not output.conforms)
        found += [Addition(problem.roles[role].iri, 1, outputs) for outputs in (anyhow,) if outputs]
        found += [Addition(problem.roles[role].iri, 1, (output,)) for output in some if output.conforms]
    return AddRecruits(tuple(found))
