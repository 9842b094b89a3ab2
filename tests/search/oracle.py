"""The semantics by enumeration: an oracle that shares no code with the search, and has no optimisation."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import combinations, product

from selfconf.model.configuration import Assignment, Configuration, Connection, ParameterSetting
from selfconf.model.hierarchy import Hierarchy
from selfconf.model.partition import Candidate, Partition, Variable
from selfconf.model.profile import Input, Operation, Output
from selfconf.model.template import Role, Task
from selfconf.model.term import IRI

Players = tuple[tuple[Candidate, ...], ...]


class World:
    """A task, a partition and a hierarchy, with the rules of the contract as plain loops."""

    def __init__(self, task: Task, partition: Partition, hierarchy: Hierarchy) -> None:
        self.task, self.partition, self.hierarchy = task, partition, hierarchy
        self.template = task.template
        self.roles: tuple[Role, ...] = task.template.roles
        self.candidates = partition.candidates
        self.variables: tuple[Variable, ...] = partition.variables
        self.place = {role.iri: number for number, role in enumerate(self.roles)}

    def connections(self, players: Sequence[Sequence[Candidate]]) -> set[Connection]:
        """Every pair of ports that an interaction of the template connects."""
        found = set()
        for interaction in self.template.interactions:
            for source in players[self.place[interaction.source]]:
                for sink in players[self.place[interaction.sink]]:
                    for output in source.profile.outputs:
                        for wanted in sink.profile.inputs:
                            if interaction.output not in (None, output.name):
                                continue
                            if interaction.input not in (None, wanted.name):
                                continue
                            named = interaction.output is not None and interaction.input is not None
                            if self.feeds(output, wanted, named):
                                found.add(
                                    Connection(
                                        source.profile.component,
                                        output.name,
                                        sink.profile.component,
                                        wanted.name,
                                    )
                                )
        return found

    def feeds(self, output: Output, wanted: Input, named: bool) -> bool:
        """Return whether types, unit, frame and shape let an output feed an input; `named` if both names are given."""
        typed = any(self.serves(one, other) for one in output.signals for other in wanted.signals)
        if not typed and not (named and (not output.signals or not wanted.signals)):
            return False
        if wanted.condition is None:
            return True
        agree = [(wanted.condition.unit, output.unit), (wanted.condition.frame, output.frame)]
        if any(asked is not None and stated is not None and asked != stated for asked, stated in agree):
            return False
        sent = wanted.condition.sent
        if sent is not None and output.signals and not self.serves(sent.type, output.request):
            return False
        return wanted.condition.accepts is None or wanted.condition.accepts in output.conforms

    def serves(self, offered: IRI | None, wanted: IRI | None) -> bool:
        """Return whether a type serves where another is wanted; of operations that is the response."""
        if offered is None or wanted is None:
            return offered is wanted
        if isinstance(offered, Operation) and isinstance(wanted, Operation):
            return self.serves(offered.response, wanted.response)
        if isinstance(offered, Operation) or isinstance(wanted, Operation):
            return False
        return wanted in self.hierarchy.superclasses(offered)

    def unfed(self, players: Sequence[Sequence[Candidate]]) -> list[tuple[IRI, str]]:
        """The inputs of players that nothing is connected to."""
        fed = {(c.sink, c.input) for c in self.connections(players)}
        return [
            (candidate.profile.component, wanted.name)
            for role in players
            for candidate in role
            for wanted in candidate.profile.inputs
            if not wanted.optional and (candidate.profile.component, wanted.name) not in fed
        ]

    def values(self, players: Sequence[Sequence[Candidate]]) -> list[set[int] | None]:
        """For each variable the numbers of the values that every player allows; None where no player constrains it."""
        found: list[set[int] | None] = []
        for number, variable in enumerate(self.variables):
            masks = [c.admits[number] for role in players for c in role]
            is_set = any(p.is_set for p in self.template.parameters if p.iri == variable.parameter)
            if not is_set and all(mask < 0 for mask in masks):  # any value that no candidate names will do
                found.append(None)
            else:
                found.append({k for k in range(len(variable.domain)) if all(mask >> k & 1 for mask in masks)})
        return found

    def unset(self, players: Sequence[Sequence[Candidate]]) -> bool:
        """Return whether a player is to be set to a parameter that is not bound and has no stated value."""
        known = {*self.task.bindings, *(variable.parameter for variable in self.variables)}
        parameters = {parameter.iri for parameter in self.template.parameters}
        return any(
            setting.value in parameters - known
            for role, chosen in zip(self.roles, players, strict=True)
            if chosen
            for setting in role.settings
        )

    def valid(self, players: Sequence[Sequence[Candidate]]) -> bool:
        """Return whether players are distinct, fed, and share a value of each free parameter."""
        components = [candidate.profile.component for role in players for candidate in role]
        return (
            len(components) == len(set(components))
            and not self.unfed(players)
            and not self.unset(players)
            and all(allowed is None or allowed for allowed in self.values(players))
        )

    def solutions(self) -> Iterator[Players]:
        """Every solution with the minima, in lexicographic order."""
        for players in product(
            *(combinations(c, role.minimum) for c, role in zip(self.candidates, self.roles, strict=True))
        ):
            if self.valid(players):
                yield players

    def all_sizes(self) -> Iterator[Players]:
        """Every configuration whatever its cardinalities, from the minima to the maxima."""
        sized = [
            [
                chosen
                for size in range(role.minimum, 1 + min(len(c), len(c) if role.maximum is None else role.maximum))
                for chosen in combinations(c, size)
            ]
            for c, role in zip(self.candidates, self.roles, strict=True)
        ]
        return (players for players in product(*sized) if self.valid(players))

    def extended(
        self, players: Sequence[Sequence[Candidate]], running: Configuration | None = None
    ) -> list[list[Candidate]]:
        """With every further candidate that fits, in order, up to the maxima; first those that run in the same role.

        Those of them that are connected to none are left out of that role, and the rest is done again. If another one
        joins, they are tried once more.
        """
        played = {} if running is None else {a.role: a.components for a in running.assignments}
        few = [
            [c for c in some if c.profile.component in played.get(role.iri, ())]
            for some, role in zip(self.candidates, self.roles, strict=True)
        ]
        asked = {c.profile.component for role in players for c in role}
        while (grown := self._connected(players, few, asked)) != [list(role) for role in players]:
            players = grown
        return grown

    def _connected(
        self, players: Sequence[Sequence[Candidate]], few: Sequence[Sequence[Candidate]], asked: Collection[IRI]
    ) -> list[list[Candidate]]:
        """With further candidates, those left out that are connected to none, unless they are asked for."""
        excluded = set[tuple[IRI, IRI]]()
        while True:
            grown = [list(role) for role in players]
            for candidates in (few, self.candidates):
                allowed = [
                    [c for c in some if (role.iri, c.profile.component) not in excluded]
                    for role, some in zip(self.roles, candidates, strict=True)
                ]
                self._grow(grown, allowed)
            idle = {(role, component) for role, component in self._unconnected(grown) if component not in asked}
            if not idle:
                return grown
            excluded |= idle

    def _grow(self, grown: list[list[Candidate]], candidates: Sequence[Sequence[Candidate]]) -> None:
        while True:
            for number, role in enumerate(self.roles):
                if role.maximum is not None and len(grown[number]) >= role.maximum:
                    continue
                more = next((c for c in candidates[number] if self._fits(grown, number, c)), None)
                if more is not None:
                    grown[number].append(more)
                    break
            else:
                return

    def _unconnected(self, players: Sequence[Sequence[Candidate]]) -> set[tuple[IRI, IRI]]:
        """The players, each with its role, of roles that feed or are fed by others, and who are connected to none."""
        pairs = [{c.source, c.sink} for c in self.connections(players)]
        return {
            (role.iri, candidate.profile.component)
            for role, some in zip(self.roles, players, strict=True)
            if any(role.iri in (one.source, one.sink) for one in self.template.interactions)
            for candidate in some
            if not any(candidate.profile.component in pair and len(pair) == 2 for pair in pairs)
        }

    def _fits(self, grown: list[list[Candidate]], number: int, more: Candidate) -> bool:
        return self.valid([[*role, more] if k == number else role for k, role in enumerate(grown)])

    def configuration(
        self, players: Sequence[Sequence[Candidate]], running: Configuration | None = None
    ) -> Configuration:
        """The configuration that players are, extended."""
        grown = self.extended(players, running)
        bindings = self.task.by_name()
        names = {p.iri: p.name for p in self.template.parameters}
        for variable, allowed in zip(self.variables, self.values(grown), strict=True):
            if allowed:
                bindings[names[variable.parameter]] = variable.domain[min(allowed)]
        settings = []
        for role, chosen in zip(self.roles, grown, strict=True):
            for setting in role.settings if chosen else ():
                value = setting.value
                if isinstance(value, IRI) and value in names:
                    value = bindings[names[value]]
                for candidate in chosen:
                    for parameter in candidate.profile.parameters:
                        matching = [s for s in role.settings if parameter.type in self.hierarchy.superclasses(s.type)]
                        matching.sort(key=lambda one: one.type != parameter.type)
                        if matching[:1] == [setting]:
                            settings.append(ParameterSetting(candidate.profile.component, parameter.name, value))
        order = {c.profile.component: k for k, c in enumerate(c for role in grown for c in role)}
        return Configuration(
            self.template.iri,
            tuple(
                Assignment(role.iri, tuple(c.profile.component for c in chosen))
                for role, chosen in zip(self.roles, grown, strict=True)
            ),
            tuple(sorted(self.connections(grown), key=lambda c: (order[c.source], c.output, order[c.sink], c.input))),
            tuple(settings),
            dict(sorted(bindings.items())),
        )

    def first(self) -> Configuration | None:
        """The answer: the first solution, extended."""
        players = next(self.solutions(), None)
        return None if players is None else self.configuration(players)
