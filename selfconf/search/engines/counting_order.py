"""The order in which options are counted: side by side those that bear on the same needs.

A totalizer (Bailleux and Boufkhad, CP 2003) counts by parts: it halves what it counts again and again, and has literals
for "at least j of this part play". Clause learning can say by these what a part of the problem asks for, such as "of
the stations in this quarter at least three play", from which too few slots for the other quarters follow at once. But
only if a part is something of which anything can be said: halves in the order of the candidates have all needs in
common, and to refute one solution too few it takes 10 to 100 times the conflicts. So options are paired with the one
that is most like them by the needs that they have and support (the Jaccard index), pairs with pairs, and so on, which
is how the totalizer pairs what stands side by side.
"""

from __future__ import annotations

from collections.abc import Sequence

from selfconf.search.reduction import Option

COMPARED = 64
"""With how many of those that follow an option is compared, so that the cost is linear beyond."""


def counting_order(options: Sequence[Option]) -> list[int]:
    """Return the places of options in an order in which those that bear on the same needs stand side by side."""
    parts = [([place], _needs(option)) for place, option in enumerate(options)]
    while len(parts) > 1:
        left, parts = parts[::-1], []
        while left:
            places, needs = left.pop()
            if left:
                others, theirs = left.pop(_nearest(needs, left))
                places, needs = places + others, needs | theirs
            parts.append((places, needs))
    return [place for places, _ in parts for place in places]


def _needs(option: Option) -> int:
    """Return a bit for each need that an option has, and one for each that it supports."""
    found = 0
    for need in option.kind.needs:
        found |= 1 << 2 * need
    for need in option.kind.supports:
        found |= 2 << 2 * need
    return found


def _nearest(needs: int, left: list[tuple[list[int], int]]) -> int:
    """Return which of the parts that are left has most needs in common with some; of several, the last one."""
    best, found = -1.0, len(left) - 1
    for place in range(len(left) - 1, max(-1, len(left) - 1 - COMPARED), -1):
        theirs = left[place][1]
        if theirs == needs:
            return place
        common = (needs & theirs).bit_count()
        likeness = common / ((needs | theirs).bit_count())
        if likeness > best:
            best, found = likeness, place
    return found
