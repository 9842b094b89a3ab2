"""What ROS 2 calls things, and what they are called here: interfaces, their types, and their quality of service."""

from __future__ import annotations

import re
from dataclasses import field
from enum import Enum

from selfconf.importing.naming import absolute, slug
from selfconf.model.immutable import immutable
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.vocabulary import XSD, Namespace

ROS2 = Namespace("https://w3id.org/selfconf/ros2#")
"""The terms for nodes and for what they say of their interfaces; see `ontology/ros2.ttl`."""
TYPE_BASE = "https://w3id.org/selfconf/ros2/"
"""What the IRI of a type begins with; its ROS name follows, such as `sensor_msgs/msg/LaserScan`."""
_NAME = r"[A-Za-z][A-Za-z0-9_]*"
_TYPE = re.compile(rf"(?P<package>{_NAME})(?:[/.](?:msg|srv|action))?[/.](?P<name>{_NAME})")
PARAMETER_TYPES = {
    "boolean": XSD.boolean, "bool": XSD.boolean, "double": XSD.double, "integer": XSD.integer, "int": XSD.integer,
    "string": XSD.string, "base64": XSD.base64Binary, "bytes": XSD.base64Binary,
}  # fmt: skip
"""The types of parameters that are one datatype, in lower case."""
_QUALITIES = {
    "profile": "qosProfile",
    "reliability": "reliability",
    "durability": "durability",
    "history": "history",
}
MOST_DEPTH = 1_000_000


class InterfaceKind(Enum):
    """The kinds of interfaces of a node, each by the name of its block in a model."""

    PUBLISHER = "publishers"
    SUBSCRIBER = "subscribers"
    SERVICE_SERVER = "serviceservers"
    SERVICE_CLIENT = "serviceclients"
    ACTION_SERVER = "actionservers"
    ACTION_CLIENT = "actionclients"

    @property
    def segment(self) -> str:
        """What stands between package and name in the type of such an interface."""
        if self in TOPICS:
            return "msg"
        return "action" if self in ACTIONS else "srv"

    @property
    def is_source(self) -> bool:
        """Whether a connection leads from it: it publishes, or serves."""
        return self in (InterfaceKind.PUBLISHER, InterfaceKind.SERVICE_SERVER, InterfaceKind.ACTION_SERVER)


TOPICS = (InterfaceKind.PUBLISHER, InterfaceKind.SUBSCRIBER)
ACTIONS = (InterfaceKind.ACTION_SERVER, InterfaceKind.ACTION_CLIENT)
COUNTERPART = {
    InterfaceKind.PUBLISHER: InterfaceKind.SUBSCRIBER,
    InterfaceKind.SERVICE_SERVER: InterfaceKind.SERVICE_CLIENT,
    InterfaceKind.ACTION_SERVER: InterfaceKind.ACTION_CLIENT,
}


@immutable
class NodeInterface:
    """A topic, service or action of a node: its kind, its name, its ROS type and its quality of service."""

    kind: InterfaceKind
    name: str
    type: str | None = None
    qualities: tuple[tuple[str, str], ...] = field(default=())

    def signal_type(self) -> IRI | None:
        """The IRI of its type, if that is a ROS name; of a service or action what its parts begin with."""
        return type_iri(self.type or "", self.kind)

    def depth(self) -> int | None:
        """How many messages may wait, if that is said."""
        said = dict(self.qualities).get("depth", "")
        return int(said) if said.isdecimal() and len(said) < 8 and 1 <= int(said) <= MOST_DEPTH else None

    def unknown_qualities(self) -> tuple[str, ...]:
        """The names of what its quality of service says and `depth` and `properties` do not."""
        no_depth = self.depth() is None
        return tuple(name for name, _ in self.qualities if name not in _QUALITIES and (name != "depth" or no_depth))

    def properties(self) -> tuple[tuple[IRI, Term], ...]:
        """The quality of service of the interface as statements about a port."""
        said = dict(self.qualities)
        found: list[tuple[IRI, Term]] = [
            (ROS2[term], Literal(said[name])) for name, term in _QUALITIES.items() if said.get(name)
        ]
        depth = self.depth()
        if depth is not None and self.kind is not InterfaceKind.SUBSCRIBER:  # an input has sc:depth
            found.append((ROS2.queueDepth, Literal(str(depth), XSD.integer)))
        return tuple(found)


def node_class(package: str, name: str) -> IRI | None:
    """The class of the nodes of one kind: that of a name in a package."""
    return absolute(f"{TYPE_BASE}{package}/node/{slug(name)}") if package and name else None


def feedback_port(action: str) -> str:
    """The name of the output that the feedback of an action is."""
    return f"{action}/feedback"


def type_iri(name: str, kind: InterfaceKind) -> IRI | None:
    """The IRI of a ROS type, written `package/msg/Name`, `package/Name` or `package.Name`."""
    found = _TYPE.fullmatch(name.strip())
    return None if found is None else IRI.unchecked(f"{TYPE_BASE}{found['package']}/{kind.segment}/{found['name']}")
