"""The component that stands for a node: it relays messages as the bytes that they are, both ways, while it is active.

What the node publishes is issued as CDR, with its type in the media type; what arrives on an input is published on the
topic of it, by the bridge as a node of its own. A message goes to a topic only if its type has the same hash. An object
is written as a message first; and what is published is issued as a signal too, where `signal_translations` has a kind
for it. Where a message came from the very topic that it would go to, ROS 2 has brought it there already, and it is not
brought twice.
"""

from __future__ import annotations

import itertools
import secrets
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Any, NamedTuple

from selfconf import ros_messages
from selfconf.bridging.ros2.attachments import RosAttachment
from selfconf.bridging.ros2.described_nodes import BRIDGE_NODE, TopicPorts, translated_name
from selfconf.bridging.ros2.signal_translations import translation_of
from selfconf.bridging.ros2.tokens import PUBLISHER, RosEndpoint, RosNodeId, RosToken
from selfconf.bridging.ros2.topic_sources import TopicSources
from selfconf.bus.port import Bus, Publisher, Replies, Sample, Undo, Urgency
from selfconf.errors import PeerError
from selfconf.ros_messages import MessageType
from selfconf.sdk import Component, Signal

MOST_MESSAGES = 5000
"""How many messages a second of one topic are relayed; an inertial sensor publishes a thousand."""
MOST_OUTGOING = 1000
"""How many messages wait for the network to take them; beyond that the oldest are dropped."""
LATEST_TIME = 9e9
"""The latest time that an attachment can say, in seconds of the Unix epoch: that of the year 2255."""
HISTORY = 1.0
"""Seconds that the publishers of a topic may take to say what they published before."""


class OwnPublisher(NamedTuple):
    """As whom the bridge publishes on a topic, and the numbers of its messages."""

    identifier: bytes
    numbers: itertools.count[int]


class RosDomain:
    """What the components of one bridge share: the network of the domain, and what is known of its topics."""

    def __init__(self, bus: Bus, number: int, complain: Callable[[str], None]) -> None:
        self.bus, self.number = bus, number
        self.session = secrets.token_hex(16)
        """The name of this bridge in the tokens that it declares."""
        self.entities = itertools.count(1)
        self._own: dict[str, OwnPublisher] = {}
        self._complain = complain
        self._topics: dict[str, TopicSources] = {}
        self._told: set[str] = set()
        self._lock = threading.Lock()

    def sources(self, key: str) -> TopicSources:
        """Who publishes on the key of a topic."""
        with self._lock:
            return self._topics.setdefault(key, TopicSources())

    def own(self, key: str) -> OwnPublisher:
        """As whom the bridge publishes on the key of a topic, for as long as it is there."""
        with self._lock:
            return self._own.setdefault(key, OwnPublisher(secrets.token_bytes(16), itertools.count(1)))

    def is_own(self, key: str, identifier: bytes) -> bool:
        """Whether a message on the key of a topic is the bridge's own: what it publishes is heard here as well."""
        own = self._own.get(key)
        return own is not None and own.identifier == identifier

    def tell(self, sentence: str) -> None:
        """Complain of something once; a message that is wrong comes a hundred times a second."""
        with self._lock:
            new = sentence not in self._told and len(self._told) < MOST_MESSAGES
            if new:
                self._told.add(sentence)
        if new:
            self._complain(sentence)


class RelayedTopic(NamedTuple):
    """A topic that the bridge publishes on, in place of what feeds an input."""

    publisher: Publisher
    own: OwnPublisher
    leave: Undo


