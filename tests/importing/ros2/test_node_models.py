"""Models of ROS 2 packages."""

from __future__ import annotations

from selfconf.errors import AuthorError
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.interfaces import InterfaceKind, NodeInterface
from selfconf.importing.ros2.model_text import parse_model
from selfconf.importing.ros2.node_models import NodeModel, node_models
from selfconf.importing.sources import SourceDocument

TEXT = """
demo:
  fromGitRepo: "https://example.org/x.git:main"
  artifacts:
    lidar:
      node: lidar_node
      publishers:
        scan:
          type: "sensor_msgs/msg/LaserScan"
          qos:
            depth: 5
            deadline: 10
            lease_duration: 2s
          frame: base
        odd: word
      subscribers:
        flow: {type: "std_msgs/msg/String", qos: {depth: many, reliability: best_effort}}
      actionclients:
        go:
          type: 'nav2_msgs/action/NavigateToPose'
          ns: GlobalNamespace
      parameters:
        rate:
          type: Double
          default: 1.2
          value: 1.5
          qos:
            profile: parameter_qos
          unit: Hz
      odd: 1
empty:
  dependencies: [ a, b ]
"""


def test_a_node_has_the_interfaces_of_its_blocks_and_the_rest_is_named() -> None:
    ledger = ImportLedger("urn:x:", list[AuthorError]().append)
    source = SourceDocument("x.ros2", "x.ros2", TEXT.encode())
    (node,) = node_models(parse_model(source), source, ledger)
    assert node == NodeModel(
        source,
        "demo",
        "lidar",
        "lidar_node",
        (
            NodeInterface(
                InterfaceKind.PUBLISHER,
                "scan",
                "sensor_msgs/msg/LaserScan",
                (("depth", "5"), ("deadline", "10"), ("lease_duration", "2s")),
            ),
            NodeInterface(InterfaceKind.PUBLISHER, "odd"),
            NodeInterface(
                InterfaceKind.SUBSCRIBER,
                "flow",
                "std_msgs/msg/String",
                (("depth", "many"), ("reliability", "best_effort")),
            ),
            NodeInterface(InterfaceKind.ACTION_CLIENT, "go", "nav2_msgs/action/NavigateToPose"),
        ),
        (("rate", "Double"),),
    )
    assert {each.what for each in ledger.omissions()} == {
        "entries 'fromGitRepo' of packages",
        "entries 'dependencies' of packages",
        "entries 'frame' of interfaces",
        "values of interfaces",
        "the quality of service 'deadline'",
        "the quality of service 'lease_duration'",
        "the quality of service 'depth'",
        "defaults of parameters",
        "values of parameters",
        "quality of service of parameters",
        "entries 'unit' of parameters",
        "entries 'odd' of nodes",
        "namespaces of interfaces",
        "packages without artifacts",
    }
