"""Nodes by zenoh-ros2-sdk, which nobody here wrote: a component hears their talker, and their listener hears it."""

from __future__ import annotations

import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from selfconf.model.term import IRI
from selfconf.protocol.messages import Wire
from tests.bridging.ros2.nodes import DOMAIN, bridging_domain, node, reader
from tests.sdk.living import LivingStage, until

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
pytest.importorskip("zenoh_ros2_sdk", reason="zenoh-ros2-sdk, whose nodes are the judges, is not installed")
pytestmark = pytest.mark.process
NODE = Path(__file__).parents[3] / "examples" / "ros2" / "node.py"
STARTS = 40.0
"""Seconds that a process with a node may take to be there."""


@pytest.fixture
def judges(living: LivingStage) -> Iterator[dict[str, subprocess.Popen[str]]]:
    """A talker on `/one` and a listener on `/two`, each a process."""
    port = living.endpoint.rpartition(":")[2]
    found = {
        kind: subprocess.Popen(
            [sys.executable, "-u", str(NODE), kind, topic, "--port", port, "--domain", str(DOMAIN)],
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        for kind, topic in (("talker", "/one"), ("listener", "/two"))
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
        heard: list[str] = []
        threading.Thread(target=lambda: heard.extend(judges["listener"].stdout or ()), daemon=True).start()

        def arrives() -> bool:  # what is issued before a subscription is known is lost, as in ROS 2
            component.emit("text", {"data": "hello"})
            return bool(heard)

        assert until(arrives)
        assert heard[0] == "heard hello\n"
        judges["talker"].kill()
        assert until(lambda: found.causes() == [f"the node /talker has left the domain {DOMAIN} of ROS 2"])
        assert until(lambda: not found.lives("talker"))
        assert found.lives("listener")
