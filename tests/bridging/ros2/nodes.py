"""Nodes of ROS 2 for tests: their tokens, keys and attachments are written out here, as rmw_zenoh writes them."""

from __future__ import annotations

import struct
import subprocess
import threading
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from typing import Any

from selfconf.bridging.bridge import Bridge
from selfconf.bridging.ros2.ros_world import RosWorld
from selfconf.bus.port import Publisher, Replies, Request, Sample, Urgency
from selfconf.bus.zenoh import ZenohBus, client
from selfconf.model.term import IRI
from selfconf.protocol.messages import Apply, CallAnswer, Reserve, Wire
from selfconf.sdk import Component, Signal
from tests.ros2.test_messages import STRING_HASH
from tests.sdk.living import LivingStage, until

DOMAIN = 42
STRING_KEY = f"std_msgs::msg::dds_::String_/{STRING_HASH}"
ADD_HASH = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"
"""Of example_interfaces/srv/AddTwoInts, as the design of rmw_zenoh says it."""
ADD_KEY = f"example_interfaces::srv::dds_::AddTwoInts_/{ADD_HASH}"
USUAL = "::,10:,:,:,,"
STRING = "<https://w3id.org/selfconf/ros2/std_msgs/msg/String>"


def text(words: str) -> bytes:
    """A message of type std_msgs/msg/String."""
    octets = words.encode() + b"\0"
    return b"\x00\x01\x00\x00" + struct.pack("<I", len(octets)) + octets


class StandIn:
    """A node in a session of its own."""

    def __init__(self, endpoint: str, name: str, session: str) -> None:
        self.name, self._session, self._entity = name, session, 0
        self.bus: ZenohBus = client([endpoint])
        self.bus.run_aside()
        self._numbers = 0
        self.leave = self.bus.announce(f"@ros2_lv/{DOMAIN}/{session}/0/0/NN/%/%/{name}")

    def token(self, kind: str, topic: str, quality: str = USUAL, key: str = STRING_KEY) -> Callable[[], None]:
        """Say that the node has an endpoint; the result takes it back."""
        self._entity += 1
        where = f"@ros2_lv/{DOMAIN}/{self._session}/0/{self._entity}/{kind}/%/%/{self.name}"
        return self.bus.announce(f"{where}/{topic.replace('/', '%')}/{key}/{quality}")

    def publishes(self, topic: str, quality: str = USUAL, key: str = STRING_KEY) -> Callable[[bytes], None]:
        """Have the node publish on a topic; the result publishes the octets of a message."""
        self.token("MP", topic, quality, key)
        declared: Publisher = self.bus.publisher(f"{DOMAIN}{topic}/{key}", Urgency.SIGNAL)
        identifier = f"{self._session}{self._entity:08d}".encode()[-16:].rjust(16, b"-")

        def publish(payload: bytes) -> None:
            self._numbers += 1
            declared.put(payload, struct.pack("<qqB16s", self._numbers, self._numbers * 10**9, 16, identifier))

        return publish

    def hears(self, topic: str, quality: str = USUAL, key: str = STRING_KEY) -> list[Sample]:
        """Have the node subscribe to a topic; the result grows by what comes there."""
        heard: list[Sample] = []
        self.bus.subscribe(f"{DOMAIN}{topic}/{key}", heard.append)
        self.token("MS", topic, quality, key)
        return heard

    def serves(self, service: str, answer: Callable[[bytes, bytes], tuple[bytes, bytes]], key: str = ADD_KEY) -> None:
        """Have the node serve a service: from the payload and attachment of a request to those of the response."""

        def asked(request: Request) -> None:
            request.reply(f"{DOMAIN}{service}/{key}", *answer(request.payload, request.attachment))
            request.finish()

        self.bus.serve(f"{DOMAIN}{service}/{key}", asked, complete=True)
        self.token("SS", service, USUAL, key)

    def asks(self, service: str, payload: bytes, key: str = ADD_KEY) -> list[Replies]:
        """Call a service, as its client does; the list receives what comes of it."""
        found: list[Replies] = []
        attachment = struct.pack("<qqB16s", 7, 10**9, 16, b"c" * 16)
        self.bus.wake_up(lambda: self.bus.ask(f"{DOMAIN}{service}/{key}", payload, 10.0, found.append, attachment))
        return found

    def close(self) -> None:
        """Be gone, as a process is that was killed."""
        self.bus.close()


