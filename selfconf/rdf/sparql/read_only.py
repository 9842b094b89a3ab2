"""What a SPARQL query must not say, so that it reads the graph that is there and nothing else.

rdflib, on which pySHACL evaluates the queries of shapes, fetches what SERVICE and FROM name, and writes keywords with
escapes: `ser\\u0076ice` is SERVICE to it. Oxigraph cannot be interrupted, and takes hours for brackets nested deep.
"""

from __future__ import annotations

import contextlib
import re
import sys
from collections.abc import Iterable
from itertools import accumulate
from typing import Any

from selfconf.errors import QueryError

LONGEST_QUERY = 20_000
"""Characters of the query of a shape."""
DEEPEST_QUERY = 100
"""How deep its brackets may nest."""
CALLS = 20_000 if sys.version_info >= (3, 11) else 10_000
"""How deep the calls of the parser may nest: for each triple after another it takes some ten.

Before Python 3.11 each call takes some of the stack of its thread, which holds 16,000 where it has 8 MiB.
"""
_PARTS = {"SERVICE": "ServiceGraphPattern", "FROM": "DatasetClause", "GRAPH": "GraphGraphPattern"}
"""What rdflib calls the parts of a query that begin with a keyword."""
# A string without an end is one up to where it has to end: to look for others in it would take quadratic time.
_STRINGS_IRIS_COMMENTS = re.compile(
    r'"""(?:[^"\\]|\\.|"(?!""))*(?:""")?'
    r"|'''(?:[^'\\]|\\.|'(?!''))*(?:''')?"
    r'|"(?:[^"\\\n]|\\.)*"?'
    r"|'(?:[^'\\\n]|\\.)*'?"
    r"|<[^<>\"{}|^`\\\s]*>"
    r"|\#[^\n]*"
    r"|\\."  # in a name, as `:a\#b`: what it escapes begins nothing
)


def says(text: str, word: str) -> bool:
    """Whether a query has a word as a keyword, not in a string, an IRI, a comment, a variable or a name."""
    bare = without(text, "#", '"', "'", "<")
    return re.search(rf"(?<![\w?$:@.-]){word}(?![\w:-])", bare, re.IGNORECASE) is not None


def without(text: str, *marks: str) -> str:
    """A query with a blank for each of its strings, IRIs or comments that begins with one of some marks."""
    return _STRINGS_IRIS_COMMENTS.sub(lambda token: " " if token[0].startswith(marks) else token[0], text)


def hidden(text: str) -> str:
    """A query with blanks for its strings, IRIs, comments and escapes; all else stays in its place."""
    return _STRINGS_IRIS_COMMENTS.sub(lambda token: re.sub(r"[^\n]", " ", token[0]), text)


def only_reads(text: str) -> None:
    """Raises QueryError for a query of a user that asks others, however that is spelt."""
    expanded = _expanded(text)
    try:
        asks = any(says(each, "SERVICE") for each in (text, expanded)) or "SERVICE" in _hidden(expanded, ("SERVICE",))
    except ValueError:
        raise QueryError(
            "this query cannot be parsed, or not so deep, and it may ask others: it has the word SERVICE"
        ) from None
    if asks:
        raise QueryError("SERVICE is not allowed: a query reads the ecology and nothing else")


def _hidden(expanded: str, words: Iterable[str]) -> set[str]:
    """Which of some words are keywords of a query without escapes, as a parser reads it; ValueError for no query.

    Only a parser knows whether `<` begins an IRI or compares, and so what is a string or a comment behind it. It takes
    long, so what has none of the words anywhere is not parsed.
    """
    mentioned = [word for word in words if word.lower() in expanded.lower()]
    if not mentioned:
        return set()
    from pyparsing import ParseBaseException, ParseResults
    from rdflib.plugins.sparql.parser import parseQuery

    found: set[str] = set()

    def visit(parsed: Any) -> None:
        found.add(getattr(parsed, "name", ""))
        if isinstance(parsed, dict | list | ParseResults):
            for part in parsed.values() if isinstance(parsed, dict) else parsed:
                visit(part)

    before = sys.getrecursionlimit()
    try:
        sys.setrecursionlimit(max(before, CALLS))
        visit(parseQuery(expanded))
    except (ParseBaseException, RecursionError):
        raise ValueError("no query") from None
    finally:
        sys.setrecursionlimit(before)
    return {word for word in mentioned if _PARTS[word] in found}


def fault(text: str) -> str | None:
    """Why the query of a shape is not evaluated, in a sentence; None if it may be."""
    depth = max(accumulate((mark in "([{") - (mark in ")]}") for mark in text), default=0)
    if len(text) > LONGEST_QUERY or depth > DEEPEST_QUERY:
        return "This query is too long, or nests too deeply, to be judged."
    expanded, hidden = _expanded(text), set[str]()
    with contextlib.suppress(ValueError):  # what pySHACL cannot parse it does not evaluate either
        hidden = _hidden(expanded, _PARTS)
    for word in (*_PARTS, "LOAD"):
        if word in hidden or says(text, word) or says(expanded, word):
            return f"The query of a role reads the advertisements and nothing else: leave out {word}."
    return None


def _expanded(text: str) -> str:
    """A query with its escapes `\\uXXXX` expanded, as rdflib does before it reads one."""
    from rdflib.plugins.sparql.parser import expandUnicodeEscapes  # loads what most commands never need

    return str(expandUnicodeEscapes(text))
