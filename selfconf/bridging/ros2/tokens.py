"""What lives in a ROS 2 domain over rmw_zenoh, as its liveliness tokens say: nodes, and what they publish and take.

    @ros2_lv/<domain>/<session>/<node>/<node>/NN/<enclave>/<namespace>/<name>
    @ros2_lv/<domain>/<session>/<node>/<entity>/MP|MS|SS|SC/<enclave>/<namespace>/<name>/<topic>/<type>/<hash>/<quality>

In names a slash is written as a percent sign, and an empty name is one. (The design of rmw_zenoh, as of jazzy, kilted
and lyrical. In humble a type has no hash, so that no program could say whether two types are one.)
"""

from __future__ import annotations

import re

from selfconf.errors import PeerError
from selfconf.model.immutable import immutable
from selfconf.ros2 import HASH, NAME, MessageType

ROOT = "@ros2_lv"
NODE, PUBLISHER, SUBSCRIPTION, SERVER, CLIENT = "NN", "MP", "MS", "SS", "SC"
_KINDS = "NN|MP|MS|SS|SC"
_PART = r"[^/*$?#\x00-\x1f\x7f-\x9f]+"  # without control characters: names stand in sentences on a terminal
_TOKEN = re.compile(
    rf"{ROOT}/(?P<domain>\d+)/(?P<session>[0-9a-f]{{1,32}})/(?P<node>\d+)/(?P<entity>\d+)/(?P<kind>{_KINDS})"
    rf"/(?P<enclave>{_PART})/(?P<namespace>{_PART})/(?P<name>{_PART})"
    rf"(?:/(?P<topic>{_PART})/(?P<type>{_PART})/(?P<hash>{_PART})/(?P<quality>{_PART}))?"
)
_DDS_NAME = re.compile(r"(\w+)::(msg|srv|action)::dds_::(\w+)_")
LONGEST_TOKEN = 4096


@immutable
class RosQuality:
    """The quality of service of a publisher or subscription: what differs from the defaults of rmw_zenoh is said."""

    reliable: bool = True
    transient_local: bool = False
    keep_all: bool = False
    depth: int = 42
    period: float | None = None
    """Seconds from one message to the next at most, if a deadline is said."""

    @classmethod
    def parse(cls, text: str) -> RosQuality:
        """Read `reliability:durability:history,depth:s,ns:s,ns:liveliness,s,ns`. Raises PeerError."""
        parts = text.split(":")
        try:
            reliability, durability, kept, deadline, _, _ = parts
            history, depth = kept.split(",")
            seconds, nanoseconds = deadline.split(",")
            period, kept_messages = int(seconds or 0) + int(nanoseconds or 0) / 1e9, int(depth or 42)
            if kept_messages < 0:
                raise ValueError(depth)
            return cls(
                reliability in ("", "1"),
                durability == "1",
                history == "2",
                kept_messages,
                period if 0 < period < 1e6 else None,
            )
        except (ValueError, OverflowError):  # a whole number may be longer than any number of seconds
            raise PeerError(f"{text[:80]!r} is no quality of service of rmw_zenoh") from None

    def falls_short_of(self, wanted: RosQuality) -> str | None:
        """In words why ROS 2 connects no publisher of this quality to a subscription of another; None if it does."""
        if wanted.reliable and not self.reliable:
            return "best_effort, not reliable"
        if wanted.transient_local and not self.transient_local:
            return "volatile, not transient_local"
        if wanted.period is not None and (self.period is None or self.period > wanted.period):
            promised = "no deadline" if self.period is None else f"a deadline of {self.period:g} s"
            return f"with {promised}, not one of {wanted.period:g} s"
        return None

    def __str__(self) -> str:
        seconds = "" if self.period is None else str(int(self.period))
        nanoseconds = "" if self.period is None else str(round(self.period % 1 * 1e9))
        depth = "" if self.depth == 42 else str(self.depth)
        reliability, durability, history = (
            "" if self.reliable else "2",
            "1" if self.transient_local else "",
            "2" if self.keep_all else "",
        )
        return f"{reliability}:{durability}:{history},{depth}:{seconds},{nanoseconds}:,:,,"


