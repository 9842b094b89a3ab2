"""The lints about ports: such as no component has, such as have no signal type, and operations that have one."""

from __future__ import annotations

from collections.abc import Iterator

from rdflib import RDF, Literal, URIRef

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf import vocabulary
from selfconf.rdf.validation.lints.linted_file import LintedFile

_SC = vocabulary.SC


def ownerless_ports(file: LintedFile) -> Iterator[Diagnostic]:
    """Ports that no component has: with a signal type, and without anything that has them; and components with one."""
    for kind, link in ((_SC.signalType, "sc:hasInput or sc:hasOutput"), (_SC.parameterType, "sc:hasParameter")):
        part = "port" if kind == _SC.signalType else "parameter"
        for node in sorted(set(file.graph.subjects(URIRef(kind))), key=file.offset):
            if (node, RDF.type, URIRef(_SC.Component)) in file.graph:
                said = file.positions.triples[next(file.graph.triples((node, URIRef(kind), None)))].predicate
                message = f"{file.short(kind)} says nothing of a component, so this is passed over."
                yield file.at(said, "SC-L25", message, hint=f"Say it of a {part} in brackets, by {link}.")
            elif (None, None, node) not in file.graph and (node, RDF.type, URIRef(_SC.Interaction)) not in file.graph:
                message = "No component has this port." if part == "port" else "Nothing has this parameter."
                yield file.at(file.offset(node), "SC-L17", message, hint=f"Say whose it is, by {link}.")


def untyped_ports(file: LintedFile) -> Iterator[Diagnostic]:
    """Ports of components that have no signal type, which is allowed and seldom meant."""
    for link in (_SC.hasInput, _SC.hasOutput):
        for node in sorted(set(file.graph.objects(None, URIRef(link))), key=file.offset):
            said = (URIRef(_SC.signalType), RDF.first)  # a list is no port at all
            if isinstance(node, Literal) or any((node, one, None) in file.graph for one in said):
                continue
            name = file.graph.value(node, URIRef(_SC.name))
            called = "This port" if name is None else f"The port {str(name)!r}"
            hint = "Give it a sc:signalType, or name it in each sc:Interaction that is to pair it."
            yield file.at(file.offset(node), "SC-L18", f"{called} has no signal type.", hint=hint)


def typed_operations(file: LintedFile) -> Iterator[Diagnostic]:
    """Operations that have a signal type, by which nothing is paired with them."""
    signal = URIRef(_SC.signalType)
    for link in (_SC.hasOperation, _SC.needsOperation):
        for node in sorted(set(file.graph.objects(None, URIRef(link))), key=file.offset):
            for kind in file.graph.objects(node, signal):
                message = "An operation has no signal type, so this is passed over."
                hint = "Say what it takes by sc:request, and what it answers by sc:response."
                yield file.at(file.positions.triples[node, signal, kind].predicate, "SC-L24", message, hint=hint)
