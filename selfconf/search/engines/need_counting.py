"""Counting what has to be supplied: needs of which no component supplies two, against the slots that may supply them.

*Why.* A sink that wants ten signals, of a role for nine components that issue one each, gets nine. Matching counts
components for slots, and groups count options that exclude each other; here the slots are what is scarce, and who fills
them does not matter. Clause learning goes through all ways to fill nine of them: with 16 signals and 15 slots it took
seconds, and the same again for the question whether one of 16 slots may be spent on a component that issues none.

*What is counted.* A need is unavoidable if so many options of a role have it that one of them fills a slot. Of the
unavoidable needs some are chosen of which no option supports two. In every solution each of these has a slot of its
own, filled by an option that supports it: a matching of needs and slots. So where there is none, there is no solution
(Hall's theorem); an option that supports one of these needs in a slot that none of the matchings gives to that need is
in no solution; and of the options that support none of them, no more play than there are slots to spare. Nothing here
depends on the order of options, so that the least solution stays.

*Which needs.* Those with the fewest supports first. A need that one slot alone can supply is left out: what it says is
that options exclude each other (`exclusion`). Needs that have many slots to spare are left out as well.

*Cost.* A pass over the needs of all options, which mostly finds none in common; then one over the supports of those
that may supply what was found, and a matching.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from itertools import accumulate, chain, takewhile

from selfconf.model.immutable import immutable, replace
from selfconf.search.engines.matching import HallSet, unmatchable
from selfconf.search.reduction import Limit, NeedScope, Option, ReducedProblem

SPARE_SLOTS = 1.5
"""Needs are counted if there are at most so many slots for each of them.

