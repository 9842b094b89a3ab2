"""The extension of a solution by every further candidate that fits and is connected to another component.

As long as there is a candidate that fits, the first one (in the order of the roles, then of the candidates) is added,
up to the role's maximum. It fits if it plays no role yet, each of its required inputs is matched, and the free
parameters still have a value. Adding a component never unfeeds another.

What was added in a role of an interaction and in the end neither feeds another component nor is fed by one is left out
of that role, and the rest is done again: it may have taken the place of one that is connected, or be of use elsewhere.
If another one joins then, what was left out is tried once more, until nothing joins.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence, Set
from heapq import heappop, heappush

from selfconf.model.configuration import Configuration, ordered_connections
from selfconf.model.immutable import replace
from selfconf.model.partition import Candidate
from selfconf.model.profile import Input, Output
from selfconf.model.term import IRI
from selfconf.search.problem import Link, Playing, Problem


def solved(problem: Problem, playing: Playing, running: Configuration | None = None) -> Configuration:
    """Return the configuration that a solution stands for, extended by every further candidate that fits.

    With a running configuration, components that play the same role there are tried before all others. Where a role
    recruits it is not extended: recruits come first, and further candidates afterwards (`with_further_players`).
    """
    if any(role.recruits for role in problem.roles):
        return problem.configuration(playing, problem.values_of(playing))
    return _connected_extension(problem, playing, _preferred(problem, running))


def with_further_players(
    problem: Problem, configuration: Configuration, running: Configuration | None
) -> Configuration:
    """Return a configuration that has its recruits, extended by every further candidate that fits.

    No recruit becomes a player, nor a candidate that would feed what recruits feed. Components that play the same
    role in a running configuration are tried before all others.
    """
    playing = [
        [c for one in a.components for c in candidates if c.profile.component == one]
        for a, candidates in zip(configuration.assignments, problem.candidates, strict=True)
    ]
    brought = [c for c in configuration.connections if not {c.source, c.sink}.isdisjoint(configuration.recruits)]
    supplied = {(connection.sink, connection.input) for connection in brought}
    preferred = [_not_feeding(problem, candidates, playing, supplied) for candidates in _preferred(problem, running)]
    extended = _connected_extension(problem, playing, preferred, configuration.recruits)
    whole = replace(extended, recruits=configuration.recruits)
    return replace(whole, connections=ordered_connections((*whole.connections, *brought), whole.components))


def _preferred(problem: Problem, running: Configuration | None) -> list[Playing]:
    """Return the candidates that are tried one after the other: those that run in the same role, and all."""
    if running is None:
        return [problem.candidates]
    played = {a.role: set(a.components) for a in running.assignments}
    kept = [
        [c for c in candidates if c.profile.component in played.get(role.iri, ())]
        for role, candidates in zip(problem.roles, problem.candidates, strict=True)
    ]
    return [kept, problem.candidates]


def _connected_extension(
    problem: Problem, playing: Playing, preferred: Sequence[Playing], besides: Collection[IRI] = ()
) -> Configuration:
    """Return the configuration of what plays, with each further candidate that fits and is connected to another.

    The first of the `preferred` candidates come before all others; the components `besides` may not play.
    """
    asked = {candidate.profile.component for role in playing for candidate in role}
    every, left_out = preferred, False
    while True:
        extended, values = [list(role) for role in playing], problem.values_of(playing)
        for candidates in preferred:
            values = _add_fitting(problem, extended, values, candidates, besides)
        found = problem.configuration(extended, values)
        idle = {(role, component) for role, component in _idle(problem, found) if component not in asked}
        if idle:
            left_out = True
            preferred = [_without(idle, candidates) for candidates in preferred]  # in another role they may be of use
        elif left_out and extended != [list(role) for role in playing]:
            # What was connected to none may be connected to what has joined, or to others that were left out.
            playing, preferred, left_out = extended, every, False
        else:
            return found


def _without(idle: Set[tuple[int, IRI]], candidates: Playing) -> Playing:
    """Return the candidates of each role but those that are of no use in it."""
    return [[c for c in some if (role, c.profile.component) not in idle] for role, some in enumerate(candidates)]


def _idle(problem: Problem, configuration: Configuration) -> set[tuple[int, IRI]]:
    """Return what neither feeds another component nor is fed by one, with its role, which is in an interaction."""
    joined = {end for c in configuration.connections if c.source != c.sink for end in (c.source, c.sink)}
    return {
        (number, component)
        for number, assignment in enumerate(configuration.assignments)
        if problem.links[number] or problem.sinks[number]
        for component in assignment.components
        if component not in joined
    }


def _not_feeding(
    problem: Problem, candidates: Playing, playing: Playing, inputs: Collection[tuple[IRI, str]]
) -> Playing:
    """Return the candidates that would feed none of some inputs, given by component and name, of what plays."""
    asked: dict[int, list[tuple[Link, Input]]] = {}
    for role, some in enumerate(playing):
        for component, port in ((c.profile.component, port) for c in some for port in c.profile.inputs):
            for link in problem.links[role] if (component, port.name) in inputs else ():
                asked.setdefault(link.source, []).append((link, port))
    return [
        [
            c
            for c in some
            if not any(problem.matches(o, link, port) for link, port in asked[role] for o in c.profile.outputs)
        ]
        if role in asked
        else some
        for role, some in enumerate(candidates)
    ]


def _add_fitting(
    problem: Problem,
    playing: list[list[Candidate]],
    values: tuple[int, ...],
    candidates: Playing,
    besides: Iterable[IRI],
) -> tuple[int, ...]:
    """Add every one of some candidates that fits, the first one first; return the values left to the variables.

    The components `besides` play no role and may not.
    """
    closed = {position for position, _ in problem.unvalued}
    open_roles = [
        p
        for p, role in enumerate(problem.roles)
        if p not in closed and (role.maximum is None or len(playing[p]) < role.maximum)
    ]
    if not open_roles:
        return values
    return _FittingCandidates(problem, playing, values, candidates, besides).added_to(open_roles)


class _FittingCandidates:
    """Further candidates, which are added to what plays already, each as soon as it fits.

    A candidate that is taken or admits no value left never fits later. One that is unfed may, once a role that feeds
    its own gets outputs that it did not have: it waits for that. So nearly every candidate is looked at once.
    """

    def __init__(
        self,
        problem: Problem,
        playing: list[list[Candidate]],
        values: tuple[int, ...],
        candidates: Playing,
        besides: Iterable[IRI],
    ) -> None:
        self.problem, self.playing, self.values, self.candidates = problem, playing, values, candidates
        self.taken = {candidate.profile.component for role in playing for candidate in role}.union(besides)
        self.offered = [{candidate.profile.outputs for candidate in role} for role in playing]
        self.trying: list[tuple[int, int]] = []
        """Roles and numbers of candidates, as a heap: the first one is tried next."""
        self.waiting: dict[int, list[tuple[int, int]]] = {}
        """For each role the candidates that wait to be fed."""
        self.unfed: dict[int, set[tuple[tuple[Input, ...], tuple[Output, ...]]]] = {}
        """For each role the ports with which a candidate waits: another one with these need not be tried."""

    def added_to(self, roles: Sequence[int]) -> tuple[int, ...]:
        """Add those that fit to what plays the roles, and return the values left to the variables."""
        # Ascending pairs are a heap already.
        self.trying = [(role, number) for role in roles for number in range(len(self.candidates[role]))]
        full = {role for role in roles if self._is_full(role)}
        # Thousands may be left when the last role is full, and again and again where what joined is of no use.
        while self.trying and len(full) < len(roles):
            role, number = heappop(self.trying)
            candidate = self.candidates[role][number]
            if role in full or candidate.profile.component in self.taken:
                continue
            narrowed = self.problem.narrowed(self.values, candidate)
            if narrowed is None:
                continue
            if not self._added(role, candidate):
                self.waiting.setdefault(role, []).append((role, number))
                continue
            self.values = narrowed
            self.taken.add(candidate.profile.component)
            if self._is_full(role):
                full.add(role)
            if candidate.profile.outputs not in self.offered[role]:
                self.offered[role].add(candidate.profile.outputs)
                self._wake_sinks(role)
        return self.values

    def _is_full(self, role: int) -> bool:
        """Return whether as many play a role as may."""
        maximum = self.problem.roles[role].maximum
        return maximum is not None and len(self.playing[role]) >= maximum

    def _added(self, role: int, candidate: Candidate) -> bool:
        """Let a candidate play a role, if each of its inputs is then matched, perhaps by an output of its own."""
        profile = candidate.profile
        ports = profile.inputs, profile.outputs
        if ports in self.unfed.get(role, ()):
            return False
        self.playing[role].append(candidate)
        # A component that is added to a solution brings no recruits of its own.
        if self.problem.compatible(role, profile, self.playing, alone=True):
            return True
        self.playing[role].pop()
        self.unfed.setdefault(role, set()).add(ports)
        return False

    def _wake_sinks(self, role: int) -> None:
        """Try again what waits in the roles that a role feeds."""
        for sink in self.problem.sinks[role]:
            self.unfed.pop(sink, None)
            for one in self.waiting.pop(sink, ()):
                heappush(self.trying, one)
