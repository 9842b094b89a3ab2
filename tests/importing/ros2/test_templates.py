"""A system as a template."""

from __future__ import annotations

from selfconf.importing.ros2.interfaces import InterfaceKind, NodeInterface
from selfconf.importing.ros2.system_models import SystemNode
from selfconf.importing.ros2.templates import roles_by_node, system_template
from selfconf.importing.ros2.wiring import NodeInstance, WiredPair
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import SC, SH, TYPE

TEMPLATE = IRI("urn:x:s")
OUT, IN = NodeInterface(InterfaceKind.PUBLISHER, "o"), NodeInterface(InterfaceKind.SUBSCRIBER, "i")
A = NodeInstance("s", SystemNode("a", "p.k", "", ()), None, (OUT,))
B = NodeInstance("part", SystemNode("b", "", "", ()), None, (IN,))


def test_a_node_of_a_part_has_a_role_below_that_of_the_part() -> None:
    assert roles_by_node(TEMPLATE, "s", [A, B]) == {A.key: "urn:x:s/role/a", B.key: "urn:x:s/role/part/b"}


def test_nodes_whose_names_look_alike_in_an_iri_have_roles_of_their_own() -> None:
    alike = [NodeInstance("s", SystemNode(name, "p.k", "", ()), None, ()) for name in ("front/a", "front-a", "front a")]
    roles = roles_by_node(TEMPLATE, "s", alike)
    assert list(roles.values()) == [f"urn:x:s/role/front-a{number}" for number in ("", "-2", "-3")]


def test_a_template_has_a_role_for_each_node_and_an_interaction_for_each_connection() -> None:
    template, a, b, interaction = system_template(TEMPLATE, "s", [A, B], [WiredPair(A, OUT, B, IN)])
    assert template.values(TYPE) == (SC.Template,)
    assert a.values(SH["class"]) == (IRI("https://w3id.org/selfconf/ros2/p/node/k"),)
    assert b.values(SH["class"]) == (IRI("https://w3id.org/selfconf/ros2#Node"),)
    assert interaction.statements == (
        (TYPE, (SC.Interaction,)),
        (SC["from"], (a.subject,)),
        (SC.output, (Literal("o"),)),
        (SC.to, (b.subject,)),
        (SC.input, (Literal("i"),)),
    )
