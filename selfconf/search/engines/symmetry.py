"""Interchangeable roles: the least solution has their components in order, so that all other orders can be left out.

*Claim.* Let a permutation of the options, within and between slots, take solutions to solutions. The least solution is
then not greater than its image, since that is a solution too. So whatever says "not greater than its image", for any
such permutation and in the order of the slots and options, holds in the least solution, and can be added without
changing which one is the least (a lex-leader constraint: Crawford, Ginsberg, Luks and Roy, KR 1996). Any number of them
can be added together, as each holds in one and the same solution.

*Roles.* Two roles with one slot each are interchangeable if they have the same components as options in the same
order, with equal values admitted, equal needs supported, and needs that want the same of the same sources; and if
neither feeds the other, or itself. Exchanging their players then takes solutions to solutions. The image of a solution
differs from it first in the first of both slots, where it has the option that the solution has in the second. So in the
least solution the first one has the option that comes first; an earlier one for sure, as components are distinct.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterator
from itertools import pairwise

from selfconf.search.reduction import ReducedProblem


def interchangeable(reduced: ReducedProblem) -> Iterator[tuple[int, int]]:
    """Yield pairs of interchangeable roles, each role of several with the next one."""
    asked = Counter(reduced.slots)
    alike: dict[Hashable, list[int]] = {}
    for role, number in asked.items():
        if number == 1:
            alike.setdefault(tuple(option.component for option in reduced.options[role]), []).append(role)
    for roles in alike.values():
        same: dict[Hashable, list[int]] = {}
        for role in roles if len(roles) > 1 else ():
            same.setdefault(_use(reduced, role), []).append(role)
        for some in same.values():
            if not any(_feeds_one_of(reduced, role, set(some)) for role in some if len(some) > 1):
                yield from pairwise(some)


def _use(reduced: ReducedProblem, role: int) -> Hashable:
    """Return all that matters of a role, but for its identity."""
    return tuple(
        (
            option.kind.admits,
            option.kind.supports,
            frozenset((reduced.needs[need].wanted, reduced.needs[need].sources) for need in option.kind.needs),
        )
        for option in reduced.options[role]
    )


def _feeds_one_of(reduced: ReducedProblem, role: int, roles: set[int]) -> bool:
    return any(reduced.needs[need].role in roles for option in reduced.options[role] for need in option.kind.supports)
