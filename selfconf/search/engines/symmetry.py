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

from collections import Counter, defaultdict
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from itertools import pairwise

from selfconf.search.reduction import Needs, Option, ReducedProblem


def interchangeable(reduced: ReducedProblem) -> Iterator[tuple[int, int]]:
    """Yield pairs of interchangeable roles, each role of several with the next one."""
    alike = [[role for role, asked in Counter(reduced.slots).items() if asked == 1]]
    # What is compared quickly comes first: mostly no roles are left that are alike in it.
    for aspect in (_components, _supports, _wants):
        alike = [same for roles in alike for same in _equal_in(aspect, reduced, roles) if len(same) > 1]
    for roles in alike:
        if not any(_feeds_one_of(reduced, role, set(roles)) for role in roles):
            yield from pairwise(roles)


def _equal_in(
    aspect: Callable[[Sequence[Option], Needs], Hashable], reduced: ReducedProblem, roles: Sequence[int]
) -> Iterable[list[int]]:
    """Return sets of some roles that are equal in an aspect."""
    same: defaultdict[Hashable, list[int]] = defaultdict(list)
    for role in roles:
        same[aspect(reduced.options[role], reduced.needs)].append(role)
    return same.values()


def _components(options: Sequence[Option], _: Needs) -> Hashable:
    return tuple([option.component for option in options])


def _supports(options: Sequence[Option], _: Needs) -> Hashable:
    return tuple([option.kind.supports for option in options])


def _wants(options: Sequence[Option], needs: Needs) -> Hashable:
    """Return the values that options admit, and what they need."""
    return tuple(
        (
            tuple(option.kind.admits.items()),
            frozenset((needs[need].wanted, needs[need].sources) for need in option.kind.needs),
        )
        for option in options
    )


def _feeds_one_of(reduced: ReducedProblem, role: int, roles: set[int]) -> bool:
    return any(reduced.needs[need].role in roles for option in reduced.options[role] for need in option.kind.supports)