@immutable
class RosNodeId:
    """Which node of which session of a domain."""

    domain: int
    session: str
    number: int


NodeIdentity = tuple[str, str]
"""Which node it is: the session, and its name with namespace. A session may say the same node by several numbers."""


@immutable
class RosEndpoint:
    """A topic that a node publishes or is subscribed to, or a service that it serves or is a client of."""

    entity: int
    kind: str
    topic: str
    """Its name with namespaces, beginning with a slash."""
    type: MessageType
    quality: RosQuality = RosQuality()

    def key(self, domain: int) -> str:
        """The key on which messages of the topic travel, or calls of the service."""
        package, segment, name = self.type.name.split("/")
        return f"{domain}/{self.topic.strip('/')}/{package}::{segment}::dds_::{name}_/{self.type.hash}"


@immutable
class RosToken:
    """A liveliness token: of a node, or of one of its endpoints."""

    node: RosNodeId
    namespace: str
    name: str
    kind: str = NODE
    endpoint: RosEndpoint | None = None

    @property
    def full_name(self) -> str:
        """The name of the node with its namespace, such as `/front/lidar`."""
        return f"{self.namespace.rstrip('/')}/{self.name}"

    @property
    def identity(self) -> NodeIdentity:
        """Which node it is of."""
        return self.node.session, self.full_name

    @classmethod
    def parse(cls, key: str) -> RosToken:
        """Read the key of a token. Raises PeerError for what is none, or of a dialect that is not known."""
        found = _TOKEN.fullmatch(key) if len(key) <= LONGEST_TOKEN else None
        if found is None or (found["kind"] == NODE) != (found["topic"] is None):
            raise PeerError(f"{key[:160]!r} is no token of rmw_zenoh")
        node = RosNodeId(int(found["domain"]), found["session"], int(found["node"]))
        namespace, name, kind = found["namespace"].replace("%", "/"), found["name"].replace("%", "/"), found["kind"]
        if kind == NODE:
            return cls(node, namespace, name, kind)
        if not HASH.fullmatch(found["hash"]):
            raise PeerError(
                f"the types of the node {namespace.rstrip('/')}/{name} have no hash, as in humble; a bridge speaks with"
                " jazzy, kilted and lyrical"
            )
        dds = _DDS_NAME.fullmatch(found["type"].replace("%", "/"))
        kind_name = "/".join(dds.groups()) if dds else ""
        if not NAME.fullmatch(kind_name):
            raise PeerError(f"{found['type'][:80]!r} is no type of messages or services")
        quality = RosQuality.parse(found["quality"])
        topic = found["topic"].replace("%", "/")
        if not all(topic.strip("/").split("/")):  # no key has an empty part
            raise PeerError(f"{topic[:80]!r} is no name of a topic or service")
        message_type = MessageType(kind_name, found["hash"])
        return cls(node, namespace, name, kind, RosEndpoint(int(found["entity"]), kind, topic, message_type, quality))

    def key(self) -> str:
        """The key of the token."""
        entity = self.node.number if self.endpoint is None else self.endpoint.entity
        who = f"{_mangled('')}/{_mangled(self.namespace.rstrip('/'))}/{_mangled(self.name)}"
        head = f"{ROOT}/{self.node.domain}/{self.node.session}/{self.node.number}/{entity}/{self.kind}/{who}"
        if self.endpoint is None:
            return head
        package, segment, name = self.endpoint.type.name.split("/")
        dds = f"{package}::{segment}::dds_::{name}_"
        return f"{head}/{_mangled(self.endpoint.topic)}/{dds}/{self.endpoint.type.hash}/{self.endpoint.quality}"


def _mangled(name: str) -> str:
    return name.replace("/", "%") or "%"
