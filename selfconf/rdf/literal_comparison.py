"""Literals as rdflib and pySHACL understand them: whether one is well-typed, and which of two is the greater.

Loading both takes longer than most configurations, so `selfconf.rdf.shacl` imports this module when a test needs it.
"""

from __future__ import annotations

from collections.abc import Callable

import rdflib
from pyshacl.rdfutil.compare import compare_literal

from selfconf.model.term import Literal, Term
from selfconf.rdf.rdflib_terms import rdflib_term

UNORDERED = (TypeError, ArithmeticError)
"""What comparing two literals raises if they have no order; the latter for a decimal beside NaN."""
_compare: Callable[[rdflib.Literal, rdflib.Literal], int] = compare_literal


def well_typed(literal: Literal) -> bool:
    """Whether the lexical form of a literal is one of its datatype."""
    found = rdflib_term(literal)
    return isinstance(found, rdflib.Literal) and found.ill_typed is not True


def has_value(literal: Literal) -> bool:
    """Whether a literal stands for a value that others can be compared with."""
    found = rdflib_term(literal)
    return isinstance(found, rdflib.Literal) and found.value is not None


def order(value: Term, limit: Term) -> int | None:
    """How a value compares with a limit: negative, zero or positive; None where the two have no order (SHACL, 4.3)."""
    one, other = rdflib_term(value), rdflib_term(limit)
    if not isinstance(one, rdflib.Literal) or not isinstance(other, rdflib.Literal):
        return None
    if isinstance(one.value, str) != isinstance(other.value, str):
        return None
    try:
        return _compare(one, other)
    except UNORDERED:
        return None
