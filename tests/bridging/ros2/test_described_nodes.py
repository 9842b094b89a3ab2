"""A node as a component: ports, promised rates, and which outputs its inputs accept."""

from __future__ import annotations

from dataclasses import replace

import selfconf
from selfconf.api.answer import Answer
from selfconf.bridging.ros2.described_nodes import described_node, is_bridged, node_iri, ports_of
from selfconf.bridging.ros2.tokens import RosEndpoint, RosNodeId, RosQuality, RosToken
from selfconf.importing import ImportedDocument, described_text
from selfconf.rdf.advertisements import read_advertisements
from selfconf.rdf.vocabulary import ROB
from selfconf.ros2 import MessageType
from tests.bridging.ros2.action_parts import ACTION, parts_of
from tests.bridging.ros2.nodes import ADD_HASH
from tests.ros2.test_messages import STRING_HASH

ADD = "https://w3id.org/selfconf/ros2/example_interfaces/srv/AddTwoInts"

LIDAR = RosToken(RosNodeId(7, "a1", 0), "/front", "lidar")
USUAL = RosQuality()
KIND = MessageType("std_msgs/msg/String", STRING_HASH)


def endpoint(number: int, kind: str, topic: str, quality: RosQuality = USUAL) -> RosEndpoint:
    return RosEndpoint(number, kind, topic, KIND, quality)


def test_topics_are_ports_and_what_every_node_has_is_left_out() -> None:
    outputs, inputs, offered, needed, actions = ports_of(
        [
            endpoint(7, "SS", "/front/reset"),
            endpoint(8, "SC", "/add"),
            endpoint(9, "SS", "/dock/_action/send_goal"),
            endpoint(4, "MP", "/front/scan"),
            endpoint(3, "MP", "/rosout"),
            endpoint(2, "MS", "/parameter_events"),
            endpoint(5, "MS", "/front/scan"),
            endpoint(6, "MP", "/front/scan"),
        ]
    )
    assert {name: each.entity for name, each in outputs.items()} == {"front/scan": 4}
    assert {name: each.entity for name, each in inputs.items()} == {"front/scan": 5}
    assert (list(offered), list(needed), actions) == (["front/reset"], ["add"], {})


def test_a_node_is_a_component_that_can_be_advertised() -> None:
    best_effort = RosQuality(reliable=False, depth=5, period=0.1)
    latched = RosQuality(transient_local=True)
    ports = ports_of(
        [
            endpoint(1, "MP", "/scan", best_effort),
            endpoint(2, "MS", "/map", latched),
            endpoint(3, "MS", "/raw", best_effort),
            RosEndpoint(4, "SS", "/front/add", MessageType("example_interfaces/srv/AddTwoInts", ADD_HASH)),
            RosEndpoint(5, "SC", "/add", MessageType("example_interfaces/srv/AddTwoInts", ADD_HASH)),
        ]
    )
    component = described_node(LIDAR, ports)
    assert component.iri == node_iri(LIDAR) == "urn:selfconf:ros2:7/front/lidar"
    text = described_text(ImportedDocument("", "", (component.described(),), {}))
    ((advertisement,), bad) = read_advertisements(text.encode(), "lidar.ttl", "file:///lidar.ttl")
    assert not bad
    scan, second = advertisement.profile.signal_outputs
    assert scan.rate == second.rate == 10.0
    assert (second.name, [str(signal) for signal in second.signals]) == ("scan as Text", [f"{ROB.Text}"])
    assert [str(signal) for signal in scan.signals] == ["https://w3id.org/selfconf/ros2/std_msgs/msg/String"]
    assert {port.name: port.depth for port in advertisement.profile.inputs if not port.is_operation} == {
        "map": 42,
        "raw": 5,
    }
    assert advertisement.profile.required == ()
    (offered,), (needed,) = advertisement.profile.operations, advertisement.profile.needed_operations
    assert (offered.name, needed.name) == ("front/add()", "add()")
    assert str(offered.response) == f"{ADD}_Response"
    assert str(needed.request) == f"{ADD}_Request"
    assert 'ros2:reliability "best_effort"' in text
    accepted = '[ sh:path ros2:durability ; sh:in ( "transient_local" ) ]'
    assert text.count(accepted) == 1
    assert text.count('[ sh:path ros2:reliability ; sh:in ( "reliable" ) ]') == 1
    assert text.count("[ sh:path ros2:translatedFrom ; sh:maxCount 0 ]") == 2


def test_an_action_is_an_operation_and_an_output_and_its_parts_are_no_ports() -> None:
    usual = endpoint(9, "MP", "/other/feedback")
    ports = ports_of([*parts_of("/dock"), *parts_of("/other"), usual, endpoint(8, "SS", "/other")])
    text = described_text(ImportedDocument("", "", (described_node(LIDAR, ports).described(),), {}))
    ((advertisement,), bad) = read_advertisements(text.encode(), "lidar.ttl", "file:///lidar.ttl")
    assert not bad
    offered = {port.name: str(port.request) for port in advertisement.profile.operations}
    assert offered["dock()"] == f"https://w3id.org/selfconf/ros2/{ACTION}_Goal"
    assert offered["other()"].endswith("_Request")  # what is a service already is no action
    outputs = {port.name: list(map(str, port.signals)) for port in advertisement.profile.signal_outputs}
    assert outputs["dock/feedback"] == [f"https://w3id.org/selfconf/ros2/{ACTION}_FeedbackMessage"]
    assert ports.outputs["other/feedback"] == usual
    assert set(outputs) == {"dock/feedback", "other/feedback", "other/feedback as Text"}


def test_what_was_translated_is_not_translated_back() -> None:
    ports = ports_of([endpoint(1, "MP", "/said"), endpoint(2, "MS", "/heard")])
    nodes = [described_node(replace(LIDAR, name=name), ports).described() for name in ("a", "b")]
    home = selfconf.read(described_text(ImportedDocument("", "", tuple(nodes), {})))
    task = selfconf.template(
        """@prefix sc: <https://w3id.org/selfconf#> . @prefix sh: <http://www.w3.org/ns/shacl#> .
        @prefix ros2: <https://w3id.org/selfconf/ros2#> . @prefix : <urn:t:> .
        :t a sc:Template ; sc:roles ( :from :to ) .
        :from a sc:Role ; sh:class ros2:Node ; sc:feeds :to .
        :to a sc:Role ; sh:class ros2:Node ."""
    )
    answer = selfconf.configure(task, home)
    assert isinstance(answer, Answer)
    assert [(each.output, each.input) for each in answer.connections] == [("said", "heard")]


def test_tools_and_bridges_are_no_components() -> None:
    assert is_bridged(LIDAR)
    for name in ("_ros2cli_daemon_0", "selfconf_bridge"):
        assert not is_bridged(RosToken(LIDAR.node, "", name))
