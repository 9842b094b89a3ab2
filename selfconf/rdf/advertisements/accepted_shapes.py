"""What an input accepts: a SHACL shape in an advertisement, which the output that feeds it has to conform to.

An advertisement is written by a stranger, so the shape is one of SHACL Core (W3C, 2017, sections 2 to 4) without
targets, SPARQL or other shapes by name: a tree of blank nodes and lists of bounded size. Its text, with the statements
of each node sorted, is its identity: inputs that ask for the same are the same to the search.
"""

from __future__ import annotations

from collections.abc import Iterator

from selfconf.model.term import BlankNode, Literal, Term
from selfconf.rdf.permitted_fields import DEEPEST_SHAPE, LISTS_OF_SHAPES, PERMITTED_IN_SHAPES, SHAPE_VALUED
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import FIRST, REST, SH

LARGEST_SHAPE = 200
"""How many statements a shape has at most."""
LONGEST_LITERAL = 300
"""How many characters a literal in a shape has at most: numbers, patterns."""


class ShapeNotAccepted(Exception):
    """A shape that no advertisement may hold: what is wrong with it, and the statement at fault, if it is one."""

    def __init__(self, problem: str, statement: Triple | None = None) -> None:
        super().__init__(problem)
        self.statement = statement


def accepted_shape(document: Document, shape: Term) -> str:
    """The text of a shape, as Turtle in brackets. Raises ShapeNotAccepted."""
    for _ in statements_of_shape(document, shape):
        pass
    return shape_text(document, shape)


def statements_of_shape(document: Document, shape: Term) -> Iterator[Triple]:
    """Every statement of a shape, as long as each may be one of an advertisement. Raises ShapeNotAccepted."""
    if document.value(shape, FIRST) is not None or document.value(shape, REST) is not None:
        raise ShapeNotAccepted("it is a list, not a shape")
    waiting, seen, number = [(shape, 1)], set[Term](), 0
    while waiting:
        node, depth = waiting.pop()
        if not isinstance(node, BlankNode) or node in seen:
            raise ShapeNotAccepted("a shape and all that belongs to it stands in brackets, once")
        seen.add(node)
        said = dict.fromkeys(document.about(node))
        if not said:
            raise ShapeNotAccepted("there are brackets in it that say nothing")
        number += len(said)
        if number > LARGEST_SHAPE or depth > DEEPEST_SHAPE:
            raise ShapeNotAccepted(f"it has more than {LARGEST_SHAPE} statements, or nests too deeply")
        for predicate, value in said:
            _look_at(document, (node, predicate, value))
            yield node, predicate, value
            if isinstance(value, BlankNode):
                waiting.append((value, depth + (predicate != REST)))


def _look_at(document: Document, statement: Triple) -> None:
    """Raise ShapeNotAccepted for a statement that has no place in the shape of an advertisement."""
    _, predicate, value = statement
    if predicate not in PERMITTED_IN_SHAPES:
        problem = f"sh:{predicate.short} is not" if predicate in SH else f"<{predicate}> is not"
        raise ShapeNotAccepted(f"{problem} of SHACL Core, or has no place in an advertisement", statement)
    members = document.items(value) if predicate in LISTS_OF_SHAPES else [value]
    if predicate in SHAPE_VALUED and not all(isinstance(member, BlankNode) for member in members):
        raise ShapeNotAccepted(f"the value of sh:{predicate.short} stands in brackets", statement)
    if isinstance(value, Literal) and len(value.lexical) > LONGEST_LITERAL:
        raise ShapeNotAccepted(f"a literal in it is longer than {LONGEST_LITERAL} characters", statement)


def shape_text(document: Document, value: Term) -> str:
    """A term of a shape, a path for example, as Turtle: equal for what says the same."""
    if isinstance(value, Literal):
        return value.turtle(lambda datatype: f"<{datatype}>")
    if not isinstance(value, BlankNode):
        return f"<{value}>"
    if document.value(value, FIRST) is not None and document.value(value, REST) is not None:
        return f"( {' '.join(shape_text(document, item) for item in document.items(value))} )"
    said = sorted({f"<{predicate}> {shape_text(document, one)}" for predicate, one in document.about(value)})
    return f"[ {' ; '.join(said)} ]"
