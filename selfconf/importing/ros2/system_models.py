"""Models of ROS 2 systems (`.rossystem`): the nodes that run, the interfaces that they expose, their connections."""

from __future__ import annotations

import re
from collections.abc import Iterator

from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.interfaces import InterfaceKind
from selfconf.importing.ros2.model_text import ModelEntry, unquoted
from selfconf.importing.sources import SourceDocument
from selfconf.model.immutable import immutable

ARROWS = {
    "pub": InterfaceKind.PUBLISHER,
    "sub": InterfaceKind.SUBSCRIBER,
    "ss": InterfaceKind.SERVICE_SERVER,
    "sc": InterfaceKind.SERVICE_CLIENT,
    "as": InterfaceKind.ACTION_SERVER,
    "ac": InterfaceKind.ACTION_CLIENT,
}
_REFERENCE = re.compile(r"(pub|sub|ss|sc|as|ac)\s*->\s*(.+)")
_UNUSED = {
    "processes": ("processes", "components are processes as their sites start them"),
    "fromFile": ("launch files", "an imported component is not started"),
    "parameters": ("parameters of systems", "a parameter belongs to a component"),
}


@immutable
class ExposedInterface:
    """An interface of a node in a system: its name there, its kind, and which interface of the node's model it is."""

    name: str
    kind: InterfaceKind
    reference: str


@immutable
class SystemNode:
    """A node in a system: its name, the model that it is an instance of, its namespace, what it exposes."""

    name: str
    model: str
    namespace: str
    exposed: tuple[ExposedInterface, ...]


@immutable
class SystemModel:
    """A system: its nodes, the systems that are part of it, and the pairs of names that are connected."""

    source: SourceDocument
    name: str
    nodes: tuple[SystemNode, ...]
    subsystems: tuple[str, ...]
    connections: tuple[tuple[str, str], ...]


def system_models(entries: list[ModelEntry], source: SourceDocument, ledger: ImportLedger) -> Iterator[SystemModel]:
    """The systems of a model."""
    for system in entries:
        nodes, parts, pairs = system.child("nodes"), system.child("subSystems"), system.child("connections")
        for each in system.below:
            if each.key in _UNUSED:
                what, why = _UNUSED[each.key]
                ledger.leave_out(what, why, source, max(1, len(each.below)))
            elif each.key not in ("nodes", "subSystems", "connections"):
                ledger.leave_out(f"entries {each.key!r} of systems", "a system has no such part", source)
        connections = []
        for pair in pairs.below if pairs is not None else ():
            ends = pair.words() if not pair.key else [pair.key, unquoted(pair.text)]
            if len(ends) == 2:
                connections.append((ends[0], ends[1]))
            else:
                ledger.leave_out("connections that are no pairs", "a connection has two ends", source)
        yield SystemModel(
            source,
            system.key,
            tuple(_node(each, source, ledger) for each in nodes.below) if nodes is not None else (),
            tuple(each.key or unquoted(each.text) for each in parts.below) if parts is not None else (),
            tuple(dict.fromkeys(connections)),
        )


def _node(node: ModelEntry, source: SourceDocument, ledger: ImportLedger) -> SystemNode:
    interfaces, exposed = node.child("interfaces"), []
    for each in interfaces.below if interfaces is not None else ():
        found = _REFERENCE.fullmatch(each.text)
        if found is None or not each.key:
            ledger.leave_out("interfaces of no kind", 'an interface is `- name: pub-> "artifact::interface"`', source)
        else:
            exposed.append(ExposedInterface(each.key, ARROWS[found[1]], unquoted(found[2])))
    values = node.child("parameters")
    if values is not None:
        ledger.leave_out(
            "values of parameters", "a task sets parameters, by sc:sets", source, max(1, len(values.below))
        )
    return SystemNode(node.key, node.value("from"), node.value("namespace"), tuple(exposed))
