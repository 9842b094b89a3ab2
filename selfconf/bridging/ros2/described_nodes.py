"""A living node as a component: its topics as ports, with the quality of service that they have.

A topic whose messages say what a kind of signals says (`signal_translations`) has that type too: a publisher is a
second output, `TOPIC as KIND`, and the input of a subscription takes either. What was translated is not translated
back: such an input accepts no second output of a node, for from node to node the messages themselves go.

An output promises the rate that its deadline says. An input that is to be reliable, or is to receive what was published
before, accepts no output that says it is otherwise (`sc:accepts`), as ROS 2 would not connect them; what comes from no
node says nothing about that, and is accepted. A service that the node serves is an operation that it offers, one that
it is a client of an operation that it needs. An action that it serves is an operation that it offers and an output for
the feedback (`actions`). What every node publishes, its log and the changes of its parameters, is left out, and so is
what else is hidden.
"""

from __future__ import annotations

import itertools
from collections.abc import Collection, Iterator
from typing import NamedTuple

from selfconf.bridging.ros2.actions import RosAction, actions_of
from selfconf.bridging.ros2.domain import BRIDGE_NODE
from selfconf.bridging.ros2.signal_translations import SignalTranslation, translation_of
from selfconf.bridging.ros2.tokens import CLIENT, PUBLISHER, SERVER, SUBSCRIPTION, RosEndpoint, RosQuality, RosToken
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
    feedback_port,
    slug,
)
from selfconf.model.immutable import replace
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import SC, SH, UNIT, XSD

NODE_NAMESPACE = "urn:selfconf:ros2:"
"""What the IRIs of nodes begin with; the domain and the name of the node follow."""
OF_EVERY_NODE = frozenset(("/rosout", "/parameter_events"))
EndpointsByName = dict[str, RosEndpoint]


class NodePorts(NamedTuple):
    """What a node has, by the names of ports and operations."""

    outputs: EndpointsByName
    inputs: EndpointsByName
    offered: EndpointsByName
    """The services that it serves."""
    needed: EndpointsByName
    """The services that it is a client of."""
    actions: dict[str, RosAction]
    """The actions that it serves, besides `offered`; their feedback is among the outputs."""

    def endpoints(self) -> frozenset[RosEndpoint]:
        """All that it has, without the numbers by which a node tells one that it makes anew from the one before."""
        named = (self.outputs, self.inputs, self.offered, self.needed)
        found = (*(each for ports in named for each in ports.values()), *itertools.chain(*self.actions.values()))
        return frozenset(replace(each, entity=0) for each in found)


def translated_name(name: str, translation: SignalTranslation) -> str:
    """The name of the second output of a publisher."""
    return f"{name} as {translation.name}"


def node_iri(token: RosToken, namespace: str = NODE_NAMESPACE) -> IRI:
    """The component that a node is."""
    path = "/".join(map(slug, token.full_name.strip("/").split("/")))
    return IRI.unchecked(f"{namespace}{token.node.domain}/{path}")


def is_bridged(token: RosToken) -> bool:
    """Whether a node is one that a bridge stands for: no bridge, and none that is hidden, as those of tools are."""
    return not token.name.startswith("_") and not token.name.startswith(BRIDGE_NODE)


def ports_of(endpoints: Collection[RosEndpoint]) -> NodePorts:
    """The ports and operations of a node, by their names; of two endpoints of one name and kind the first counts."""
    found: dict[str, EndpointsByName] = {kind: {} for kind in (PUBLISHER, SUBSCRIPTION, SERVER, CLIENT)}
    for each in sorted(endpoints, key=lambda one: one.entity):
        if each.topic not in OF_EVERY_NODE and not is_hidden(each.topic):
            found[each.kind].setdefault(each.topic.strip("/"), each)
    actions = {name: each for name, each in actions_of(endpoints).items() if name not in found[SERVER]}
    for name, action in actions.items():
        found[PUBLISHER].setdefault(feedback_port(name), action.feedback)
    outputs, inputs, offered, needed = (dict(sorted(named.items())) for named in found.values())
    return NodePorts(outputs, inputs, offered, needed, actions)


