"""How much of what a ROS 2 node publishes arrives through the bridge, and how much later, beside a direct subscription.

    python -m benchmarks.bridge [--seconds 10] [--smoke] [--write]

A node publishes on one topic; the bridge and the configurator of a task are processes of their own, and the task
connects the node to another one with another topic. A subscription of Zenoh to the first topic and one to the second
count side by side, in the same seconds: messages a second, the ratio of both, and by how much later a message comes
over the second topic, which holds two more hops and the bridge.
"""

from __future__ import annotations

import argparse
import os
import secrets
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from pathlib import Path
from typing import Any, NamedTuple

from benchmarks.machine import described, quantile, table
from benchmarks.quiet import until_quiet
from selfconf import ros2
from selfconf.bridging.ros2.attachments import RosAttachment
from selfconf.bridging.ros2.tokens import PUBLISHER, SUBSCRIPTION, RosEndpoint, RosNodeId, RosToken
from selfconf.bus.port import Sample, Urgency
from selfconf.bus.zenoh import ZenohBus, client, router

DOMAIN = 7
PATIENCE = 60.0
PAGE = Path(__file__).parents[1] / "docs" / "benchmarks" / "bridge.md"
INTRODUCTION = """# The bridge to ROS 2

Made by `python -m benchmarks.bridge --write`; what is measured is told at the head of that file. Published, direct and
relayed are messages a second.

"""
TASK = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix ros2: <https://w3id.org/selfconf/ros2#> .
<urn:relay> a sc:Template ; sc:roles ( <urn:source> <urn:sink> ) .
<urn:source> a sc:Role ; sh:class ros2:Node ; sc:feeds <urn:sink> ;
    sh:property [ sh:path ros2:nodeName ; sh:hasValue "source" ] .
