"""Enough different components for all slots: bipartite matching, and Hall's theorem where it fails.

A solution needs a matching of slots and components. Depth-first search and clause learning alike take exponential
time to see that there is none (the pigeonhole principle); augmenting paths see it in time slots times options. If
some slots stay unmatched, the slots reached from one of them by alternating paths have together fewer options than
there are of them (Hall's theorem, 1935): that is the reason to give.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from selfconf.model.term import IRI


@dataclass(frozen=True, slots=True)
class Shortage:
    """Roles that together have fewer components than slots."""

    roles: tuple[int, ...]
    wanted: int
    found: int


def shortage(slots: Sequence[int], options: Sequence[Sequence[IRI]]) -> Shortage | None:
    """The roles that lack components, or None if each slot can have one of its own; `options` are per role."""
    holder: dict[IRI, int] = {}
    held: list[IRI | None] = [None] * len(slots)
    for slot, role in enumerate(slots):
        for component in options[role]:
            if component not in holder:
                holder[component], held[slot] = slot, component
                break
    for slot, component in enumerate(held):
        if component is None:
            reached = _augment(slot, slots, options, holder, held)
            if reached is not None:
                roles = tuple(sorted({slots[other] for other in reached}))
                found = {one for role in roles for one in options[role]}
                wanted = sum(1 for role in slots if role in set(roles))
                return Shortage(roles, wanted, len(found))
    return None


def _augment(
    start: int,
    slots: Sequence[int],
    options: Sequence[Sequence[IRI]],
    holder: dict[IRI, int],
    held: list[IRI | None],
) -> set[int] | None:
    """Give the slot a component, moving others; or else the slots that alternating paths reach from it.

    Slots of one role have the same options, so that each role is looked through once.
    """
    came: dict[IRI, int] = {}
    looked: set[int] = set()
    reached, waiting = {start}, [start]
    while waiting:
        slot = waiting.pop()
        if slots[slot] in looked:
            continue
        looked.add(slots[slot])
        for component in options[slots[slot]]:
            if component in came:
                continue
            came[component] = slot
            owner = holder.get(component)
            if owner is None:
                _shift(component, came, holder, held)
                return None
            if owner not in reached:
                reached.add(owner)
                waiting.append(owner)
    return reached


def _shift(component: IRI | None, came: dict[IRI, int], holder: dict[IRI, int], held: list[IRI | None]) -> None:
    """Hand components on along the path that was found, back to the slot that had none."""
    while component is not None:
        slot = came[component]
        holder[component], held[slot], component = slot, component, held[slot]
