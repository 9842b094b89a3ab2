"""Turtle in and out: text to triples of the model's terms, and triples to text, by Oxigraph.

`Document` is the triples of one source by subject; `parse` reads one. `Triple` and `Node` are its parts.
`term`, `resource` and `named` pass between Oxigraph's terms, Turtle's names and the model's terms; `SKOLEM` marks the
IRIs that stand for labelled blank nodes. `ntriples` and `to_turtle` write; `ox_term` makes a term of Oxigraph.
`not_turtle` words a syntax error.
"""

from selfconf.rdf.turtle.document import SKOLEM, Document, Node, Triple, named, not_turtle, parse, resource, term
from selfconf.rdf.turtle.serialization import ntriples, ox_term, to_turtle

__all__ = [
    "SKOLEM",
    "Document",
    "Node",
    "Triple",
    "named",
    "not_turtle",
    "ntriples",
    "ox_term",
    "parse",
    "resource",
    "term",
    "to_turtle",
]
