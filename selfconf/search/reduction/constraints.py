"""The constraints of a problem, one by one, and the subproblem in which only some of them are in force.

What is not in force is not asked for: a role may then be left unplayed, a need unsupported, a variable without a common
value, a component in several roles. Fewer constraints in force never make less possible.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Set

from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.search.reduction.arc_consistency import consistent
from selfconf.search.reduction.dominance import ANY_VALUES, without_dominated
from selfconf.search.reduction.reduced_problem import InterchangeabilityClass, Option, ReducedProblem


@immutable
class Played:
    """A role is played by as many components as it asks for at least."""

    role: int


@immutable
class Fed:
    """A need, by number, has a support, if a component with that need plays."""

    need: int


@immutable
class Shared:
    """A variable, by number, has a value that every component that plays admits."""

    variable: int


@immutable
class Distinct:
    """A component plays one role (the constraint AllDifferent over all slots)."""


Constraint = Played | Fed | Shared | Distinct

NO_COMPONENT = IRI.unchecked("")
"""The component of an option that leaves a slot empty, where the role of the slot need not be played."""


def all_of(given: ReducedProblem) -> tuple[Constraint, ...]:
    """Return every constraint of a problem, in the order of roles and needs."""
    used = sorted({need for options in given.options for option in options for need in option.kind.needs})
    constrained = sorted(set[int]().union(*[option.kind.admits for options in given.options for option in options]))
    return (
        *(Played(role) for role in dict.fromkeys(given.slots)),
        *map(Fed, used),
        *map(Shared, constrained),
        Distinct(),
    )


def subproblem(given: ReducedProblem, constraints: Set[Constraint]) -> ReducedProblem:
    """Return the problem with only some constraints in force, after arc consistency.

    Only roles that one of the constraints is about keep their slots. A role that has to play no part may leave its
    slots empty (`NO_COMPONENT`), as the last option of each.
    """
    needs = {one.need for one in constraints if isinstance(one, Fed)}
    required = {one.role for one in constraints if isinstance(one, Played)}
    scope = required | {source for need in needs for source, *_ in given.needs[need].sources}
    slots = tuple(role for role in given.slots if role in scope)
    weaker, kinds = _weakened(given, constraints, scope)
    removed, removals = consistent(kinds, len(given.needs), given.values, required)
    left = {
        role: [
            Option(option.number, option.component, kind)
            for option in given.options[role]
            if id(kind := weaker[id(option.kind)]) not in removed
        ]
        for role in dict.fromkeys(slots)
    }
    minima = Counter(slots)
    # With fewer constraints more candidates are interchangeable, so that dominance leaves fewer of them.
    kept = without_dominated(left, minima)
    for role in kept.keys() - required:
        kept[role] += _empty(role, minima[role])
    return ReducedProblem(
        slots,
        tuple(tuple(kept.get(role, ())) for role in range(len(given.options))),
        given.needs,
        given.values,
        tuple(removals),
    )


def _empty(role: int, slots: int) -> list[Option]:
    """Return the options that leave the slots of a role empty: nothing needed, nothing supported, any value."""
    kind = InterchangeabilityClass(role, (), (), ANY_VALUES)
    return [Option(-1, NO_COMPONENT, kind) for _ in range(slots)]


def pruned(given: ReducedProblem) -> ReducedProblem:
    """Return the problem with every constraint in force, after arc consistency."""
    played = dict.fromkeys(given.slots)
    removed, removals = consistent(given.kinds(), len(given.needs), given.values, played)
    if not removed:
        return given
    options = tuple(tuple(o for o in some if id(o.kind) not in removed) for some in given.options)
    return ReducedProblem(given.slots, options, given.needs, given.values, tuple(removals))


def _weakened(
    given: ReducedProblem, constraints: Set[Constraint], scope: Set[int]
) -> tuple[dict[int, InterchangeabilityClass], tuple[InterchangeabilityClass, ...]]:
    """Return for each class, by identity, what is left of it under some constraints alone; and all that are left.

    Classes that differ in nothing that these constraints are about become one.
    """
    needs = {one.need for one in constraints if isinstance(one, Fed)}
    variables = {one.variable for one in constraints if isinstance(one, Shared)}
    weaker: dict[int, InterchangeabilityClass] = {}
    known: dict[tuple[object, ...], InterchangeabilityClass] = {}
    for kind in given.kinds():
        if kind.role not in scope:
            continue
        needed = tuple(need for need in kind.needs if need in needs)
        supported = tuple(need for need in kind.supports if need in needs)
        admits = {variable: mask for variable, mask in kind.admits.items() if variable in variables}
        key = (kind.role, needed, supported, *admits.items())
        found = known.get(key)
        if found is None:
            found = known[key] = InterchangeabilityClass(kind.role, needed, supported, admits, number=kind.number)
        found.number = min(found.number, kind.number)
        found.signatures += kind.signatures
        weaker[id(kind)] = found
    return weaker, tuple(known.values())
