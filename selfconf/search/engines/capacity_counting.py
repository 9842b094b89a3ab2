"""Counting what each role can serve: demands that every solution meets, against how many of them an option meets.

*Why.* A hole takes two guests, whichever they are: a role for the hole with an option for each pair. Seventeen guests
do not fit into eight such holes, which neither matching sees, as no two roles share a component, nor groups of options
that exclude each other; clause learning goes through all ways to seat sixteen of them.

*Demands.* A demand is met in every solution by an option that plays in one of some roles. There are two kinds: a need
that some component has in every solution, met by what supports it; and a role of one slot, each option of which goes
with few options of some other role, its partner: met by these, be it that they support what the option needs, or that
it supports all that they need of it.

*What is counted.* An option of a role meets some of the demands; the most that any of its options meets, times the
slots of the role, is the capacity of the role. In every solution each demand is met by some role, and none meets more
than its capacity: a matching of demands and places. So where there is none, there is no solution (Hall's theorem); what
meets a demand in a role of which no place is in a matching with it is in no solution; nor is an option of a role of one
slot that meets so few demands that the others do not have places enough. Nothing here depends on the order of options.

*Cost.* A pass over all pairs of an option and a role that it is bound to, unless the first options of roles go with
many of each; then a matching for each number of demands that an option of a role may meet, where places are scarce.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Iterable, Mapping, Sequence

from selfconf.model.immutable import replace
from selfconf.search.engines.conflict_graph import mask_of, numbers_of
from selfconf.search.engines.exclusion import feeding_alone
from selfconf.search.engines.matching import HallSet, unmatchable
from selfconf.search.engines.need_counting import parts_by_role
from selfconf.search.reduction import Option, ReducedProblem

SPARE_PLACES = 0.25
"""Demands are counted if there are at most so many places to spare for each of them."""
LOOKS_PER_OPTION = 4
"""How often it is looked at what an option supports, on average, if demands of roles are to be counted."""
SHARE_PARTNERS = 2
"""An option demands something of a role only if it goes with at most one in this number of the role's options."""

Demand = Mapping[int, int]
"""The options that meet a demand: for each role that has some, a mask of their places among the role's options."""


def within_capacity(given: ReducedProblem) -> ReducedProblem | None:
    """Return a problem without options that leave demands unmet, the same one if there are none; None if all do."""
    for demands in (_of_needs(given), _of_roles(given)):
        left = _met(given, demands)
        if left is not given:
            return left
    return given


def _of_needs(given: ReducedProblem) -> list[Demand]:
    """Return the demands that are needs of some component in every solution, but for those that one slot may supply."""
    found: dict[int, dict[int, int]] = {need: {} for need in _unavoidable(given)}
    for role, options in enumerate(given.options) if found else ():
        for place, option in enumerate(options):
            for need in found.keys() & option.kind.supports:
                found[need][role] = found[need].get(role, 0) | 1 << place
    return list(found.values())


def _unavoidable(given: ReducedProblem) -> set[int]:
    """Return the needs of some component in every solution that several slots may supply."""
    asked = Counter(given.slots)
    # What one slot alone may supply, it has to: clauses say so.
    several = {
        scope
        for scope in dict.fromkeys(given.needs.scopes)
        if sum(asked[role] for role in {source.role for source in scope.sources}) > 1
    }
    found: set[int] = set()
    for role, slots in asked.items() if several else ():
        options = given.options[role]
        counted = Counter([need for option in options for need in option.kind.needs])
        common = [need for need, number in counted.items() if number > len(options) - slots]
        found.update(need for need in common if given.needs.scopes[need] in several)
    return found


def _of_roles(given: ReducedProblem) -> list[Demand]:
    """Return the demands that are roles of one slot each."""
    bonds = _Bonds(given)
    return [demand for role in bonds.roles() if (demand := _demand(bonds, role, given.options[role])) is not None]


def _demand(bonds: _Bonds, role: int, options: Iterable[Option]) -> Demand | None:
    """Return what the options of a role go with of their partners; None if some option has no partner."""
    found: dict[int, int] = {}
    for option in options:
        partner = bonds.partner(role, option)
        if partner is None:
            return None
        other, fitting = partner
        found[other] = found.get(other, 0) | fitting
    return found