With 2, one of three graphs to be seen by few of their nodes took 1.5 times as long, and two half as long; with 1.5 only
these two are counted.
"""


@immutable
class CountedNeeds:
    """Unavoidable needs of which no option supports two, and the roles that may supply them, which supply no others."""

    needs: Mapping[int, frozenset[int]]
    """The roles that may supply each need."""
    slots: Sequence[int]
    """The roles that may supply some of them, each as often as it has slots."""

    @property
    def spare(self) -> int:
        """How many slots are left if each need has one; below zero if there are too few."""
        return len(self.slots) - len(self.needs)


@immutable
class Undersupply:
    """Unavoidable needs that have fewer slots to supply them than they are."""

    needs: tuple[int, ...]
    slots: int


def counted_needs(given: ReducedProblem, single: bool = False) -> list[CountedNeeds]:
    """Return the unavoidable needs that are counted, those that may be supplied by the same roles together.

    They are needs that a role of several slots may supply; or else, if `single`, that only roles of one slot each may
    supply: these are many in some problems, and counting them says something about few.
    """
    asked = Counter(given.slots)
    wanted = _unavoidable(given, asked, single)
    if not wanted or not _may_be_scarce(given, asked, wanted):
        return []
    supports = _supports(given, wanted)
    pressed = Counter(chain.from_iterable({role for role, _ in some} for some in supports.values()))
    if all(SPARE_SLOTS * pressed[role] < asked[role] for role in pressed):
        return []
    able = {need: frozenset(role for role, _ in supports[need]) for need in _chosen(supports)}
    return [
        CountedNeeds(needs, slots)
        for needs in parts_by_role(able)
        for slots in [[role for role in sorted(frozenset().union(*needs.values())) for _ in range(asked[role])]]
        if len(slots) <= SPARE_SLOTS * len(needs)
    ]


def _unavoidable(given: ReducedProblem, asked: Mapping[int, int], single: bool) -> set[int]:
    """Return the needs that some component has in every solution, but for those that one slot alone may supply."""
    if not single and len(asked) == len(given.slots):
        return set()
    several: dict[NeedScope, bool] = {}
    found: set[int] = set()
    for role, slots in asked.items():
        for need in _common(given.options[role], slots):
            scope = given.needs.scopes[need]
            if scope not in several:
                slots_of = [asked.get(source, 0) for source in {source.role for source in scope.sources}]
                most = max(slots_of, default=0)
                several[scope] = sum(slots_of) > most == 1 if single else most > 1
            if several[scope]:
                found.add(need)
    return found


def _common(options: tuple[Option, ...], slots: int) -> set[int]:
    """Return the needs that are left in each choice of so many options."""
    if slots == 1:
        common = set(options[0].kind.needs) if options else set[int]()
        for option in options:
            if not common:
                break
            common.intersection_update(option.kind.needs)
        return common
    counted = Counter(chain.from_iterable([option.kind.needs for option in options]))
    return {need for need, number in counted.items() if number > len(options) - slots}


def _may_be_scarce(given: ReducedProblem, asked: Mapping[int, int], wanted: set[int]) -> bool:
    """Return False if each need has so many supports that there are slots to spare; True where several roles share."""
    roles = {source.role for scope in {given.needs.scopes[need] for need in wanted} for source in scope.sources}
    if len(roles) > 1:
        return True
    options = [option for role in roles for option in given.options[role]]
    counted = Counter(chain.from_iterable([option.kind.supports for option in options]))
    # Of needs of which no option supports two, all supports together are no more than there are options.
    sums = accumulate(sorted(counted[need] for need in wanted))
    most = sum(1 for _ in takewhile(len(options).__ge__, sums))
    return SPARE_SLOTS * most >= sum(asked[role] for role in roles)


Support = tuple[int, frozenset[int]]
"""A role, and those of some needs that one or several of its options support."""


def _supports(given: ReducedProblem, wanted: set[int]) -> dict[int, set[Support]]:
    """Return for each of some needs by what it is supported."""
    found: dict[int, set[Support]] = {need: set() for need in wanted}
    scopes = {given.needs.scopes[need] for need in wanted}
    for role in {source.role for scope in scopes for source in scope.sources}:
        for kind in {option.kind for option in given.options[role]}:
            support = role, frozenset(wanted.intersection(kind.supports))
            for need in support[1]:
                found[need].add(support)
    return found


def _chosen(supports: Mapping[int, set[Support]]) -> Iterator[int]:
    """Yield some of the needs of which no option supports two."""
    shared = set[int]()
    for need in sorted(supports, key=lambda need: (len(supports[need]), need)):
        if need not in shared:
            yield need
            shared.update(*[these for _, these in supports[need]])


def parts_by_role(able: Mapping[int, frozenset[int]]) -> Iterator[dict[int, frozenset[int]]]:
    """Yield needs, given by number with the roles that are able to supply them, in parts with no role in common."""
    having: defaultdict[int, list[int]] = defaultdict(list)
    for need, roles in able.items():
        for role in roles:
            having[role].append(need)
    left = dict(able)
    while left:
        need, _ = left.popitem()
        part, waiting = {need: able[need]}, [*able[need]]
        while waiting:
            for other in having.pop(waiting.pop(), ()):
                if other in left:
                    part[other] = left.pop(other)
                    waiting += part[other]
        yield part


def supplied(given: ReducedProblem, counted: Sequence[CountedNeeds]) -> Undersupply | ReducedProblem:
    """Return a problem without options that leave needs unsupplied, the same one if there are none; or such needs."""
    useless: set[tuple[int, int]] = set()
    full: dict[int, CountedNeeds] = {}
    for some in counted:
        found = _in_no_matching(some)
        if isinstance(found, Undersupply):
            return found
        useless |= {(need, role) for need, role in found if need is not None}
        full |= {role: some for need, role in found if need is None}
    if not useless and not full:
        return given

    def supplies(role: int, option: Option) -> bool:
        if role in full and full[role].needs.keys().isdisjoint(option.kind.supports):
            return False
        return not useless or all((need, role) not in useless for need in option.kind.supports)

    options = tuple(
        tuple(option for option in some if supplies(role, option)) for role, some in enumerate(given.options)
    )
    return replace(given, options=options) if options != given.options else given


def _in_no_matching(counted: CountedNeeds) -> Undersupply | set[tuple[int | None, int]]:
    """Return pairs of a need and a role of which no slot can be matched with it; of None, if it can spare no slot."""
    needs: list[int | None] = [*counted.needs]
    pools = [[slot for slot, role in enumerate(counted.slots) if role in able] for able in counted.needs.values()]
    if counted.spare > 0:
        needs.append(None)  # takes a slot to spare, whichever it is
        pools.append([*range(len(counted.slots))])
    found = unmatchable(range(len(pools)), pools)
    if isinstance(found, HallSet):
        return Undersupply(tuple(need for place in found.roles if (need := needs[place]) is not None), found.found)
    pairs = {(needs[place], counted.slots[slot]) for place, slot in found}
    return pairs if counted.spare > 0 else pairs | {(None, role) for role in counted.slots}


def limits(given: ReducedProblem, counted: Sequence[CountedNeeds]) -> tuple[Limit, ...]:
    """Return how many options may fill slots for counted needs and supply none of these: one for each slot to spare."""
    return tuple(
        Limit(
            frozenset(
                (role, option.number)
                for role in dict.fromkeys(some.slots)
                for option in given.options[role]
                if some.needs.keys().isdisjoint(option.kind.supports)
            ),
            some.spare,
        )
        for some in counted
    )
