"""Systems that are parts of others as composites: components whose inside is a task of the system's own template.

A system with parts is described twice. Its flat template has a role for each node, those of its parts included, for
one site that has all of them. Its template of parts has a role for each of its own nodes and for each part, which is a
composite: for sites that answer for a part each, and repair it themselves. A composite has a named port for each topic
that its nodes expose, but for inputs that are fed inside and that no system with this part connects.

Ports of a composite are joined to those of a node by type. So one of which the node has several of a type is left out.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

from selfconf.importing.imported import DescribedStatement, Description, ImportedComponent, ImportedPort, NestedNode
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.interfaces import ROS2, TOPICS, InterfaceKind, NodeInterface
from selfconf.importing.ros2.system_models import SystemModel
from selfconf.importing.ros2.templates import fact, interaction, roles_by_node, system_template, template_head
from selfconf.importing.ros2.wiring import NodeInstance, SystemWiring
from selfconf.model.immutable import replace
from selfconf.model.profile import CALL_MARK
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import SC, SH, TYPE


class CompositePort(NamedTuple):
    """A port of a composite: the interface of a node inside that it is, under the name by which that is exposed."""

    instance: NodeInstance
    interface: NodeInterface

    @property
    def key(self) -> tuple[tuple[str, str], NodeInterface]:
        """What tells it from the ports of other nodes."""
        return self.instance.key, self.interface

    @property
    def is_output(self) -> bool:
        """Whether it is an output."""
        return self.interface.kind is InterfaceKind.PUBLISHER


class SystemComposites:
    """The composites of one import."""

    def __init__(self, wiring: SystemWiring, ledger: ImportLedger) -> None:
        self._wiring, self._ledger = wiring, ledger

    @cached_property
    def parts(self) -> dict[str, SystemModel]:
        """The systems that are parts of others and have nodes, by their names."""
        named = {part for system in self._wiring.systems for part in system.subsystems if part != system.name}
        found = {system.name: system for system in reversed(self._wiring.systems)}
        return {name: found[name] for name in sorted(named & found.keys()) if self._wiring.members(found[name])}

    @cached_property
    def _ports(self) -> dict[str, dict[str, CompositePort]]:
        """The ports of each composite, by their names."""
        return {name: dict(self._ports_of(system)) for name, system in self.parts.items()}

    def composite(self, system: SystemModel) -> Iterator[Description]:
        """A part as a component, with the template of its inside and the roles of that."""
        template, members = self._ledger.minted(system.name, "inside"), self._wiring.members(system)
        head, *others = system_template(template, system.name, members, self._wiring.pairs(system))
        ports = [(name, port, self._port(system, name, port)) for name, port in self._ports[system.name].items()]
        yield (
            ImportedComponent(
                self._iri(system.name),
                (ROS2.System,),
                labels=(Literal(system.name),),
                properties=((ROS2.systemName, Literal(system.name)),),
                inputs=tuple(described for _, port, described in ports if not port.is_output),
                outputs=tuple(described for _, port, described in ports if port.is_output),
            )
            .described()
            .with_statement(SC.grounding, NestedNode(((SC.template, (template,)),)))
        )
        roles = roles_by_node(template, system.name, members)
        named: list[DescribedStatement] = []
        for link, is_output in ((SC.hasInput, False), (SC.hasOutput, True)):
            nodes = tuple(
                replace(
                    described,
                    optional=False,
                    properties=((SC.of, roles[port.instance.key]),),
                ).node()
                for _, port, described in ports
                if port.is_output is is_output
            )
            named += [(link, nodes)] if nodes else []
        yield Description(head.subject, (*head.statements, *named))
        yield from others

    def template_of_parts(self, system: SystemModel) -> list[Description]:
        """The template of a system with a role for each of its own nodes and for each part.

        It is empty where the system has no part, and where a connection leads to what is no port of a part.
        """
        parts = [name for name in dict.fromkeys(system.subsystems) if name in self.parts and name != system.name]
        if not parts:
            return []
        template, own = self._ledger.minted(system.name, "parts"), self._wiring.own(system)
        roles = roles_by_node(template, system.name, own)
        of_parts = {name: self._ledger.minted(system.name, "parts", "part", name) for name in parts}
        inside = {port.key: (of_parts[name], exposed) for name in parts for exposed, port in self._ports[name].items()}
        interactions = []
        for number, pair in enumerate(self._wiring.own_pairs(system), 1):
            source = _end(roles, inside, pair.source, pair.output)
            sink = _end(roles, inside, pair.sink, pair.input)
            if source is None or sink is None or source[0] == sink[0]:
                reason = "it has connections to services, or to topics that are no ports of its parts"
                self._ledger.leave_out("the template of parts of a system", reason, system.source)
                return []
            interactions.append(interaction(template, number, *source, *sink))
        _, *nodes = system_template(template, system.name, own, ())
        return [
            template_head(template, system.name, (*roles.values(), *of_parts.values())),
            *nodes,
            *(Description(role, _asks_for(name)) for name, role in of_parts.items()),
            *interactions,
        ]

    def _iri(self, name: str) -> IRI:
        return self._ledger.minted(name, "composite")

    def _ports_of(self, system: SystemModel) -> Iterator[tuple[str, CompositePort]]:
        members = self._wiring.members(system)
        fed = {(pair.sink.key, pair.input) for pair in self._wiring.pairs(system)}
        outside = set[tuple[tuple[str, str], NodeInterface]]().union(*self._connected_outside(system))
        taken: set[tuple[str, bool]] = set()
        for instance in members:
            for interface in instance.interfaces[: len(instance.node.exposed)]:
                port = CompositePort(instance, interface)
                if interface.kind not in TOPICS or (port.key in fed and port.key not in outside):
                    continue
                kind = interface.signal_type()
                alike = [
                    each for each in instance.interfaces if (each.kind, each.signal_type()) == (interface.kind, kind)
                ]
                if kind is None or len(alike) > 1 or (interface.name, port.is_output) in taken:
                    reason = (
                        "they have no type, or their node has several of it, or another one is exposed by that name"
                    )
                    self._ledger.leave_out("ports of composites", reason, system.source)
                    continue
                taken.add((interface.name, port.is_output))
                yield interface.name, port

    def _connected_outside(self, part: SystemModel) -> list[set[tuple[tuple[str, str], NodeInterface]]]:
        """Of each system with this part, the inputs that it connects itself."""
        wholes = (system for system in self._wiring.systems if part.name in system.subsystems)
        return [{(pair.sink.key, pair.input) for pair in self._wiring.own_pairs(whole)} for whole in wholes]

    def _port(self, part: SystemModel, name: str, port: CompositePort) -> ImportedPort:
        """A port of a composite as it is seen from outside."""
        required = self._wiring.required(port.instance, port.interface) and all(
            port.key in connected for connected in self._connected_outside(part)
        )
        kind = port.interface.signal_type()
        return ImportedPort(name, () if kind is None else (kind,), None, not port.is_output and not required)


def _asks_for(part: str) -> tuple[DescribedStatement, ...]:
    """What a role says that a part of a name plays."""
    return (TYPE, (SC.Role,)), (SH["class"], (ROS2.System,)), (SH.property, (fact(ROS2.systemName, part),))


def _end(
    roles: dict[tuple[str, str], IRI],
    inside: dict[tuple[tuple[str, str], NodeInterface], tuple[IRI, str]],
    instance: NodeInstance,
    interface: NodeInterface,
) -> tuple[IRI, str] | None:
    """The role and the name of a port at the end of a connection; None if no role has such a port."""
    if instance.key in roles:
        return roles[instance.key], interface.name + ("" if interface.kind in TOPICS else CALL_MARK)
    return inside.get((instance.key, interface))
