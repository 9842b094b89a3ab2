"""Which datatypes are numbers, and what a literal is as a value of Python (XSD 1.1 Part 2, section 3.4).

This is the one table: everything that asks whether a datatype is that of a number, or what number a literal is, asks
here.
"""

from __future__ import annotations

import re

from selfconf.model.term import IRI, XSD, Literal, Term

WHOLE = frozenset(
    IRI(XSD + name)
    for name in (
        "integer", "nonPositiveInteger", "negativeInteger", "nonNegativeInteger", "positiveInteger",
        "long", "int", "short", "byte", "unsignedLong", "unsignedInt", "unsignedShort", "unsignedByte",
    )
)  # fmt: skip
"""xsd:integer and every datatype that XSD derives from it."""
NUMERIC = WHOLE | {IRI(XSD + name) for name in ("decimal", "double", "float")}
"""Every datatype of numbers."""
BOOLEAN = IRI(XSD + "boolean")

_TRUTH = {"true": True, "1": True, "false": False, "0": False}
_WHOLE = re.compile(r"[+-]?[0-9]+")
_REAL = re.compile(r"[+-]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?|[+-]?INF|NaN")
"""What XSD takes for a number; Python's `int` and `float` take more, such as 1_000 and nan."""


def as_python(term: Term) -> bool | int | float | str:
    """A term as code likes it: a truth value or a number where the datatype is one of these, else its text.

    Raises ValueError for a literal that is none of its datatype; bounds such as those of xsd:byte are not checked.
    """
    if not isinstance(term, Literal) or (term.datatype not in NUMERIC and term.datatype != BOOLEAN):
        return str(term)
    lexical = term.lexical.strip(" \t\r\n")  # white space around it is no part of the value (XSD, section 4.3.6)
    if term.datatype == BOOLEAN:
        if lexical in _TRUTH:
            return _TRUTH[lexical]
    elif term.datatype in WHOLE:
        if _WHOLE.fullmatch(lexical):
            return int(lexical)
    elif _REAL.fullmatch(lexical):
        return float(lexical)
    raise ValueError(f"{term.lexical!r} is no xsd:{term.datatype.short}")
