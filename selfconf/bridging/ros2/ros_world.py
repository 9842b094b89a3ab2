"""The world of the nodes of a ROS 2 domain: found by their tokens, advertised as they come and go.

All of this happens on the thread of the bus that is connected to the router of ROS 2. The tokens of a node come one
after the other, so a node is advertised once no more have come for a moment. A node that has gone is FAIL; one that
offers more than before is advertised anew when no task holds it, and one that offers less at once. A node that another
bridge stands for lives here when that one has gone.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field

from selfconf import ros2
from selfconf.bridging.bridge import Bridge
from selfconf.bridging.ros2.described_nodes import (
    OF_EVERY_NODE,
    NodePorts,
    described_node,
    is_bridged,
    node_iri,
    ports_of,
)
from selfconf.bridging.ros2.domain import BRIDGE_NODE, RosDomain, bridge_token
from selfconf.bridging.ros2.node_component import NodeComponent
from selfconf.bridging.ros2.tokens import (
    NODE,
    PUBLISHER,
    ROOT,
    SERVER,
    SUBSCRIPTION,
    NodeIdentity,
    RosEndpoint,
    RosToken,
)
from selfconf.bus.port import Undo
from selfconf.bus.zenoh import ZenohBus
from selfconf.errors import PeerError
from selfconf.importing import ImportedDocument
from selfconf.model.term import IRI

TOKENS_COMPLETE = 0.3
"""Seconds without a new token after which those of a node are complete."""
LOOK_WHETHER_FREE = 1.0
"""Seconds after which it is checked again whether a node may be advertised anew."""
LOOK_WHETHER_IT_LIVES = 2.0
"""Seconds after which it is checked again whether a node lives, or may live by now: another bridge may have ended."""
RELEASING = 0.5
"""Seconds from the FAIL of a node that has gone to the end of its life, in which it can still be released."""
MOST_NODES = 2000
"""How many nodes one bridge stands for."""


@dataclass
class RosNode:
    """A node of the domain, as its tokens say, and what was made of it."""

    token: RosToken
    tokens: dict[str, RosToken] = field(default_factory=dict)
    advertised: frozenset[RosEndpoint] | None = None
    """The endpoints of the ports that it was last advertised with; None while it is not."""
    code: NodeComponent | None = None
    settle: Undo = lambda: None

    @property
    def endpoints(self) -> frozenset[RosEndpoint]:
        """What it publishes and takes now."""
        return frozenset(token.endpoint for token in self.tokens.values() if token.endpoint is not None)


class RosWorld:
    """The other side of a bridge to ROS 2."""

    def __init__(self, connect: Callable[[], ZenohBus], domain: int, bridge: Bridge) -> None:
        """Begin to follow the tokens of the domain; `connect` opens a node of its network. Raises NetworkError."""
        ros2.load()  # here it holds up nothing
        self._number, self._bridge, self._bus = domain, bridge, connect()
        self._domain = RosDomain(self._bus, domain, bridge.complain)
        self._reached = True
        self._nodes: dict[NodeIdentity, RosNode] = {}
        self._by_name: dict[IRI, NodeIdentity] = {}
        self._on_topic: dict[str, dict[str, RosToken]] = {}
        """The tokens of the publishers and subscriptions of each topic and type, by their keys."""
        begun = threading.Event()

        def begin() -> None:
            self._bus.watch_link(self._link_changed)
            self._bus.announce(bridge_token(self._domain).key())
            self._bus.watch(f"{ROOT}/{domain}/**", self._changed, many=True)
            begun.set()

        self._bus.wake_up(begin)
        if self._bus.run_aside():
            begun.wait()

    def close(self) -> None:
        """Leave the domain."""
        self._bus.close()

    def _link_changed(self) -> None:
        """Say that the router is gone, or is there again: with it all nodes go and come, also those of no task."""
        reached = bool(self._bus.link)
        if reached != self._reached:
            self._reached = reached
            lost = "cannot be reached any more; its nodes are gone until it is there again"
            self._bridge.complain(f"the router of ROS 2 {'is reached again' if reached else lost}")

    def _changed(self, key: str, alive: bool) -> None:
        try:
            token = RosToken.parse(key)
        except PeerError as error:
            self._domain.tell(f"left out of the domain {self._number} of ROS 2: {error}")
            return
        if token.node.session == self._domain.session:
            return
        if token.kind in (PUBLISHER, SUBSCRIPTION) and token.endpoint is not None:
            self._compare_quality(key, token, token.endpoint, alive)
        if token.kind == PUBLISHER and token.endpoint is not None:
            sources, publisher = (
                self._domain.sources(token.endpoint.key(self._number)),
                (token.identity, token.endpoint.entity),
            )
            sources.add(publisher) if alive else sources.remove(publisher)
        if token.kind == SERVER and token.endpoint is not None:
            of_bridge = token.name.startswith(BRIDGE_NODE)
            self._domain.server_changed(token.endpoint.key(self._number), key, alive, of_bridge)
        if is_bridged(token):
            self._come(key, token) if alive else self._go(key, token)

    def _compare_quality(self, key: str, token: RosToken, endpoint: RosEndpoint, alive: bool) -> None:
        """Say which publishers and subscriptions of one topic ROS 2 does not connect, as their qualities differ."""
        if endpoint.topic in OF_EVERY_NODE:
            return
        known = self._on_topic.setdefault(endpoint.key(self._number), {})
        if not alive:
            known.pop(key, None)
            if not known:  # topics may have other names each time
                del self._on_topic[endpoint.key(self._number)]
            return
        for other in known.values():
            if other.kind != token.kind and other.endpoint is not None:
                publisher, subscription = (token, other) if token.kind == PUBLISHER else (other, token)
                offered, wanted = (endpoint, other.endpoint) if publisher is token else (other.endpoint, endpoint)
                why = offered.quality.falls_short_of(wanted.quality)
                if why is not None:
                    self._domain.tell(
                        f"{endpoint.topic}: {publisher.full_name} publishes {why} as {subscription.full_name} asks;"
                        " ROS 2 does not connect them"
                    )
        known[key] = token

    def _come(self, key: str, token: RosToken) -> None:
        if token.identity not in self._nodes and len(self._nodes) >= MOST_NODES:
            self._domain.tell(f"there are more than {MOST_NODES} nodes; a bridge stands for so many")
            return
        node = self._nodes.setdefault(token.identity, RosNode(token))
        node.tokens[key] = token
        self._settle(node, TOKENS_COMPLETE)

    def _go(self, key: str, token: RosToken) -> None:
        node = self._nodes.get(token.identity)
        if node is None:
            return
        node.tokens.pop(key, None)
        if not node.tokens or (token.kind == NODE and all(one.kind != NODE for one in node.tokens.values())):
            name, domain = token.full_name, f"the domain {self._number} of ROS 2"
            lost = "the router of ROS 2 cannot be reached any more, so nothing is known of the node"
            self._end(node, f"the node {name} has left {domain}" if self._bus.link else f"{lost} {name}")
        else:
            self._settle(node, TOKENS_COMPLETE)

    def _settle(self, node: RosNode, seconds: float) -> None:
        node.settle()
        node.settle = self._bus.later(seconds, lambda: self._settled(node))

    def _settled(self, node: RosNode) -> None:
        """Advertise a node as it is now, if that is another than it was."""
        ports, iri = ports_of(node.endpoints), node_iri(node.token)
        endpoints = ports.endpoints()
        if endpoints == node.advertised:
            return
        if self._by_name.setdefault(iri, node.token.identity) != node.token.identity:
            name = node.token.full_name
            self._domain.tell(f"two nodes are called {name}; the first one counts, as long as it is there")
            return
        if node.code is not None and node.code.active:
            if node.advertised is not None and endpoints >= node.advertised:
                self._settle(node, LOOK_WHETHER_FREE)
                return
            node.code.fail(f"the node {node.token.full_name} offers less than before")
        component = described_node(node.token, ports)
        try:
            self._bridge.advertise(iri, ImportedDocument("", _place(node.token), (component.described(),), {}))
        except OSError as error:
            self._domain.tell(f"{node.token.full_name} cannot be advertised: {error.strerror}")
            self._settle(node, LOOK_WHETHER_FREE)
            return
        node.advertised = endpoints
        self._live(node, ports)

    def _live(self, node: RosNode, ports: NodePorts) -> None:
        """Have a node that is advertised live here."""
        code = node.code = NodeComponent(self._domain, node.token, ports)

        def look() -> None:
            if node.code is not code:
                return  # it was advertised anew, or has gone
            if self._bridge.lives(iri):
                self._bus.later(LOOK_WHETHER_IT_LIVES, look)
            else:
                self._live(node, ports)

        def begun(outcome: Future[str | None]) -> None:
            self._begun(node, outcome)
            self._bus.later(LOOK_WHETHER_IT_LIVES, look)

        iri = node_iri(node.token)
        self._bridge.begin_life(iri, code).add_done_callback(begun)

    def _begun(self, node: RosNode, outcome: Future[str | None]) -> None:
        """Say whether a node lives here; on the thread of the components' code."""
        trouble = outcome.result()
        name = node.token.full_name
        self._domain.tell(
            f"{name} is here, in the domain {self._number} of ROS 2" if trouble is None else f"{name}: {trouble}"
        )

    def _end(self, node: RosNode, reason: str) -> None:
        """A node has gone: what it was held for has to know why, before it lives no more."""
        node.settle()
        del self._nodes[node.token.identity]
        iri = node_iri(node.token)
        if self._by_name.get(iri) != node.token.identity:
            return
        del self._by_name[iri]
        code, node.code = node.code, None
        if code is not None and code.active:
            code.fail(reason)
        self._bus.later(RELEASING, lambda: self._withdraw(iri, code))
        for other in self._nodes.values():
            if node_iri(other.token) == iri:
                self._settle(other, TOKENS_COMPLETE)

    def _withdraw(self, iri: IRI, code: NodeComponent | None) -> None:
        """Advertise a node no more, unless another one of its name has come meanwhile."""
        if iri not in self._by_name:
            self._bridge.withdraw(iri)
        elif code is not None:
            self._bridge.end_life(iri, code)


def _place(token: RosToken) -> str:
    return f"{token.full_name} in the domain {token.node.domain} of ROS 2"
