"""What a configuration has to meet, one by one, and a problem in which only some of it is asked for.

A set of requirements is *in force*; what is not in force is not asked for: a role may then be left unplayed, a need
unserved, a variable without a common value, a component in several roles. Less in force never makes less possible.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Set
from dataclasses import dataclass

from selfconf.model.partition import ANY_VALUE
from selfconf.model.term import IRI
from selfconf.search.reduction.arc_consistency import consistent
from selfconf.search.reduction.dominance import thinned
from selfconf.search.reduction.reduced_problem import InterchangeabilityClass, Option, ReducedProblem


@dataclass(frozen=True, slots=True)
class Played:
    """A role is played by as many components as it asks for at least."""

    role: int


@dataclass(frozen=True, slots=True)
class Fed:
    """A need, by number, of whoever has it is served."""

    need: int


@dataclass(frozen=True, slots=True)
class Shared:
    """A variable, by number, has a value that everybody who plays allows."""

    variable: int


@dataclass(frozen=True, slots=True)
class Distinct:
    """A component plays one role."""


Constraint = Played | Fed | Shared | Distinct

NO_COMPONENT = IRI("")
"""Who plays a role that is not in force, for once."""


def all_of(given: ReducedProblem) -> tuple[Constraint, ...]:
    """Every requirement of a problem, in the order of roles and needs."""
    used = sorted({need for options in given.options for option in options for need in option.kind.needs})
    constrained = [
        variable
        for variable in range(len(given.values))
        if any(o.kind.admits[variable] != ANY_VALUE for options in given.options for o in options)
    ]
    return (
        *(Played(role) for role in dict.fromkeys(given.slots)),
        *map(Fed, used),
        *map(Shared, constrained),
        Distinct(),
    )


def relaxed(given: ReducedProblem, force: Set[Constraint]) -> ReducedProblem:
    """The problem with only some requirements in force, after arc consistency; only roles that matter keep slots."""
    needs = {r.need for r in force if isinstance(r, Fed)}
    variables = {r.variable for r in force if isinstance(r, Shared)}
    required = {r.role for r in force if isinstance(r, Played)}
    matter = required | {source for need in needs for source, _ in given.needs[need].sources}
    slots = tuple(role for role in given.slots if role in matter)
    known: dict[tuple[object, ...], InterchangeabilityClass] = {}
    became: dict[int, InterchangeabilityClass] = {}
    for kind in given.kinds():
        if kind.role in matter:
            became[id(kind)] = _relaxed_kind(kind, needs, variables, known)
    gone, departures = consistent(tuple(known.values()), len(given.needs), given.values, required)
    left = {
        role: [
            Option(option.number, option.component, kind)
            for option in given.options[role]
            if id(kind := became[id(option.kind)]) not in gone
        ]
        for role in dict.fromkeys(slots)
    }
    minima = Counter(slots)
    kept = thinned(left, minima)
    free = tuple(ANY_VALUE for _ in given.values)
    for role in left:
        if role not in required:
            nobody = InterchangeabilityClass(role, (), (), free)
            kept[role] += [Option(-1, NO_COMPONENT, nobody) for _ in range(minima[role])]
    return ReducedProblem(
        slots,
        tuple(tuple(kept.get(role, ())) for role in range(len(given.options))),
        given.needs,
        given.values,
        tuple(departures),
    )


def pruned(given: ReducedProblem) -> ReducedProblem:
    """The problem with everything in force, after arc consistency."""
    played = dict.fromkeys(given.slots)
    gone, departures = consistent(given.kinds(), len(given.needs), given.values, played)
    if not gone:
        return given
    options = tuple(tuple(o for o in some if id(o.kind) not in gone) for some in given.options)
    return ReducedProblem(given.slots, options, given.needs, given.values, tuple(departures))


def _relaxed_kind(
    kind: InterchangeabilityClass,
    needs: Set[int],
    variables: Set[int],
    known: dict[tuple[object, ...], InterchangeabilityClass],
) -> InterchangeabilityClass:
    key = (
        kind.role,
        tuple(need for need in kind.needs if need in needs),
        tuple(need for need in kind.gives if need in needs),
        tuple(mask if v in variables else ANY_VALUE for v, mask in enumerate(kind.admits)),
    )
    found = known.get(key)
    if found is None:
        found = known[key] = InterchangeabilityClass(*key, number=kind.number)
    found.number = min(found.number, kind.number)
    found.likes += kind.likes
    return found
