"""The problem in small integers, without what cannot matter: kinds, the kernel and arc consistency.

*Needs.* An input that role r must have fed is a *need*: the role, the links that may feed it, and the signal. Needs
are numbered. What a candidate needs in a role, what it gives to the roles fed by that role, and what it lets the
variables be make its *kind*; two candidates of a role with the same ports have the same kind, which is worked out
once. Output types are expanded upward, once per output and role, to the needs they serve.

*Kernel.* Two cuts, each of which keeps the least solution.
(1) Let S be the number of all slots. Of each kind of a role the first S suffice: were a later one in a slot of the
least solution, then at most S - 1 of the first S would play, one of them would be free, and putting it there would
give a lesser solution. This needs no knowledge of who is eligible for what else.
(2) Let a group be the candidates that are eligible for exactly the same roles R, with the same kind in each, and k
the number of slots of R. For each role of R the first k of the group suffice, by the same argument: members can only
play in the k slots of R. Keeping one per kind would be wrong as soon as roles share candidates.
Roles with no slots take no part: nobody plays them before the extension.

*Arc consistency.* A kind that needs what no kind left gives is in no solution, nor is a kind whose variables could
only have values that some role cannot have. Both leave, until nothing changes; each leaving is recorded with its
cause, so that a refusal can tell how a role ran out of candidates. Counting the givers of each need makes it linear
in the number of needs and gifts of all kinds.

Cost: one pass over the candidates of roles that have slots; after it only kinds and kept candidates are touched.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import compress
from operator import attrgetter, not_

from selfconf.model.partition import ANY_VALUE, Candidate
from selfconf.model.profile import Input, Output
from selfconf.model.term import IRI
from selfconf.search.problem import Problem
from selfconf.search.wiring import Need, Wiring

Ports = tuple[tuple[Input, ...], tuple[Output, ...], tuple[int, ...]]

ports_of: Callable[[Candidate], Ports] = attrgetter("profile.inputs", "profile.outputs", "admits")
"""All of a candidate that its kind depends on."""


class Kind:
    """What a candidate is to the search, in one role: numbers of needs, and masks of values."""

    __slots__ = ("admits", "gives", "needs", "number", "ports", "role")

    def __init__(
        self,
        role: int,
        needs: tuple[int, ...],
        gives: tuple[int, ...],
        admits: tuple[int, ...],
        number: int = -1,
        ports: tuple[Ports, ...] = (),
    ) -> None:
        self.role, self.needs, self.gives, self.admits = role, needs, gives, admits
        self.number, self.ports = number, ports
        """The number of the first candidate of this kind, and what candidates of this kind have."""


class Option:
    """A candidate that a slot may take: its number in the role's order, its component and its kind."""

    __slots__ = ("component", "kind", "number")

    def __init__(self, number: int, component: IRI, kind: Kind) -> None:
        self.number, self.component, self.kind = number, component, kind


@dataclass(frozen=True, slots=True)
class Departure:
    """Why a kind left: a need that nobody left can serve, or a variable with no value that every role can have."""

    kind: Kind
    need: int | None = None
    variable: int | None = None


@dataclass(frozen=True, slots=True)
class Compact:
    """The kernel of a problem: options per role, the needs by number, and how others left."""

    slots: tuple[int, ...]
    """The role of each slot, in order; a role that asks for k components has k slots."""
    options: tuple[tuple[Option, ...], ...]
    needs: tuple[Need, ...]
    values: tuple[int, ...]
    """What each variable may be before anybody plays."""
    departures: tuple[Departure, ...] = ()

    def short(self) -> int | None:
        """The first role with fewer options than slots, if there is one: then there is no solution."""
        asked = Counter(self.slots)
        return next((role for role, slots in asked.items() if len(self.options[role]) < slots), None)

    def kinds(self) -> list[Kind]:
        """The kinds that options are of, in order."""
        return list(dict.fromkeys([option.kind for options in self.options for option in options]))


def compact(problem: Problem, apart: Collection[IRI] = (), order: Mapping[int, Sequence[int]] | None = None) -> Compact:
    """The kernel of a problem; components that are set apart are of no kind but their own.

    `order` is another order of the candidates of each role, by number: then the first and the least are by that.
    """
    slots = tuple(role for role, asked in enumerate(problem.roles) for _ in range(asked.minimum))
    minima = Counter(slots)
    wiring = Wiring(problem)
    same: dict[int, list[tuple[int, Kind]]] = {}
    for role in minima:
        numbers = range(len(problem.candidates[role])) if order is None else order[role]
        same[role] = _alike(role, problem.candidates[role], numbers, len(slots), apart, wiring)
    for role, members in same.items():
        for kind in {kind: None for _, kind in members}:
            kind.gives = wiring.served(role, kind.ports[0][1])
    names = [problem.candidates[role][number].profile.component for role in same for number, _ in same[role]]
    unshared = len(set(names)) == len(names)
    left: dict[int, list[Option]] = {}
    for role, members in same.items():
        here = problem.candidates[role]
        some = _first(members, minima[role]) if unshared else members
        left[role] = [Option(number, here[number].profile.component, kind) for number, kind in some]
    if not unshared:
        left = kernel(left, minima)
    options = tuple(tuple(left.get(role, ())) for role in range(len(problem.roles)))
    return Compact(slots, options, tuple(wiring.needs), problem.open_values)


