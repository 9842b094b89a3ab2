"""Models of ROS 2 packages (`.ros2`): which nodes their executables are, and the interfaces of each."""

from __future__ import annotations

from collections.abc import Iterator

from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.interfaces import InterfaceKind, NodeInterface
from selfconf.importing.ros2.model_text import ModelEntry, unquoted
from selfconf.importing.sources import SourceDocument
from selfconf.model.immutable import immutable

BLOCKS = {kind.value: kind for kind in InterfaceKind}
_OF_PARAMETERS = {
    "default": ("defaults of parameters", "a task sets parameters, by sc:sets"),
    "value": ("values of parameters", "a task sets parameters, by sc:sets"),
    "qos": ("quality of service of parameters", "a parameter is set, not sent"),
    "ns": ("namespaces of parameters", "a parameter is set by its name"),
}
"""What a model says of parameters that has no counterpart, in words, and why not."""


@immutable
class NodeModel:
    """A kind of node: where it comes from, its interfaces, and the names and types of its parameters."""

    source: SourceDocument
    package: str
    artifact: str
    name: str
    interfaces: tuple[NodeInterface, ...]
    parameters: tuple[tuple[str, str], ...] = ()


def node_models(entries: list[ModelEntry], source: SourceDocument, ledger: ImportLedger) -> Iterator[NodeModel]:
    """The nodes of the packages of a model."""
    for package in entries:
        for each in package.below:
            if each.key != "artifacts":
                ledger.leave_out(f"entries {each.key!r} of packages", "they say where the code is", source)
        artifacts = package.child("artifacts")
        if artifacts is None or not artifacts.below:
            ledger.leave_out("packages without artifacts", "there is no node in them", source)
        for artifact in artifacts.below if artifacts is not None else ():
            yield _node(package.key, artifact, source, ledger)


def _node(package: str, artifact: ModelEntry, source: SourceDocument, ledger: ImportLedger) -> NodeModel:
    interfaces: list[NodeInterface] = []
    parameters: list[tuple[str, str]] = []
    for block in artifact.below:
        if block.key in BLOCKS:
            interfaces += (_interface(BLOCKS[block.key], each, source, ledger) for each in block.below)
        elif block.key == "parameters":
            parameters += (_parameter(each, source, ledger) for each in block.below)
        elif block.key != "node":
            ledger.leave_out(f"entries {block.key!r} of nodes", "a model of a node has no such part", source)
    name = artifact.value("node") or artifact.key
    return NodeModel(source, package, artifact.key, name, tuple(interfaces), tuple(parameters))


def _parameter(entry: ModelEntry, source: SourceDocument, ledger: ImportLedger) -> tuple[str, str]:
    for each in entry.below:
        if each.key != "type":
            unknown = f"entries {each.key!r} of parameters", "a parameter has a name and a type"
            ledger.leave_out(*_OF_PARAMETERS.get(each.key, unknown), source)
    return entry.key, entry.value("type")


def _interface(kind: InterfaceKind, entry: ModelEntry, source: SourceDocument, ledger: ImportLedger) -> NodeInterface:
    qualities = entry.child("qos")
    for each in entry.below:
        if each.key == "ns":
            ledger.leave_out("namespaces of interfaces", "ports are connected by their names", source)
        elif each.key not in ("type", "qos"):
            ledger.leave_out(f"entries {each.key!r} of interfaces", "an interface has type, ns and qos", source)
    if entry.text:
        ledger.leave_out("values of interfaces", "an interface has type, ns and qos", source)
    said = tuple((each.key, unquoted(each.text)) for each in qualities.below) if qualities is not None else ()
    interface = NodeInterface(kind, entry.key, entry.value("type") or None, said)
    for name in interface.unknown_qualities():
        ledger.leave_out(f"the quality of service {name!r}", "there is no term for it, or not for this value", source)
    return interface
