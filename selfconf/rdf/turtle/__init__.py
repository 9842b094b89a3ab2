"""Turtle in and out: text to triples of the model's terms, and triples to text, by Oxigraph.

`Document` is the triples of one source by subject; `parse` reads one. `Triple` and `Node` are its parts, and
`ListFault` is what can be wrong with a list in it.
`term`, `resource` and `named` pass between Oxigraph's terms, Turtle's names and the model's terms; `SKOLEM` marks the
IRIs that stand for labelled blank nodes. `ntriples` and `to_turtle` write, and `pretty_turtle` writes for people;
`ox_term` makes a term of Oxigraph. `not_turtle` words a syntax error; `advice` is what to try then, `undeclared_prefix`
the prefix that it may be about, and `USUAL` are those that most texts declare. `read_ontology` reads any format of RDF,
and `in_turtle` makes Turtle of it that can be read elsewhere;
`format_of` and `other_format` tell which one a file is in (`RdfFormat`), and `conversion` is the command that makes
Turtle of it. `first_not_utf_8` finds the place where a text is not UTF-8, and `check_utf_8` refuses it.
`check_turtle_1_1` refuses what only Turtle 1.2 has. `QUOTED` and `COMMENT` match what hides signs in a text.
"""

from selfconf.rdf.turtle.advice import USUAL, advice, undeclared_prefix
from selfconf.rdf.turtle.document import (
    SKOLEM,
    Document,
    ListFault,
    Node,
    Triple,
    named,
    not_turtle,
    parse,
    resource,
    term,
)
from selfconf.rdf.turtle.formats import RdfFormat, conversion, format_of, in_turtle, other_format, read_ontology
from selfconf.rdf.turtle.refused_text import check_turtle_1_1, check_utf_8, first_not_utf_8
from selfconf.rdf.turtle.serialization import ntriples, ox_term, pretty_turtle, to_turtle
from selfconf.rdf.turtle.tokens import COMMENT, QUOTED

__all__ = [
    "COMMENT",
    "QUOTED",
    "SKOLEM",
    "USUAL",
    "Document",
    "ListFault",
    "Node",
    "RdfFormat",
    "Triple",
    "advice",
    "check_turtle_1_1",
    "check_utf_8",
    "conversion",
    "first_not_utf_8",
    "format_of",
    "in_turtle",
    "named",
    "not_turtle",
    "ntriples",
    "other_format",
    "ox_term",
    "parse",
    "pretty_turtle",
    "read_ontology",
    "resource",
    "term",
    "to_turtle",
    "undeclared_prefix",
]
