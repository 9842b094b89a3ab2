"""NoDL in XML."""

from __future__ import annotations

import pytest

from selfconf.errors import AuthorError
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.interfaces import InterfaceKind, NodeInterface
from selfconf.importing.ros2.node_models import NodeModel
from selfconf.importing.ros2.nodl import NodlReader
from selfconf.importing.sources import SourceDocument

TEXT = """<?xml version="1.0"?>
<interface version="1">
  <node name="talker" executable="talk">
    <parameter name="rate" type="int"/>
    <topic name="/chat" type="std_msgs/msg/String" publisher="true" subscription="true">
      <qos_profile depth="10" lifespan=".5"/>
    </topic>
    <service name="/s" type="std_srvs/srv/Empty" role="both"/>
    <action name="/a" type="x/action/Y" client="true" server="false"><goal_service_qos_profile depth="1"/></action>
    <topic name="/none" type="std_msgs/msg/String"/>
  </node>
  <node executable="x"/>
</interface>
"""


def read(text: str) -> tuple[list[NodeModel], set[str]]:
    ledger = ImportLedger("urn:x:", list[AuthorError]().append)
    nodes = NodlReader(SourceDocument("x.nodl.xml", "x.nodl.xml", text.encode()), ledger).read()
    return nodes, {each.what for each in ledger.omissions()}


def test_a_node_has_its_interfaces_by_their_roles() -> None:
    (node,), left_out = read(TEXT)
    depth = (("depth", "10"),)
    assert (node.name, node.artifact, node.parameters) == ("talker", "talk", (("rate", "int"),))
    assert node.interfaces == (
        NodeInterface(InterfaceKind.PUBLISHER, "/chat", "std_msgs/msg/String", depth),
        NodeInterface(InterfaceKind.SUBSCRIBER, "/chat", "std_msgs/msg/String", depth),
        NodeInterface(InterfaceKind.SERVICE_SERVER, "/s", "std_srvs/srv/Empty"),
        NodeInterface(InterfaceKind.SERVICE_CLIENT, "/s", "std_srvs/srv/Empty"),
        NodeInterface(InterfaceKind.ACTION_CLIENT, "/a", "x/action/Y"),
    )
    assert left_out == {
        "other qualities of service", "qualities of the parts of actions", "elements 'topic' of nodes",
        "nodes without a name",
    }  # fmt: skip


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("<interface version='1'>\n <node>", "x.nodl.xml:2:8: this is not XML"),
        ("<launch/>", "x.nodl.xml:1:1: this is not NoDL: its root is 'launch'"),
        ("<interface version='2'/>", "version '2' of NoDL is not known"),
        ("<!DOCTYPE x [<!ENTITY a 'b'>]><interface version='1'/>", "declares an entity"),
    ],
)
def test_what_is_no_nodl_is_named_with_its_place(text: str, words: str) -> None:
    with pytest.raises(AuthorError) as error:
        read(text)
    assert words in str(error.value)
