"""Signals of a template that come to nothing: loops that lead nowhere, inputs that no role feeds.

A cycle of `sc:feeds` is no mistake by itself: closed loops are what control is about. But a loop acts on the world
through an actuator in it, or hands something on, to a role or by an output of the template; one that does neither only
keeps itself busy.

An input that a role asks its component to have has to be fed, or no component that has it can play the role, unless the
input is optional, or the role recruits what feeds it, or it is one of the template. Most templates leave ports to the
components. Where one speaks of them, what is asked of the one end is held against what is asked of the other; whether
signals match is seen in the widest sense, that of the loaded ontologies.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import NamedTuple

from rdflib import RDF, SH, Literal, URIRef
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.model.strong_components import strong_components
from selfconf.model.wording import listed
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.lints.normal_form import NormalForm, ShapeStatement, ValueNormalForm
from selfconf.rdf.vocabulary import ROB, SC

_FEEDS, _NAME, _SIGNAL = URIRef(SC.feeds), URIRef(SC.name), URIRef(SC.signalType)
_INPUT, _OUTPUT = URIRef(SC.hasInput), URIRef(SC.hasOutput)
_OPTIONAL, _RECRUITS, _OFFERED = URIRef(SC.optional), URIRef(SC.recruits), URIRef(SC.hasOperation)


class RoleLink(NamedTuple):
    """One role feeds another, perhaps from one port to another."""

    source: Node
    sink: Node
    output: Node | None
    input: Node | None
    offset: int


class Ask(NamedTuple):
    """A port that a component has to have to play a role: its name and its signal type, where they are stated."""

    name: Node | None
    signal: Node | None
    statement: ShapeStatement


def idle_loops(file: LintedFile) -> Iterator[Diagnostic]:
    """Loops of roles that feed only each other, with no actuator among them."""
    for roles, links in _templates(file):
        for loop in _loops(links):
            inside = [link for link in links if link.source in loop]
            if all(link.sink in loop for link in inside) and not any(_comes_out(file, role) for role in loop):
                names = listed([file.short(str(role)) for role in roles if role in loop])
                which = (
                    f"The role {names} feeds only itself"
                    if len(loop) == 1
                    else f"The roles {names} feed only each other"
                )
                closing = [link.offset for link in inside if roles.index(link.sink) <= roles.index(link.source)]
                message = f"{which}, without an actuator: nothing comes of this loop."
                hint = "Let it feed a role outside, or a kind of rob:Actuator."
                yield file.at(max(closing), "SC-L12", message, hint=hint)


def _loops(links: Collection[RoleLink]) -> Collection[set[Node]]:
    """The roles that feed each other in a circle, as many of them together as do."""
    feeds: dict[Node, set[Node]] = {}
    for link in links:
        feeds.setdefault(link.source, set()).add(link.sink)
    group = strong_components(feeds)
    loops: dict[Node, set[Node]] = {}
    for source, sink, *_ in links:
        if group[source] == group[sink]:
            loops.setdefault(group[source], set()).update((source, sink))
    return loops.values()


def starving_inputs(file: LintedFile) -> Iterator[Diagnostic]:
    """Inputs that a role asks for and no role that feeds it could feed."""
    for roles, links in _templates(file):
        normal = {role: NormalForm(file.source, (role,)) for role in roles}
        for sink in roles:
            if _fed_otherwise(file, sink):
                continue
            feeding = [link for link in links if link.sink == sink]
            for asked in _asked(normal[sink], _INPUT):
                if any(_could(file, normal[link.source], link, asked) for link in feeding):
                    continue
                what = " ".join(["an input", *_described(file, asked)])
                feeders = listed(sorted({file.short(str(link.source)) for link in feeding}))
                if feeders:
                    message = f"This asks for {what}, which nothing that {feeders} is asked for could feed."
                    hint = (
                        "Ask for such an output there, let another role feed this one, or let an interaction name it."
                    )
                else:
                    message = f"This asks for {what}, and no role feeds the role {file.short(str(sink))}."
                    hint = f"Let a role sc:feeds {file.short(str(sink))}."
                yield file.at(_place(file, asked.statement), "SC-L13", message, hint=hint)


def _fed_otherwise(file: LintedFile, role: Node) -> bool:
    """Whether recruits, or what is outside of the template, feed the players of a role, as other roles may do."""
    recruits = file.graph.objects(role, _RECRUITS)
    return any(not isinstance(shape, Literal) or shape.value for shape in recruits) or _outside(file, role, _INPUT)


def _outside(file: LintedFile, role: Node, *links: URIRef) -> bool:
    """Whether a template has a port of a role, to which one of some properties leads, for what is outside."""
    ports = file.graph.subjects(URIRef(SC.of), role)
    return any((None, link, port) in file.graph for port in ports for link in links)


def _templates(file: LintedFile) -> Iterator[tuple[list[Node], list[RoleLink]]]:
    """The roles of each template, in order, and which feeds which."""
    graph, places = file.graph, file.positions.triples
    for head in set(graph.objects(None, URIRef(SC.roles))):
        roles = list(file.items(head))
        links = [
            RoleLink(role, sink, None, None, places[role, _FEEDS, sink].object)
            for role in roles
            for sink in graph.objects(role, _FEEDS)
            if sink in roles
        ]
        for node in graph.subjects(RDF.type, URIRef(SC.Interaction)):
            source, sink = graph.value(node, URIRef(SC["from"])), graph.value(node, URIRef(SC.to))
            if source in roles and sink in roles and source is not None and sink is not None:
                ports = graph.value(node, URIRef(SC.output)), graph.value(node, URIRef(SC.input))
                links.append(RoleLink(source, sink, *ports, places[node, URIRef(SC.to), sink].object))
        yield roles, links


def _comes_out(file: LintedFile, role: Node) -> bool:
    """Whether something comes of a role but for what it feeds: it may act, or issues or answers for the template."""
    return _acts(file, role) or _outside(file, role, _OUTPUT, _OFFERED)


def _acts(file: LintedFile, role: Node) -> bool:
    """Whether a role may act on the world: it is an actuator, or of a kind that no loaded ontology tells about."""
    kinds = [str(kind) for kind in file.graph.objects(role, SH["class"])]
    return not kinds or any(file.index.serves(kind, ROB.Actuator) or file.index.undeclared(kind) for kind in kinds)


def _asked(normal: NormalForm, link: URIRef) -> Iterator[Ask]:
    """The inputs or outputs that a role asks for; not the inputs that it asks to be optional."""
    for along, signals in ((_SIGNAL, True), (_NAME, False)):
        values = normal.values.get((RDF.first, link, along))
        for one in values.required if values else ():
            yield Ask(None, one[2], one) if signals else Ask(one[2], None, one)
    ports = normal.values.get((link,))
    for port, statement in _ports(ports) if ports else ():
        if not _optional(port):
            yield Ask(_only(port, _NAME), _only(port, _SIGNAL), statement)


def _ports(ports: ValueNormalForm) -> Iterator[tuple[NormalForm, ShapeStatement]]:
    """What has to hold of a port that has to be there, and what says so: a shape for some ports, or for all of them."""
    needed, source = ports.needed(), ports.source
    if needed is None:
        return
    shapes = [
        (shape, inner)
        for shape in ports.shapes
        for inner in source.values(shape, SH.qualifiedValueShape)
        if any(isinstance(n, Literal) and n.value for n in source.values(shape, SH.qualifiedMinCount))
    ]
    for shape, inner in shapes:
        yield NormalForm(source, (inner,)), (shape, SH.qualifiedValueShape, inner)
    if not shapes:
        yield ports.each, needed[1]


def _optional(port: NormalForm) -> bool:
    """Whether a port has to be one that may stay unfed."""
    return _only(port, _OPTIONAL) == Literal(True)


def _only(port: NormalForm, path: URIRef) -> Node | None:
    """The value that a port has to have, if one is asked for."""
    values = port.values.get((path,))
    if values is None:
        return None
    listed = [items for one in values.each.own if one[1] == SH["in"] and len(items := port.source.items(one[2])) == 1]
    return next((one[2] for one in values.required), listed[0][0] if listed and path == _SIGNAL else None)


def _could(file: LintedFile, source: NormalForm, link: RoleLink, wanted: Ask) -> bool:
    """Whether what is asked of a source leaves room for an output that feeds the input."""
    if link.input is not None and wanted.name is not None and link.input != wanted.name:
        return False
    outputs = source.values.get((_OUTPUT,))
    if outputs is not None and any(most == 0 for most, _ in outputs.most):
        return False
    offered = [ask.signal for ask in _asked(source, _OUTPUT) if ask.signal is not None]
    if wanted.signal is None or not offered:
        return True
    return any(file.index.serves(str(signal), str(wanted.signal)) for signal in offered)


def _described(file: LintedFile, asked: Ask) -> Iterator[str]:
    if asked.name is not None:
        yield f'"{asked.name}"'
    if asked.signal is not None:
        yield f"of {file.short(str(asked.signal))}"


def _place(file: LintedFile, statement: ShapeStatement) -> int:
    places = file.positions.triples.get(statement)
    return places.object if places else file.offset(statement[0])