class NodeComponent(Component):
    """A node as a component."""

    def __init__(self, domain: RosDomain, token: RosToken, outputs: TopicPorts, inputs: TopicPorts) -> None:
        self._domain, self._token, self._outputs, self._inputs = domain, token, outputs, inputs
        self._outgoing: deque[tuple[RosEndpoint, bytes, float]] = deque(maxlen=MOST_OUTGOING)
        """The messages that are to be published, with their times."""
        self._declared: list[Undo] = []
        self._relayed: dict[str, RelayedTopic] = {}

    @staticmethod
    def signal_value(value: Any, media: str) -> Any:
        """A message is relayed as it is, and so not read here."""
        return value

    # On the thread of the component's code, which declares nothing: the bus of the domain has a thread of its own.

    def started(self) -> None:
        """Begin to relay what the node publishes."""
        self._domain.bus.wake_up(self._begin)

    def stopped(self) -> None:
        """Relay nothing any more, in either direction."""
        self._domain.bus.wake_up(self._end)

    def received(self, port: str, signal: Signal) -> None:
        """Publish a signal on the topic of an input."""
        endpoint = self._inputs[port]
        try:
            payload = self._payload(endpoint, signal)
        except ros_messages.MessageError as error:
            self._domain.tell(f"{endpoint.topic}: what {signal.source.short} issues {error}")
            return
        if payload is not None:
            self._outgoing.append((endpoint, payload, signal.time))
            self._domain.bus.wake_up(self._publish_next)

    # On the thread of the bus of the domain.

    def _begin(self) -> None:
        for name, endpoint in self._outputs.items():
            output = RelayedOutput(self, name, endpoint, self._domain, self._token)
            self._declared.append(self._domain.bus.subscribe(output.key, output.received, direct=True))
            if endpoint.quality.transient_local:
                output.ask_for_history()

    def _end(self) -> None:
        for undo in (*self._declared, *(topic.leave for topic in self._relayed.values())):
            undo()
        self._declared, self._relayed = [], {}

    def _publish_next(self) -> None:
        """Publish the message that has waited longest; none is left where too many had to wait."""
        if not self._outgoing:
            return
        endpoint, payload, moment = self._outgoing.popleft()
        if not self.active:
            return
        topic = self._relayed.get(endpoint.topic) or self._relay_to(endpoint)
        nanoseconds = int(moment * 1e9) if 0.0 <= moment < LATEST_TIME else 0  # the clock of a source may be any
        attachment = RosAttachment(next(topic.own.numbers), nanoseconds, topic.own.identifier)
        topic.publisher.put(payload, attachment.pack())

    def _payload(self, endpoint: RosEndpoint, signal: Signal) -> bytes | None:
        """A signal as a message; None if the message has come over this topic. Raises MessageError."""
        if not isinstance(signal.value, bytes):
            return written(signal, endpoint.type)
        said = ros_messages.read_media(signal.media)
        if said is None:
            raise ros_messages.MessageError("is neither a message nor an object")
        if said.type != endpoint.type:
            other = "another definition of it" if said.type.name == endpoint.type.name else said.type.name
            raise ros_messages.MessageError(f"is no {endpoint.type.name} by its hash, but {other}; it is not relayed")
        return None if said.topic == place_of(self._domain.number, endpoint) else signal.value

    def _relay_to(self, endpoint: RosEndpoint) -> RelayedTopic:
        """Declare in ROS 2 that the bridge publishes on the topic of an input, as whoever is subscribed asks for."""
        bus, key = self._domain.bus, endpoint.key(self._domain.number)
        token = bridge_token(self._domain, endpoint)
        # Like rmw_zenoh: only where everything is kept does a publisher wait for a network that is short of room.
        waits = endpoint.quality.keep_all and endpoint.quality.reliable
        publisher = bus.publisher(key, Urgency.EVENT if waits else Urgency.SIGNAL)
        leave = bus.announce(token.key())

        def end() -> None:
            leave()
            publisher.undeclare()

        topic = self._relayed[endpoint.topic] = RelayedTopic(publisher, self._domain.own(key), end)
        return topic


