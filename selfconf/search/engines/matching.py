"""Enough different components for all slots: bipartite matching, and Hall's theorem where it fails.

A solution needs a matching of slots and components. Depth-first search and clause learning alike take exponential
time to see that there is none (the pigeonhole principle); augmenting paths see it in time slots times options. If
some slots stay unmatched, the slots reached from one of them by alternating paths have together fewer options than
there are of them (Hall's theorem, 1935): that is the reason to give.

If there is a matching, an option that is in none of them is in no solution. Which these are is told by the strongly
connected components of the graph that leads from each slot to its matched component and from each component to the
other slots that could take it, with what is reachable from components that nobody holds (Regin, AAAI 1994).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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
    found = _matched(slots, _pools(options))
    return found if isinstance(found, Shortage) else None


def impossible(slots: Sequence[int], options: Sequence[Sequence[IRI]]) -> Shortage | set[tuple[int, IRI]]:
    """The roles that lack components; or else the pairs of a role and an option that are in no matching."""
    holder = _matched(slots, _pools(options))
    if isinstance(holder, Shortage):
        return holder
    home = {component: slots[slot] for component, slot in holder.items()}
    leads = {role: {home[c] for c in options[role] if c in home} for role in dict.fromkeys(slots)}
    free = _leading_to({role for role in leads if any(c not in home for c in options[role])}, leads)
    group = _groups(leads)
    return {
        (role, component)
        for role in leads
        for component in options[role]
        if component in home and home[component] not in free and group[home[component]] != group[role]
    }


def _leading_to(goals: set[int], leads: Mapping[int, set[int]]) -> set[int]:
    backward: dict[int, list[int]] = {}
    for role, others in leads.items():
        for other in others:
            backward.setdefault(other, []).append(role)
    found, waiting = set(goals), list(goals)
    while waiting:
        for role in backward.get(waiting.pop(), ()):
            if role not in found:
                found.add(role)
                waiting.append(role)
    return found


def _groups(leads: Mapping[int, set[int]]) -> dict[int, int]:
    """The strongly connected component of each role (Tarjan 1972), without recursion."""
    order: dict[int, int] = {}
    low: dict[int, int] = {}
    group: dict[int, int] = {}
    stack: list[int] = []
    for root in leads:
        work = [(root, iter(leads[root]))] if root not in order else []
        if work:
            order[root] = low[root] = len(order)
            stack.append(root)
        while work:
            role, others = work[-1]
            for other in others:
                if other not in order:
                    order[other] = low[other] = len(order)
                    stack.append(other)
                    work.append((other, iter(leads[other])))
                    break
                if other not in group:
                    low[role] = min(low[role], order[other])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[role])
                if low[role] == order[role]:
                    while True:
                        member = stack.pop()
                        group[member] = role
                        if member == role:
                            break
    return group


class FollowedMatching:
    """A matching that follows a depth-first search: whoever is still to come keeps a component to play it.

    Slots are given components in order. A slot that is taken back need not be undone: what it has is as good as any.
    """

    def __init__(self, slots: Sequence[int], options: Sequence[Sequence[IRI]]) -> None:
        self.slots, self.options = slots, _pools(options)
        found = _matched(slots, self.options)
        self.shortage = found if isinstance(found, Shortage) else None
        """The roles that lack components, if there are any: then nobody has a partner."""
        self.holder: dict[IRI, int] = {} if isinstance(found, Shortage) else found
        self.held: list[IRI | None] = [None] * len(slots)
        for component, slot in self.holder.items():
            self.held[slot] = component

    def give(self, place: int, component: IRI) -> bool:
        """Give a slot a component, if every later slot can then still have one of its own."""
        owner, before = self.holder.get(component), self.held[place]
        if owner == place:
            return True
        if before is not None:
            del self.holder[before]
        self.holder[component], self.held[place] = place, component
        if owner is None:
            return True
        self.held[owner] = None
        if _augment(owner, self.slots, self.options, self.holder, self.held, place) is None:
            return True
        self.holder[component], self.held[owner], self.held[place] = owner, component, before
        if before is not None:
            self.holder[before] = place
        return False


def _pools(options: Sequence[Sequence[IRI]]) -> list[Sequence[IRI]]:
    """The same options; roles that have the same share one sequence, so that it needs to be looked through but once."""
    known: dict[tuple[IRI, ...], Sequence[IRI]] = {}
    return [known.setdefault(tuple(some), some) for some in options]


def _matched(slots: Sequence[int], options: Sequence[Sequence[IRI]]) -> Shortage | dict[IRI, int]:
    """For each component that is taken the slot that has it."""
    holder: dict[IRI, int] = {}
    held: list[IRI | None] = [None] * len(slots)
    for slot, role in enumerate(slots):
        for component in options[role]:
            if component not in holder:
                holder[component], held[slot] = slot, component
                break
    for slot, component_held in enumerate(held):
        if component_held is None:
            reached = _augment(slot, slots, options, holder, held)
            if reached is not None:
                roles = tuple(sorted({slots[other] for other in reached}))
                found = {one for role in roles for one in options[role]}
                wanted = sum(1 for role in slots if role in set(roles))
                return Shortage(roles, wanted, len(found))
    return holder


def _augment(
    start: int,
    slots: Sequence[int],
    options: Sequence[Sequence[IRI]],
    holder: dict[IRI, int],
    held: list[IRI | None],
    settled: int = -1,
) -> set[int] | None:
    """Give the slot a component, moving others but those up to a settled one; or else the slots that are reached.

    Options are looked through once, however many slots and roles have them.
    """
    came: dict[IRI, int] = {}
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
            owner = holder.get(component)
            if owner is not None and owner <= settled:
                continue
            came[component] = slot
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
