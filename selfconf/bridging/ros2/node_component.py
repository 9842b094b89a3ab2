"""The component that stands for a node: it relays messages as the bytes that they are, both ways, while it is active.

What the node publishes is issued as CDR, with its type in the media type; what arrives on an input is published on the
topic of it, by the bridge as a node of its own. A message goes to a topic only if its type has the same hash. An object
is written as a message first; and what is published is issued as a signal too, where `signal_translations` has a kind
for it. Where a message came from the very topic that it would go to, ROS 2 has brought it there already, and it is not
brought twice. Services are the affair of `services`, actions that of `actions`, and what a lifecycle node is in that of
`lifecycle`.
"""

from __future__ import annotations

import time
from collections import deque
from concurrent.futures import Future
from functools import partial
from typing import Any, NamedTuple

from selfconf import ros2
from selfconf.bridging.ros2.actions import call_action
from selfconf.bridging.ros2.attachments import RosAttachment
from selfconf.bridging.ros2.described_nodes import NodePorts, translated_name
from selfconf.bridging.ros2.domain import OwnPublisher, RosDomain, bridge_token, place_of
from selfconf.bridging.ros2.lifecycle import NodeLifecycle, lifecycle_of
from selfconf.bridging.ros2.services import ServedService, call_service
from selfconf.bridging.ros2.signal_translations import translation_of
from selfconf.bridging.ros2.tokens import PUBLISHER, RosEndpoint, RosToken
from selfconf.bus.port import Publisher, Replies, Sample, Undo, Urgency
from selfconf.errors import PeerError
from selfconf.ros2 import MessageType
from selfconf.sdk import Component, Signal

MOST_MESSAGES = 5000
"""How many messages a second of one topic are relayed; an inertial sensor publishes a thousand."""
MOST_OUTGOING = 1000
"""How many messages wait for the network to take them; beyond that the oldest are dropped."""
MOST_KEPT_MESSAGES = 100
"""How many messages of a topic are kept at most for those that are subscribed later, where that is asked for."""
LATEST_TIME = 9e9
"""The latest time that an attachment can say, in seconds of the Unix epoch: that of the year 2255."""
HISTORY = 1.0
"""Seconds that the publishers of a topic may take to say what they published before."""


class RelayedTopic(NamedTuple):
    """A topic that the bridge publishes on, in place of what feeds an input."""

    publisher: Publisher
    own: OwnPublisher
    leave: Undo


