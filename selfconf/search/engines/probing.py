"""Probing: an option is tried alone in its slot, and removed if that leaves other slots too few components.

*Why.* Matching counts the components that are options of some roles (Hall's theorem), and arc consistency removes the
options whose needs have no support; neither sees what the other would see after a choice. Let one role decide which
inputs can be fed at all, as who issues the licences does: with each of its options another part of the people is left,
and each part may be too few. Clause learning refutes such a choice in exponential time, counting by cases.

*What is kept.* This is singleton consistency (Debruyne and Bessiere, IJCAI 1997) with arc consistency and Hall's
condition, of components and of needs that are counted (`need_counting`): an option is removed if, with no other one in
its slot, a role has no option left, some slots have fewer components than they need, or some needs fewer slots. Such an
option is in no solution, so that every solution stays, and with them the least.

*Cost.* A pass over all needs and supports for each option of a role that others need, while there are few of these.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from selfconf.model.immutable import replace
from selfconf.search.engines.matching import hall_set
from selfconf.search.engines.need_counting import Undersupply, counted_needs, supplied
from selfconf.search.reduction import ArcConsistency, Option, ReducedProblem, pruned

MOST_PROBED = 20_000
"""How many needs and supports are read at most, some milliseconds."""


def probed(given: ReducedProblem) -> ReducedProblem:
    """Return a problem without the options that were tried and are in no solution; the same one if there are none."""
    left = MOST_PROBED
    size = sum(1 + len(kind.needs) + len(kind.supports) for kind in given.kinds())
    trial: _Trial | None = None
    for role, slots in Counter(given.slots).items():
        options = given.options[role]
        if slots > 1 or not any(option.kind.supports for option in options):
            continue
        left -= size * len(options)
        if left < 0:
            break
        trial = trial or _Trial(given)
        kept = tuple(option for option in options if trial.fits(role, option))
        if len(kept) < len(options):
            given, trial = pruned(_with(given, {role: kept})), None
            if given.wiped_out() is not None:
                break
    return given


class _Trial:
    """A problem in which one option after the other is tried alone in its slot."""

    def __init__(self, given: ReducedProblem) -> None:
        self._given = given
        self._asked = Counter(given.slots)
        self._consistency = ArcConsistency(given.kinds(), len(given.needs), given.values, self._asked)

    def fits(self, role: int, option: Option) -> bool:
        """Return whether arc consistency leaves each role options, and all slots enough components."""
        given, kind = self._given, option.kind
        others = {id(other.kind): other.kind for other in given.options[role] if other.kind is not kind}
        removed, removals = self._consistency.without(others.values())
        left: dict[int, tuple[Option, ...]] = {role: (option,)}
        for touched in {removal.kind.role for removal in removals}:
            left[touched] = tuple(
                one for one in left.get(touched, given.options[touched]) if id(one.kind) not in removed
            )
            if len(left[touched]) < self._asked[touched]:
                return False
        remaining = _with(given, left)
        # Where no other role lost an option, components are enough: those that are not had been removed before.
        if removals and hall_set(remaining.slots, remaining.components()) is not None:
            return False
        return not isinstance(supplied(remaining, counted_needs(remaining)), Undersupply)


def _with(given: ReducedProblem, left: Mapping[int, tuple[Option, ...]]) -> ReducedProblem:
    return replace(given, options=tuple(left.get(role, options) for role, options in enumerate(given.options)))
