"""One import of ROS 2 models: nodes in packages, systems of nodes, and definitions of nodes, linked to each other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import groupby

from selfconf.errors import AuthorError
from selfconf.importing.imported import Description, ImportedDocument
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.naming import slug, stem
from selfconf.importing.ros2.components import NodeReader
from selfconf.importing.ros2.composites import SystemComposites
from selfconf.importing.ros2.interfaces import TYPE_BASE, NodeInterface
from selfconf.importing.ros2.model_text import parse_model
from selfconf.importing.ros2.node_models import NodeModel, node_models
from selfconf.importing.ros2.nodl import NodlReader
from selfconf.importing.ros2.system_models import SystemModel, system_models
from selfconf.importing.ros2.templates import system_template
from selfconf.importing.ros2.wiring import NodeInstance, SystemWiring
from selfconf.importing.sources import SourceDocument

BRACES = "this is in the notation of before 2022, with braces; open and save it with the RosTooling of today"


def import_nodes(sources: Iterable[SourceDocument], ledger: ImportLedger) -> Iterator[ImportedDocument]:
    """The nodes of ROS 2 models as components, and systems as templates too."""
    models: list[NodeModel] = []
    systems: list[SystemModel] = []
    for source in sources:
        try:
            _read(source, models, systems, ledger)
        except AuthorError as error:
            ledger.unreadable(error)
    wiring = SystemWiring(systems, models, ledger)
    composites = SystemComposites(wiring, ledger)
    for name, group in groupby(systems, lambda system: stem(system.source)):
        yield from _systems(name, list(group), wiring, composites, ledger)
    unused = (model for model in models if model not in wiring.used)
    for name, nodes in groupby(unused, lambda model: stem(model.source)):
        kinds = list(nodes)
        described = tuple(_node(node, ledger) for node in kinds)
        yield ImportedDocument(name, kinds[0].source.name, described, _prefixes(kinds))


def _read(source: SourceDocument, models: list[NodeModel], systems: list[SystemModel], ledger: ImportLedger) -> None:
    if source.octets.lstrip().startswith(b"<"):
        nodes = NodlReader(source, ledger).read()
        models += nodes
        if not nodes:
            ledger.leave_out("documents without nodes", "an interface of NoDL has nodes", source)
        return
    if source.octets.lstrip().startswith((b"RosSystem", b"PackageSet")):
        raise AuthorError(BRACES, file=source.shown, line=1, column=1)
    entries = parse_model(source)
    if any(entry.child("artifacts") is not None for entry in entries):
        models += node_models(entries, source, ledger)
    elif any(entry.child(part) is not None for entry in entries for part in ("nodes", "subSystems")):
        systems += system_models(entries, source, ledger)
    else:
        ledger.leave_out("documents without nodes", "a package has artifacts, a system has nodes", source)


def _systems(
    name: str, systems: list[SystemModel], wiring: SystemWiring, composites: SystemComposites, ledger: ImportLedger
) -> Iterator[ImportedDocument]:
    """The nodes of the systems of one source, a template for each of these, and what is for parts of systems."""
    source, instances = systems[0].source, [each for system in systems for each in wiring.own(system)]
    prefixes = {"": ledger.namespace + slug(systems[0].name) + "/"} | _prefixes(instances)
    nodes = tuple(_instance(each, source, wiring, ledger) for each in instances)
    if nodes:
        yield ImportedDocument(name, source.name, nodes, prefixes)
    folder = name.rpartition("/")[0]
    for system in systems:
        if not wiring.members(system):
            ledger.leave_out("templates of systems without nodes", "a template has at least one role", source)
            continue
        template = ledger.minted(system.name)
        described = system_template(template, system.name, wiring.members(system), wiring.pairs(system))
        prefixes = {"": f"{template}/", "role": f"{template}/role/"}
        path = f"{folder}/{slug(system.name)}" if folder else slug(system.name)
        yield ImportedDocument(f"{path}.template", source.name, tuple(described), prefixes)
        types, base = _prefixes(wiring.members(system)), ledger.minted(system.name)
        if composites.parts.get(system.name) is system:
            described = list(composites.composite(system))
            named = {"": f"{base}/", "inside": f"{base}/inside/role/"}
            yield ImportedDocument(f"{path}.composite", source.name, tuple(described), named | types)
        described = composites.template_of_parts(system)
        if described:
            named = {"": f"{base}/parts/", "role": f"{base}/parts/role/", "part": f"{base}/parts/part/"}
            yield ImportedDocument(f"{path}.parts.template", source.name, tuple(described), named)


def _instance(
    instance: NodeInstance, source: SourceDocument, wiring: SystemWiring, ledger: ImportLedger
) -> Description:
    package, _, kind = instance.node.model.partition(".")
    facts = {
        "nodeName": instance.node.name,
        "nodeNamespace": instance.node.namespace,
        "system": instance.system,
        "package": package,
        "executable": instance.model.artifact if instance.model else "",
        "nodeType": instance.model.name if instance.model else kind,
    }

    def wired(interface: NodeInterface) -> bool:
        return wiring.required(instance, interface)

    parameters = instance.model.parameters if instance.model else ()
    iri = ledger.minted(instance.system, instance.node.name)
    return NodeReader(ledger, source).component(iri, instance.interfaces, facts, parameters, wired).described()


def _node(node: NodeModel, ledger: ImportLedger) -> Description:
    """A kind of node that is part of no system, as the component that it would be."""
    facts = {"nodeName": node.name, "package": node.package, "executable": node.artifact, "nodeType": node.name}
    iri = ledger.minted(node.package or stem(node.source).replace("/", "-"), node.name)
    return NodeReader(ledger, node.source).component(iri, node.interfaces, facts, node.parameters).described()


def _prefixes(nodes: Iterable[NodeInstance | NodeModel]) -> dict[str, str]:
    """A prefix for each family of types: `sensor_msgs` for its messages, `std_srvs-srv` for its services."""
    found = {}
    for node in nodes:
        for interface in node.interfaces:
            kind = interface.signal_type()
            if kind is not None:
                package, segment = kind.removeprefix(TYPE_BASE).split("/")[:2]
                found[package if segment == "msg" else f"{package}-{segment}"] = f"{TYPE_BASE}{package}/{segment}/"
    return found
