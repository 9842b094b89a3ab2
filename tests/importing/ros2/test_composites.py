"""A system that is part of another one is a composite, too: with the ports that it exposes, and its inside."""

from __future__ import annotations

import selfconf
from selfconf.api.answer import Answer
from tests.importing.imports import Workshop, left_out

PACKAGE = """
demo:
  artifacts:
    driver:
      node: driver
      publishers:
        scan:
          type: "sensor_msgs/msg/LaserScan"
        left:
          type: "sensor_msgs/msg/Image"
        right:
          type: "sensor_msgs/msg/Image"
      subscribers:
        rate:
          type: "std_msgs/msg/Float64"
    filter:
      node: filter
      publishers:
        clean:
          type: "sensor_msgs/msg/LaserScan"
      subscribers:
        raw:
          type: "sensor_msgs/msg/LaserScan"
      serviceservers:
        reset:
          type: "std_srvs/srv/Empty"
    planner:
      node: planner
      publishers:
        speed:
          type: "std_msgs/msg/Float64"
      subscribers:
        scan:
          type: "sensor_msgs/msg/LaserScan"
      serviceclients:
        reset:
          type: "std_srvs/srv/Empty"
"""
SYSTEMS = """
sensing:
  nodes:
    laser:
      from: "demo.driver"
      interfaces:
        - laser_scan: pub-> "driver::scan"
        - left: pub-> "driver::left"
        - laser_rate: sub-> "driver::rate"
    cleaner:
      from: "demo.filter"
      interfaces:
        - raw_scan: sub-> "filter::raw"
        - clean_scan: pub-> "filter::clean"
        - reset: ss-> "filter::reset"
  connections:
    - [laser_scan, raw_scan]
robot:
  nodes:
    brain:
      from: "demo.planner"
      interfaces:
        - brain_scan: sub-> "planner::scan"
        - brain_speed: pub-> "planner::speed"
        - brain_reset: sc-> "planner::reset"
  subSystems:
    - sensing
  connections:
    - [clean_scan, brain_scan]
    - [brain_speed, laser_rate]
"""


def test_a_part_is_a_component_with_the_ports_that_it_exposes(workshop: Workshop) -> None:
    report = workshop.imported("ros2", {"demo.ros2": PACKAGE, "robot.rossystem": SYSTEMS})
    texts = workshop.texts()
    assert list(texts) == [
        "robot.parts.template.ttl",
        "robot.template.ttl",
        "robot.ttl",
        "sensing.composite.ttl",
        "sensing.template.ttl",
    ]
    said = texts["sensing.composite.ttl"]
    assert "@prefix : <urn:selfconf:ros2:sensing/> ." in said
    assert ":composite a sc:Component, ros2:System ;" in said
    assert "sc:grounding [ sc:template :inside ]" in said
    assert said.count('sc:name "raw_scan"') == 0  # it is fed inside, and by nobody else
    for name in ("laser_scan", "clean_scan", "laser_rate"):
        assert said.count(f'sc:name "{name}"') == 2
    assert left_out(report) == {"ports of composites": 1}


def test_a_system_is_configured_by_its_parts(workshop: Workshop) -> None:
    report = workshop.imported("ros2", {"demo.ros2": PACKAGE, "robot.rossystem": SYSTEMS})
    paths = {file.path.name: file.path for file in report.files}
    assert not selfconf.validate(list(paths.values())).errors
    home = selfconf.read(*paths.values())
    task = selfconf.template(paths["robot.parts.template.ttl"])
    answer = selfconf.configure(task, home)
    assert isinstance(answer, Answer), answer
    found = {(str(each.source), each.output, str(each.sink), each.input) for each in answer.connections}
    brain, sensing = "urn:selfconf:ros2:robot/brain", "urn:selfconf:ros2:sensing/composite"
    assert found == {
        (sensing, "clean_scan", brain, "brain_scan"),
        (brain, "brain_speed", sensing, "laser_rate"),
    }


def test_a_system_that_calls_what_is_in_a_part_is_described_flat_alone(workshop: Workshop) -> None:
    called = SYSTEMS + "    - [reset, brain_reset]\n"
    report = workshop.imported("ros2", {"demo.ros2": PACKAGE, "robot.rossystem": called})
    assert left_out(report) == {"ports of composites": 1, "the template of parts of a system": 1}
    assert not any("parts" in name for name in workshop.texts())
    home = selfconf.read(*(file.path for file in report.files))
    task = selfconf.template(workshop.out / "robot.template.ttl")
    answer = selfconf.configure(task, home)
    assert isinstance(answer, Answer)
    assert {(each.output, each.input) for each in answer.connections} == {
        ("clean_scan", "brain_scan"),
        ("brain_speed", "laser_rate"),
        ("reset()", "brain_reset()"),
        ("laser_scan", "raw_scan"),  # inside of the part
    }


def test_the_inside_of_a_part_has_the_connections_of_its_own_parts(workshop: Workshop) -> None:
    outer = SYSTEMS + "house:\n  subSystems:\n    - robot\n"
    workshop.imported("ros2", {"demo.ros2": PACKAGE, "robot.rossystem": outer})
    inside = workshop.texts()["robot.composite.ttl"]
    assert inside.count("a sc:Interaction") == 3
    for name in ("raw_scan", "laser_rate", "brain_scan"):
        assert inside.count(f'sc:name "{name}"') == 0  # each is fed inside
