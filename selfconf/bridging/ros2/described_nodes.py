"""A living node as a component: its topics as ports, with the quality of service that they have.

An output promises the rate that its deadline says. An input that is to be reliable, or is to receive what was published
before, accepts no output that says it is otherwise (`sc:accepts`), as ROS 2 would not connect them; what comes from no
node says nothing about that, and is accepted. What every node has, its log and its parameters, is left out.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from selfconf.bridging.ros2.tokens import PUBLISHER, RosEndpoint, RosQuality, RosToken
from selfconf.importing import (
    ROS2,
    ImportedComponent,
    ImportedPort,
    ImportLedger,
    InterfaceKind,
    NestedNode,
    NodeInterface,
    NodeReader,
    SourceDocument,
    TermList,
    slug,
)
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import SC, SH, UNIT, XSD

NODE_NAMESPACE = "urn:selfconf:ros2:"
"""What the IRIs of nodes begin with; the domain and the name of the node follow."""
OF_EVERY_NODE = frozenset(("/rosout", "/parameter_events"))
BRIDGE_NODE = "selfconf_bridge"
"""The name of the node as which a bridge is seen in ROS 2."""
TopicPorts = dict[str, RosEndpoint]


def node_iri(token: RosToken) -> IRI:
    """The component that a node is."""
    path = "/".join(map(slug, token.full_name.strip("/").split("/")))
    return IRI(f"{NODE_NAMESPACE}{token.node.domain}/{path}")


def is_bridged(token: RosToken) -> bool:
    """Whether a node is one that a bridge stands for: no bridge, and none that is hidden, as those of tools are."""
    return not token.name.startswith("_") and not token.name.startswith(BRIDGE_NODE)


def ports_of(endpoints: Iterable[RosEndpoint]) -> tuple[TopicPorts, TopicPorts]:
    """The outputs and inputs of a node, by name; of two endpoints of one topic and kind the first counts."""
    outputs: TopicPorts = {}
    inputs: TopicPorts = {}
    for each in sorted(endpoints, key=lambda one: one.entity):
        if each.topic not in OF_EVERY_NODE:
            (outputs if each.kind == PUBLISHER else inputs).setdefault(each.topic.strip("/"), each)
    return outputs, inputs


def described_node(token: RosToken, outputs: TopicPorts, inputs: TopicPorts) -> ImportedComponent:
    """A node as the component that it is."""
    interfaces = [
        NodeInterface(kind, name, each.type.name, _qualities(each.quality))
        for kind, ports in ((InterfaceKind.PUBLISHER, outputs), (InterfaceKind.SUBSCRIBER, inputs))
        for name, each in ports.items()
    ]
    source = SourceDocument(f"the domain {token.node.domain} of ROS 2", "", b"")
    reader = NodeReader(ImportLedger(NODE_NAMESPACE, lambda error: None), source)
    facts = {"nodeName": token.name, "nodeNamespace": token.namespace or "/"}
    found = reader.component(node_iri(token), tuple(interfaces), facts)
    return replace(
        found,
        outputs=tuple(_promised(port, outputs[port.name].quality) for port in found.outputs),
        inputs=tuple(_demanding(port, inputs[port.name].quality) for port in found.inputs),
    )


def _qualities(quality: RosQuality) -> tuple[tuple[str, str], ...]:
    return (
        ("reliability", "reliable" if quality.reliable else "best_effort"),
        ("durability", "transient_local" if quality.transient_local else "volatile"),
        ("history", "keep_all" if quality.keep_all else "keep_last"),
        ("depth", str(quality.depth)),
    )


def _promised(port: ImportedPort, quality: RosQuality) -> ImportedPort:
    if quality.period is None:
        return port
    rate = NestedNode(
        ((SC.value, (Literal(f"{1 / quality.period:.6g}", XSD.double),)), (SC.unit, (UNIT.HZ,))),
    )
    return replace(port, properties=(*port.properties, (SC.rate, rate)))


def _demanding(port: ImportedPort, quality: RosQuality) -> ImportedPort:
    wanted = [
        NestedNode(((SH.path, (term,)), (SH["in"], (TermList((Literal(value),)),))))
        for term, value, is_wanted in (
            (ROS2.reliability, "reliable", quality.reliable),
            (ROS2.durability, "transient_local", quality.transient_local),
        )
        if is_wanted
    ]
    if not wanted:
        return port
    return replace(port, properties=(*port.properties, (SC.accepts, NestedNode(((SH.property, tuple(wanted)),)))))
