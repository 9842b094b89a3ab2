"""ROS 2 nodes as components: publishers are outputs, subscribers inputs, services and actions operations.

The feedback of an action is an output of the node that serves it; a component that calls an action may leave it unused.

A subscriber without a publisher waits without harm, and in most systems some do, so an input may stay unfed unless
the systems that have the node connect it. A client needs its operation in the same way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

from selfconf.importing.imported import ImportedComponent, ImportedOperation, ImportedPort
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.interfaces import (
    ACTIONS,
    PARAMETER_TYPES,
    ROS2,
    InterfaceKind,
    NodeInterface,
    feedback_port,
    node_class,
)
from selfconf.importing.sources import SourceDocument
from selfconf.model.profile import is_port_name
from selfconf.model.term import IRI, Literal, Term
from selfconf.ros2 import FEEDBACK_MESSAGE, GOAL, REQUEST, RESPONSE, RESULT

Wired = Callable[[NodeInterface], bool]


def nobody_wires(_: NodeInterface) -> bool:
    """The wiring of a node that is part of no system."""
    return False


class NodeReader:
    """Makes components of nodes."""

    def __init__(self, ledger: ImportLedger, source: SourceDocument) -> None:
        self.ledger, self.source = ledger, source

    def component(
        self,
        iri: IRI,
        interfaces: tuple[NodeInterface, ...],
        facts: dict[str, str],
        parameters: tuple[tuple[str, str], ...] = (),
        wired: Wired = nobody_wires,
    ) -> ImportedComponent:
        """A node as a component; the facts are what ROS calls it, by terms of the ontology for ROS 2."""
        interfaces = self._with_distinct_names(interfaces)
        of = {kind: [each for each in interfaces if each.kind is kind] for kind in InterfaceKind}
        kind = node_class(facts.get("package", ""), facts.get("nodeType", ""))
        said: list[tuple[IRI, Term]] = [
            (ROS2[name], Literal(fact)) for name, fact in facts.items() if fact and name != "nodeType"
        ]
        return ImportedComponent(
            self.ledger.names.component(iri, self.source),
            (ROS2.Node, kind) if kind else (ROS2.Node,),
            labels=(Literal(facts["nodeName"]),),
            properties=tuple(said),
            inputs=tuple(self._port(each, not wired(each)) for each in of[InterfaceKind.SUBSCRIBER]),
            outputs=(
                *(self._port(each) for each in of[InterfaceKind.PUBLISHER]),
                *self._feedback(of[InterfaceKind.ACTION_SERVER], {each.name for each in of[InterfaceKind.PUBLISHER]}),
            ),
            parameters=tuple(self._parameters(parameters)),
            operations=tuple(
                self._operation(each) for each in (*of[InterfaceKind.SERVICE_SERVER], *of[InterfaceKind.ACTION_SERVER])
            ),
            needs=tuple(
                self._operation(each, not wired(each))
                for each in (*of[InterfaceKind.SERVICE_CLIENT], *of[InterfaceKind.ACTION_CLIENT])
            ),
        )

    def _port(self, interface: NodeInterface, optional: bool = False) -> ImportedPort:
        kind = self._type(interface)
        depth = interface.depth() if interface.kind is InterfaceKind.SUBSCRIBER else None
        types = () if kind is None else (kind,)
        return ImportedPort(interface.name, types, None, optional, depth, interface.properties())

    def _feedback(self, actions: list[NodeInterface], taken: set[str]) -> Iterator[ImportedPort]:
        """The outputs that the feedback of actions is, but for names that topics have already."""
        for each in actions:
            name, kind = feedback_port(each.name), each.signal_type()
            if name in taken:
                self.ledger.leave_out("feedback of actions", "a topic of the node has its name", self.source)
            else:
                yield ImportedPort(name, () if kind is None else (IRI.unchecked(kind + FEEDBACK_MESSAGE),))

    def _operation(self, interface: NodeInterface, optional: bool = False) -> ImportedOperation:
        kind = self._type(interface)
        if interface.kind in ACTIONS:
            asked, answered = GOAL, RESULT
            if not interface.kind.is_source:
                reason = "a component that calls an action waits for its result"
                self.ledger.leave_out("feedback of actions that are called", reason, self.source)
        else:
            asked, answered = REQUEST, RESPONSE
        request, response = (
            (None, None) if kind is None else (IRI.unchecked(kind + asked), IRI.unchecked(kind + answered))
        )
        return ImportedOperation(interface.name, request, response, optional, interface.properties())

    def _type(self, interface: NodeInterface) -> IRI | None:
        found = interface.signal_type()
        if interface.type and found is None:
            reason = "a ROS type is package/msg/Name; the interface is kept without one"
            self.ledger.leave_out(f"the type {interface.type[:60]!r}", reason, self.source)
        return found

    def _parameters(self, parameters: tuple[tuple[str, str], ...]) -> list[tuple[str, IRI]]:
        found: dict[str, IRI] = {}
        for name, kind in parameters:
            datatype = PARAMETER_TYPES.get(kind.strip().lower())
            if datatype is None or not name or name in found:
                reason = "an operational parameter has a name and one datatype"
                self.ledger.leave_out(
                    "parameters that are lists, arrays or structs, or have no type", reason, self.source
                )
            else:
                found[name] = datatype
        return list(found.items())

    def _with_distinct_names(self, interfaces: tuple[NodeInterface, ...]) -> tuple[NodeInterface, ...]:
        """The interfaces of which each name occurs once among those that are inputs, outputs and so on."""
        found: dict[tuple[object, str], NodeInterface] = {}
        for each in interfaces:
            group = (each.kind.is_source, each.kind in (InterfaceKind.PUBLISHER, InterfaceKind.SUBSCRIBER))
            if not is_port_name(each.name) or (group, each.name) in found:
                reason = (
                    "two interfaces of one node that do the same have one name, or one has none, ends in (), or has"
                    " control characters"
                )
                self.ledger.leave_out("interfaces", reason, self.source)
            else:
                found[group, each.name] = each
        return tuple(found.values())