class BridgedDomain:
    """A bridge to a domain, and what it has complained of."""

    def __init__(self, stage: LivingStage, folder: Path) -> None:
        self.stage, self.folder = stage, folder
        self.complaints: list[str] = []
        self.bridge = Bridge(folder, self.complaints.append)
        self._nodes: list[StandIn] = []

    def node(self, name: str, session: str = "") -> StandIn:
        """A node that joins the domain."""
        found = StandIn(self.stage.endpoint, name, session or f"{len(self._nodes) + 1:032x}")
        self._nodes.append(found)
        return found

    def lives(self, name: str) -> bool:
        """Whether a node lives on this side."""
        return self.bridge.lives(node(name))

    def is_complete(self, name: str, *ports: str) -> bool:
        """Whether a node lives with some ports or operations: on a busy machine some of its tokens may come late."""
        said = self.advertised()
        return all(f'sc:name "{port}"' in said for port in ports) and self.lives(name)

    def complained(self, words: str) -> bool:
        """Whether some words stand in a complaint."""
        return any(words in complaint for complaint in self.complaints)

    def causes(self) -> list[str]:
        """The reasons of the FAILs so far."""
        return [fail.detail for _, fail in self.stage.fails]

    def activate(
        self, name: str, callers: Mapping[str, tuple[IRI, ...]] | None = None, /, **inputs: tuple[Wire, ...]
    ) -> None:
        """Activate a node, with its inputs fed; `callers` are who may call its operations."""
        answer = self.called_for(name, callers, **inputs)
        assert answer.active, answer

    def called_for(
        self, name: str, callers: Mapping[str, tuple[IRI, ...]] | None = None, /, **inputs: tuple[Wire, ...]
    ) -> CallAnswer:
        """What a node answers that is to be activated."""
        assert until(lambda: self.lives(name)), self.complaints
        held = self.stage.call(node(name), "reserve", Reserve(1, self.stage.supervisor, "task~1"))
        assert until(lambda: held)
        apply = Apply(1, self.stage.supervisor, "task~1", inputs=inputs, callers=callers or {})
        answers = self.stage.call(node(name), "apply", apply)
        assert until(lambda: answers)
        return answers[0]

    def advertised(self) -> str:
        """All that is advertised."""
        texts = []
        for path in sorted(self.folder.glob("*.ttl")):
            with suppress(FileNotFoundError):  # the bridge has taken it away meanwhile
                texts.append(path.read_text())
        return "\n".join(texts)

    def close(self) -> None:
        """Have every node leave."""
        for one in self._nodes:
            one.close()


@contextmanager
def bridging_domain(stage: LivingStage, folder: Path) -> Iterator[BridgedDomain]:
    """Bridge a domain inside the `with` block; its router is that of the ecology, which has other keys."""
    folder.mkdir(exist_ok=True)
    found = BridgedDomain(stage, folder)
    world = partial(RosWorld, partial(client, [stage.endpoint]), DOMAIN)
    with found.bridge.living(world, stage.ecology, stage.node):
        try:
            yield found
        finally:
            found.close()
    assert not stage.hangs


def node(name: str) -> IRI:
    """The component that a node of a name is."""
    return IRI(f"urn:selfconf:ros2:{DOMAIN}/{name}")


def lines_of(judge: subprocess.Popen[str]) -> list[str]:
    """What a judge says; the list grows."""
    found: list[str] = []
    threading.Thread(target=lambda: found.extend(judge.stdout or ()), daemon=True).start()
    return found


class Reader(Component):
    """Receives messages, and issues objects, without knowing anything of ROS 2."""

    def __init__(self) -> None:
        self.heard: list[Any] = []

    def received(self, port: str, signal: Signal) -> None:
        self.heard.append((signal.value, signal.time))


def reader(stage: LivingStage, **inputs: tuple[Wire, ...]) -> Reader:
    """A reader that is active."""
    port = f'[ sc:name "text" ; sc:signalType {STRING} ]'
    kind = stage.advertised(
        Reader, f"<urn:c:reader> a sc:Component, :Reader ; sc:hasInput {port} ; sc:hasOutput {port} ."
    )
    component = stage.component(kind())
    held = stage.call("urn:c:reader", "reserve", Reserve(1, stage.supervisor, "task~1"))
    assert until(lambda: held)
    answers = stage.call("urn:c:reader", "apply", Apply(1, stage.supervisor, "task~1", inputs=inputs))
    assert until(lambda: answers and answers[0].active)
    return component
