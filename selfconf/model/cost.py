"""The cost of a configuration, as its template states it: a weighted sum per level, the levels in order of importance.

A term adds, for each component that plays, the value of a property of it times a weight: seconds of latency, metres of
error, currency. Levels are compared lexicographically: the second matters only among equals of the first. Numbers are
exact fractions, so that no order of addition and no rounding changes an answer.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.immutable import immutable
from selfconf.model.literal_values import fraction
from selfconf.model.profile import Profile
from selfconf.model.term import IRI


@immutable
class CostTerm:
    """A property whose value counts, times a weight (negative to reward large values), for one role or for all."""

    property: IRI
    weight: Fraction = Fraction(1)
    otherwise: Fraction | None = None
    """What counts for a component without the property; without it such a component is *unknown* here."""
    role: IRI | None = None


CostLevel = tuple[CostTerm, ...]


def cost(
    levels: Sequence[CostLevel], role: IRI, profile: Profile, hierarchy: Hierarchy = NOTHING_ABOVE
) -> tuple[Fraction, ...]:
    """What a component costs in a role: how many of its terms are unknown, then the sum of each level.

    Unknown comes first: something that is not known is never preferred to something that is. Of several values of a
    property the one that costs most counts.
    """
    found = [[value for _, value in _terms(level, role, profile, hierarchy)] for level in levels]
    unknown = sum(value is None for level in found for value in level)
    return Fraction(unknown), *(sum((v for v in level if v is not None), Fraction(0)) for level in found)


def unknown(
    levels: Sequence[CostLevel], role: IRI, profile: Profile, hierarchy: Hierarchy = NOTHING_ABOVE
) -> Iterator[IRI]:
    """The properties that terms of a component in a role ask for, that it does not have, with nothing said for that."""
    for level in levels:
        yield from (term.property for term, value in _terms(level, role, profile, hierarchy) if value is None)


def _terms(
    level: CostLevel, role: IRI, profile: Profile, hierarchy: Hierarchy
) -> Iterator[tuple[CostTerm, Fraction | None]]:
    for term in level:
        if term.role not in (None, role):
            continue
        values = [
            value * term.weight
            for predicate, said in profile.properties
            if term.property == predicate or term.property in hierarchy.superproperties(predicate)
            if (value := fraction(said)) is not None
        ]
        if values:
            yield term, max(values)
        else:
            yield term, None if term.otherwise is None else term.otherwise * term.weight
