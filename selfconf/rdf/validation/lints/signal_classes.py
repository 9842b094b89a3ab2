"""Classes of signals in the place of components and ports, and classes of components in the place of signals.

A component, a port and a signal are three things: a component has ports, a port is a node with a name and a signal
type, and the signal type is a class of signals. What names one for another is well-formed, and matches nothing.
"""

from __future__ import annotations

from collections.abc import Iterator

from rdflib import RDF, SH, Literal, URIRef
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.vocabulary import SC

_PORT_LINKS = frozenset(map(URIRef, (SC.hasInput, SC.hasOutput)))
_TYPE_LINKS = frozenset(map(URIRef, (SC.signalType, SC.request, SC.response)))
"""What leads to a class of signals."""


def signals_among_types(file: LintedFile) -> Iterator[Diagnostic]:
    """Classes of signals among the types of a component."""
    for component in set(file.graph.subjects(RDF.type, URIRef(SC.Component))):
        for kind in file.graph.objects(component, RDF.type):
            if file.index.classes_signals(str(kind)):
                message = f"{file.short(str(kind))} is a kind of signals, and no component is a signal."
                hint = "Say of a port that it has such signals, by sc:signalType."
                offset = file.positions.triples[component, RDF.type, kind].object
                yield file.at(offset, "SC-L28", message, hint=hint)


def components_as_signals(file: LintedFile) -> Iterator[Diagnostic]:
    """Classes of components as the types of signals."""
    for (_, predicate, kind), offsets in file.positions.triples.items():
        if predicate in _TYPE_LINKS and file.index.classes_components(str(kind)):
            yield _component_kind(file, kind, offsets.object)


def misplaced_classes_in_shapes(file: LintedFile) -> Iterator[Diagnostic]:
    """Shapes that ask of a port what is true of its signal type, or of a signal type what is true of its signals."""
    accepting = set(file.graph.objects(None, URIRef(SC.accepts)))
    for shape, word, kind, offset in _asked_classes(file):
        path = file.graph.value(shape, SH.path)
        last = [path, *file.items(path)][-1] if path is not None else None
        short = file.short(str(kind))
        if (last in _PORT_LINKS or shape in accepting) and file.index.classes_signals(str(kind)):
            message = f"{short} is a kind of signals, and no port is a signal."
            steps = "sc:signalType" if last is None else f"( {file.short(str(last))} sc:signalType )"
            hint = f"Ask for its signal type: sh:property [ sh:path {steps} ; sh:hasValue {short} ]."
            yield file.at(offset, "SC-L28", message, hint=hint)
        elif (last in _PORT_LINKS or shape in accepting) and file.index.classes_components(str(kind)):
            message = f"{short} is a kind of components, and no port is a component."
            owner = f"sh:property [ sh:path [ sh:inversePath {file.short(SC.hasOutput)} ] ; sh:class {short} ]"
            asked = f"Ask it of the component: {owner}." if last is None else None
            yield file.at(offset, "SC-L28", message, hint=asked)
        elif last in _TYPE_LINKS and word == SH["class"]:
            message = (
                f"This asks for a signal of the type {short}, and {file.short(str(last))} leads to the type itself."
            )
            yield file.at(offset, "SC-L28", message, hint=f"Write sh:hasValue {short}.")
        elif last in _TYPE_LINKS and file.index.classes_components(str(kind)):
            yield _component_kind(file, kind, offset)


def _component_kind(file: LintedFile, kind: Node, offset: int) -> Diagnostic:
    message = f"{file.short(str(kind))} is a kind of components, and no signal is a component."
    return file.at(offset, "SC-L28", message, hint="Name a class of signals.")


def _asked_classes(file: LintedFile) -> Iterator[tuple[Node, Node, Node, int]]:
    """What shapes ask values to be or to be instances of: the shape, the word of SHACL, the IRI and its place."""
    listed = {cell: shape for shape, values in file.graph.subject_objects(SH["in"]) for cell in file.cells(values)}
    for (node, predicate, kind), offsets in file.positions.triples.items():
        if isinstance(kind, Literal):
            continue
        if predicate == RDF.first and node in listed:
            yield listed[node], SH["in"], kind, offsets.object
        elif predicate == SH["class"] or predicate == SH.hasValue:
            yield node, predicate, kind, offsets.object
