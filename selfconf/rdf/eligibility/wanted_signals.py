"""What the shape of a role asks of ports: the signal types of its outputs and inputs, and the shape without that.

A property shape is *about ports* if its path begins with `sc:hasOutput` or `sc:hasInput`; so is what `sh:and`, `sh:or`,
`sh:xone` or `sh:node` lead to, if it holds nothing else. Of these are gathered the classes that it names by
`sh:hasValue` or `sh:in` behind `sc:signalType`. That is enough to tell how near a component comes; whether it conforms
is judged by the whole shape.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import NamedTuple

from selfconf.model.immutable import replace
from selfconf.model.port_likeness import Types, WantedPorts
from selfconf.model.term import IRI, BlankNode, Term
from selfconf.rdf.permitted_fields import DEEPEST_SHAPE, LISTS_OF_SHAPES, SHAPE_ANNOTATIONS, SHAPE_VALUED
from selfconf.rdf.shacl import shapes_behind
from selfconf.rdf.turtle import Document, Node
from selfconf.rdf.vocabulary import RDF, RDFS, SC, SH

_PORTS = frozenset((SC.hasInput, SC.hasOutput))
_SAYS_NOTHING = SHAPE_ANNOTATIONS | {RDF.type, SH.severity}
_ASKING = SHAPE_VALUED - {SH["not"]}
"""What leads to shapes that say what there has to be."""


class _Want(NamedTuple):
    """What a shape wants of a port which a predicate links to: that it is of one of some types."""

    link: IRI
    types: Types


def wanted_ports(document: Document, role: IRI) -> WantedPorts | None:
    """What the shape of a role asks of ports; None if it asks nothing."""
    wants = [
        want
        for predicate, value in _statements_about_ports(document, role)
        for want in _said(document, predicate, value, (), 0)
    ]
    if not wants:
        return None
    issued = tuple(dict.fromkeys(want.types for want in wants if want.link == SC.hasOutput))
    given = tuple(dict.fromkeys(want.types for want in wants if want.link == SC.hasInput))
    return WantedPorts(issued or None, given or None)


def required_signals(document: Document, role: IRI) -> tuple[tuple[IRI, IRI], ...]:
    """What a component needs at least: `sc:hasInput` or `sc:hasOutput`, and the type of a port of that kind.

    Only what a property shape of the role asks for by `sh:hasValue` behind the types of ports counts.
    """
    found: list[tuple[IRI, IRI]] = []
    for shape in document.values(role, SH.property):
        path = _path(document, shape)
        if len(path) > 1 and path[0] in _PORTS and path[1] == SC.signalType and _upward(document, path[2:]):
            values = document.values(shape, SH.hasValue) if document.value(shape, SH.deactivated) is None else []
            found += [(link, one) for link in path[:1] if isinstance(link, IRI) for one in _classes(values)]
    return tuple(found)


def _upward(document: Document, steps: list[Term]) -> bool:
    """Whether the rest of a path leads from a class to classes above it alone, or nowhere."""
    star = [(SH.zeroOrMorePath, RDFS.subClassOf)]
    return all(step == RDFS.subClassOf or document.about(step) == star for step in steps)


def without_port_shapes(document: Document, role: IRI) -> Document:
    """A template in which the shape of a role asks nothing of ports."""
    about_ports = set(_statements_about_ports(document, role))
    said = [statement for statement in document.about(role) if statement not in about_ports]
    statements: dict[Node, list[tuple[IRI, Term]]] = {**document.statements, role: said}
    return replace(document, statements=statements)


def _statements_about_ports(document: Document, role: IRI) -> Iterator[tuple[IRI, Term]]:
    """The statements about a role that speak of ports alone."""
    return (
        (predicate, value)
        for predicate, value in document.about(role)
        if predicate in _ASKING
        and all(_about_ports(document, shape) for shape in shapes_behind(document, predicate, value))
    )


def _about_ports(document: Document, shape: Term, depth: int = 0) -> bool:
    """Whether a shape speaks of ports, and of nothing else."""
    path = _path(document, shape)
    if path:
        return path[0] in _PORTS
    said = [(predicate, value) for predicate, value in document.about(shape) if predicate not in _SAYS_NOTHING]
    return bool(said) and all(
        predicate in SHAPE_VALUED
        and depth <= DEEPEST_SHAPE
        and all(_about_ports(document, inner, depth + 1) for inner in shapes_behind(document, predicate, value))
        for predicate, value in said
    )


def _path(document: Document, shape: Term) -> list[Term]:
    """The path of a property shape, as the list of its steps."""
    path = document.value(shape, SH.path)
    if path is None:
        return []
    return list(document.items(path)) if isinstance(path, BlankNode) and document.value(path, RDF.first) else [path]


def _wants(document: Document, shape: Term, before: tuple[Term, ...], depth: int) -> Iterator[_Want]:
    """The types that a shape names, where the path that leads to them goes through the type of a port."""
    path = (*before, *_path(document, shape))
    for predicate, value in document.about(shape) if depth <= DEEPEST_SHAPE else ():
        yield from _said(document, predicate, value, path, depth)


def _said(document: Document, predicate: IRI, value: Term, path: tuple[Term, ...], depth: int) -> Iterator[_Want]:
    """The types that one statement of a shape names, or the shapes that it leads to."""
    if predicate in LISTS_OF_SHAPES:
        found = [want for one in document.items(value) for want in _wants(document, one, path, depth + 1)]
        yield from iter(found) if predicate == SH["and"] else _any_of(found)
    elif predicate in _ASKING:
        yield from _wants(document, value, path, depth + 1)
    elif predicate in (SH.hasValue, SH["in"]) and SC.signalType in path and isinstance(path[0], IRI):
        named = [value] if predicate == SH.hasValue else document.items(value)
        types = tuple(_classes(named))
        if types:
            yield _Want(path[0], types)


def _classes(named: Iterable[Term]) -> Iterator[IRI]:
    """The terms, among some, that may be classes."""
    return (one for one in named if isinstance(one, IRI))


def _any_of(wants: list[_Want]) -> Iterator[_Want]:
    """Alternatives as one want for each side: a port of any of the types."""
    for link in (SC.hasOutput, SC.hasInput):
        types = tuple(dict.fromkeys(one for want in wants if want.link == link for one in want.types))
        if types:
            yield _Want(link, types)
