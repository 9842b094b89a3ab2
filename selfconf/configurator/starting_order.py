"""What the components of a configuration are to do, and in which order they start and come to rest.

What feeds is started before what it feeds; in a loop of connections the order of the roles decides; actuators, which
feed nothing, come last, when everything else acts. Coming to rest goes the other way.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping
from itertools import pairwise
from typing import NamedTuple

from selfconf.model.configuration import Configuration
from selfconf.model.immutable import immutable
from selfconf.model.profile import CALL_MARK
from selfconf.model.term import IRI, Term
from selfconf.protocol.messages import Wire, Wires


class Caller(NamedTuple):
    """A component, and the operation that it needs, by which it calls one of another component."""

    component: IRI
    operation: str


Callers = Mapping[str, tuple[Caller, ...]]
"""Which components may call each operation of a component, by the name of its output."""


def wiring(configuration: Configuration) -> dict[IRI, dict[str, tuple[Wire, ...]]]:
    """For each component of a configuration, which outputs each of its inputs follows.

    Those of a composite that the configuration is the inside of are what is outside.
    """
    wires: dict[IRI, dict[str, list[Wire]]] = {component: {} for component in configuration.components}
    for connection in configuration.connections:
        if connection.sink not in wires:
            continue  # a port of the whole: what follows it is outside
        wires[connection.sink].setdefault(connection.input, []).append(Wire(connection.source, connection.output))
    return {component: {port: tuple(w) for port, w in inputs.items()} for component, inputs in wires.items()}


def callers(configuration: Configuration) -> dict[IRI, Callers]:
    """For each component of a configuration, which may call each of its operations."""
    found: dict[IRI, dict[str, list[Caller]]] = {component: {} for component in configuration.components}
    for connection in configuration.connections:
        if connection.output.endswith(CALL_MARK) and connection.source in found:
            found[connection.source].setdefault(connection.output, []).append(Caller(connection.sink, connection.input))
    return {component: {name: tuple(some) for name, some in calls.items()} for component, calls in found.items()}


def parameter_values(configuration: Configuration) -> dict[IRI, dict[str, Term]]:
    """For each component of a configuration, the values of its operational parameters."""
    values: dict[IRI, dict[str, Term]] = {component: {} for component in configuration.components}
    for setting in configuration.settings:
        values[setting.component][setting.name] = setting.value
    return values


@immutable
class StartingOrder:
    """Which components must act before a component is started."""

    before: Mapping[IRI, frozenset[IRI]]
    """For each component, what is started before it: all that feed it, but in a loop the one before it by the roles."""
    after: Mapping[IRI, tuple[IRI, ...]]
    """For each component, those that wait for it."""
    actuators: frozenset[IRI]
    """The components that feed nothing: they wait for all others."""


@immutable
class Plan:
    """What a deployment needs to know of its configuration, as each of its many steps asks for a part of it."""

    configuration: Configuration
    inputs: Mapping[IRI, Wires]
    values: Mapping[IRI, Mapping[str, Term]]
    callers: Mapping[IRI, Callers]
    order: StartingOrder


def plan_of(configuration: Configuration) -> Plan:
    """Return the plan of a deployment."""
    return Plan(
        configuration,
        wiring(configuration),
        parameter_values(configuration),
        callers(configuration),
        starting_order(configuration),
    )


def starting_order(configuration: Configuration) -> StartingOrder:
    """Return the starting order of a configuration, in time linear in its connections if they form no loop."""
    rank = {component: number for number, component in enumerate(configuration.components)}
    feeders: dict[IRI, set[IRI]] = {component: set() for component in rank}
    fed: dict[IRI, list[IRI]] = {component: [] for component in rank}
    for source, sink in _joined(configuration, rank):
        feeders[sink].add(source)
        fed[source].append(sink)
    before: dict[IRI, frozenset[IRI]] = {}
    for together in _placed(rank, feeders, fed):
        for component in together:
            before[component] = frozenset(feeders[component] - set(together))
        for previous, component in pairwise(together):
            before[component] |= {previous}
    after: dict[IRI, list[IRI]] = {component: [] for component in rank}
    for component in rank:
        for earlier in before[component]:
            after[earlier].append(component)
    actuators = frozenset(c for c, sinks in fed.items() if not sinks)
    return StartingOrder(before, {c: tuple(waiting) for c, waiting in after.items()}, actuators)


def _joined(configuration: Configuration, known: Container[IRI]) -> Iterable[tuple[IRI, IRI]]:
    """Which components are connected, each pair once; what is connected to itself, or to what is outside, left out."""
    pairs = dict.fromkeys((one.source, one.sink) for one in configuration.connections)
    return (pair for pair in pairs if pair[0] != pair[1] and pair[0] in known and pair[1] in known)


def _placed(
    rank: Mapping[IRI, int], feeders: Mapping[IRI, set[IRI]], fed: Mapping[IRI, list[IRI]]
) -> Iterable[tuple[IRI, ...]]:
    """The components in a topological order (Kahn), those of a loop together, in the order of their roles.

    Of several loops that one comes first which nothing feeds that has not come yet.
    """
    missing = {component: len(sources) for component, sources in feeders.items()}
    placed: set[IRI] = set()
    ready = [component for component in rank if not missing[component]]
    while len(placed) < len(rank):
        if ready:
            together: tuple[IRI, ...] = (ready.pop(),)
        else:
            left = {component: feeders[component] - placed for component in rank if component not in placed}
            together = tuple(sorted(_end_loop(left), key=rank.__getitem__))
        placed.update(together)
        for sink in (sink for component in together for sink in fed[component]):
            missing[sink] -= 1
            if not missing[sink] and sink not in placed:
                ready.append(sink)
        yield together


def resting_next(wires: Mapping[IRI, Wires], left: Iterable[IRI]) -> tuple[IRI, ...]:
    """Of the components that still act, those that feed none of the others; where there is none, a loop at the end.

    The loop is given backwards.
    """
    acting = tuple(left)
    fed: dict[IRI, set[IRI]] = {component: set() for component in acting}
    for component in acting:
        for wire in (wire for followed in wires.get(component, {}).values() for wire in followed):
            if wire.component in fed and wire.component != component:
                fed[wire.component].add(component)
    sinks = tuple(component for component in acting if not fed[component])
    if sinks or not acting:
        return sinks
    loop = _end_loop(fed)
    return tuple(component for component in reversed(acting) if component in loop)


def _end_loop(graph: Mapping[IRI, Iterable[IRI]]) -> set[IRI]:
    """Components that reach each other, and nothing else: a strongly connected component at the end of a graph."""
    loop = _reached(next(iter(graph)), graph)
    while smaller := next((reached for c in loop if len(reached := _reached(c, graph)) < len(loop)), None):
        loop = smaller
    return loop


def _reached(component: IRI, graph: Mapping[IRI, Iterable[IRI]]) -> set[IRI]:
    """A component, and those that an edge leads to, directly or through others."""
    reached, new = {component}, [component]
    while new:
        more = set(graph[new.pop()]) - reached
        reached |= more
        new += more
    return reached


def resting_waves(wires: Mapping[IRI, Wires], components: Iterable[IRI]) -> tuple[tuple[IRI, ...], ...]:
    """Components in the order in which they come to rest: those of a wave at once, when those before it are at rest."""
    waves: list[tuple[IRI, ...]] = []
    left = tuple(components)
    while left:
        waves.append(resting_next(wires, left))
        resting = frozenset(waves[-1])
        left = tuple(component for component in left if component not in resting)
    return tuple(waves)
