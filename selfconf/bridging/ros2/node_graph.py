"""The graph of a ROS 2 domain at one moment: a description of each node that lives there, without living as it.

A node is described as a bridge would advertise it, by the same name, so that what is written down and what lives are
one component. What a description says depends on the graph alone, not on the order in which its parts came.
"""

from __future__ import annotations

from collections.abc import Iterator

from selfconf.bridging.ros2.actions import action_name
from selfconf.bridging.ros2.described_nodes import OF_EVERY_NODE, described_node, is_bridged, is_hidden, ports_of
from selfconf.bridging.ros2.tokens import NODE, ROOT, NodeIdentity, RosToken
from selfconf.bus.port import Bus
from selfconf.errors import AuthorError, PeerError
from selfconf.importing import ImportedDocument, ImportLedger, SourceDocument, slug

TOKENS_NAMED = 5.0
"""Seconds that the router may take to name all tokens; it answers at once."""


def living_graph(bus: Bus, domain: int, ledger: ImportLedger) -> Iterator[ImportedDocument]:
    """The nodes that live in a domain, by their names; what of it cannot be described goes into the ledger."""
    found: list[tuple[str, ...]] = []
    bus.roll_call(f"{ROOT}/{domain}/**", TOKENS_NAMED, found.append)
    bus.run(lambda: bool(found))
    nodes: dict[NodeIdentity, list[RosToken]] = {}
    for key in sorted(found[0]):
        try:
            token = RosToken.parse(key)
        except PeerError as error:
            ledger.unreadable(AuthorError(str(error), file=_place(domain)))
            continue
        if is_bridged(token):
            nodes.setdefault(token.identity, []).append(token)
    described: set[str] = set()
    for (_, name), tokens in sorted(nodes.items(), key=lambda node: (node[0][1], node[0][0])):
        source = SourceDocument(f"{name} in {_place(domain)}", name.strip("/"), b"")
        if name in described:
            ledger.leave_out("further nodes of one name", "a component has one name", source)
        elif any(token.kind == NODE for token in tokens):
            described.add(name)
            yield _described(tokens, ledger, source)


def _described(tokens: list[RosToken], ledger: ImportLedger, source: SourceDocument) -> ImportedDocument:
    endpoints = [token.endpoint for token in tokens if token.endpoint is not None]
    ports = ports_of(endpoints)
    hidden = sum(
        is_hidden(each.topic) and action_name(each.topic).strip("/") not in ports.actions for each in endpoints
    )
    usual = sum(each.topic in OF_EVERY_NODE for each in endpoints)
    for number, what, why in (
        (hidden, "hidden topics and services", "they are parts of actions that others serve, or of tools"),
        (usual, "topics of logs and of changed parameters", "every node has them"),
    ):
        if number:
            ledger.leave_out(what, why, source, number)
    component = described_node(tokens[0], ports, ledger)
    name = "/".join(map(slug, source.name.split("/")))
    return ImportedDocument(name, source.shown, (component.described(),), {})


def _place(domain: int) -> str:
    return f"the domain {domain} of ROS 2"