<urn:sink> a sc:Role ; sh:class ros2:Node ; sh:property [ sh:path ros2:nodeName ; sh:hasValue "sink" ] .
"""


class Load(NamedTuple):
    """What is published: a type with its fields, so many times a second."""

    kind: str
    fields: Mapping[str, Any]
    rate: float


class Relayed(NamedTuple):
    """What has come of a load: bytes of a message, messages a second both ways, and by how much later, in seconds."""

    load: Load
    size: int
    direct: float
    relayed: float
    later: list[float]


LOADS = (
    Load("sensor_msgs/msg/LaserScan", {"ranges": [1.0] * 720}, 40.0),
    Load("sensor_msgs/msg/Image", {"height": 480, "width": 640, "step": 1920, "data": bytes(921_600)}, 30.0),
    Load("std_msgs/msg/String", {"data": "hello"}, 1000.0),
)


class Arrivals:
    """When each message has arrived, by its time as its publisher has stamped it."""

    def __init__(self) -> None:
        self.moments: dict[int, float] = {}

    def received(self, sample: Sample) -> None:
        """Note a message."""
        self.moments.setdefault(RosAttachment.unpack(sample.attachment).nanoseconds // 1000, time.monotonic())


def measured(load: Load, seconds: float) -> Relayed:
    """Publish a load for so many seconds, and count what arrives."""
    kind = ros2.usual_type(load.kind)
    assert kind is not None
    payload = ros2.message(load.fields, kind)
    ends = RosEndpoint(1, PUBLISHER, "/source", kind), RosEndpoint(1, SUBSCRIPTION, "/sink", kind)
    with ExitStack() as stack:
        hub = router()
        hub.run_aside()
        stack.callback(hub.close)
        direct, relayed = Arrivals(), Arrivals()
        nodes = [_node(stack, hub.endpoint, name, end) for name, end in zip(("source", "sink"), ends, strict=True)]
        nodes[1].subscribe(ends[1].key(DOMAIN), relayed.received, direct=True)
        observer = client([hub.endpoint])
        stack.callback(observer.close)
        observer.run_aside()
        observer.subscribe(ends[0].key(DOMAIN), direct.received, direct=True)
        declared = nodes[0].publisher(ends[0].key(DOMAIN), Urgency.SIGNAL)

        def publish(number: int) -> None:
            stamped = RosAttachment(number, time.time_ns() // 1000 * 1000, b"the source's own")
            declared.put(payload, stamped.pack())

        _start(stack, hub.endpoint)

        def arrives() -> bool:
            publish(0)
            return bool(relayed.moments)

        _until(arrives)
        _publish_at(load.rate, seconds, publish, direct, relayed)
        common = direct.moments.keys() & relayed.moments.keys()
        later = [relayed.moments[one] - direct.moments[one] for one in common]
        return Relayed(load, len(payload), len(direct.moments) / seconds, len(relayed.moments) / seconds, later)


def _publish_at(rate: float, seconds: float, publish: Callable[[int], None], *arrivals: Arrivals) -> None:
    """Publish at a rate, and wait until all has arrived; a message that is late is published at once."""

    def arrived() -> list[int]:
        return [len(each.moments) for each in arrivals]

    until_quiet(arrived)
    for each in arrivals:
        each.moments.clear()
    began = time.monotonic()
    for number in range(1, int(rate * seconds) + 1):
        publish(number)
        time.sleep(max(0.0, began + number / rate - time.monotonic()))  # until the next one is due
    until_quiet(arrived)


def _node(stack: ExitStack, endpoint: str, name: str, end: RosEndpoint) -> ZenohBus:
    """A node of ROS 2 with one topic."""
    bus = client([endpoint])
    stack.callback(bus.close)
    bus.run_aside()
    node = RosNodeId(DOMAIN, secrets.token_hex(16), 0)
    bus.announce(RosToken(node, "", name).key())
    bus.announce(RosToken(node, "", name, end.kind, end).key())
    return bus


def _start(stack: ExitStack, endpoint: str) -> None:
    """Start a bridge, and the task."""
    folder = Path(stack.enter_context(tempfile.TemporaryDirectory()))
    (folder / "relay.ttl").write_text(TASK)
    environment = {**os.environ, "SELFCONF_RUNTIME_DIR": str(folder / "runtime"), "SELFCONF_ECOLOGY": "relay"}
    domain = ("--connect", endpoint, "--domain", str(DOMAIN))
    bridge = _process(stack, environment, "bridge", "ros2", *domain)
    _until(lambda: bridge.poll() is not None or any((folder / "runtime").glob("*.json")))
    _process(stack, environment, "run", str(folder / "relay.ttl"), "--wait")


def _process(stack: ExitStack, environment: Mapping[str, str], *arguments: str) -> subprocess.Popen[bytes]:
    command = [sys.executable, "-m", "selfconf", *arguments]
    silent = subprocess.DEVNULL
    process = subprocess.Popen(command, env=environment, stdout=silent, stderr=silent)

    def end() -> None:
        process.terminate()
        process.wait()

    stack.callback(end)
    return process


def _until(condition: Callable[[], object]) -> None:
    deadline, pause = time.monotonic() + PATIENCE, threading.Event()
    while not condition():
        if time.monotonic() > deadline:
            raise SystemExit("the bridge relays nothing")
        pause.wait(0.1)


def report(found: list[Relayed]) -> str:
    """The table."""
    head = ("message", "bytes", "published", "direct", "relayed", "ratio", "later (ms), median", "p99")
    rows = [
        (
            one.load.kind,
            f"{one.size:,}",
            f"{one.load.rate:g}",
            f"{one.direct:.1f}",
            f"{one.relayed:.1f}",
            f"{one.relayed / one.direct:.2f}" if one.direct else "-",
            *(f"{1000 * quantile(one.later, share):.2f}" if one.later else "-" for share in (0.5, 0.99)),
        )
        for one in found
    ]
    return table(head, rows)


def main() -> None:
    """Measure, print the table, and write the page if asked to."""
    parser = argparse.ArgumentParser(description="the bridge to ROS 2 beside a direct subscription")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--smoke", action="store_true", help="a short run, to see that it works")
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name}")
    given = parser.parse_args()
    loads, seconds = (LOADS[:1], 1.0) if given.smoke else (LOADS, given.seconds)
    page = report([measured(load, seconds) for load in loads])
    page = f"{page}\n\nMeasured on {described('eclipse-zenoh', 'rosbags')}.\n"
    print(page, end="")
    if given.write:
        PAGE.write_text(INTRODUCTION + page)


if __name__ == "__main__":
    main()