def is_hidden(name: str) -> bool:
    """Whether a topic or service is hidden, as the parts of actions are: by an underscore that a name begins with."""
    return any(part.startswith("_") for part in name.split("/"))


def described_node(token: RosToken, ports: NodePorts, ledger: ImportLedger | None = None) -> ImportedComponent:
    """A node as the component that it is; a ledger says what its name begins with, and hears what is left out."""
    outputs, inputs, offered, needed, actions = ports
    topics = {name: each for name, each in outputs.items() if not is_hidden(each.topic)}
    interfaces = [
        NodeInterface(kind, name, each.type.name, qualities(each.quality))
        for kind, named, qualities in (
            (InterfaceKind.PUBLISHER, topics, _qualities),
            (InterfaceKind.SUBSCRIBER, inputs, _qualities),
            (InterfaceKind.SERVICE_SERVER, offered, _no_qualities),
            (InterfaceKind.SERVICE_CLIENT, needed, _no_qualities),
        )
        for name, each in named.items()
    ]
    interfaces += (NodeInterface(InterfaceKind.ACTION_SERVER, name, each.type) for name, each in actions.items())
    source = SourceDocument(f"the domain {token.node.domain} of ROS 2", "", b"")
    ledger = ledger or ImportLedger(NODE_NAMESPACE, lambda error: None)
    facts = {"nodeName": token.name, "nodeNamespace": token.namespace or "/"}
    found = NodeReader(ledger, source).component(node_iri(token, ledger.namespace), tuple(interfaces), facts)
    return replace(
        found,
        outputs=tuple(port for each in found.outputs for port in _issuing(each, outputs[each.name])),
        inputs=tuple(_demanding(port, inputs[port.name]) for port in found.inputs),
    )


def _no_qualities(_: RosQuality) -> tuple[tuple[str, str], ...]:
    """A service is reliable by being one; no client chooses by the quality of it."""
    return ()


def _qualities(quality: RosQuality) -> tuple[tuple[str, str], ...]:
    return (
        ("reliability", "reliable" if quality.reliable else "best_effort"),
        ("durability", "transient_local" if quality.transient_local else "volatile"),
        ("history", "keep_all" if quality.keep_all else "keep_last"),
        ("depth", str(quality.depth)),
    )


def _issuing(port: ImportedPort, endpoint: RosEndpoint) -> Iterator[ImportedPort]:
    """The output of a publisher, and the second one where its messages are translated."""
    yield _promised(port, endpoint.quality)
    translation = translation_of(endpoint.type.name)
    if translation is not None:
        source = (ROS2.translatedFrom, Literal(port.name))
        second = ImportedPort(translated_name(port.name, translation), (translation.signal,), properties=(source,))
        yield _promised(second, endpoint.quality)


def _promised(port: ImportedPort, quality: RosQuality) -> ImportedPort:
    if quality.period is None:
        return port
    rate = NestedNode(
        ((SC.value, (Literal(f"{1 / quality.period:.6g}", XSD.double),)), (SC.unit, (UNIT.HZ,))),
    )
    return replace(port, properties=(*port.properties, (SC.rate, rate)))


def _demanding(port: ImportedPort, endpoint: RosEndpoint) -> ImportedPort:
    """The input of a subscription, with the kind of signal of which its messages are made, and what it accepts."""
    quality, translation = endpoint.quality, translation_of(endpoint.type.name)
    wanted = [
        NestedNode(((SH.path, (term,)), (SH["in"], (TermList((Literal(value),)),))))
        for term, value, is_wanted in (
            (ROS2.reliability, "reliable", quality.reliable),
            (ROS2.durability, "transient_local", quality.transient_local),
        )
        if is_wanted
    ]
    if translation is not None and translation.write is not None:
        port = replace(port, types=(*port.types, translation.signal))
        none = Literal("0", XSD.integer)
        wanted.append(NestedNode(((SH.path, (ROS2.translatedFrom,)), (SH.maxCount, (none,)))))
    if not wanted:
        return port
    return replace(port, properties=(*port.properties, (SC.accepts, NestedNode(((SH.property, tuple(wanted)),)))))