def _alike(
    role: int,
    candidates: Sequence[Candidate],
    numbers: Sequence[int],
    most: int,
    apart: Collection[IRI],
    wiring: Wiring,
) -> list[tuple[int, Kind]]:
    """The candidates that are among the first so many of their kind: their numbers, in the order given, and kinds.

    The one pass over all candidates: who has what enough others have is passed over without a step of Python.
    """
    key: Callable[[Candidate], Hashable] = _own(apart) if apart else ports_of
    kinds: dict[Hashable, Kind] = {}
    met: dict[Kind, int] = {}
    enough: set[Hashable] = set()
    found: list[tuple[int, Kind]] = []
    ordered = candidates if isinstance(numbers, range) else [candidates[number] for number in numbers]
    here: Iterable[tuple[int, Candidate]] = zip(numbers, ordered, strict=True)
    if len(ordered) > most:
        here = compress(here, map(not_, map(enough.__contains__, map(key, ordered))))
    for number, candidate in here:
        same = key(candidate)
        kind = kinds.get(same)
        if kind is None:
            ports = ports_of(candidate)
            kind = kinds[same] = Kind(role, wiring.needed(role, ports[0]), (), ports[2], number, (ports,))
            seen = met[kind] = 1
        else:
            seen = met[kind] = met[kind] + 1
        found.append((number, kind))
        if seen == most:
            enough.add(same)
    return found


def _first(members: list[tuple[int, Kind]], most: int) -> list[tuple[int, Kind]]:
    """The first so many members of each kind."""
    left = dict.fromkeys([kind for _, kind in members], most)
    if len(left) == len(members):
        return members
    found = []
    for number, kind in members:
        if left[kind]:
            left[kind] -= 1
            found.append((number, kind))
    return found


def _own(apart: Collection[IRI]) -> Callable[[Candidate], Hashable]:
    """What candidates are told apart by if some components are set apart."""
    return lambda candidate: (
        ports_of(candidate),
        candidate.profile.component if candidate.profile.component in apart else None,
    )


def consistent(
    kinds: Sequence[Kind], needs: int, values: Sequence[int], required: Collection[int]
) -> tuple[set[int], list[Departure]]:
    """The kinds that are in no solution, by identity, and why, in the order in which they left.

    `required` are the roles that somebody must play; only they constrain the variables.
    """
    givers = [0] * needs
    needing: list[list[Kind]] = [[] for _ in range(needs)]
    for kind in kinds:
        for need in kind.gives:
            givers[need] += 1
        for need in kind.needs:
            needing[need].append(kind)
    gone: set[int] = set()
    departures: list[Departure] = []
    waiting = [need for need in range(needs) if not givers[need]]
    while True:
        while waiting:
            need = waiting.pop()
            for kind in needing[need]:
                if id(kind) not in gone:
                    gone.add(id(kind))
                    departures.append(Departure(kind, need=need))
                    waiting += _leave(kind, givers)
        by_value = list(_valueless([kind for kind in kinds if id(kind) not in gone], values, required))
        if not by_value:
            return gone, departures
        for departure in by_value:
            if id(departure.kind) not in gone:
                gone.add(id(departure.kind))
                departures.append(departure)
                waiting += _leave(departure.kind, givers)


def _leave(kind: Kind, givers: list[int]) -> Iterator[int]:
    for need in kind.gives:
        givers[need] -= 1
        if not givers[need]:
            yield need


def _valueless(kinds: Sequence[Kind], values: Sequence[int], required: Collection[int]) -> Iterator[Departure]:
    """The kinds that allow a variable only values that some role cannot have; none once a role has nobody left."""
    if not {kind.role for kind in kinds}.issuperset(required):
        return
    for number, common in enumerate(values):
        some = dict.fromkeys(required, 0)
        for kind in kinds:
            if kind.role in some:
                some[kind.role] |= kind.admits[number]
        for allowed in some.values():
            common &= allowed
        if common != ANY_VALUE:
            for kind in kinds:
                if not kind.admits[number] & common:
                    yield Departure(kind, variable=number)


def kernel(left: Mapping[int, list[Option]], minima: Mapping[int, int]) -> dict[int, list[Option]]:
    """Of each group as many options as there are slots for it, the first ones."""
    group: dict[IRI, int] = {}
    limit: list[int] = [0]
    following: dict[tuple[int, int], int] = {}
    for role, options in left.items():
        for option in options:
            step = group.get(option.component, 0), id(option.kind)
            after = following.get(step)
            if after is None:
                after = following[step] = len(limit)
                limit.append(limit[step[0]] + minima[role])
            group[option.component] = after
    kept: dict[int, list[Option]] = {}
    for role, options in left.items():
        count: dict[int, int] = {}
        kept[role] = []
        for option in options:
            number = group[option.component]
            seen = count[number] = count.get(number, 0) + 1
            if seen <= limit[number]:
                kept[role].append(option)
    return kept


class Prepared:
    """A problem, made compact when that is first asked for."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem

    @cached_property
    def compact(self) -> Compact:
        """The kernel of the problem."""
        return compact(self.problem)