class RelayedOutput:
    """What a node publishes on one topic, on its way to an output; called on the threads of the network."""

    def __init__(
        self, component: NodeComponent, name: str, endpoint: RosEndpoint, domain: RosDomain, token: RosToken
    ) -> None:
        self._component, self._name, self._endpoint, self._domain, self._token = (
            component,
            name,
            endpoint,
            domain,
            token,
        )
        self.key = endpoint.key(domain.number)
        self._media = endpoint.type.media(place_of(domain.number, endpoint))
        self._sources = domain.sources(self.key)
        self._checked = ros_messages.is_known(endpoint.type)
        self._translation = translation_of(endpoint.type.name)
        self._second, self._in_second = 0, 0

    def ask_for_history(self) -> None:
        """Have publishers that keep what they published say it: they are asked beside the key of the topic."""
        self._domain.bus.ask(f"{self.key}/@adv/**?_anyke", b"", HISTORY, self._heard_history)

    def _heard_history(self, replies: Replies) -> None:
        for sample in replies.samples:
            self.received(sample)

    def received(self, sample: Sample) -> None:
        """Issue a message, if it is the node's."""
        try:
            attachment = RosAttachment.unpack(sample.attachment)
        except PeerError as error:
            self._domain.tell(f"{self._endpoint.topic}: passed over what was published there: {error}")
            return
        if self._domain.is_own(self.key, attachment.publisher) or self._is_flood():
            return
        node = self._sources.node(attachment.publisher)
        if node is None:
            self._domain.tell(
                f"{self._endpoint.topic}: {len(self._sources)} nodes publish there, and which message is whose"
                " cannot be said; such messages are not relayed"
            )
        elif node == self._token.identity:
            self._issue(sample.payload, attachment)

    def _issue(self, payload: bytes, attachment: RosAttachment) -> None:
        moment, signal = attachment.nanoseconds / 1e9, None
        if self._checked:
            try:
                if self._translation is None:
                    ros_messages.check_message(payload, self._endpoint.type)
                else:
                    signal = self._translation.read(ros_messages.message_fields(payload, self._endpoint.type))
            except ros_messages.MessageError as error:
                self._component.fail(f"what {self._token.full_name} publishes on {self._endpoint.topic} {error}")
                return
        self._component.emit(self._name, payload, moment, self._media)
        if self._translation is not None and signal is not None:
            self._component.emit(translated_name(self._name, self._translation), signal, moment)

    def _is_flood(self) -> bool:
        """Whether the topic has had as many messages in this second as are relayed."""
        second = int(time.monotonic())
        if second != self._second:
            self._second, self._in_second = second, 0
        self._in_second += 1
        if self._in_second == MOST_MESSAGES + 1:
            self._domain.tell(
                f"{self._endpoint.topic}: more than {MOST_MESSAGES} messages a second; the rest is dropped"
            )
        return self._in_second > MOST_MESSAGES


def written(signal: Signal, kind: MessageType) -> bytes:
    """An object as a message: it has the fields of that, or of a signal that is translated. Raises MessageError."""
    if not ros_messages.is_known(kind):
        raise ros_messages.MessageError(f"is an object, and the fields of {kind.name} are not known")
    translation, fields = translation_of(kind.name), signal.value
    if translation is not None and translation.write is not None and translation.is_signal(fields):
        fields = translation.write(fields, signal.time)
    return ros_messages.message(fields, kind)


def place_of(domain: int, endpoint: RosEndpoint) -> str:
    """Where messages of an endpoint are published: the domain and the topic, as the media type says it."""
    return f"{domain}{endpoint.topic}"


def bridge_token(domain: RosDomain, endpoint: RosEndpoint | None = None) -> RosToken:
    """The token of the bridge as a node, or of a topic on which it publishes what an endpoint takes."""
    node = RosNodeId(domain.number, domain.session, 0)
    if endpoint is None:
        return RosToken(node, "", BRIDGE_NODE)
    own = RosEndpoint(next(domain.entities), PUBLISHER, endpoint.topic, endpoint.type, endpoint.quality)
    return RosToken(node, "", BRIDGE_NODE, PUBLISHER, own)