class _Bonds:
    """Which options of two roles of one slot each go with each other, by the needs that only one of them may feed."""

    def __init__(self, given: ReducedProblem) -> None:
        asked = Counter(given.slots)
        alone = {scope: role for scope, role in feeding_alone(given).items() if asked[scope.role] == 1}
        self._source = {need: alone[scope] for need, scope in enumerate(given.needs.scopes) if scope in alone}
        """For each of these needs the role that may feed it."""
        self._fed: defaultdict[int, defaultdict[int, list[int]]] = defaultdict(lambda: defaultdict(list))
        """For each role that feeds others, these, each with its needs."""
        for need, source in self._source.items():
            self._fed[source][given.needs.scopes[need].role].append(need)
        self._options = [len(options) for options in given.options]
        looks = sum(self._options[role] * sum(map(len, sinks.values())) for role, sinks in self._fed.items())
        self.few = 0 < looks <= LOOKS_PER_OPTION * sum(self._options)
        """Whether there are some, and few enough to be looked at."""
        self._having: defaultdict[int, int] = defaultdict(int)
        """For each need the options that have it, as a mask of their places in their role."""
        self._supporting: defaultdict[int, int] = defaultdict(int)
        for role in self.roles():
            self._note(given.options[role])

    def _note(self, options: Iterable[Option]) -> None:
        """Note what the options of a role need and support."""
        for place, option in enumerate(options):
            for need in option.kind.needs:
                self._having[need] |= 1 << place
            for need in option.kind.supports:
                self._supporting[need] |= 1 << place

    def roles(self) -> list[int]:
        """Return the roles that may have partners, in order."""
        return [] if not self.few else sorted({*self._fed, *(sink for sinks in self._fed.values() for sink in sinks)})

    def partner(self, role: int, option: Option) -> tuple[int, int] | None:
        """Return the role of whose options the least share goes with an option, and these; None if none is small."""
        fitting: dict[int, int] = {}
        supports = set(option.kind.supports)
        for sink, needs in self._fed[role].items() if role in self._fed else ():
            unfed = 0
            for need in needs:
                if need not in supports:
                    unfed |= self._having[need]
            fitting[sink] = ~unfed & (1 << self._options[sink]) - 1
        for need in option.kind.needs:
            source = self._source.get(need)
            if source is not None:
                fitting[source] = fitting.get(source, -1) & self._supporting[need]
        shares = {other: some.bit_count() / max(1, self._options[other]) for other, some in fitting.items()}
        other = min(shares, key=lambda other: (shares[other], other), default=None)
        return None if other is None or shares[other] * SHARE_PARTNERS > 1 else (other, fitting[other])


def _met(given: ReducedProblem, demands: Sequence[Demand]) -> ReducedProblem | None:
    """Return a problem without options that leave demands unmet, the same one if there are none; None if all do."""
    asked = Counter(given.slots)
    able = {number: frozenset(demand) for number, demand in enumerate(demands) if all(asked[role] for role in demand)}
    useless: dict[int, int] = {}
    for part in parts_by_role(able):
        found = _useless([demands[number] for number in part], asked)
        if found is None:
            return None
        useless |= found
    options = tuple(
        tuple(option for place, option in enumerate(some) if not useless.get(role, 0) >> place & 1)
        for role, some in enumerate(given.options)
    )
    return given if options == given.options else replace(given, options=options)


def _useless(demands: Sequence[Demand], asked: Mapping[int, int]) -> dict[int, int] | None:
    """Return for each role a mask of the places of options that leave some of the demands unmet; None if all do."""
    meeting = _counted(demands)
    capacity = {role: asked[role] * max(counts.values(), default=0) for role, counts in meeting.items()}
    spare = sum(capacity.values()) - len(demands)
    if spare > SPARE_PLACES * len(demands):
        return {}
    places = [[(role, number) for role in demand for number in range(capacity[role])] for demand in demands]
    unmet = unmatchable(range(len(demands)), places)
    if isinstance(unmet, HallSet):
        return None
    found = dict.fromkeys(meeting, 0)
    for demand, (role, _) in unmet:
        found[role] |= demands[demand][role]
    for role, counts in meeting.items():
        if asked[role] == 1 and spare < capacity[role]:
            # Of the options, also of those that meet no demand, all but these.
            found[role] |= ~mask_of([place for place, count in counts.items() if count + spare >= capacity[role]])
    return found


def _counted(demands: Iterable[Demand]) -> dict[int, Counter[int]]:
    """Return for each role that meets demands how many of them each of its options meets, by place."""
    found: defaultdict[int, Counter[int]] = defaultdict(Counter)
    for demand in demands:
        for role, some in demand.items():
            found[role].update(numbers_of(some))
    return found
