"""Models of ROS 2 systems."""

from __future__ import annotations

from selfconf.errors import AuthorError
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.interfaces import InterfaceKind
from selfconf.importing.ros2.model_text import parse_model
from selfconf.importing.ros2.system_models import ExposedInterface, SystemModel, SystemNode, system_models
from selfconf.importing.sources import SourceDocument

TEXT = """
robot:
  fromFile: 'pkg/launch/x.launch.py'
  subSystems:
    base
    - arm
  nodes:
    node1:
      from: "pkg.lidar"
      namespace: "front"
      interfaces:
        - scan: pub-> "lidar::scan"
        - reset : ss-> 'lidar::reset'
        - odd: "lidar::odd"
      parameters:
        - p: "lidar::p"
          value: [ first: 2
                   second: true ]
  connections:
    -[ scan , laser]
    - ["scan", "laser"]
    - [ a ]
  processes:
    one:
      threads: 2
"""


def test_a_system_has_nodes_parts_and_connections_and_the_rest_is_named() -> None:
    ledger = ImportLedger("urn:x:", list[AuthorError]().append)
    source = SourceDocument("x", "x", TEXT.encode())
    (system,) = system_models(parse_model(source), source, ledger)
    exposed = (
        ExposedInterface("scan", InterfaceKind.PUBLISHER, "lidar::scan"),
        ExposedInterface("reset", InterfaceKind.SERVICE_SERVER, "lidar::reset"),
    )
    node = SystemNode("node1", "pkg.lidar", "front", exposed)
    assert system == SystemModel(source, "robot", (node,), ("base", "arm"), (("scan", "laser"),))
    assert {each.what for each in ledger.omissions()} == {
        "launch files", "processes", "connections that are no pairs", "interfaces of no kind", "values of parameters",
    }  # fmt: skip
