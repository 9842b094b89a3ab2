"""Nodes by zenoh-ros2-sdk, which nobody here wrote: a component hears their talker, and their listener hears it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from importlib.util import find_spec
from pathlib import Path

import pytest

from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire
from tests.bridging.ros2.nodes import DOMAIN, bridging_domain, lines_of, node, reader
from tests.sdk.living import LivingStage, until

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
pytestmark = [
    pytest.mark.process,
    pytest.mark.skipif(
        find_spec("zenoh_ros2_sdk") is None, reason="zenoh-ros2-sdk, whose nodes are the judges, is not installed"
    ),
]
ROOT = Path(__file__).parents[3]
NODE = ROOT / "examples" / "ros2" / "node.py"
STARTS = 40.0
"""Seconds that a process with a node may take to be there."""


@pytest.fixture
def judges(living: LivingStage) -> Iterator[dict[str, subprocess.Popen[str]]]:
    """A talker on `/one`, a listener on `/two`, a server of `/three` and a client of `/four`, each a process."""
    port, domain = living.endpoint.rpartition(":")[2], str(DOMAIN)
    adding = ("-m", "tests.bridging.ros2.adding_node")
    commands = {
        "talker": (str(NODE), "talker", "/one", "--port", port, "--domain", domain),
        "listener": (str(NODE), "listener", "/two", "--port", port, "--domain", domain),
        "server": (*adding, "server", "/three", port, domain),
        "client": (*adding, "client", "/four", port, domain),
    }
    found = {
        kind: subprocess.Popen(
            [sys.executable, "-u", *command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, cwd=ROOT
        )
        for kind, command in commands.items()
    }
    yield found
    for process in found.values():
        process.kill()
        process.wait()
        if process.stdout is not None:
            process.stdout.close()


def test_components_and_foreign_nodes_feed_each_other(
    living: LivingStage, tmp_path: Path, judges: dict[str, subprocess.Popen[str]]
) -> None:
    with bridging_domain(living, tmp_path / "ads") as found:
        assert until(lambda: found.lives("talker") and found.lives("listener"), STARTS), found.complaints
        found.activate("talker")
        component = reader(living, text=(Wire(node("talker"), "one"),))
        found.activate("listener", two=(Wire(IRI("urn:c:reader"), "text"),))
        assert until(lambda: len(component.heard) > 2)
        assert component.heard[0][0]["data"].startswith("talker ")
        heard, answered = lines_of(judges["listener"]), lines_of(judges["client"])

        def arrives() -> bool:  # what is issued before a subscription is known is lost, as in ROS 2
            component.emit("text", {"data": "hello"})
            return bool(heard)

        assert until(arrives)
        assert heard[0] == "heard hello\n"
        assert until(lambda: found.lives("server") and found.lives("client"), STARTS), found.complaints
        found.activate("server", {"three()": (node("client"),)})
        found.activate("client", **{"four()": (Wire(node("server"), "three()"),)})
        assert until(lambda: "answered 42\n" in answered, STARTS), found.complaints
        judges["talker"].kill()
        assert until(lambda: found.causes() == [f"the node /talker has left the domain {DOMAIN} of ROS 2"])
        assert until(lambda: not found.lives("talker"))
        assert found.lives("listener")
