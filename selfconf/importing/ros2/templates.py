"""A system of ROS 2 nodes as a template: a role for each node, and an interaction for each connection.

A role asks for the node that plays it in the system: by its kind, its name and the name of the system. An interaction
names both ports, because by type alone a system has about half as many connections again that were not meant.
"""

from __future__ import annotations

from collections.abc import Iterable

from selfconf.importing.imported import DescribedStatement, Description, NestedNode, TermList
from selfconf.importing.naming import NumberedNames, slug
from selfconf.importing.ros2.interfaces import ROS2, TOPICS, node_class
from selfconf.importing.ros2.wiring import NodeInstance, WiredPair
from selfconf.model.profile import CALL_MARK
from selfconf.model.term import IRI, Literal
from selfconf.rdf.vocabulary import LABEL, SC, SH, TYPE, XSD


def roles_by_node(template: IRI, system: str, members: Iterable[NodeInstance]) -> dict[tuple[str, str], IRI]:
    """The roles of nodes in a template, by what tells the nodes apart; one of a subsystem is named after that too."""
    names = NumberedNames()
    found = {}
    for instance in members:
        path = [] if instance.system == system else [slug(instance.system)]
        found[instance.key] = IRI(names.free("/".join([f"{template}/role", *path, slug(instance.node.name)])))
    return found


def system_template(
    template: IRI, system: str, members: Iterable[NodeInstance], pairs: Iterable[WiredPair]
) -> list[Description]:
    """The template of a system, its roles, and its interactions."""
    members = tuple(members)
    roles = roles_by_node(template, system, members)
    found = [template_head(template, system, roles.values())]
    for instance in members:
        facts = (fact(ROS2.nodeName, instance.node.name), fact(ROS2.system, instance.system))
        package, _, kind = instance.node.model.partition(".")
        kind = instance.model.name if instance.model else kind
        role = ((TYPE, (SC.Role,)), (SH["class"], (node_class(package, kind) or ROS2.Node,)), (SH.property, facts))
        found.append(Description(roles[instance.key], role))
    for number, pair in enumerate(pairs, 1):
        called = "" if pair.output.kind in TOPICS else CALL_MARK
        ends = (roles[pair.source.key], pair.output.name + called, roles[pair.sink.key], pair.input.name + called)
        found.append(interaction(template, number, *ends))
    return found


def template_head(template: IRI, system: str, roles: Iterable[IRI]) -> Description:
    """The template of a system, as far as it stands in its roles."""
    return Description(
        template,
        (
            (TYPE, (SC.Template,)),
            (LABEL, (Literal(f"ROS 2 system {system}"),)),
            (SC.roles, (TermList(tuple(roles)),)),
        ),
    )


def interaction(template: IRI, number: int, source: IRI, output: str, sink: IRI, taken: str) -> Description:
    """A connection of a template between two roles, by the names of the ports."""
    statements: tuple[DescribedStatement, ...] = (
        (TYPE, (SC.Interaction,)),
        (SC["from"], (source,)),
        (SC.output, (Literal(output),)),
        (SC.to, (sink,)),
        (SC.input, (Literal(taken),)),
    )
    return Description(IRI.unchecked(f"{template}/connection/{number}"), statements)


def fact(path: IRI, value: str) -> NestedNode:
    """What a component has to say of itself."""
    said = TermList((Literal(value),))
    return NestedNode(((SH.path, (path,)), (SH["in"], (said,)), (SH.minCount, (Literal("1", XSD.integer),))))
