"""Who is connected to whom."""

from __future__ import annotations

from selfconf.errors import AuthorError
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.interfaces import InterfaceKind, NodeInterface
from selfconf.importing.ros2.node_models import NodeModel
from selfconf.importing.ros2.system_models import ExposedInterface, SystemModel, SystemNode
from selfconf.importing.ros2.wiring import SystemWiring
from selfconf.importing.sources import SourceDocument

SOURCE = SourceDocument("x", "x", b"")
TWIST, SCAN = "geometry_msgs/msg/Twist", "sensor_msgs/msg/LaserScan"
PUB, SUB, SS, SC = (
    InterfaceKind.PUBLISHER, InterfaceKind.SUBSCRIBER, InterfaceKind.SERVICE_SERVER, InterfaceKind.SERVICE_CLIENT,
)  # fmt: skip
PUBLISHED = NodeInterface(PUB, "scan", SCAN)
MODELS = (
    NodeModel(SOURCE, "p", "lidar", "lidar_node", (PUBLISHED, NodeInterface(SS, "reset", "a/B"))),
    NodeModel(
        SOURCE,
        "p",
        "stop",
        "stop",
        (NodeInterface(SUB, "scan", SCAN), NodeInterface(SC, "reset", "a/B"), NodeInterface(SUB, "cmd", TWIST)),
    ),
)


def node(name: str, model: str, **exposed: InterfaceKind) -> SystemNode:
    """A node that exposes interfaces by names that begin with those of its model."""
    return SystemNode(
        name,
        model,
        "",
        tuple(ExposedInterface(label, kind, f"x::{label.partition('_')[0]}") for label, kind in exposed.items()),
    )


LIDAR = node("front", "p.lidar", scan_out=PUB, reset_srv=SS)
STOP = node("stop", "p.stop", scan_in=SUB, cmd_in=SUB, reset_client=SC)


def wiring(*systems: SystemModel) -> tuple[SystemWiring, dict[str, int]]:
    ledger = ImportLedger("urn:x:", list[AuthorError]().append)
    found = SystemWiring(systems, MODELS, ledger)
    return found, {f"{each.what}: {each.reason}": each.number for each in ledger.omissions()}


def system(
    name: str, nodes: tuple[SystemNode, ...], *pairs: tuple[str, str], parts: tuple[str, ...] = ()
) -> SystemModel:
    return SystemModel(SOURCE, name, nodes, parts, pairs)


def named(found: SystemWiring, name: str) -> list[tuple[str, str, str, str]]:
    (system,) = (each for each in found.systems if each.name == name)
    return [(p.source.node.name, p.output.name, p.sink.node.name, p.input.name) for p in found.pairs(system)]


def test_connections_lead_from_who_publishes_or_serves_whichever_end_is_named_first() -> None:
    found, left_out = wiring(system("s", (LIDAR, STOP), ("scan_in", "scan_out"), ("reset_srv", "reset_client")))
    assert named(found, "s") == [
        ("front", "scan_out", "stop", "scan_in"),
        ("front", "reset_srv", "stop", "reset_client"),
    ]
    assert left_out == {}
    assert found.used == set(MODELS)


def test_a_connection_may_lead_into_a_part() -> None:
    base, whole = system("base", (LIDAR,)), system("s", (STOP,), ("scan_out", "scan_in"), parts=("base", "gone"))
    found, left_out = wiring(whole, base)
    assert named(found, "s") == [("front", "scan_out", "stop", "scan_in")]
    assert [instance.key for instance in found.members(whole)] == [("s", "stop"), ("base", "front")]
    assert list(left_out) == ["subsystems: their models are not among the sources"]


def test_a_whole_has_the_connections_of_its_parts_and_of_theirs_each_once() -> None:
    inner = system("inner", (LIDAR, STOP), ("scan_out", "scan_in"))
    base = system("base", (), ("reset_srv", "reset_client"), parts=("inner",))
    whole = system("s", (node("rear", "p.stop", cmd_rear=SUB),), ("scan_out", "scan_in"), parts=("base", "inner"))
    found, left_out = wiring(whole, base, inner)
    pairs = [("front", "scan_out", "stop", "scan_in"), ("front", "reset_srv", "stop", "reset_client")]
    assert named(found, "s") == pairs
    assert [pair.input.name for pair in found.own_pairs(whole)] == ["scan_in"]
    assert named(found, "base") == pairs[::-1]
    assert left_out == {}
    stop = found.own(inner)[1]
    assert [each.name for each in stop.interfaces if found.required(stop, each)] == ["scan_in"]


def test_systems_that_are_parts_of_each_other_end() -> None:
    one, two = system("one", (LIDAR,), parts=("two",)), system("two", (STOP,), parts=("one",))
    found, _ = wiring(one, two)
    assert len(found.members(one)) == len(found.members(two)) == 2


def test_a_connection_that_makes_no_sense_is_left_out() -> None:
    twice = (LIDAR, node("rear", "p.lidar", scan_out=PUB), STOP)
    pairs = (("scan_out", "scan_in"), ("gone", "scan_in"), ("reset_srv", "scan_in"))
    found, left_out = wiring(system("s", twice, *pairs))
    assert named(found, "s") == []
    assert sum(left_out.values()) == 3
    found, left_out = wiring(system("s", (LIDAR, STOP), ("scan_out", "cmd_in")))
    assert list(left_out) == ["connections: their ends are of different types"]


def test_an_input_is_required_where_every_system_that_has_its_node_connects_it() -> None:
    base, whole = system("base", (STOP,)), system("s", (LIDAR,), ("scan_out", "scan_in"), parts=("base",))
    found, _ = wiring(whole, base)
    (stop,) = found.own(base)
    assert [found.required(stop, each) for each in stop.interfaces] == [False] * 3
    alone, _ = wiring(system("s", (LIDAR, STOP), ("scan_out", "scan_in")))
    stop = alone.own(alone.systems[0])[1]
    assert {each.name: alone.required(stop, each) for each in stop.interfaces} == {
        "scan_in": True, "cmd_in": False, "reset_client": False,
    }  # fmt: skip


def test_a_node_without_a_model_has_the_interfaces_that_it_exposes_without_types() -> None:
    found, left_out = wiring(system("s", (node("x", "q.gone", scan_out=PUB), STOP), ("scan_out", "scan_in")))
    assert found.own(found.systems[0])[0].interfaces == (NodeInterface(PUB, "scan_out"),)
    assert named(found, "s") == [("x", "scan_out", "stop", "scan_in")]
    assert len(left_out) == 1


def test_what_is_not_exposed_keeps_its_name_and_what_is_not_in_the_model_has_no_type() -> None:
    found, left_out = wiring(system("s", (node("front", "p.lidar", odd_out=PUB),)))
    assert [(each.name, each.type) for each in found.own(found.systems[0])[0].interfaces] == [
        ("odd_out", None), ("scan", SCAN), ("reset", "a/B"),
    ]  # fmt: skip
    assert list(left_out) == [
        "types of interfaces that the model of their node does not have: they are kept without a type"
    ]
