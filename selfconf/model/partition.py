"""The partition F1 ... Fn: for each role, in order, the eligible components (section 3.2 of the paper).

A parameter that is left unbound is a variable shared by the roles that mention it. What a candidate allows the
variable to be is a bit mask over the variable's domain. A negative mask, with infinitely many bits set, also allows
what is not in the domain; `ANY_VALUE` (all bits set) does not constrain the variable at all.
Candidates can play together iff, for each variable, the conjunction of their masks is not zero.

No search may depend on which site answered first. So candidates are ordered by what they say of themselves
(`candidate_order`); the order decides which configuration is the first.

A component that one obstacle alone keeps out of a role is a `NearMiss`. `rdf.eligibility` finds those of which types,
properties or ports are amiss, `composition.near_misses` those that feed nothing that is lacking, and ranks all of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import field
from decimal import Decimal
from operator import attrgetter
from typing import TypeVar

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import FrozenMapping, immutable, replace
from selfconf.model.obstacle import Obstacle
from selfconf.model.profile import Input, Placed, Ports, Profile, WantedSignal, shared_ports
from selfconf.model.term import IRI, Term

ANY_VALUE = -1


@immutable
class Variable:
    """A parameter left unbound, and the values that some candidate could give it; bit k stands for `domain[k]`."""

    parameter: IRI
    domain: tuple[Term, ...]
    listed: bool = False
    """Whether the parameter lists its values itself (`sh:in`): it may have any of them, and no other."""

    def first(self, mask: int) -> Term | None:
        """The first value that a mask allows, or None if it allows any outside the domain, or one by a further bit."""
        place = (mask & -mask).bit_length() - 1
        return None if mask < 0 or place >= len(self.domain) else self.domain[place]


@immutable
class Mention:
    """A free parameter that the shape of a role mentions, so that it matters what a component states for it."""

    parameter: IRI
    only: frozenset[Term] | None = None
    """The values that the rest of the shape permits a component to state for it; None if these are not listed."""
    never: frozenset[Term] = frozenset()
    """Of the values that candidates state, those that the rest of the shape does not permit."""
    required: bool = False
    """Whether a component has to state a value for it."""

    def beside(self, other: Mention) -> Mention:
        """What is asked by this and another mention of the same parameter together."""
        only = other.only if self.only is None else self.only if other.only is None else self.only & other.only
        return Mention(self.parameter, only, self.never | other.never, self.required or other.required)

    def among(self, values: frozenset[Term]) -> Mention:
        """The mention if only some values may be stated."""
        return replace(self, only=values)


@immutable
class Candidate:
    """A component that is eligible for a role, and what it allows each variable to be."""

    profile: Profile
    admits: tuple[int, ...] = ()


@immutable
class Recruit:
    """A component that may feed players without playing a role itself."""

    profile: Profile
    roles: frozenset[int]
    """The roles, by number, whose players it may feed; other recruits it may feed in any case."""

    @property
    def component(self) -> IRI:
        """The IRI of the component."""
        return self.profile.component


@immutable
class NearMiss(Placed):
    """A component that a role would take, but for one thing."""

    role: IRI
    component: IRI
    obstacle: Obstacle
    allows: Mapping[IRI, frozenset[Term]] = field(default_factory=dict, compare=False, repr=False)
    """For each free parameter that it constrains, the values that it would allow."""
    likeness: float = field(default=0.0, kw_only=True, compare=False)
    """How near it comes to what the role asks for, from 0 to 1, by its ports and its texts."""
    recruit: bool = field(default=False, kw_only=True)
    """Whether it would not play the role, but be recruited for it."""

    def __post_init__(self) -> None:
        object.__setattr__(self, "allows", FrozenMapping(self.allows))

    def __str__(self) -> str:
        return self.obstacle.clause


Barred = IRI | tuple[int | None, IRI]
"""What a search is barred from: a component, or one only as the player of a role, which is given by its number, or as
a recruit (None)."""
Unissuable = tuple[int | None, str | None, WantedSignal]
"""What an input wants that no component to add could be known to issue: for a role by its number, or to be recruited
(None), and by an output of that name, where an interaction asks for one."""
_PORTS = attrgetter("profile.ports")
_C = TypeVar("_C", Candidate, Recruit)


@immutable
class Partition:
    """F1 ... Fn in the order of the template's roles, each in the order in which candidates are tried."""

    candidates: tuple[tuple[Candidate, ...], ...]
    variables: tuple[Variable, ...] = ()
    recruits: tuple[Recruit, ...] = ()
    """The components that may be recruited, in the order in which they are preferred; none where no role recruits."""
    mentions: tuple[tuple[Mention, ...], ...] = ()
    """For each role the free parameters that its shape mentions, whether or not any candidate states a value."""
    unaddable: frozenset[int] = frozenset()
    """The roles, by number, for which no addition can be worded: their shapes contradict themselves, list who may play
    them, or ask of a free parameter what depends on alternatives, or what only pySHACL can tell."""

    unissuable: frozenset[Unissuable] = frozenset()
    """What candidates want that is not asked of components to add."""

    def mentioned(self, role: int) -> tuple[Mention, ...]:
        """The free parameters that the shape of a role, given by its number, mentions."""
        return self.mentions[role] if role < len(self.mentions) else ()

    def without(self, left_out: Set[Barred]) -> Partition:
        """The partition without some components, and without the values that none of those left states."""
        gone, less = set[IRI](), dict[int | None, set[IRI]]()
        for one in left_out:
            if isinstance(one, IRI):
                gone.add(one)
            else:
                less.setdefault(one[0], set()).add(one[1])
        of_roles = [gone | less.get(number, set()) for number in range(len(self.candidates))]
        left = tuple(
            tuple(candidate for candidate in some if candidate.profile.component not in without)
            for some, without in zip(self.candidates, of_roles, strict=True)
        )
        without = gone | less.get(None, set())
        return self._narrowed(left, tuple(recruit for recruit in self.recruits if recruit.component not in without))

    def without_recruits(self) -> Partition:
        """The partition with which players have to be enough."""
        return replace(self, recruits=())

    def with_only(self, role: int, component: IRI) -> Partition:
        """The partition in which one component alone may play a role, given by its number.

        The values that others state for the role stay, as these are eligible all the same.
        """
        only = tuple(c for c in self.candidates[role] if c.profile.component == component)
        return replace(self, candidates=(*self.candidates[:role], only, *self.candidates[role + 1 :]))

    def with_sent_requests(self, hierarchy: Hierarchy) -> Partition:
        """The partition in which each operation that is needed knows all that its request is under a hierarchy."""
        if hierarchy.flat:
            return self
        # One look at each candidate in C, then one at each choice of ports that they share.
        components = (*(one for some in self.candidates for one in some), *self.recruits)
        distinct = {id(ports): ports for ports in map(_PORTS, components)}
        changed = {key: _raised(ports, hierarchy) for key, ports in distinct.items() if _sends(ports)}
        if not changed:
            return self

        def told(some: Iterable[_C]) -> tuple[_C, ...]:
            return tuple(
                replace(one, profile=replace(one.profile, ports=changed[id(one.profile.ports)]))
                if id(one.profile.ports) in changed
                else one
                for one in some
            )

        return replace(self, candidates=tuple(map(told, self.candidates)), recruits=told(self.recruits))

    def _narrowed(self, left: tuple[tuple[Candidate, ...], ...], recruits: tuple[Recruit, ...]) -> Partition:
        """The partition with these candidates, and without the values of variables that none of them states."""
        kept = [_places_stated(variable, number, left) for number, variable in enumerate(self.variables)]
        if all(len(places) == len(variable.domain) for places, variable in zip(kept, self.variables, strict=True)):
            return replace(self, candidates=left, recruits=recruits)
        numbers = [number for number, places in enumerate(kept) if places]

        def narrowed(candidate: Candidate) -> Candidate:
            admits = tuple(_moved(candidate.admits[number], kept[number]) for number in numbers)
            return Candidate(candidate.profile, admits)

        domains = ((self.variables[n], tuple(self.variables[n].domain[place] for place in kept[n])) for n in numbers)
        variables = tuple(replace(variable, domain=domain) for variable, domain in domains)
        candidates = tuple(tuple(map(narrowed, role)) for role in left)
        return replace(self, candidates=candidates, variables=variables, recruits=recruits)


