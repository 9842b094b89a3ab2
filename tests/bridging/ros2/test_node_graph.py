"""The nodes that live are written down as they are, and again in the same way."""

from __future__ import annotations

from pathlib import Path

import pytest

from selfconf.api.living.living_import import import_living_nodes
from selfconf.bridging.ros2 import living_graph
from selfconf.bus.zenoh import client
from selfconf.importing import FileState, ImportLedger, described_text
from tests.bridging.ros2.action_parts import parts_of
from tests.bridging.ros2.nodes import ADD_KEY, DOMAIN, StandIn, bridging_domain
from tests.sdk.living import LivingStage, until

SESSION = "a" * 32


def graph(stage: LivingStage) -> tuple[dict[str, str], list[str]]:
    """The nodes that live, by their names, and what was left out or could not be read."""
    bus, complaints = client([stage.endpoint]), list[str]()
    ledger = ImportLedger("urn:test:", lambda error: complaints.append(str(error)))
    try:
        found = {each.name: described_text(each) for each in living_graph(bus, DOMAIN, ledger)}
    finally:
        bus.close()
    return found, [*complaints, *map(str, ledger.omissions())]


def test_each_node_is_described_by_the_graph_alone(living: LivingStage) -> None:
    first, second = (StandIn(living.endpoint, "lidar", character * 32) for character in "ab")
    first.token("MP", "/zeta")
    first.token("MS", "/alpha")
    first.token("SS", "/add", key=ADD_KEY)
    first.token("MP", "/rosout")
    first.token("MP", "/dock/_action/status")
    for part in parts_of("/turn"):
        package, segment, name = part.type.name.split("/")
        first.token(part.kind, part.topic, key=f"{package}::{segment}::dds_::{name}_/{part.type.hash}")
    first.bus.announce(f"@ros2_lv/{DOMAIN}/nonsense")
    try:
        assert until(lambda: "turn/feedback" in str(graph(living)))
        found, complaints = graph(living)
        assert (found, complaints) == graph(living)
        assert list(found) == ["lidar"]
        text = found["lidar"]
        assert text.index("alpha") < text.index("zeta") < text.index("AddTwoInts")
        assert f"<urn:test:{DOMAIN}/lidar> a sc:Component, ros2:Node" in text
        for words in (
            "is no token",
            "further nodes of one name (1)",
            "hidden topics and services (1)",
            "topics of logs",
        ):
            assert any(words in one for one in complaints), complaints
    finally:
        for one in (first, second):
            one.close()


def test_an_import_of_what_lives_is_what_a_bridge_advertises_and_stays_the_same(
    living: LivingStage, tmp_path: Path
) -> None:
    pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
    with bridging_domain(living, tmp_path / "ads") as found:
        node = found.node("talker")
        node.publishes("/chatter")
        assert until(lambda: found.lives("talker"))
        report = import_living_nodes(living.endpoint, DOMAIN, tmp_path / "written")
        ((written,), head) = (report.files, "importing again replaces this file.\n\n")
        assert written.path.read_text().partition(head)[2] == found.advertised().partition("\n\n")[2]
        node.token("MS", "/more")

        def written_anew() -> bool:
            (again,) = import_living_nodes(living.endpoint, DOMAIN, tmp_path / "written").files
            return again.state is FileState.CHANGED

        assert until(written_anew)
        (again,) = import_living_nodes(living.endpoint, DOMAIN, tmp_path / "written").files
        assert again.state is FileState.UNCHANGED
