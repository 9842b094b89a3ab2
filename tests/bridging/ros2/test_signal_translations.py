"""What a message says is said by a signal, and what a signal says by a message."""

from __future__ import annotations

import math
from typing import Any

import pytest
from rdflib import Graph, URIRef

from selfconf import files, library, ros2
from selfconf.bridging.ros2.signal_translations import SIGNAL_TRANSLATIONS, translation_of
from selfconf.importing import ROS2, InterfaceKind
from selfconf.importing.ros2.interfaces import type_iri
from selfconf.model.term import IRI
from selfconf.rdf.vocabulary import ROB

pytest.importorskip("rosbags", reason="the extra `ros2` is not installed")
SIGNALS: dict[str, dict[str, Any]] = {
    ROB.PlanarPose2D: {"x": 1.5, "y": -2.0, "theta": -2.5, "frame": "map"},
    ROB.Velocity2D: {"linear": 0.5, "angular": -0.25},
    ROB.Odometry2D: {"x": 1.0, "y": 2.0, "theta": 3.0, "linear": 0.5, "angular": 0.25},
    ROB.Temperature: {"temperature": 21.5},
    ROB.Switch: {"on": True},
    ROB.Text: {"text": "good evening"},
}


def read(name: str, **fields: Any) -> dict[str, Any]:
    """A message of a type as a signal, by way of its bytes."""
    kind, translation = ros2.usual_type(name), translation_of(name)
    assert kind is not None
    assert translation is not None
    return translation.read(ros2.message_fields(ros2.message(fields, kind), kind))


@pytest.mark.parametrize("each", SIGNAL_TRANSLATIONS, ids=lambda each: each.message)
def test_a_message_is_a_signal_of_its_kind_and_comes_back_from_it(each: Any) -> None:
    kind = ros2.usual_type(each.message)
    assert kind is not None
    (fields,) = files.signal_fields(library.ontologies(), frozenset([each.signal])).values()
    assert each.fields == tuple(one.name for one in fields.fields if one.required)
    assert fields.problem(read(each.message)) is None
    if each.write is not None:
        signal = SIGNALS[each.signal]
        assert each.is_signal(signal)
        payload = ros2.message(each.write(signal, 1700000000.5), kind)
        found = each.read(ros2.message_fields(payload, kind))
        lost = {"frame": ""} if each.message.endswith("Pose2D") else {}
        assert found == pytest.approx({**signal, **lost})


def test_a_scan_has_its_directions_one_by_one_and_nothing_seen_is_the_greatest_range() -> None:
    scan = read(
        "sensor_msgs/msg/LaserScan", angle_min=-0.5, angle_increment=0.25, range_max=8.0, ranges=[1.0, math.inf, 2.0]
    )
    assert scan == {"angles": [-0.5, -0.25, 0.0], "ranges": [1.0, 8.0, 2.0], "max_range": 8.0}
    assert read("sensor_msgs/msg/Range", max_range=4.0, range=math.nan)["ranges"] == [4.0]


def test_what_is_too_near_to_be_measured_is_not_what_is_not_there() -> None:
    scan = read("sensor_msgs/msg/LaserScan", range_min=0.25, range_max=8.0, ranges=[-math.inf, math.nan])
    assert scan["ranges"] == [0.25, 8.0]
    assert read("sensor_msgs/msg/Range", min_range=0.5, max_range=4.0, range=-math.inf)["ranges"] == [0.5]


def test_a_temperature_that_is_received_as_a_message_goes_on_as_that_message() -> None:
    kind, translation = ros2.usual_type("sensor_msgs/msg/Temperature"), translation_of("sensor_msgs/msg/Temperature")
    assert kind is not None
    assert translation is not None
    assert translation.write is not None
    stated = {"header": {"stamp": {"sec": 5, "nanosec": 6}, "frame_id": "oven"}, "temperature": 180.0, "variance": 0.5}
    assert ros2.message_fields(ros2.message(translation.write(stated, 7.0), kind), kind) == stated
    assert "colour" not in translation.write({"temperature": 180.0, "colour": "red"}, 7.0)


def test_an_object_with_the_fields_of_the_message_is_no_signal() -> None:
    twist = translation_of("geometry_msgs/msg/Twist")
    assert twist is not None
    assert twist.is_signal({"linear": 0.5, "angular": 0.0})
    assert not twist.is_signal({"linear": {"x": 0.5}, "angular": {}})
    assert not twist.is_signal([0.5, 0.0])


def test_the_ontology_says_which_messages_are_which_signals() -> None:
    (path,) = [one for one in library.ontologies() if one.name == "ros2.ttl"]
    said = Graph().parse(path)

    def pairs(term: IRI) -> set[tuple[str, str]]:
        return {(str(one), str(other)) for one, other in said.subject_objects(URIRef(term))}

    translated = [(type_iri(each.message, InterfaceKind.PUBLISHER), each) for each in SIGNAL_TRANSLATIONS]
    assert pairs(ROS2.readAs) == {(str(kind), str(each.signal)) for kind, each in translated}
    assert pairs(ROS2.writtenFrom) == {(str(kind), str(each.signal)) for kind, each in translated if each.write}
