"""NoDL, the Node Definition Language of ROS 2, in XML (version 1): the interfaces of nodes, by executable."""

from __future__ import annotations

from collections.abc import Iterator
from xml.parsers import expat

from selfconf.errors import AuthorError
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.interfaces import InterfaceKind, NodeInterface
from selfconf.importing.ros2.node_models import NodeModel
from selfconf.importing.sources import SourceDocument

NODL_KINDS = {
    ("topic", "publisher"): InterfaceKind.PUBLISHER,
    ("topic", "subscription"): InterfaceKind.SUBSCRIBER,
    ("service", "server"): InterfaceKind.SERVICE_SERVER,
    ("service", "client"): InterfaceKind.SERVICE_CLIENT,
    ("action", "server"): InterfaceKind.ACTION_SERVER,
    ("action", "client"): InterfaceKind.ACTION_CLIENT,
}
"""The kinds of interfaces by element and role: a role is an attribute that is true, or the value of `role`."""
_QUALITIES = ("depth", "reliability", "durability", "history")


class NodlReader:
    """Reads one document. Element by element, so that nothing of it has to be kept or expanded."""

    def __init__(self, source: SourceDocument, ledger: ImportLedger) -> None:
        self.source, self.ledger = source, ledger
        self.nodes: list[NodeModel] = []
        self._path: list[str] = []
        self._node: dict[str, str] = {}
        self._interfaces: list[NodeInterface] = []
        self._parameters: list[tuple[str, str]] = []
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.EntityDeclHandler = self._entity

    def read(self) -> list[NodeModel]:
        """The nodes. Raises AuthorError with line and column where it is not XML, or not NoDL."""
        try:
            self._parser.Parse(self.source.octets, True)
        except expat.ExpatError as error:
            what = expat.ErrorString(error.code)
            raise AuthorError(
                f"this is not XML: {what}", file=self.source.shown, line=error.lineno, column=error.offset + 1
            ) from None
        return self.nodes

    def _mistake(self, message: str) -> AuthorError:
        line, column = self._parser.CurrentLineNumber, self._parser.CurrentColumnNumber + 1
        return AuthorError(message, file=self.source.shown, line=line, column=column)

    def _entity(self, *_: object) -> None:
        raise self._mistake("it declares an entity, which is not expanded; write it out")

    def _start(self, element: str, attributes: dict[str, str]) -> None:
        if not self._path and element != "interface":
            raise self._mistake(f"this is not NoDL: its root is {element[:40]!r}, not 'interface'")
        if not self._path and attributes.get("version") != "1":
            raise self._mistake(f"version {attributes.get('version')!r} of NoDL is not known; version 1 is read")
        self._path.append(element)
        if self._path == ["interface", "node"]:
            self._node, self._interfaces, self._parameters = attributes, [], []
        elif self._path[:2] == ["interface", "node"] and len(self._path) == 3:
            self._member(element, attributes)
        elif len(self._path) == 4 and element.endswith("qos_profile") and self._interfaces:
            self._qualities(element, attributes)

    def _end(self, _: str) -> None:
        if self._path == ["interface", "node"]:
            name, executable = self._node.get("name", ""), self._node.get("executable", "")
            if name:
                found = tuple(self._interfaces), tuple(self._parameters)
                self.nodes.append(NodeModel(self.source, "", executable, name, *found))
            else:
                self.ledger.leave_out("nodes without a name", "a component has a name", self.source)
        self._path.pop()

    def _member(self, element: str, attributes: dict[str, str]) -> None:
        name, kind = attributes.get("name", ""), attributes.get("type", "")
        if element == "parameter":
            self._parameters.append((name, kind))
            return
        roles = tuple(self._roles(element, attributes))
        self._interfaces += (NodeInterface(role, name, kind or None) for role in roles)
        if not roles:
            reason = "an interface publishes, subscribes, serves or calls"
            self.ledger.leave_out(f"elements {element[:40]!r} of nodes", reason, self.source)

    @staticmethod
    def _roles(element: str, attributes: dict[str, str]) -> Iterator[InterfaceKind]:
        for (of, role), kind in NODL_KINDS.items():
            if of == element and (attributes.get(role) == "true" or attributes.get("role") in (role, "both")):
                yield kind

    def _qualities(self, element: str, attributes: dict[str, str]) -> None:
        if element != "qos_profile":
            self.ledger.leave_out("qualities of the parts of actions", "an operation has one", self.source)
            return
        said = tuple((name, attributes[name]) for name in _QUALITIES if attributes.get(name))
        if said != tuple(item for item in attributes.items() if item[1]):
            reason = "depth, reliability, durability and history are kept"
            self.ledger.leave_out("other qualities of service", reason, self.source)
        last = self._interfaces[-1]
        self._interfaces = [
            NodeInterface(each.kind, each.name, each.type, said)
            if (each.name, each.type) == (last.name, last.type)
            else each
            for each in self._interfaces
        ]
