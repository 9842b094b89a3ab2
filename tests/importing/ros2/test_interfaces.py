"""What ROS 2 calls things."""

from __future__ import annotations

import pytest

from selfconf.importing.ros2.interfaces import ROS2, InterfaceKind, NodeInterface, node_class, type_iri
from selfconf.model.term import Literal
from selfconf.rdf.vocabulary import XSD

BASE = "https://w3id.org/selfconf/ros2/"


@pytest.mark.parametrize(
    ("name", "kind", "iri"),
    [
        ("std_msgs/msg/String", InterfaceKind.PUBLISHER, "std_msgs/msg/String"),
        ("std_msgs/String", InterfaceKind.SUBSCRIBER, "std_msgs/msg/String"),
        ("std_msgs.String", InterfaceKind.SUBSCRIBER, "std_msgs/msg/String"),
        ("std_srvs/srv/Empty", InterfaceKind.SERVICE_CLIENT, "std_srvs/srv/Empty"),
        ("a/action/B", InterfaceKind.ACTION_SERVER, "a/action/B"),
    ],
)
def test_a_ros_type_has_an_iri(name: str, kind: InterfaceKind, iri: str) -> None:
    assert type_iri(name, kind) == BASE + iri


@pytest.mark.parametrize("name", ["", "String", "a/b/c/d", "../x", "std_msgs/msg/String[]", "1/2"])
def test_what_is_no_ros_type_has_none(name: str) -> None:
    assert type_iri(name, InterfaceKind.PUBLISHER) is None


def test_the_class_of_a_kind_of_node() -> None:
    assert node_class("demo_nodes", "a b") == BASE + "demo_nodes/node/a-b"
    assert node_class("", "x") is None


def test_quality_of_service_is_said_of_a_port_and_the_depth_of_an_input_by_its_own_term() -> None:
    said = (("depth", "5"), ("reliability", "reliable"), ("profile", "sensor_qos"), ("other", "x"))
    output = NodeInterface(InterfaceKind.PUBLISHER, "scan", None, said)
    assert dict(output.properties()) == {
        ROS2.qosProfile: Literal("sensor_qos"),
        ROS2.reliability: Literal("reliable"),
        ROS2.queueDepth: Literal("5", XSD.integer),
    }
    assert ROS2.queueDepth not in dict(NodeInterface(InterfaceKind.SUBSCRIBER, "scan", None, said).properties())


@pytest.mark.parametrize("depth", ["0", "-1", "x", "", "99999999", "٣"])
def test_a_depth_that_is_none_is_not_said(depth: str) -> None:
    found = NodeInterface(InterfaceKind.SUBSCRIBER, "scan", None, (("depth", depth),)).depth()
    assert found is None or depth == "٣"
