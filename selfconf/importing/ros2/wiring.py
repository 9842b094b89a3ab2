"""Which nodes are connected in systems of ROS 2: the names in a model, resolved to interfaces of nodes.

A system may have other systems as its parts. They are flattened: their nodes are nodes of the whole, so that a
connection of the whole may name an interface of a part, and their connections are connections of the whole.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.interfaces import COUNTERPART, NodeInterface
from selfconf.importing.ros2.node_models import NodeModel
from selfconf.importing.ros2.system_models import SystemModel, SystemNode
from selfconf.model.immutable import immutable


@immutable
class NodeInstance:
    """A node that runs in a system: the system that describes it, and its interfaces by their names there."""

    system: str
    node: SystemNode
    model: NodeModel | None
    interfaces: tuple[NodeInterface, ...]

    @property
    def key(self) -> tuple[str, str]:
        """What tells it from the nodes of all systems."""
        return self.system, self.node.name


@immutable
class WiredPair:
    """A connection: an interface that publishes or serves, and one of another node that subscribes or calls."""

    source: NodeInstance
    output: NodeInterface
    sink: NodeInstance
    input: NodeInterface


class SystemWiring:
    """The systems of one import with their nodes and connections."""

    def __init__(self, systems: Iterable[SystemModel], models: Iterable[NodeModel], ledger: ImportLedger) -> None:
        self.systems = list(systems)
        self.ledger = ledger
        self.used: set[NodeModel] = set()
        """The models of which some system has an instance."""
        self._by_name = {system.name: system for system in reversed(self.systems)}
        self._models = {(model.package, each): model for model in models for each in (model.artifact, model.name)}
        self._instances = {
            id(system): tuple(self._instance(system, node) for node in system.nodes) for system in self.systems
        }
        self._own_pairs = {id(system): tuple(self._resolved(system)) for system in self.systems}

    def own(self, system: SystemModel) -> tuple[NodeInstance, ...]:
        """The nodes that a system itself describes."""
        return self._instances[id(system)]

    def members(self, system: SystemModel) -> list[NodeInstance]:
        """The nodes of a system and of its parts, each once."""
        found: dict[tuple[str, str], NodeInstance] = {}
        for each in self._with_parts(system):
            for instance in self.own(each):
                found.setdefault(instance.key, instance)
        return list(found.values())

    def own_pairs(self, system: SystemModel) -> tuple[WiredPair, ...]:
        """The connections that a system itself describes."""
        return self._own_pairs[id(system)]

    def pairs(self, system: SystemModel) -> list[WiredPair]:
        """The connections of a system and of its parts, each once, its own first."""
        return list(dict.fromkeys(pair for each in self._with_parts(system) for pair in self.own_pairs(each)))

    def required(self, instance: NodeInstance, interface: NodeInterface) -> bool:
        """Whether every system that has a node connects an interface of it, by itself or inside of a part."""
        having = [system for system in self.systems if instance.key in {each.key for each in self.members(system)}]
        return all(
            any((pair.sink.key, pair.input) == (instance.key, interface) for pair in self.pairs(system))
            for system in having
        )

    def _with_parts(self, system: SystemModel) -> list[SystemModel]:
        """A system and the systems that are its parts, directly or as parts of these, each once."""
        found = {system.name: system}
        waiting = [system]
        while waiting:
            for name in waiting.pop(0).subsystems:
                if name in self._by_name and name not in found:
                    found[name] = self._by_name[name]
                    waiting.append(found[name])
        return list(found.values())

    def _instance(self, system: SystemModel, node: SystemNode) -> NodeInstance:
        package, _, name = node.model.partition(".")
        model = self._models.get((package, name))
        if model is None:
            reason = "no source has these models, so the interfaces that the system exposes have no types"
            self.ledger.leave_out(f"what {node.model or 'no model'} says of its nodes", reason, system.source)
            bare = (NodeInterface(each.kind, each.name) for each in node.exposed)
            return NodeInstance(system.name, node, None, tuple(bare))
        self.used.add(model)
        left = {(each.kind, each.name): each for each in model.interfaces}
        found = []
        for exposed in node.exposed:
            name = exposed.reference.rpartition("::")[2]
            said = next((each for each in model.interfaces if (each.kind, each.name) == (exposed.kind, name)), None)
            left.pop((exposed.kind, name), None)
            if said is None:
                what = "types of interfaces that the model of their node does not have"
                self.ledger.leave_out(what, "they are kept without a type", system.source)
            qualities = said.qualities if said else ()
            found.append(NodeInterface(exposed.kind, exposed.name, said.type if said else None, qualities))
        return NodeInstance(system.name, node, model, (*found, *left.values()))

    def _resolved(self, system: SystemModel) -> Iterator[WiredPair]:
        for name in system.subsystems:
            if name not in self._by_name:
                self.ledger.leave_out("subsystems", "their models are not among the sources", system.source)
        members = self.members(system)
        for ends in system.connections:
            first, second = (self._end(system, members, name) for name in ends)
            if first is None or second is None:
                reason = "no node of the system, or more than one, exposes an interface of such a name"
                self.ledger.leave_out("connections", reason, system.source)
                continue
            if not first[1].kind.is_source:
                first, second = second, first
            pair = WiredPair(*first, *second)
            if COUNTERPART.get(pair.output.kind) is not pair.input.kind:
                self.ledger.leave_out("connections", "their ends are of kinds that do not go together", system.source)
            elif pair.output.type and pair.input.type and pair.output.signal_type() != pair.input.signal_type():
                self.ledger.leave_out("connections", "their ends are of different types", system.source)
            elif pair.source.key == pair.sink.key:
                self.ledger.leave_out("connections", "they lead from a node to itself", system.source)
            else:
                yield pair

    def _end(
        self, system: SystemModel, members: list[NodeInstance], name: str
    ) -> tuple[NodeInstance, NodeInterface] | None:
        """The interface of a name: of a node of the system itself, or else of its parts, if there is one such."""
        exposed = [
            (instance, interface)
            for instance in members
            for interface in instance.interfaces[: len(instance.node.exposed)]
            if interface.name == name
        ]
        own = [each for each in exposed if each[0].system == system.name] or exposed
        return own[0] if len(own) == 1 else None
