"""A system as a template."""

from __future__ import annotations

from selfconf.importing.ros2.interfaces import InterfaceKind, NodeInterface
from selfconf.importing.ros2.system_models import SystemNode
from selfconf.importing.ros2.templates import role_of, system_template
from selfconf.importing.ros2.wiring import NodeInstance, WiredPair
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import SC, SH, TYPE

TEMPLATE = IRI("urn:x:s")
OUT, IN = NodeInterface(InterfaceKind.PUBLISHER, "o"), NodeInterface(InterfaceKind.SUBSCRIBER, "i")
A = NodeInstance("s", SystemNode("a", "p.k", "", ()), None, (OUT,))
B = NodeInstance("part", SystemNode("b", "", "", ()), None, (IN,))


def test_a_node_of_a_part_has_a_role_below_that_of_the_part() -> None:
    assert role_of(TEMPLATE, A, "s") == "urn:x:s/role/a"
    assert role_of(TEMPLATE, B, "s") == "urn:x:s/role/part/b"


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
