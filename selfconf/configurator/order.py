"""In which order the components of a configuration start and come to rest.

What feeds is started before what it feeds; in a loop of connections the order of the roles decides; actuators, which
feed nothing, come last, when everything else acts. Coming to rest goes the other way.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from selfconf.model.configuration import Configuration
from selfconf.model.term import IRI, Term
from selfconf.protocol.messages import Wire

InputWires = Mapping[str, tuple[Wire, ...]]
"""Which outputs each input of a component follows."""


def wiring(configuration: Configuration) -> dict[IRI, dict[str, tuple[Wire, ...]]]:
    """For each component of a configuration, which outputs each of its inputs follows."""
    wires: dict[IRI, dict[str, list[Wire]]] = {component: {} for component in configuration.components}
    for connection in configuration.connections:
        wires[connection.sink].setdefault(connection.input, []).append(Wire(connection.source, connection.output))
    return {component: {port: tuple(w) for port, w in inputs.items()} for component, inputs in wires.items()}


def parameter_values(configuration: Configuration) -> dict[IRI, dict[str, Term]]:
    """For each component of a configuration, the values of its operational parameters."""
    values: dict[IRI, dict[str, Term]] = {component: {} for component in configuration.components}
    for setting in configuration.settings:
        values[setting.component][setting.name] = setting.value
    return values


@dataclass(frozen=True, slots=True)
class StartingOrder:
    """Which components must act before a component is started."""

    before: Mapping[IRI, frozenset[IRI]]
    """For each component, the feeders that are started before it: all, but for those that close a loop."""
    after: Mapping[IRI, tuple[IRI, ...]]
    """For each component, those that wait for it."""
    actuators: frozenset[IRI]
    """The components that feed nothing: they wait for all others."""


def starting_order(configuration: Configuration) -> StartingOrder:
    """Return the starting order of a configuration, in time linear in its connections."""
    rank = {component: number for number, component in enumerate(configuration.components)}
    feeders: dict[IRI, set[IRI]] = {component: set() for component in rank}
    fed: dict[IRI, list[IRI]] = {component: [] for component in rank}
    for connection in configuration.connections:
        if connection.source != connection.sink and connection.source not in feeders[connection.sink]:
            feeders[connection.sink].add(connection.source)
            fed[connection.source].append(connection.sink)
    place = _placed(rank, feeders, fed)
    before = {c: frozenset(one for one in sources if place[one] < place[c]) for c, sources in feeders.items()}
    after = {c: tuple(one for one in sinks if c in before[one]) for c, sinks in fed.items()}
    return StartingOrder(before, after, frozenset(c for c, sinks in fed.items() if not sinks))


def _placed(
    rank: Mapping[IRI, int], feeders: Mapping[IRI, set[IRI]], fed: Mapping[IRI, list[IRI]]
) -> Mapping[IRI, int]:
    """The place of each component in a topological order (Kahn); a loop is entered at its first role."""
    missing = {component: len(sources) for component, sources in feeders.items()}
    place: dict[IRI, int] = {}
    ready = [component for component in rank if not missing[component]]
    rest = iter(rank)
    while len(place) < len(rank):
        if not ready:
            ready.append(next(component for component in rest if component not in place))
        component = ready.pop()
        if component in place:
            continue
        place[component] = len(place)
        for sink in fed[component]:
            missing[sink] -= 1
            if not missing[sink] and sink not in place:
                ready.append(sink)
    return place


def resting_next(wires: Mapping[IRI, InputWires], left: Iterable[IRI]) -> tuple[IRI, ...]:
    """Of the components that still act, those that feed none of the others; all of them where each feeds another."""
    acting = tuple(left)
    among = set(acting)
    feeding = {
        wire.component
        for component in among
        for followed in wires.get(component, {}).values()
        for wire in followed
        if wire.component != component
    }
    return tuple(component for component in acting if component not in feeding) or acting
