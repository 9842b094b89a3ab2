"""Literals as rdflib and pySHACL understand them: whether one is well-typed, and which of two is the greater.

pySHACL also orders what has no order, a date and a number by the names of their datatypes, two IRIs by their letters,
and so lets `sh:minInclusive 5` pass any date, and `sh:lessThan` too. Here only literals of one value space have an
order, as in SPARQL, and NaN has none; pySHACL is corrected by that (`selfconf.rdf.pyshacl_corrections`).

Loading both takes longer than most configurations, so `selfconf.rdf.shacl` imports this module when a test needs it.
"""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime, timedelta
from decimal import Decimal

import rdflib
from pyshacl.rdfutil.compare import compare_literal
from rdflib.xsd_datetime import Duration

from selfconf.model.term import Literal, Term
from selfconf.rdf.rdflib_terms import rdflib_term

UNORDERED = (TypeError, ArithmeticError)
"""What comparing two literals raises if they have no order; the latter for a decimal beside NaN."""
_compare: Callable[[rdflib.Literal, rdflib.Literal], int] = compare_literal
_VALUE_SPACES: tuple[tuple[type, ...], ...] = ((int, float, Decimal), (str,), (datetime,), (timedelta, Duration))
"""The Python classes of values that have an order whatever their datatypes are."""

_MARKUP = frozenset((rdflib.RDF.XMLLiteral, rdflib.RDF.HTML))
"""The datatypes whose values are documents, which have no order; rdflib fails to tell whether two are equal."""


def _value_space(literal: rdflib.Literal) -> object:
    """What literals with an order have in common: their language, or the classes of their values, or their datatype."""
    if literal.language:
        return literal.language.lower()
    kind = type(literal.value)
    return next((classes for classes in _VALUE_SPACES if kind in classes), literal.datatype)


def compare_in_order(one: rdflib.Literal, other: rdflib.Literal) -> int:
    """How two literals compare: negative, zero or positive. Raises one of UNORDERED where they have no order."""
    if _MARKUP & {one.datatype, other.datatype} or _value_space(one) != _value_space(other):
        raise TypeError("the two have no order")
    if one.ill_typed or other.ill_typed:  # rdflib gives 300 to "300"^^xsd:byte, and orders it by its datatype
        raise TypeError("what is no form of its datatype has no value")
    if one.value != one.value or other.value != other.value:
        raise TypeError("NaN is neither less nor greater than any number")
    if one.language:  # rdflib orders by the tag first, as it is written: `en` comes after `EN`
        return (str(one) > str(other)) - (str(one) < str(other))
    return _compare(one, other)


def well_typed(literal: Literal) -> bool:
    """Whether the lexical form of a literal is one of its datatype."""
    found = rdflib_term(literal)
    return isinstance(found, rdflib.Literal) and found.ill_typed is not True


def has_value(literal: Literal) -> bool:
    """Whether a literal stands for a value that others can be compared with."""
    found = rdflib_term(literal)
    return isinstance(found, rdflib.Literal) and found.value is not None


def comparable(one: Term, other: Term) -> bool:
    """Whether two literals are of one value space; what is of another has no order beside either (SPARQL 1.1, 17.3)."""
    first, second = rdflib_term(one), rdflib_term(other)
    if not isinstance(first, rdflib.Literal) or not isinstance(second, rdflib.Literal):
        return False
    return _value_space(first) == _value_space(second)


def order(value: Term, limit: Term) -> int | None:
    """How a value compares with a limit: negative, zero or positive; None where the two have no order (SHACL, 4.3)."""
    return order_of(rdflib_term(value), rdflib_term(limit))


def order_of(one: rdflib.term.Node, other: rdflib.term.Node) -> int | None:
    if not isinstance(one, rdflib.Literal) or not isinstance(other, rdflib.Literal):
        return None
    if isinstance(one.value, str) != isinstance(other.value, str):
        return None
    try:
        return compare_in_order(one, other)
    except UNORDERED:
        return None
