"""The queries of shapes (SHACL, sections 5 and 6), and why one is not asked.

Beside what keeps a text from being a query at all, three mistakes make one that finds nothing, so that every component
conforms: a prefix that is not declared as its author believes, a pattern of REGEX or REPLACE that is no regular
expression, and flags that rdflib passes over. They are looked for where a query has them as constants,
in one text or in several that CONCAT joins.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

import pyoxigraph as ox

from selfconf.model.curie import is_prefix
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.shacl.patterns import pattern_fault
from selfconf.rdf.sparql import hidden, why_not_asked
from selfconf.rdf.turtle import Document, Node, Triple
from selfconf.rdf.vocabulary import OWL, SH

DECLARATION = "a node with one sh:prefix and one sh:namespace, which is an absolute IRI as a text"
"""What the value of sh:declare has to be, in words."""
_FLAGS = "ims"
"""The flags of SPARQL (XPath, 7.6.1.1) that rdflib knows."""
_CALL = re.compile(r"(?<![\w?$@:.-])(REGEX|REPLACE)\s*\(", re.IGNORECASE)
_CONCAT = re.compile(r"CONCAT\s*\(", re.IGNORECASE)
_PLACE_OF_FLAGS = {"REGEX": 2, "REPLACE": 3}
_ABSOLUTE = re.compile(r"[A-Za-z][\w+.-]*:")


def refused_queries(document: Document, constraint: Node) -> Iterator[tuple[Triple, str]]:
    """Each query of a constraint that is not asked, or declaration of a prefix for it that is none, and a sentence.

    There are none for a node that is no constraint with a query.
    """
    prefixes: dict[str, str] = {}
    for triple in _declarations(document, constraint):
        declared = _declared(document, triple[2])
        if declared is None:
            yield triple, f"The value of sh:declare has to be {DECLARATION}."
            return
        prefix, namespace = declared
        if prefixes.setdefault(prefix, namespace) != namespace:
            yield triple, f"The prefix {prefix}: stands for <{prefixes[prefix]}> in this query already."
            return
    for predicate, query in document.about(constraint):
        if predicate in (SH.select, SH.ask):
            text = str(query)
            reason = why_not_asked(text, prefixes, predicate.short) or _misleading(text)
            if reason is not None:
                yield (constraint, predicate, query), reason


def _declarations(document: Document, constraint: Term) -> Iterator[Triple]:
    """The declarations of prefixes for a constraint: `sh:prefixes/owl:imports*/sh:declare` (SHACL, 5.2.1)."""
    owners = document.values(constraint, SH.prefixes)
    for owner in owners:  # which grows on the way
        if not isinstance(owner, Literal):
            yield from ((owner, SH.declare, each) for each in document.values(owner, SH.declare))
            owners += [one for one in document.values(owner, OWL.imports) if one not in owners]


def _declared(document: Document, declaration: Term) -> tuple[str, str] | None:
    """The prefix and the namespace of a declaration; None where it is none."""
    said = [document.values(declaration, predicate) for predicate in (SH.prefix, SH.namespace)]
    match said:
        case [[Literal() as prefix], [Literal() as namespace]]:
            fits = is_prefix(prefix.lexical) and _is_absolute(namespace.lexical)
            return (prefix.lexical, namespace.lexical) if fits else None
    return None


def _is_absolute(text: str) -> bool:
    try:
        return _ABSOLUTE.match(IRI(text)) is not None
    except ValueError:
        return False


def _misleading(text: str) -> str | None:
    """What a query asks by a pattern or by flags that make it find nothing, in a sentence; None if it asks neither."""
    for function, arguments in _calls(text):
        values = [_constant(argument) for _, argument in arguments]
        place = _PLACE_OF_FLAGS[function]
        flags = values[place] if len(values) > place else ""
        if flags is not None and not set(flags) <= set(_FLAGS):
            return f"At {_position(text, arguments[place][0])} the flags of {function} may be i, m and s alone."
        pattern = values[1] if len(values) > 1 else None
        fault = None if pattern is None else pattern_fault(pattern, flags or "")
        if fault is not None:
            return f"The pattern of {function} at {_position(text, arguments[1][0])} is no regular expression: {fault}."
    return None


def _calls(text: str) -> Iterator[tuple[str, list[tuple[int, str]]]]:
    """The calls of REGEX and REPLACE in a query: which it is, and its arguments, each with its offset."""
    bare = hidden(text)
    for call in _CALL.finditer(bare):
        yield call[1].upper(), _arguments(text, bare, call.end())[0]


def _arguments(text: str, bare: str, begin: int) -> tuple[list[tuple[int, str]], int]:
    """The arguments of a call behind its opening bracket, each with its offset, and where the call ends.

    `bare` is the text without strings, IRIs and comments.
    """
    depth, arguments = 0, list[tuple[int, str]]()
    for offset in range(begin, len(bare)):
        mark = bare[offset]
        if depth == 0 and mark in ",)":
            argument = text[begin:offset]
            arguments.append((begin + len(argument) - len(argument.lstrip()), argument.strip()))
            begin = offset + 1
            if mark == ")":
                break
        depth += (mark in "([{") - (mark in ")]}")
    return arguments, begin


def _constant(expression: str) -> str | None:
    """The text that an expression is, if it is a literal, or CONCAT of such.

    To evaluate others could take as long as they like.
    """
    bare = hidden(expression)
    if (joining := _CONCAT.match(bare)) is not None:
        arguments, end = _arguments(expression, bare, joining.end())
        texts = [_constant(argument) for _, argument in arguments if not bare[end:].strip()]
        known = [text for text in texts if text is not None]
        return "".join(known) if texts and len(known) == len(texts) else None
    if not expression.startswith(("'", '"')) or bare.strip():
        return None
    try:
        answer = ox.Store().query(f"SELECT ?value {{ VALUES ?value {{ {expression} }} }}")
    except SyntaxError:  # a string without an end
        return None
    values = [row["value"] for row in answer] if isinstance(answer, ox.QuerySolutions) else []
    return values[0].value if len(values) == 1 and isinstance(values[0], ox.Literal) else None


def _position(text: str, offset: int) -> str:
    """Line and column of an offset, from 1 on."""
    before = text[:offset]
    return f"{before.count(chr(10)) + 1}:{offset - before.rfind(chr(10))}"
