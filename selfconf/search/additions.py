"""Roles that ask for no component, used when that is what it takes.

A role with `sc:minCount 0` that feeds another, or recruits, may be left unplayed. Where there is no solution without
its components, but one with some of them, the fewest are asked for: by their number, and of equally few by the order
of the roles.

*How they are found.* Each optional role is given slots, and for each slot a candidate that is absent: it has no ports,
and stands for a slot that stays empty. To ask for the fewest components is then a matter of cost: the fewest slots that
are not empty, and of equally few the most of the first optional role, then of the second, and so on. So the search for
the best finds them. How many slots a role needs follows from the answer: a solution with so many additions says that no
role needs more.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from fractions import Fraction

from selfconf.model.cost import CostTerm
from selfconf.model.immutable import replace
from selfconf.model.optimum import Optimum
from selfconf.model.partition import ANY_VALUE, Candidate
from selfconf.model.profile import Profile
from selfconf.model.refusal import Undecided
from selfconf.model.term import IRI, XSD_NAMESPACE, Literal
from selfconf.search.budget import Budget
from selfconf.search.engines import any_by_clauses
from selfconf.search.problem import Problem
from selfconf.search.reduction import LazyReduction, pruned, recruits_that_matter, reduced
from selfconf.search.strategies import best_configuration, solution
from selfconf.search.supply import Issued

MOST_OF_A_ROLE = 64
"""How many components of one optional role are asked for at most."""
CHOICE_STEPS = 20_000
"""Steps for each question about a choice of optional roles, unless more are allowed."""
ABSENT = IRI("urn:selfconf:absent")
"""The property by which a candidate says that it stands for an empty slot."""
_ABSENT_ONCE = ((ABSENT, Literal("1", IRI(XSD_NAMESPACE + "integer"))),)


def with_additions(problem: Problem, steps: int | None = None) -> Problem | Undecided | None:
    """Return a problem that has no solution with the fewest of its optional roles asked for that give it one.

    None if no choice of them does, and `Undecided` if that was not decided within the steps for one question.
    """
    if any(role.minimum and not some for role, some in zip(problem.roles, problem.candidates, strict=True)):
        return None
    steps = max(CHOICE_STEPS, steps or 0)
    needed = _needed(problem)
    if not needed:
        return None
    most = max(needed.values())
    found = _fewest(problem, needed, min(most, MOST_OF_A_ROLE), steps)
    if found is None and most > MOST_OF_A_ROLE:
        # What arc consistency finds out does not depend on how many there are.
        tried = pruned(reduced(_optional(problem, needed, MOST_OF_A_ROLE)))
        return Undecided(steps) if tried.wiped_out() is None else None
    return asking_for(problem, found) if isinstance(found, Counter) else found


def with_optional_slots(problem: Problem) -> Problem:
    """Return a problem in which optional roles have slots that may stay empty; the same one where none could help.

    It has a solution where some choice of the optional roles has one. A slot that stays empty has a candidate there.
    """
    needed = _needed(problem)
    return _optional(problem, needed, min(max(needed.values()), MOST_OF_A_ROLE)) if needed else problem


def asking_for_all(problem: Problem) -> Problem:
    """Return a problem in which optional roles that may feed others ask for as many components as may be tried."""
    rooms = {number: min(_room(problem, number), MOST_OF_A_ROLE) for number in range(len(problem.roles))}
    return asking_for(problem, {number: room for number, room in rooms.items() if room})


def _fewest(problem: Problem, needed: Mapping[int, int], most: int, steps: int) -> Counter[int] | Undecided | None:
    """Return the fewest components that make a solution possible, by role, with at most so many of each."""
    solvable = _is_solvable(_optional(problem, needed, most), steps)
    if solvable is not True:
        return solvable if isinstance(solvable, Undecided) else None
    for room in (*(1 << k for k in range(most.bit_length()) if 1 << k < most), most):
        optional = _optional(problem, needed, room)
        found = _chosen(problem, optional, steps) if room == most or _is_solvable(optional, steps) is True else None
        if isinstance(found, Counter) and room < min(found.total(), most):  # with more of one role it may take fewer
            fewer = _chosen(problem, _optional(problem, needed, min(found.total(), most)), steps)
            found = fewer if isinstance(fewer, Counter) else found
        if found is not None:
            return found
    return None


def _is_solvable(problem: Problem, steps: int) -> Undecided | bool:
    found = solution(LazyReduction(problem), Budget(steps), any_by_clauses)
    return Undecided(steps) if isinstance(found, Undecided) else found is not None


def _chosen(problem: Problem, optional: Problem, steps: int) -> Counter[int] | Undecided | None:
    """Return how many components of each optional role the best solution asks for; None if recruits allow none."""
    best = best_configuration(optional, steps)
    if not isinstance(best, Optimum):
        return best if isinstance(best, Undecided) else None
    numbers = {role.iri: number for number, role in enumerate(problem.roles) if role.minimum == 0}
    return Counter(
        numbers[one.role]
        for one in best.configuration.assignments
        if one.role in numbers
        for component in one.components
        if not component.startswith(ABSENT)
    )


def _needed(problem: Problem) -> dict[int, int]:
    """Return the optional roles that may help, by number, with how many of their components could be of use at most.

    Each that is asked for feeds an input that none of the others feeds, of a player or of recruits. If it is one of a
    player, none of the others feeds any that wants the same in the same role, either.
    """
    unvalued = {number for number, _ in problem.unvalued}
    roles = (number for number in range(len(problem.roles)) if number not in unvalued)
    room = {number: some for number in roles if (some := _room(problem, number))}
    inputs = [max((len(c.profile.required) for c in some), default=0) for some in problem.candidates]
    of_recruits = _needs_of_recruits_fed(problem, room)
    most = _most_of_use(problem, room, of_recruits)
    needed, before = dict.fromkeys(room, 0), dict[int, int]()
    while needed != before:  # along a chain of optional roles, or around a circle
        before = needed
        slots = [needed.get(number, role.minimum) for number, role in enumerate(problem.roles)]
        of_players = {number: sum(slots[sink] * inputs[sink] for sink in problem.sinks[number]) for number in room}
        needed = {number: min(most[number], of_players[number] + of_recruits[number]) for number in room}
    return {number: count for number, count in needed.items() if count}


def _most_of_use(problem: Problem, room: Mapping[int, int], of_recruits: Mapping[int, int]) -> dict[int, int]:
    """Return for roles, by number, how many components could be of use at most, however many play the others.

    More than are asked for of a role are not told apart, so that going around a circle of optional roles ends soon.
    """
    of_roles = _needs_of_roles_fed(problem, room)
    return {n: min(some, of_roles[n] + of_recruits[n], MOST_OF_A_ROLE + 1) for n, some in room.items()}


def _needs_of_roles_fed(problem: Problem, roles: Iterable[int]) -> dict[int, int]:
    """Return for some roles, by number, how many inputs that want different of the roles that they feed they may feed.

    Inputs of one role that want the same, and that the same interactions feed, count once.
    """
    found: dict[int, set[object]] = {role: set() for role in roles}
    for sink in set().union(*(problem.sinks[role] for role in found)):
        for port in {port for candidate in problem.candidates[sink] for port in candidate.profile.required}:
            sources = problem.feeding(sink, port.name)
            for role in {source.role for source in sources} & found.keys():
                found[role].add((sink, sources, port.wanted))
    return {role: len(some) for role, some in found.items()}


def _needs_of_recruits_fed(problem: Problem, roles: Iterable[int]) -> dict[int, int]:
    """Return for some roles, by number, how many of the signals that recruits need their candidates could issue."""
    matter = recruits_that_matter(problem) if problem.supply.recruits else ()
    required = (problem.supply.required[number] for number in matter)
    wanted = {port.wanted for ports in required for port in ports}
    found: dict[int, int] = {}
    for role in roles:
        issued = Issued(problem.hierarchy)
        issued.add(role, {output for candidate in problem.candidates[role] for output in candidate.profile.outputs})
        found[role] = sum(map(issued.serves, wanted))
    return found


def _room(problem: Problem, number: int) -> int:
    """Return how many components may play a role at most that is optional, and may feed others; else zero."""
    role, candidates = problem.roles[number], len(problem.candidates[number])
    if role.minimum or not (problem.sinks[number] or problem.supply.recruits):
        return 0
    return candidates if role.maximum is None else min(role.maximum, candidates)


def _optional(problem: Problem, needed: Mapping[int, int], room: int) -> Problem:
    """Return a problem in which optional roles have slots that may stay empty, and solutions cost what they ask for."""
    slots = {number: min(count, room) for number, count in needed.items()}
    roles = tuple(
        replace(role, minimum=slots.get(number, 0), maximum=slots.get(number, 0)) if role.minimum == 0 else role
        for number, role in enumerate(problem.roles)
    )
    admits = (ANY_VALUE,) * len(problem.variables)
    candidates = tuple(
        (
            *some,
            *(
                Candidate(Profile(IRI.unchecked(f"{ABSENT}:{number}:{place}"), properties=_ABSENT_ONCE), admits)
                for place in range(slots.get(number, 0))
            ),
        )
        for number, some in enumerate(problem.candidates)
    )
    fewest = CostTerm(ABSENT, Fraction(-1), otherwise=Fraction(0))
    earliest = (CostTerm(ABSENT, otherwise=Fraction(0), role=problem.roles[number].iri) for number in slots)
    template = replace(problem.task.template, roles=roles, cost=((fewest,), *((term,) for term in earliest)))
    partition = replace(problem.partition, candidates=candidates)
    return Problem(replace(problem.task, template=template), partition, problem.hierarchy)


def asking_for(problem: Problem, minima: Mapping[int, int]) -> Problem:
    """Return a problem with other minima for some roles, by number."""
    roles = tuple(replace(role, minimum=minima.get(number, role.minimum)) for number, role in enumerate(problem.roles))
    template = replace(problem.task.template, roles=roles)
    return Problem(replace(problem.task, template=template), problem.partition, problem.hierarchy)
