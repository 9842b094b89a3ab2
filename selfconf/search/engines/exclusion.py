"""Groups of options of which at most one can play, read off needs, components and values, and counted.

A *group* is a set of options that exclude each other pairwise (a clique of the graph of conflicts): "no two share a
frequency" may be wired by port names, pair by pair, and is a group for each frequency in the end. Groups are grown
greedily until each conflict that is counted here is in one of them, so that they say all that these needs say; one
constraint with many options propagates like all of its pairs, in a fraction of the space.
Where each role that constrains a free parameter admits other values of it than all other roles, and each option of a
role of several slots other values than all other options, the options that constrain it are a group too: "who has the
room at nine" lets one lecture have it.

Where no three roles have conflicts with each other, as between items and the bins that take some of them, groups would
be of two roles each, which say no more than the needs do, and are not counted: there needs stay needs.

Which options exclude each other is read by a `ConflictGraph`, and what follows from the groups found by a
`GroupCounting`. Where nothing but components exclude each other, the groups are the components: matching has counted
all but the sets of roles that need each of their components. Where roles that have components in common do not feed
each other, as carts of one pool that each serve a hall of their own, a component is a group as it stands, too: to enter
it in the graph takes time and memory as the square of the options.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import reduce
from itertools import chain
from operator import or_

from selfconf.model.immutable import replace
from selfconf.model.partition import ANY_VALUE
from selfconf.model.term import IRI
from selfconf.search.engines.conflict_graph import ConflictGraph, numbers_of, often_supported
from selfconf.search.engines.group_counting import ExclusiveGroups, GroupCounting
from selfconf.search.reduction import NeedScope, ReducedProblem

SHARE_EXCLUDING = 16
"""One in this number of all needs at least has to be fed by one role alone, and often, or none is looked at."""
SHARE_APART = 2
"""The first options of roles have to differ in one in this number of the variables, or values are not looked at."""
FIRST_OPTIONS = 64
"""How many of its options are the first ones of a role of several slots."""


def exclusive_groups(reduced: ReducedProblem, distinct: bool = True, patience: int | None = None) -> ExclusiveGroups:
    """Return the groups of a reduced problem, and what counting them proves.

    If components need not be distinct, one component in two roles is no conflict. With patience, counting is left after
    so many groups from which nothing followed, if nothing has followed from any; `all_counted` then goes on.
    """
    names = [option.component for options in reduced.options for option in options if option.component]
    shared = distinct and len(set(names)) < len(names)
    needs = _fed_by_one(reduced, shared)
    of_values = _groups_of_values(reduced)
    by_values = [some for some in of_values.values() if some]
    if not needs and not shared and not by_values:
        return ExclusiveGroups()
    graph = ConflictGraph(reduced, needs)
    if not by_values and not any(graph.across):
        of_components = _groups_of_components(reduced) if shared else ExclusiveGroups()
        return replace(of_components, stated=frozenset(graph.stated))
    same = _apart_from_needs(graph, needs) if shared else []
    graph.settled = frozenset(of_values)
    groups = [*by_values, *same, *graph.groups()]
    return GroupCounting(graph, groups).counted(groups, patience)


def _groups_of_values(reduced: ReducedProblem) -> dict[int, list[int]]:
    """Return by variable the options that constrain it, where no value of it suits two that could play at once.

    As each option has some value, that one of them plays at most is all that the variable says; where they are of one
    role with one slot that is nothing, and no options are returned. One option alone that a role of several slots has
    is a group for counting: it takes what nothing else does.
    """
    if not _often_apart(reduced):
        return {}
    asked = Counter(reduced.slots)
    found: dict[int, list[int]] = {}
    for variable, some in enumerate(reduced.constraining()):
        admitted: dict[tuple[int, int], int] = {}
        for role, number, mask in some:
            player = role, number + 1 if asked[role] > 1 else 0
            admitted[player] = admitted.get(player, 0) | mask
        if _disjoint(admitted.values()) and all(mask > 0 for _, _, mask in some):
            says = len(admitted) > 1 or any(number for _, number in admitted)
            found[variable] = [number for _, number, _ in some] if says else []
    return found


def _often_apart(reduced: ReducedProblem) -> bool:
    """Return whether the first options of the roles that constrain a variable mostly admit other values of it each."""
    asked = Counter(reduced.slots)
    firsts: defaultdict[int, list[int]] = defaultdict(list)
    for role, options in enumerate(reduced.options if reduced.values else ()):
        for option in options[: FIRST_OPTIONS if asked[role] > 1 else 1]:
            for variable, mask in option.kind.admits.items():
                firsts[variable].append(mask)
    apart = [_disjoint(masks) for masks in firsts.values() if len(masks) > 1]
    return bool(apart) and SHARE_APART * sum(apart) >= len(apart)


def _disjoint(masks: Iterable[int]) -> bool:
    """Return whether no value is in two of some masks, but for those that have all values."""
    some = [mask for mask in masks if mask != ANY_VALUE]
    return reduce(or_, some, 0).bit_count() == sum([mask.bit_count() for mask in some])


def _groups_of_components(reduced: ReducedProblem) -> ExclusiveGroups:
    """Return the groups where only components exclude each other: one for each that several roles share.

    Counting then means components: where some roles share no component with any other, and have as many as slots.
    """
    same = _by_component(reduced)
    roles_of: dict[IRI, list[int]] = {}
    for option in chain.from_iterable(reduced.options):
        if option.component:
            roles_of.setdefault(option.component, []).append(option.kind.role)
    groups = [some for some in same.values() if len(some) > 1]
    if not groups:
        return ExclusiveGroups()
    asked = Counter(reduced.slots)
    played: list[list[int]] = []
    for roles, components in _connected(roles_of):
        slots = sum(asked[role] for role in roles)
        options = sum(len(reduced.options[role]) for role in roles)
        if slots < len(components) or options > sum(len(same[component]) for component in components):
            continue
        if slots > len(components):
            return ExclusiveGroups(groups, crowded=frozenset(roles))
        if len(roles) > 1:
            played += [same[component] for component in components]
    return ExclusiveGroups(groups, played=played)


def _by_component(reduced: ReducedProblem) -> dict[IRI, list[int]]:
    """Return the numbers of the options that each component is."""
    same: dict[IRI, list[int]] = {}
    for number, option in enumerate(chain.from_iterable(reduced.options)):
        if option.component:
            same.setdefault(option.component, []).append(number)
    return same


def _apart_from_needs(graph: ConflictGraph, needs: Mapping[int, set[int]]) -> list[list[int]]:
    """Return the groups that components are as they stand; none if they have been entered in the graph."""
    if _among_sharing(graph.reduced, needs):
        graph.add_components()
        return []
    return [some for some in _by_component(graph.reduced).values() if len(some) > 1]


def _among_sharing(reduced: ReducedProblem, needs: Mapping[int, set[int]]) -> bool:
    """Return whether a role alone feeds needs of a role that has a component in common with it."""
    scopes = reduced.needs.scopes
    bound = {(source, scopes[need].role) for source, some in needs.items() for need in some}
    having = {
        role: {option.component for option in reduced.options[role] if option.component}
        for role in set(chain.from_iterable(bound))
    }
    return any(not having[source].isdisjoint(having[sink]) for source, sink in bound)


def _connected(roles_of: Mapping[IRI, Sequence[int]]) -> Iterator[tuple[set[int], list[IRI]]]:
    """Yield sets of roles that share components among themselves alone, given those of each, with these components."""
    having: dict[int, list[IRI]] = {}
    for component, roles in roles_of.items():
        for role in roles:
            having.setdefault(role, []).append(component)
    met: set[int] = set()
    for start in having:
        if start in met:
            continue
        found, waiting, components = {start}, [start], dict[IRI, None]()
        while waiting:
            for component in having[waiting.pop()]:
                if component not in components:
                    components[component] = None
                    waiting += set(roles_of[component]) - found
                    found.update(roles_of[component])
        met |= found
        yield found, list(components)


def _fed_by_one(reduced: ReducedProblem, shared: bool) -> dict[int, set[int]]:
    """Return for each role with one slot the needs of other roles that it alone feeds, mostly by many of its options.

    None are returned if these are few, or if no three roles may have conflicts with each other.
    """
    scopes = reduced.needs.scopes
    alone = feeding_alone(reduced)
    if not _any_three(alone, _sharing(reduced) if alone and shared else ()):
        return {}
    found: defaultdict[int, set[int]] = defaultdict(set)
    used = set[int]().union(*[option.kind.needs for options in reduced.options for option in options])
    for number in used:
        if scopes[number] in alone:
            found[alone[scopes[number]]].add(number)
    often = {role: some for role, needs in found.items() if (some := often_supported(reduced.options[role], needs))}
    return often if sum(map(len, often.values())) * SHARE_EXCLUDING >= len(used) else {}


def feeding_alone(reduced: ReducedProblem) -> dict[NeedScope, int]:
    """Return the scopes that one other role with one slot alone feeds, with that role."""
    asked = Counter(reduced.slots)
    alone: dict[NeedScope, int] = {}
    for scope in dict.fromkeys(reduced.needs.scopes):
        role, *others = [source.role for source in scope.sources] or [scope.role]
        if role != scope.role and asked[role] == 1 and others.count(role) == len(others):
            alone[scope] = role
    return alone


def _any_three(alone: Mapping[NeedScope, int], sharing: Iterable[int]) -> bool:
    """Return whether three roles may have conflicts with each other, given the role that feeds each scope alone.

    Given are also the sets of roles that have a component in common, as masks.
    """
    beside: defaultdict[int, int] = defaultdict(int)
    for scope, role in alone.items():
        beside[role] |= 1 << scope.role
        beside[scope.role] |= 1 << role
    for roles in sharing:
        for role in numbers_of(roles):
            beside[role] |= roles & ~(1 << role)
    return any(beside[role] & beside[scope.role] for scope, role in alone.items())


def _sharing(reduced: ReducedProblem) -> set[int]:
    """Return the sets of roles that have a component in common, as masks."""
    roles_of: dict[IRI, int] = {}
    for role, options in enumerate(reduced.options):
        for option in options:
            roles_of[option.component] = roles_of.get(option.component, 0) | 1 << role
    return {roles for component, roles in roles_of.items() if component and roles & (roles - 1)}
