"""ROS 2 nodes as components."""

from __future__ import annotations

from selfconf.errors import AuthorError
from selfconf.importing.imported import ImportedComponent, ImportedOperation, ImportedPort
from selfconf.importing.ledger import ImportLedger
from selfconf.importing.ros2.components import NodeReader, nobody_wires
from selfconf.importing.ros2.interfaces import ROS2, InterfaceKind, NodeInterface
from selfconf.importing.sources import SourceDocument
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import XSD

BASE = "https://w3id.org/selfconf/ros2/"
INTERFACES = (
    NodeInterface(InterfaceKind.PUBLISHER, "x", "std_msgs/msg/String"),
    NodeInterface(InterfaceKind.SUBSCRIBER, "x", "std_msgs/msg/String", (("depth", "5"),)),
    NodeInterface(InterfaceKind.SUBSCRIBER, "y"),
    NodeInterface(InterfaceKind.SERVICE_SERVER, "x", "std_srvs/srv/Empty"),
    NodeInterface(InterfaceKind.ACTION_CLIENT, "x", "a/action/B"),
)


def read(
    interfaces: tuple[NodeInterface, ...], parameters: tuple[tuple[str, str], ...] = (), wired: bool = False
) -> tuple[ImportedComponent, set[str]]:
    ledger = ImportLedger("urn:x:", list[AuthorError]().append)
    facts = {"nodeName": "n", "package": "p", "nodeType": "k", "nodeNamespace": ""}
    reader = NodeReader(ledger, SourceDocument("s", "s", b""))
    chosen = (lambda _: True) if wired else nobody_wires
    return reader.component(IRI("urn:x:n"), interfaces, facts, parameters, chosen), {
        each.what for each in ledger.omissions()
    }


def test_a_node_takes_and_gives_what_its_interfaces_say() -> None:
    string = (IRI(BASE + "std_msgs/msg/String"),)
    component, left_out = read(INTERFACES)
    assert component == ImportedComponent(
        IRI("urn:x:n"),
        (ROS2.Node, IRI(BASE + "p/node/k")),
        labels=(Literal("n"),),
        properties=((ROS2.nodeName, Literal("n")), (ROS2.package, Literal("p"))),
        inputs=(ImportedPort("x", string, optional=True, depth=5), ImportedPort("y", optional=True)),
        outputs=(ImportedPort("x", string),),
        operations=(
            ImportedOperation("x", IRI(BASE + "std_srvs/srv/Empty_Request"), IRI(BASE + "std_srvs/srv/Empty_Response")),
        ),
        needs=(ImportedOperation("x", IRI(BASE + "a/action/B_Goal"), IRI(BASE + "a/action/B_Result"), optional=True),),
    )
    assert left_out == {"feedback of actions that are called"}


def test_an_action_is_an_operation_and_its_feedback_an_output() -> None:
    dock = NodeInterface(InterfaceKind.ACTION_SERVER, "dock", "a/action/B")
    component, left_out = read((dock,))
    assert component.operations == (
        ImportedOperation("dock", IRI(BASE + "a/action/B_Goal"), IRI(BASE + "a/action/B_Result")),
    )
    assert component.outputs == (ImportedPort("dock/feedback", (IRI(BASE + "a/action/B_FeedbackMessage"),)),)
    assert not left_out
    taken = NodeInterface(InterfaceKind.PUBLISHER, "dock/feedback")
    component, left_out = read((dock, taken))
    assert component.outputs == (ImportedPort("dock/feedback"),)
    assert left_out == {"feedback of actions"}


def test_what_is_wired_is_required() -> None:
    component, _ = read(INTERFACES, wired=True)
    assert [each.optional for each in (*component.inputs, *component.needs)] == [False] * 3


def test_a_parameter_of_one_datatype_is_operational_and_another_is_named() -> None:
    component, left_out = read((), (("rate", "Double"), ("on", "bool"), ("list", "Array[Double]"), ("odd", "")))
    assert component.parameters == (("rate", XSD.double), ("on", XSD.boolean))
    assert left_out == {"parameters that are lists, arrays or structs, or have no type"}


def test_a_type_that_is_none_and_a_name_that_is_taken_are_named() -> None:
    port = NodeInterface(InterfaceKind.PUBLISHER, "x", "no type")
    component, left_out = read((port, port))
    assert component.outputs == (ImportedPort("x"),)
    assert left_out == {"the type 'no type'", "interfaces"}
