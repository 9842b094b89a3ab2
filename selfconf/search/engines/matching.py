"""Enough different components for all slots: bipartite matching, and Hall's theorem where it fails.

A solution needs a matching of slots and components. Depth-first search and clause learning alike take exponential
time to see that there is none (the pigeonhole principle); augmenting paths see it in time slots times options. If
some slots stay unmatched, the slots reached from one of them by alternating paths have together fewer options than
there are of them (Hall's theorem, 1935): their roles are the reason to give.

If there is a matching, an option that is in none of them is in no solution. Which these are follows from the strongly
connected components of the graph that leads from each slot to its matched component and from each component to the
other slots that could take it, with what is reachable from components that are unmatched (Regin, AAAI 1994).
"""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import Generic, TypeVar

from selfconf.model.immutable import immutable
from selfconf.model.strong_components import strong_components

Pooled = TypeVar("Pooled", bound=Hashable)
"""By what components are known here: their names, or the numbers of groups of which each stands for one."""


@immutable
class HallSet:
    """Roles that together have fewer components than slots."""

    roles: tuple[int, ...]
    wanted: int
    """The number of their slots."""
    found: int
    """The number of different components among their options."""


def hall_set(slots: Sequence[int], options: Sequence[Sequence[Pooled]]) -> HallSet | None:
    """Return roles that lack components, or None if each slot can have one of its own; `options` are per role."""
    found = _matched(slots, _shared_pools(options))
    return found if isinstance(found, HallSet) else None


def unmatchable(slots: Sequence[int], options: Sequence[Sequence[Pooled]]) -> HallSet | set[tuple[int, Pooled]]:
    """Return the pairs of a role and an option that are in no matching; or else roles that lack components."""
    slot_of = _matched(slots, _shared_pools(options))
    if isinstance(slot_of, HallSet):
        return slot_of
    matched = {component: slots[slot] for component, slot in slot_of.items()}
    # Slots of one role have the same options, so that the graph is one of roles: an edge where one could take over a
    # component of the other.
    edges = {role: {matched[c] for c in options[role] if c in matched} for role in dict.fromkeys(slots)}
    free = _reaching({role for role in edges if any(c not in matched for c in options[role])}, edges)
    group = strong_components(edges)
    return {
        (role, component)
        for role in edges
        for component in options[role]
        if component in matched and matched[component] not in free and group[matched[component]] != group[role]
    }


def _reaching(goals: set[int], edges: Mapping[int, set[int]]) -> set[int]:
    """Return the nodes from which a path leads to one of the goals."""
    backward: dict[int, list[int]] = {}
    for role, others in edges.items():
        for other in others:
            backward.setdefault(other, []).append(role)
    found, waiting = set(goals), list(goals)
    while waiting:
        for role in backward.get(waiting.pop(), ()):
            if role not in found:
                found.add(role)
                waiting.append(role)
    return found


class MaintainedMatching(Generic[Pooled]):
    """A matching maintained along a depth-first search: every slot still to come keeps a component of its own.

    Slots are given components in order. When a slot is taken back nothing is undone: its component stays as good as
    any other until the slot is given one again.
    """

    def __init__(self, slots: Sequence[int], options: Sequence[Sequence[Pooled]]) -> None:
        self.slots, self.options = slots, _shared_pools(options)
        found = _matched(slots, self.options)
        self.hall_set = found if isinstance(found, HallSet) else None
        """Roles that lack components, if there are any: then there is no matching to maintain."""
        self.slot_of: dict[Pooled, int] = {} if isinstance(found, HallSet) else found
        self.component_of: list[Pooled | None] = [None] * len(slots)
        for component, slot in self.slot_of.items():
            self.component_of[slot] = component

    def give(self, place: int, component: Pooled) -> bool:
        """Give a slot a component, if every later slot can then still have one of its own; or else change nothing."""
        owner, before = self.slot_of.get(component), self.component_of[place]
        if owner == place:
            return True
        if before is not None:
            del self.slot_of[before]
        self.slot_of[component], self.component_of[place] = place, component
        if owner is None:
            return True
        self.component_of[owner] = None
        if _augment(owner, self.slots, self.options, self.slot_of, self.component_of, place) is None:
            return True
        self.slot_of[component], self.component_of[owner], self.component_of[place] = owner, component, before
        if before is not None:
            self.slot_of[before] = place
        return False


def _shared_pools(options: Sequence[Sequence[Pooled]]) -> list[Sequence[Pooled]]:
    """Return the options with one sequence for all roles that have equal ones, so that it is looked through once."""
    known: dict[tuple[Pooled, ...], Sequence[Pooled]] = {}
    return [known.setdefault(tuple(some), some) for some in options]


def _matched(slots: Sequence[int], options: Sequence[Sequence[Pooled]]) -> HallSet | dict[Pooled, int]:
    """Return for each component that is matched its slot, or else roles that lack components."""
    slot_of: dict[Pooled, int] = {}
    component_of: list[Pooled | None] = [None] * len(slots)
    # A greedy matching first: augmenting paths are then needed for the few slots that it leaves out.
    for slot, role in enumerate(slots):
        for component in options[role]:
            if component not in slot_of:
                slot_of[component], component_of[slot] = slot, component
                break
    for slot, matched in enumerate(component_of):
        if matched is None:
            reached = _augment(slot, slots, options, slot_of, component_of)
            if reached is not None:
                return _hall_set_of(reached, slots, options)
    return slot_of


def _hall_set_of(reached: set[int], slots: Sequence[int], options: Sequence[Sequence[Pooled]]) -> HallSet:
    """Return the roles of slots that alternating paths reach from an unmatched one: they lack a component."""
    roles = tuple(sorted({slots[slot] for slot in reached}))
    found = {component for role in roles for component in options[role]}
    return HallSet(roles, sum(map(set(roles).__contains__, slots)), len(found))


def _augment(
    start: int,
    slots: Sequence[int],
    options: Sequence[Sequence[Pooled]],
    slot_of: dict[Pooled, int],
    component_of: list[Pooled | None],
    settled: int = -1,
) -> set[int] | None:
    """Match a slot along an augmenting path that leaves slots up to a settled one alone; or return the slots reached.

    Options are looked through once, however many slots and roles have them.
    """
    came: dict[Pooled, int] = {}
    looked: set[int] = set()
    reached, waiting = {start}, [start]
    while waiting:
        slot = waiting.pop()
        pool = options[slots[slot]]
        if id(pool) in looked:
            continue
        looked.add(id(pool))
        for component in pool:
            if component in came:
                continue
            owner = slot_of.get(component)
            if owner is not None and owner <= settled:
                continue
            came[component] = slot
            if owner is None:
                _flip(component, came, slot_of, component_of)
                return None
            if owner not in reached:
                reached.add(owner)
                waiting.append(owner)
    return reached


def _flip(
    component: Pooled | None, came: dict[Pooled, int], slot_of: dict[Pooled, int], component_of: list[Pooled | None]
) -> None:
    """Flip the augmenting path that was found, back to the slot that had no component."""
    while component is not None:
        slot = came[component]
        slot_of[component], component_of[slot], component = slot, component, component_of[slot]
