"""What a SPARQL query must not say, so that it reads the graph that is there and nothing else.

rdflib, on which pySHACL evaluates the queries of shapes, fetches what SERVICE and FROM name, and writes keywords with
escapes: `ser\\u0076ice` is SERVICE to it. Oxigraph cannot be interrupted, and takes hours for brackets nested deep.
"""

from __future__ import annotations

import re
from itertools import accumulate

from rdflib import SH, Graph
from rdflib.plugins.sparql.parser import expandUnicodeEscapes
from rdflib.term import Node

from selfconf.errors import QueryError

LONGEST = 20_000
"""Characters of the query of a shape."""
DEEPEST = 100
"""How deep its brackets may nest."""
_STRINGS_IRIS_COMMENTS = re.compile(
    r'"""(?:[^"\\]|\\.|"(?!""))*"""'
    r"|'''(?:[^'\\]|\\.|'(?!''))*'''"
    r'|"(?:[^"\\\n]|\\.)*"'
    r"|'(?:[^'\\\n]|\\.)*'"
    r"|<[^<>\"{}|^`\\\s]*>"
    r"|\#[^\n]*"
)


def says(text: str, word: str) -> bool:
    """Whether a query has a word as a keyword, not in a string, an IRI, a comment, a variable or a name."""
    bare = without(text, "#", '"', "'", "<")
    return re.search(rf"(?<![\w?$:@.-]){word}(?![\w:-])", bare, re.IGNORECASE) is not None


def without(text: str, *marks: str) -> str:
    """A query with a blank for each of its strings, IRIs or comments that begins with one of some marks."""
    return _STRINGS_IRIS_COMMENTS.sub(lambda token: " " if token[0].startswith(marks) else token[0], text)


def only_reads(text: str) -> None:
    """Raises QueryError for a query of a user that asks others, however that is spelt."""
    if says(text, "SERVICE") or says(expandUnicodeEscapes(text), "SERVICE"):
        raise QueryError("SERVICE is not allowed: a query reads the ecology and nothing else")


def fault(text: str) -> str | None:
    """Why the query of a shape is not evaluated, in a sentence; None if it may be."""
    depth = max(accumulate((mark in "([{") - (mark in ")]}") for mark in text), default=0)
    if len(text) > LONGEST or depth > DEEPEST:
        return "This query is too long, or nests too deeply, to be judged."
    expanded = expandUnicodeEscapes(text)
    for word in ("SERVICE", "FROM", "GRAPH", "LOAD"):
        if says(text, word) or says(expanded, word):
            return f"The query of a role reads the advertisements and nothing else: leave out {word}."
    return None


def faults(shapes: Graph) -> dict[tuple[Node, Node, Node], str]:
    """Every query in some shapes that is not evaluated, as the triple that holds it, and why."""
    return {
        (subject, predicate, query): reason
        for predicate in (SH.select, SH.ask, SH.construct, SH.update)
        for subject, query in shapes.subject_objects(predicate)
        if (reason := fault(str(query))) is not None
    }