def _places_stated(variable: Variable, number: int, roles: Iterable[Iterable[Candidate]]) -> list[int]:
    """Which values of the domain of a variable are listed, or stated by a candidate."""
    stated = (1 << len(variable.domain)) - 1 if variable.listed else 0
    for role in roles:
        for candidate in role:
            stated |= max(0, candidate.admits[number])
    return [place for place in range(len(variable.domain)) if stated >> place & 1]


def _moved(mask: int, kept: Sequence[int]) -> int:
    """A mask over the values that are kept of a domain."""
    if mask < 0:
        return ANY_VALUE & ~sum(1 << bit for bit, place in enumerate(kept) if not mask >> place & 1)
    return sum(1 << bit for bit, place in enumerate(kept) if mask >> place & 1)


def _sends(ports: Ports) -> bool:
    return any(port.request is not None for port in ports.inputs)


def _raised(ports: Ports, hierarchy: Hierarchy) -> Ports:
    return shared_ports(tuple(_raised_input(port, hierarchy) for port in ports.inputs), ports.outputs)


def _raised_input(port: Input, hierarchy: Hierarchy) -> Input:
    """A needed operation whose request is known by all that it is; any other input as it is."""
    condition = port.condition
    if condition is None or condition.sent is None or condition.sent.type is None:
        return port
    sent = condition.sent._replace(kinds=hierarchy.superclasses(condition.sent.type))
    return port._replace(condition=condition._replace(sent=sent))


def candidate_order(profile: Profile) -> tuple[Decimal, str]:
    """The order in which candidates are tried: higher preference first, then by IRI, never by time of arrival."""
    return profile.preference.copy_negate(), profile.component  # a minus sign would round


def ordered(candidates: list[Candidate]) -> tuple[Candidate, ...]:
    """Candidates in the order in which they are tried."""
    return tuple(sorted(candidates, key=lambda candidate: candidate_order(candidate.profile)))
