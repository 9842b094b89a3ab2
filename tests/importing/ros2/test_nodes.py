"""One import of ROS 2 models: what comes of systems, and whether their connections are found again."""

from __future__ import annotations

import pytest

import selfconf as sc
from selfconf.importing import ROS2
from selfconf.model.configuration import Configuration
from selfconf.rdf.vocabulary import SC, TYPE
from tests.harness.effort import examples
from tests.importing.imports import Workshop, left_out
from tests.importing.ros2.look_alikes import system

NODL = '<interface version="1"><node name="n" executable="e"><parameter name="p" type="int"/></node></interface>'


@pytest.mark.parametrize("seed", range(examples(25)))
def test_the_configuration_of_a_system_has_its_connections_and_no_others(workshop: Workshop, seed: int) -> None:
    look_alike = system(seed)
    report = workshop.imported("ros2", look_alike.texts)
    assert report.unreadable == ()
    assert "connections" not in left_out(report)
    answer = sc.configure(sc.template(workshop.out / "robot.template.ttl"), sc.read(workshop.out))
    assert isinstance(answer, Configuration), answer
    found = {(each.source.short, each.output, each.sink.short, each.input) for each in answer.connections}
    assert found == look_alike.connections


def test_nodes_of_a_system_are_components_and_the_models_that_they_are_instances_of_are_not(workshop: Workshop) -> None:
    texts = system(3).texts
    report = workshop.imported("ros2", texts)
    assert [file.path.name for file in report.files] == [
        "base.ttl", "base.template.ttl", "base.composite.ttl", "robot.ttl", "robot.template.ttl",
        "robot.parts.template.ttl",
    ]  # fmt: skip
    nodes = texts["robot.rossystem"].count("      from:") + texts["base.rossystem"].count("      from:")
    components = [each for file in report.files for each in file.document.subjects(SC.Component)]
    assert len(components) == nodes + 1
    systems = [each.subject for each in components if ROS2.System in each.values(TYPE)]
    assert systems == ["urn:selfconf:ros2:base/composite"]


def test_models_that_no_system_uses_and_nodl_are_components_of_their_own(workshop: Workshop) -> None:
    report = workshop.imported("ros2", {"nodes.ros2": system(3).texts["nodes.ros2"], "a/n.nodl.xml": NODL})
    assert [file.path.relative_to(workshop.out).as_posix() for file in report.files] == ["a/n.ttl", "nodes.ttl"]
    assert "<urn:selfconf:ros2:a-n/n> a sc:Component, ros2:Node ;" in workshop.texts()["a/n.ttl"]


def test_importing_again_writes_the_same_bytes(workshop: Workshop) -> None:
    workshop.imported("ros2", system(5).texts)
    before = workshop.texts()
    assert {file.state.value for file in workshop.imported("ros2", {}).files} == {"unchanged"}
    assert workshop.texts() == before


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("old.rossystem", "RosSystem { Name 'x' }", "old.rossystem:1:1: this is in the notation of before 2022"),
        ("bad.ros2", "a:\n  b c\n", "bad.ros2:2:3: a line is"),
        ("bad.nodl.xml", "<interface", "bad.nodl.xml:1:1: this is not XML"),
    ],
)
def test_what_cannot_be_read_is_named_and_the_rest_is_imported(
    workshop: Workshop, name: str, text: str, words: str
) -> None:
    report = workshop.imported("ros2", {name: text, "n.nodl.xml": NODL})
    assert words in str(report.unreadable[0])
    assert len(report.files) == 1


def test_a_connection_of_services_is_one_of_operations(workshop: Workshop) -> None:
    nodes = """p:
  artifacts:
    a:
      node: a
      serviceservers:
        s:
          type: "std_srvs/srv/Trigger"
    b:
      node: b
      serviceclients:
        s:
          type: "std_srvs/srv/Trigger"
"""
    whole = """w:
  nodes:
    a:
      from: "p.a"
      interfaces:
        - server: ss-> "a::s"
    b:
      from: "p.b"
      interfaces:
        - client: sc-> "b::s"
  connections:
    - [ server, client ]
"""
    report = workshop.imported("ros2", {"p.ros2": nodes, "w.rossystem": whole})
    assert left_out(report) == {}
    interaction = " ".join(workshop.texts()["w.template.ttl"].partition("sc:Interaction")[2].split())
    assert 'sc:output "server()"' in interaction
    assert 'sc:input "client()"' in interaction
    text = " ".join(workshop.texts()["w.ttl"].split())
    trigger = "sc:request std_srvs-srv:Trigger_Request ; sc:response std_srvs-srv:Trigger_Response ] ."
    assert f'sc:hasOperation [ sc:name "server" ; {trigger}' in text
    assert f'sc:needsOperation [ sc:name "client" ; {trigger}' in text
    assert "sc:optional" not in text


def test_a_system_without_nodes_is_no_template(workshop: Workshop) -> None:
    report = workshop.imported("ros2", {"x.rossystem": "a:\n  nodes:\n"})
    assert report.files == ()
    assert left_out(report) == {"templates of systems without nodes": 1}


def test_a_document_without_nodes_is_named(workshop: Workshop) -> None:
    nodl = '<interface version="1"/>'
    report = workshop.imported("ros2", {"x.ros2": "a:\n  b: c\n", "y.ros2": "a:\n  artifacts:\n", "z.nodl.xml": nodl})
    assert left_out(report) == {"documents without nodes": 2, "packages without artifacts": 1}
