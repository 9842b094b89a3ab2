"""The statements that make up the shape of a role, as they stand in the document of its template."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace

from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.turtle import Document, Node, Triple
from selfconf.rdf.vocabulary import FIRST, SC, SH, TYPE

ROLE_STRUCTURE = frozenset((TYPE, SC.feeds, SC.sets, SC.minCount, SC.maxCount, SC.recruits))
"""What is said of a role besides its shape."""


def substituted(document: Document, values: Mapping[IRI, Term]) -> Document:
    """A template with parameters replaced by their values wherever they stand in shapes: in lists and paths too."""
    if not values:
        return document
    statements = {
        subject: [
            (predicate, values[value])
            if isinstance(value, IRI) and value in values and (predicate in SH or predicate == FIRST)
            else (predicate, value)
            for predicate, value in said
        ]
        for subject, said in document.statements.items()
    }
    return replace(document, statements=statements)


def mentions(document: Document, shape: Term, parameters: frozenset[IRI]) -> set[IRI]:
    """The parameters that stand somewhere in a shape, such as that of a role."""
    found: set[IRI] = set()
    for _, value in [] if isinstance(shape, Literal) else shape_statements(document, shape):
        if value in parameters and isinstance(value, IRI):
            found.add(value)
    return found


def shape_statements(document: Document, role: Node) -> Iterator[tuple[IRI, Term]]:
    """Predicate and object of each statement of a role's shape, nested and named shapes included."""
    for _, predicate, value in shape_triples(document, role):
        yield predicate, value


def shape_triples(document: Document, role: Node) -> Iterator[Triple]:
    """Each statement of a role's shape, nested and named shapes included."""
    waiting: list[Node] = [role]
    seen: set[Term] = {role}
    while waiting:
        subject = waiting.pop()
        for predicate, value in document.statements.get(subject, ()):
            if subject == role and predicate in ROLE_STRUCTURE:
                continue
            yield subject, predicate, value
            if not isinstance(value, Literal) and value not in seen:
                seen.add(value)
                waiting.append(value)
