"""What an input accepts: a SHACL shape in an advertisement, which the output that feeds it has to conform to.

An advertisement is written by a stranger, so the shape is one of SHACL Core (W3C, 2017, sections 2 to 4) without
targets, SPARQL or other shapes by name: a tree of blank nodes and lists of bounded size. Its text, with the statements
of each node sorted, is its identity: inputs that ask for the same are the same to the search.
"""

from __future__ import annotations

from collections.abc import Iterator

from selfconf.model.term import BlankNode, Literal, Term
from selfconf.rdf.permitted_fields import PERMITTED_IN_SHAPES, SHAPE_VALUED
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import FIRST, NIL, REST, SH

LARGEST_SHAPE = 200
"""How many statements a shape has at most."""
DEEPEST = 15
"""How deep nodes are nested in a shape at most, as deep as pySHACL looks."""


class ShapeNotAccepted(Exception):
    """A shape that no advertisement may hold: what is wrong with it, and the statement at fault, if it is one."""

    def __init__(self, problem: str, statement: Triple | None = None) -> None:
        super().__init__(problem)
        self.statement = statement


def accepted_shape(document: Document, shape: Term) -> str:
    """The text of a shape, as Turtle in brackets. Raises ShapeNotAccepted."""
    for _ in statements_of_shape(document, shape):
        pass
    return _text(document, shape)


def statements_of_shape(document: Document, shape: Term) -> Iterator[Triple]:
    """Every statement of a shape, as long as each may be one of an advertisement. Raises ShapeNotAccepted."""
    waiting, seen, number = [(shape, 1)], set[Term](), 0
    while waiting:
        node, depth = waiting.pop()
        if not isinstance(node, BlankNode) or node in seen:
            raise ShapeNotAccepted("a shape and all that belongs to it stands in brackets, once")
        seen.add(node)
        said = dict.fromkeys(document.about(node))
        if not said:
            raise ShapeNotAccepted("there are brackets in it that say nothing")
        for predicate, value in said:
            number += 1
            statement = node, predicate, value
            if number > LARGEST_SHAPE or depth > DEEPEST:
                raise ShapeNotAccepted(f"it has more than {LARGEST_SHAPE} statements, or nests too deeply")
            if predicate not in PERMITTED_IN_SHAPES:
                problem = f"sh:{predicate.short} is not" if predicate in SH else f"<{predicate}> is not"
                raise ShapeNotAccepted(f"{problem} of SHACL Core, or has no place in an advertisement", statement)
            if predicate in SHAPE_VALUED and not isinstance(value, BlankNode) and value != NIL:
                raise ShapeNotAccepted(f"the value of sh:{predicate.short} stands in brackets", statement)
            yield statement
            if isinstance(value, BlankNode):
                waiting.append((value, depth + (predicate != REST)))


def _text(document: Document, value: Term) -> str:
    """A term of a shape as Turtle."""
    if isinstance(value, Literal):
        return value.turtle(lambda datatype: f"<{datatype}>")
    if not isinstance(value, BlankNode):
        return f"<{value}>"
    if document.value(value, FIRST) is not None and document.value(value, REST) is not None:
        return f"( {' '.join(_text(document, item) for item in document.items(value))} )"
    said = sorted({f"<{predicate}> {_text(document, one)}" for predicate, one in document.about(value)})
    return f"[ {' ; '.join(said)} ]"
