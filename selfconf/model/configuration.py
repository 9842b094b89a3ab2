"""A configuration <B, S>: the running components and the connections between them (section 2 of the paper)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import field
from typing import Literal

from selfconf.model.immutable import immutable
from selfconf.model.template import Interaction
from selfconf.model.term import IRI, Term


@immutable
class Connection:
    """An input of one component follows an output of another. Connections are ordered by their fields."""

    source: IRI
    output: str
    sink: IRI
    input: str

    def __lt__(self, other: Connection) -> bool:
        own = self.source, self.output, self.sink, self.input
        return own < (other.source, other.output, other.sink, other.input)


def ordered_connections(connections: Iterable[Connection], components: Iterable[IRI]) -> tuple[Connection, ...]:
    """Connections in the order of the components that they join, sources first, and of the names of their ports."""
    place = {component: number for number, component in enumerate(components)}
    return tuple(sorted(connections, key=lambda c: (place[c.source], c.output, place[c.sink], c.input)))


@immutable
class Assignment:
    """The components that play a role, in the order in which they were chosen."""

    role: IRI
    components: tuple[IRI, ...]


@immutable
class ParameterSetting:
    """An operational parameter of a component and the value it is given."""

    component: IRI
    name: str
    value: Term


@immutable
class Wants:
    """What the inputs of a component are to follow, and the values of its parameters; by default neither.

    Several tasks may hold a component that can be shared, if they want the same of it.
    """

    inputs: frozenset[tuple[str, IRI, str]] = frozenset()
    """An input, the component that it follows, and the output of that one."""
    values: frozenset[tuple[str, Term]] = frozenset()
    """The name of an operational parameter, and its value."""


@immutable
class Configuration:
    """Which components play which role (in template order), all connections and settings, the bindings by name.

    >>> home = read("examples/clock")
    >>> answer = configure(template("examples/clock/tell-the-time.ttl"), home)
    >>> isinstance(answer, Configuration), answer.components
    (True, (<https://example.org/my-home#clock>, <https://example.org/my-home#display>))
    """

    template: IRI
    assignments: tuple[Assignment, ...]
    connections: tuple[Connection, ...] = ()
    settings: tuple[ParameterSetting, ...] = ()
    bindings: Mapping[str, Term] = field(default_factory=dict, hash=False)
    recruits: tuple[IRI, ...] = field(default=(), repr=False)
    """The components that feed players or each other without playing a role, in the order of preference."""

    def __bool__(self) -> Literal[True]:
        return True  # also one without roles; by `Literal`, type checkers tell it from a refusal, which is false

    @property
    def players(self) -> tuple[IRI, ...]:
        """The components that play a role, in the order of the roles."""
        return tuple(component for assignment in self.assignments for component in assignment.components)

    @property
    def components(self) -> tuple[IRI, ...]:
        """B, the components of the configuration: its players in the order of the roles, then its recruits."""
        return (*self.players, *self.recruits)

    def wants(self, component: IRI) -> Wants:
        """What is wanted of one of the components."""
        return Wants(
            frozenset((one.input, one.source, one.output) for one in self.connections if one.sink == component),
            frozenset((one.name, one.value) for one in self.settings if one.component == component),
        )

    def unconnected(self, interactions: Iterable[Interaction]) -> tuple[Interaction, ...]:
        """The interactions that connect nothing, though both of their roles are played.

        That is so where what the sink needs is fed by others, or is optional.
        """
        players = {assignment.role: assignment.components for assignment in self.assignments}

        def connects(one: Interaction, connection: Connection) -> bool:
            ends = connection.source in players[one.source] and connection.sink in players[one.sink]
            return ends and one.output in (None, connection.output) and one.input in (None, connection.input)

        played = (one for one in interactions if players.get(one.source) and players.get(one.sink))
        return tuple(one for one in played if not any(connects(one, each) for each in self.connections))

    def role_of(self, component: IRI) -> IRI | None:
        """The role that a component plays, if it plays one."""
        return next((a.role for a in self.assignments if component in a.components), None)