class NodeComponent(Component):
    """A node as a component."""

    def __init__(self, domain: RosDomain, token: RosToken, ports: NodePorts) -> None:
        self._domain, self._token, self._ports = domain, token, ports
        self._outgoing: deque[tuple[RosEndpoint, bytes, float]] = deque(maxlen=MOST_OUTGOING)
        """The messages that are to be published, with their times."""
        self._declared: list[Undo] = []
        self._relayed: dict[str, RelayedTopic] = {}
        self._served: dict[str, ServedService] = {}
        """The services that the bridge serves for the clients of the node, by the names of operations."""
        endpoints = lifecycle_of(token.full_name, ports.offered, ports.outputs)
        self._lifecycle = endpoints and NodeLifecycle(domain, token.full_name, endpoints, self.fail)

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
        endpoint = self._ports.inputs[port]
        try:
            payload = self._payload(endpoint, signal)
        except ros2.MessageError as error:
            self._domain.tell(f"{endpoint.topic}: what {signal.source.short} issues {error}")
            return
        if payload is not None:
            self._outgoing.append((endpoint, payload, signal.time))
            self._domain.bus.wake_up(self._publish_next)

    def called(self, operation: str, request: Signal) -> Future[Any]:
        """Ask the service or the action that an operation is; the response comes from the network."""
        action = self._ports.actions.get(operation)
        if action is not None:
            return call_action(self._domain, action, request)
        return call_service(self._domain, self._ports.offered[operation], request)

    def connected(self, operation: str) -> None:
        """Serve the service that the node is a client of."""
        self._domain.bus.wake_up(partial(self._serve, operation))

    def disconnected(self, operation: str) -> None:
        """Serve it no more."""
        self._domain.bus.wake_up(partial(self._end_service, operation))

    def issue_translated(self, name: str, signal: dict[str, Any], moment: float) -> str | None:
        """Issue what a message was translated to; what keeps it from being a signal, without its subject, if so.

        Messages may say what no signal can, as that nothing was measured (NaN): that is no failure of the node.
        """
        problem = self._attached().outputs.problem(name, signal)
        if problem is None:
            self.emit(name, signal, moment)
        return problem

    # On the thread of the bus of the domain.

    def _serve(self, operation: str) -> None:
        if self.active and operation not in self._served:
            service = ServedService(self._domain, self._ports.needed[operation], operation, self)
            self._served[operation] = service

    def _end_service(self, operation: str) -> None:
        service = self._served.pop(operation, None)
        if service is not None:
            service.end()

    def _begin(self) -> None:
        for name, endpoint in self._ports.outputs.items():
            output = RelayedOutput(self, name, endpoint, self._domain, self._token)
            self._declared.append(self._domain.bus.subscribe(output.key, output.received, direct=True))
            if endpoint.quality.transient_local:
                output.ask_for_history()
        if self._lifecycle is not None:
            self._lifecycle.activate()

    def _end(self) -> None:
        for undo in (*self._declared, *(topic.leave for topic in self._relayed.values())):
            undo()
        self._declared, self._relayed = [], {}
        for operation in list(self._served):
            self._end_service(operation)
        if self._lifecycle is not None:
            self._lifecycle.rest()

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
        said = ros2.read_media(signal.media)
        if said is None:
            raise ros2.MessageError("is neither a message nor an object")
        if said.type != endpoint.type:
            other = "another definition of it" if said.type.name == endpoint.type.name else said.type.name
            raise ros2.MessageError(f"is no {endpoint.type.name} by its hash, but {other}; it is not relayed")
        return None if said.topic == place_of(self._domain.number, endpoint) else signal.value

    def _relay_to(self, endpoint: RosEndpoint) -> RelayedTopic:
        """Declare in ROS 2 that the bridge publishes on the topic of an input, as its subscriber asks for."""
        bus, key = self._domain.bus, endpoint.key(self._domain.number)
        token = bridge_token(self._domain, PUBLISHER, endpoint)
        # Like rmw_zenoh: only where everything is kept does a publisher wait for a network that is short of room.
        waits = endpoint.quality.keep_all and endpoint.quality.reliable
        quality = endpoint.quality
        depth = MOST_KEPT_MESSAGES if quality.keep_all else min(quality.depth, MOST_KEPT_MESSAGES)
        publisher = bus.publisher(
            key, Urgency.EVENT if waits else Urgency.SIGNAL, kept=depth if quality.transient_local else 0
        )
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
        self._checked = ros2.is_known(endpoint.type)
        self._translation = translation_of(endpoint.type.name)
        self._second, self._in_second = 0, 0
        self._told_untranslated = False

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
                    ros2.check_message(payload, self._endpoint.type)
                else:
                    signal = self._translation.read(ros2.message_fields(payload, self._endpoint.type))
            except ros2.MessageError as error:
                self._component.fail(f"what {self._token.full_name} publishes on {self._endpoint.topic} {error}")
                return
        self._component.emit(self._name, payload, moment, self._media)
        if self._translation is not None and signal is not None:
            name = translated_name(self._name, self._translation)
            problem = self._component.issue_translated(name, signal, moment)
            if problem is not None and not self._told_untranslated:  # once: a problem may name another value each time
                self._told_untranslated = True
                self._domain.tell(
                    f"{self._endpoint.topic}: what {self._token.full_name} publishes is no signal on {name!r}, as that"
                    f" {problem}; the messages are relayed"
                )

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
    if not ros2.is_known(kind):
        raise ros2.MessageError(f"is an object, and the fields of {kind.name} are not known")
    translation, fields = translation_of(kind.name), signal.value
    if translation is not None and translation.write is not None and translation.is_signal(fields):
        try:
            fields = translation.write(fields, signal.time)
        except (TypeError, ValueError, OverflowError) as error:  # of an infinite angle there is no sine: ValueError
            raise ros2.MessageError(f"is no {translation.name}: {error}") from None
    return ros2.message(fields, kind)
