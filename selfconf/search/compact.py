"""The problem in small integers, without what cannot matter: kinds, arc consistency and the kernel.

*Needs.* An input that role r must have fed is a *need*: the role, the links that may feed it, and the signal. Needs
are numbered. What a candidate needs in a role, what it gives to the roles fed by that role, and what it lets the
variables be make its *kind*; two candidates of a role with the same ports have the same kind, which is worked out
once. Output types are expanded upward, once per output and role, to the needs they serve.

*Arc consistency.* A kind that needs what no kind left gives is in no solution, nor is a kind whose variables could
only have values that some role cannot have. Both leave, until nothing changes; each leaving is recorded with its
cause, so that a refusal can tell how a role ran out of candidates. Counting the givers of each need makes it linear
in the number of needs and gifts of all kinds.

*Kernel.* Let a group be the candidates that are eligible for exactly the same roles R and are of the same kind in
each. Members are interchangeable: swapping two in a solution, or one in it for one outside, gives a solution. Let k
be the number of slots of R. Then for each role of R only the first k members, in the order of that role, can occur
in the least solution: were another one in a slot of role r, then at most k - 1 of the first k would play (in the
other slots of R), one of them would be free, and putting it there would give a lesser solution. So the least
solution of the kernel is the least solution. Keeping one member per kind would be wrong as soon as roles share
candidates. Roles with no slots take no part: nobody plays them before the extension.

Cost: one pass over the candidates of roles that have slots; after it only kinds and kept candidates are touched.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass

from selfconf.model.partition import ANY_VALUE
from selfconf.model.profile import Input, Output
from selfconf.model.term import IRI
from selfconf.search.problem import Problem

Ports = tuple[tuple[Input, ...], tuple[Output, ...], tuple[int, ...]]


@dataclass(frozen=True, slots=True)
class Need:
    """A signal that an input of whoever plays `role` must get; `input` only where an interaction names it."""

    role: int
    signal: IRI
    sources: tuple[tuple[int, str | None], ...]
    """The roles that may feed it, each with the name of the output, if the interaction names one."""
    input: str | None = None


class Kind:
    """What a candidate is to the search, in one role: numbers of needs, and masks of values."""

    __slots__ = ("admits", "gives", "needs", "role")

    def __init__(self, role: int, needs: tuple[int, ...], gives: tuple[int, ...], admits: tuple[int, ...]) -> None:
        self.role, self.needs, self.gives, self.admits = role, needs, gives, admits


class Option:
    """A candidate that a slot may take: its number in the role's order, its component and its kind."""

    __slots__ = ("component", "kind", "number")

    def __init__(self, number: int, component: IRI, kind: Kind) -> None:
        self.number, self.component, self.kind = number, component, kind


@dataclass(frozen=True, slots=True)
class Departure:
    """Why a kind left: a need that nobody left could serve, or a variable with no value that every role can have."""

    kind: Kind
    need: int | None = None
    variable: int | None = None


@dataclass(frozen=True, slots=True)
class Compact:
    """The kernel of a problem: options per role, the needs by number, and how the rest left."""

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


class Wiring:
    """Numbers the needs of a problem and says which of them an output serves."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self.needs: list[Need] = []
        self._number: dict[tuple[int, tuple[tuple[int, str | None], ...], IRI], int] = {}
        self._served: dict[tuple[int, IRI], list[tuple[int, str | None]]] = {}

    def need(self, role: int, wanted: Input) -> int:
        """The number of the need that an input is."""
        links = [link for link in self.problem.links[role] if link.input in (None, wanted.name)]
        sources = tuple(dict.fromkeys((link.source, link.output) for link in links))
        key = role, sources, wanted.signal
        number = self._number.get(key)
        if number is None:
            number = self._number[key] = len(self.needs)
            named = any(link.input for link in self.problem.links[role])
            self.needs.append(Need(role, wanted.signal, sources, wanted.name if named else None))
            for source, output in sources:
                self._served.setdefault((source, wanted.signal), []).append((number, output))
        return number

    def served(self, role: int, outputs: Sequence[Output]) -> tuple[int, ...]:
        """The needs that somebody with these outputs serves by playing a role; every need must be known by now."""
        found: dict[int, None] = {}
        for output in outputs:
            for signal in self.problem.hierarchy.superclasses(output.signal):
                for number, name in self._served.get((role, signal), ()):
                    if name is None or name == output.name:
                        found[number] = None
        return tuple(sorted(found))


def compact(problem: Problem, prune: bool = True) -> Compact:
    """The kernel of a problem, after arc consistency unless that is left out."""
    slots = tuple(role for role, asked in enumerate(problem.roles) for _ in range(asked.minimum))
    wiring = Wiring(problem)
    played = list(dict.fromkeys(slots))
    members = {role: _members(problem, wiring, role) for role in played}
    of: dict[tuple[int, Ports], Kind] = {}
    for role in played:
        for ports, needs in members[role][1].items():
            of[role, ports] = Kind(role, needs, wiring.served(role, ports[1]), ports[2])
    gone: set[int] = set()
    departures: list[Departure] = []
    if prune:
        gone, departures = consistent(tuple(of.values()), len(wiring.needs), problem.open_values, played)
    left: dict[int, list[Option]] = {}
    for role in played:
        candidates = problem.candidates[role]
        left[role] = [
            Option(number, candidates[number].profile.component, kind)
            for number, ports in enumerate(members[role][0])
            if id(kind := of[role, ports]) not in gone
        ]
    kept = kernel(left, {role: problem.roles[role].minimum for role in left})
    options = tuple(tuple(kept.get(role, ())) for role in range(len(problem.roles)))
    return Compact(slots, options, tuple(wiring.needs), problem.open_values, tuple(departures))


def _members(problem: Problem, wiring: Wiring, role: int) -> tuple[list[Ports], dict[Ports, tuple[int, ...]]]:
    """The ports of each candidate of a role, in order, and the needs of each different one."""
    ports: list[Ports] = [(c.profile.inputs, c.profile.outputs, c.admits) for c in problem.candidates[role]]
    different = dict.fromkeys(ports, ())
    return ports, {one: tuple(dict.fromkeys(wiring.need(role, wanted) for wanted in one[0])) for one in different}


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


def kernel(left: dict[int, list[Option]], minima: dict[int, int]) -> dict[int, list[Option]]:
    """Of each group as many options as there are slots for it, the first ones."""
    eligible: dict[IRI, tuple[int, ...]] = {}
    shared = len(left) > 1 and _any_shared(left)
    if shared:
        for options in left.values():
            for option in options:
                eligible[option.component] = (*eligible.get(option.component, ()), id(option.kind))
    role_of = {id(option.kind): option.kind.role for options in left.values() for option in options} if shared else {}
    kept: dict[int, list[Option]] = {}
    for role, options in left.items():
        count: dict[tuple[int, ...], int] = {}
        limit: dict[tuple[int, ...], int] = {}
        kept[role] = []
        for option in options:
            group = eligible[option.component] if shared else (id(option.kind),)
            seen = count[group] = count.get(group, 0) + 1
            if seen == 1:
                roles = {role_of[kind] for kind in group} if shared else {role}
                limit[group] = sum(minima[r] for r in roles)
            if seen <= limit[group]:
                kept[role].append(option)
    return kept


def _any_shared(left: dict[int, list[Option]]) -> bool:
    everybody: set[IRI] = set()
    for options in left.values():
        before = len(everybody)
        everybody.update(option.component for option in options)
        if len(everybody) < before + len(options):
            return True
    return False
