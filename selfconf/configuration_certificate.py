"""A certificate: whether a configuration meets its task, checked by rules that share nothing with the search.

The contract is read as a list of conditions on a finished configuration (section 2 of the paper: <B, S>, the two
rules of section 2.3), and the certificate names those that the configuration breaks. The module imports values alone,
and no code of the search, so that a mistake there does not repeat itself here. The cost is linear in the number of
connections that the template could make.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from selfconf.model.configuration import Configuration, Connection, ParameterSetting
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.partition import Candidate, Partition
from selfconf.model.profile import Input, Output, Profile
from selfconf.model.template import Role, Task
from selfconf.model.term import IRI, Term

Players = Mapping[IRI, Sequence[Candidate]]
"""For each role the candidates that play it."""


def broken_conditions(
    task: Task, partition: Partition, configuration: Configuration, hierarchy: Hierarchy = NOTHING_ABOVE
) -> list[str]:
    """Return every condition that a configuration breaks, each in a sentence; none if it meets its task."""
    return list(_Check(task, partition, configuration, hierarchy).problems())


class _Check:
    def __init__(self, task: Task, partition: Partition, configuration: Configuration, hierarchy: Hierarchy) -> None:
        self.task, self.partition = task, partition
        self.configuration, self.hierarchy = configuration, hierarchy
        self.template = task.template

    def problems(self) -> Iterator[str]:
        """Yield the conditions that are broken."""
        # Roles first: what rests on them can only be checked when the right components play.
        wrong = list(self._roles())
        yield from wrong
        if not wrong:
            players = self._players()
            yield from self._connections(players)
            yield from self._values(players)
            yield from self._settings(players)

    def _roles(self) -> Iterator[str]:
        configuration = self.configuration
        if configuration.template != self.template.iri:
            yield f"it is a configuration of {configuration.template.short}, not of {self.template.iri.short}"
        roles = [role.iri for role in self.template.roles]
        if [assignment.role for assignment in configuration.assignments] != roles:
            yield "its roles are not those of the template, each once and in order"
            return
        for component, times in Counter(configuration.components).items():
            if times > 1:
                yield f"{component.short} plays {times} parts"
        for role, assignment, eligible in zip(
            self.template.roles, configuration.assignments, self.partition.candidates, strict=True
        ):
            number = len(assignment.components)
            if number < role.minimum:
                yield f"{role.iri.short} asks for {role.minimum} components and has {number}"
            if role.maximum is not None and number > role.maximum:
                yield f"{role.iri.short} allows {role.maximum} components and has {number}"
            known = {candidate.profile.component for candidate in eligible}
            for component in assignment.components:
                if component not in known:
                    yield f"{component.short} is not eligible for {role.iri.short}"

    def _players(self) -> dict[IRI, list[Candidate]]:
        players: dict[IRI, list[Candidate]] = {}
        for assignment, eligible in zip(self.configuration.assignments, self.partition.candidates, strict=True):
            chosen = set(assignment.components)
            by_name = {c.profile.component: c for c in eligible if c.profile.component in chosen}
            players[assignment.role] = [by_name[component] for component in assignment.components]
        return players

    def _connections(self, players: Players) -> Iterator[str]:
        possible = set(self._possible_connections(players))
        actual = Counter(self.configuration.connections)
        extra = sorted(set(actual) - possible)
        if self.configuration.recruits:
            yield from self._recruits(players, extra)
        else:
            yield from (f"{_words(connection)}: no interaction makes this connection" for connection in extra)
        for connection in sorted(possible - set(actual)):
            yield f"{_words(connection)}: this connection is missing"
        for connection, times in actual.items():
            if times > 1:
                yield f"{_words(connection)}: this connection is there {times} times"
        yield from self._unconnected()
        fed = {(connection.sink, connection.input) for connection in actual}
        for candidate in (candidate for some in players.values() for candidate in some):
            for wanted in candidate.profile.inputs:
                if not wanted.optional and (candidate.profile.component, wanted.name) not in fed:
                    yield f"the input {wanted.name!r} of {candidate.profile.component.short} is not fed"

    def _unconnected(self) -> Iterator[str]:
        """Yield the roles of interactions with more players than are asked for that feed none and are not fed."""
        joined = {c for one in self.configuration.connections if one.source != one.sink for c in (one.source, one.sink)}
        joining = {role for one in self.template.interactions for role in (one.source, one.sink)}
        for role, assignment in zip(self.template.roles, self.configuration.assignments, strict=True):
            idle = [component for component in assignment.components if component not in joined]
            if role.iri in joining and len(idle) > role.minimum:
                yield f"{role.iri.short} asks for {role.minimum} components, and {idle[-1].short} is not connected"

    def _recruits(self, players: Players, extra: Sequence[Connection]) -> Iterator[str]:
        """Yield what is wrong with the recruits: `extra` are the connections that no interaction makes."""
        known = {recruit.component: recruit for recruit in self.partition.recruits}
        recruits, playing = self.configuration.recruits, self.configuration.players
        for component, times in Counter(recruits).items():
            if component not in known or component in playing or times > 1:
                yield f"{component.short} cannot be recruited"
                return
        profiles = {c.profile.component: c.profile for some in players.values() for c in some}
        profiles |= {component: known[component].profile for component in recruits}
        fed = Counter((connection.sink, connection.input) for connection in self.configuration.connections)
        yield from _idle(recruits, extra)
        for component in recruits:
            lacking = [wanted.name for wanted in profiles[component].required if not fed[component, wanted.name]]
            yield from (f"the input {name!r} of {component.short} is not fed" for name in lacking)
        yield from self._badly_joined(profiles, fed, extra)
        yield from self._of_other_roles(players, extra)
        yield from _cycle(recruits, extra)

    def _badly_joined(
        self, profiles: Mapping[IRI, Profile], fed: Mapping[tuple[IRI, str], int], extra: Sequence[Connection]
    ) -> Iterator[str]:
        """Yield the connections to which types or conditions do not allow, and those of inputs with another source."""
        for connection in extra:
            if not self._may_connect(profiles, connection):
                yield f"{_words(connection)}: the output cannot feed the input"
            elif fed[connection.sink, connection.input] > 1:
                yield f"{_words(connection)}: the input has a source besides"

    def _of_other_roles(self, players: Players, extra: Sequence[Connection]) -> Iterator[str]:
        """Yield the connections by which a player gets from a recruit what its role does not allow."""
        roles = {recruit.component: recruit.roles for recruit in self.partition.recruits}
        place = {c.profile.component: number for number, some in enumerate(players.values()) for c in some}
        for connection in extra:
            role = place.get(connection.sink)
            if role is not None and (connection.source in place or role not in roles.get(connection.source, ())):
                yield f"{_words(connection)}: no recruit of this role feeds it"

    def _may_connect(self, profiles: Mapping[IRI, Profile], connection: Connection) -> bool:
        """Return whether a connection joins ports of the configuration that may be joined, names or no names."""
        if connection.source not in profiles or connection.sink not in profiles:
            return False
        output = profiles[connection.source].output(connection.output)
        wanted = next((port for port in profiles[connection.sink].inputs if port.name == connection.input), None)
        if output is None or wanted is None:
            return False
        return any(True for _ in self._fed_by(output, [(connection.sink, wanted)], by_name=False))

    def _possible_connections(self, players: Players) -> Iterator[Connection]:
        """Yield every pair of an output and an input that match along an interaction."""
        for interaction in self.template.interactions:
            by_name = None not in (interaction.output, interaction.input)
            inputs = [
                (candidate.profile.component, wanted)
                for candidate in players[interaction.sink]
                for wanted in candidate.profile.inputs
                if interaction.input is None or interaction.input == wanted.name
            ]
            for source in players[interaction.source]:
                for output in source.profile.outputs:
                    if interaction.output is None or interaction.output == output.name:
                        for sink, wanted in self._fed_by(output, inputs, by_name):
                            yield Connection(source.profile.component, output.name, sink, wanted.name)

    def _fed_by(
        self, output: Output, inputs: Sequence[tuple[IRI, Input]], by_name: bool
    ) -> Iterator[tuple[IRI, Input]]:
        """Yield the inputs that types and conditions allow an output to feed; `by_name` where both ports are named."""
        served = frozenset[IRI]().union(*map(self.hierarchy.superclasses, output.signals))
        for one in inputs:
            wanted = one[1]
            if served.isdisjoint(wanted.signals) and not (by_name and () in (output.signals, wanted.signals)):
                continue
            unit, frame, shape, sent = wanted.condition or (None, None, None, None)
            if (
                (output.unit == unit or None in (output.unit, unit))
                and (output.frame == frame or None in (output.frame, frame))
                and (shape is None or shape in output.conforms)
                and (sent is None or not output.signals or self._takes(output.request, sent.type))
            ):
                yield one

    def _takes(self, taken: IRI | None, given: IRI | None) -> bool:
        """Return whether what is given may go where a type is taken; None is nothing."""
        return taken is given if taken is None or given is None else self.hierarchy.matches(given, taken)

    def _values(self, players: Players) -> Iterator[str]:
        names = {parameter.iri: parameter.name for parameter in self.template.parameters}
        bindings = self.configuration.bindings
        for iri, value in self.task.bindings.items():
            if bindings.get(names[iri]) != value:
                yield f"the parameter {names[iri]} is bound to {value}, not to {bindings.get(names[iri])}"
        for number, variable in enumerate(self.partition.variables):
            name = names[variable.parameter]
            constrained = [
                candidate for some in players.values() for candidate in some if candidate.admits[number] >= 0
            ]
            found: Term | None = bindings.get(name)
            if found is None:
                if constrained:
                    yield f"the parameter {name} has no value, and {len(constrained)} components depend on it"
            elif found not in variable.domain:
                yield f"the parameter {name} is {found}, which no candidate allows"
            else:
                bit = 1 << variable.domain.index(found)
                for candidate in (candidate for some in players.values() for candidate in some):
                    if not candidate.admits[number] & bit:
                        yield f"{candidate.profile.component.short} does not allow {name} to be {found}"

    def _settings(self, players: Players) -> Iterator[str]:
        expected: list[ParameterSetting] = []
        for role in self.template.roles:
            values = self._set_by(role) if players[role.iri] else {}
            for candidate in players[role.iri]:
                expected += self._set_on(candidate.profile, values)
            if None in values.values():
                yield f"the role {role.iri.short} sets a parameter to something that has no value"
                return
        actual = self.configuration.settings
        for one in dict.fromkeys((*actual, *expected)):
            if actual.count(one) != expected.count(one):
                fault = "is missing" if one not in actual else "is not asked for"
                yield f"setting {one.name!r} of {one.component.short} to {one.value} {fault}"

    def _set_by(self, role: Role) -> dict[IRI, Term | None]:
        """The values that a role sets, by the types of the parameters; None where a parameter of the task has none."""
        names = {parameter.iri: parameter.name for parameter in self.template.parameters}
        found: dict[IRI, Term | None] = {}
        for setting in role.settings:
            value: Term | None = setting.value
            if isinstance(value, IRI) and value in names:
                value = self.configuration.bindings.get(names[value])
            found.setdefault(setting.type, value)
        return found

    def _set_on(self, profile: Profile, values: Mapping[IRI, Term | None]) -> Iterator[ParameterSetting]:
        """What a component has its parameters set to: each to one value, that of its own type before all others."""
        for parameter in profile.parameters:
            types = [one for one in values if self.hierarchy.matches(one, parameter.type)]
            value = values[parameter.type if parameter.type in types else types[0]] if types else None
            if value is not None:
                yield ParameterSetting(profile.component, parameter.name, value)


def _idle(recruits: Sequence[IRI], connections: Sequence[Connection]) -> Iterator[str]:
    """Yield the recruits that feed nothing."""
    feeding = {connection.source for connection in connections}
    yield from (f"{one.short} is recruited and feeds nothing" for one in recruits if one not in feeding)


def _cycle(recruits: Sequence[IRI], connections: Sequence[Connection]) -> Iterator[str]:
    """Yield that recruits feed each other in a cycle, if they do."""
    left = set(recruits)
    sources: dict[IRI, set[IRI]] = {one: set() for one in left}
    sinks: dict[IRI, set[IRI]] = {one: set() for one in left}
    for one in connections:
        if one.source in left and one.sink in left:
            sources[one.sink].add(one.source)
            sinks[one.source].add(one.sink)
    free = [one for one in left if not sources[one]]
    while free:
        source = free.pop()
        left.remove(source)
        for sink in sinks[source]:
            sources[sink].remove(source)
            if not sources[sink]:
                free.append(sink)
    if left:
        yield f"the recruits {', '.join(sorted(one.short for one in left))} feed each other in a cycle"


def _words(connection: Connection) -> str:
    source = f"{connection.source.short}.{connection.output}"
    return f"{source} to {connection.sink.short}.{connection.input}"
