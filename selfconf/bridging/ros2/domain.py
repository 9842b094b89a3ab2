"""What the components of a bridge to ROS 2 share: the network of the domain, and what is known of its topics."""

from __future__ import annotations

import itertools
import secrets
import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from selfconf.bridging.ros2.attachments import RosAttachment
from selfconf.bridging.ros2.tokens import NODE, RosEndpoint, RosNodeId, RosToken
from selfconf.bridging.ros2.topic_sources import TopicSources
from selfconf.bus.port import Bus, Replies

if TYPE_CHECKING:
    from selfconf.bridging.ros2.services import ServedService

BRIDGE_NODE = "selfconf_bridge"
"""The name of the node as which a bridge is seen in ROS 2."""
MOST_SENTENCES = 5000
"""How many different complaints are reported; what causes them may have any number of names."""


class OwnPublisher(NamedTuple):
    """The identity under which the bridge publishes on a topic or calls a service, and the numbers of its messages."""

    identifier: bytes
    numbers: itertools.count[int]


class RosDomain:
    """What the components of one bridge share: the network of the domain, and what is known of its topics."""

    def __init__(self, bus: Bus, number: int, complain: Callable[[str], None]) -> None:
        self.bus, self.number = bus, number
        self.session = secrets.token_hex(16)
        """The name of this bridge in the tokens that it declares."""
        self.entities = itertools.count(1)
        self.serving: dict[str, list[ServedService]] = {}
        """What answers calls where no node does, by the key of the service, the first first.

        It is used on the thread of the bus alone.
        """
        self._own: dict[str, OwnPublisher] = {}
        self._complain = complain
        self._topics: dict[str, TopicSources] = {}
        self._servers: dict[str, dict[str, bool]] = {}
        """The tokens of the servers of each service, and whether they are of bridges."""
        self._told: set[str] = set()
        self._lock = threading.Lock()

    def sources(self, key: str) -> TopicSources:
        """The publishers on the key of a topic."""
        with self._lock:
            return self._topics.setdefault(key, TopicSources())

    def server_changed(self, key: str, token: str, alive: bool, of_bridge: bool = False) -> None:
        """A server of a service, by the key of its token, has come or gone; on the thread of the bus."""
        servers = self._servers.setdefault(key, {})
        if alive:
            servers[token] = of_bridge
        else:
            servers.pop(token, None)
        if not servers:  # names of services, as those of tools, may be others each time
            del self._servers[key]
        for one in self.serving.get(key, ()):
            one.look()

    def has_server(self, key: str, *, of_bridges: bool = True) -> bool:
        """Whether a node serves the key of a service; also another bridge, unless these are left out."""
        return any(of_bridges or not of_bridge for of_bridge in self._servers.get(key, {}).values())

    def own(self, key: str) -> OwnPublisher:
        """The identity under which the bridge publishes on a topic, or calls a service, for as long as it is there."""
        with self._lock:
            return self._own.setdefault(key, OwnPublisher(secrets.token_bytes(16), itertools.count(1)))

    def ask(self, service: RosEndpoint, payload: bytes, seconds: float, done: Callable[[Replies], None]) -> None:
        """Call a service as the bridge, on the thread of the bus; `done` receives what comes of it within that time."""
        key = service.key(self.number)
        own = self.own(key)
        attachment = RosAttachment(next(own.numbers), time.time_ns(), own.identifier).pack()
        self.bus.ask(key, payload, seconds, done, attachment)

    def is_own(self, key: str, identifier: bytes) -> bool:
        """Whether a message on the key of a topic is the bridge's own: what it publishes is heard here as well."""
        own = self._own.get(key)
        return own is not None and own.identifier == identifier

    def tell(self, sentence: str) -> None:
        """Complain of something once; a message that is wrong comes a hundred times a second."""
        with self._lock:
            new = sentence not in self._told and len(self._told) < MOST_SENTENCES
            if new:
                self._told.add(sentence)
        if new:
            self._complain(sentence)


def place_of(domain: int, endpoint: RosEndpoint) -> str:
    """Where messages of an endpoint are published: the domain and the topic, as the media type says it."""
    return f"{domain}{endpoint.topic}"


def bridge_token(domain: RosDomain, kind: str = NODE, endpoint: RosEndpoint | None = None) -> RosToken:
    """The token of the bridge as a node, or of its counterpart of a kind to an endpoint of another node."""
    node = RosNodeId(domain.number, domain.session, 0)
    if endpoint is None:
        return RosToken(node, "", BRIDGE_NODE)
    own = RosEndpoint(next(domain.entities), kind, endpoint.topic, endpoint.type, endpoint.quality)
    return RosToken(node, "", BRIDGE_NODE, kind, own)
