"""Literals as rdflib and pySHACL understand them: whether one is well-typed, and which of two is the greater.

pySHACL also orders what has no order, a date and a number by the names of their datatypes, and so lets `sh:minInclusive
5` pass any date. Here only literals of one value space have an order, as in SPARQL; within `only_ordered` pySHACL asks
for it here.

Loading both takes longer than most configurations, so `selfconf.rdf.shacl` imports this module when a test needs it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import datetime, timedelta
from decimal import Decimal

import rdflib
from pyshacl.constraints.core import value_range_constraints
from pyshacl.rdfutil.compare import compare_literal
from rdflib.xsd_datetime import Duration

from selfconf.model.term import Literal, Term
from selfconf.rdf.rdflib_terms import rdflib_term

UNORDERED = (TypeError, ArithmeticError)
"""What comparing two literals raises if they have no order; the latter for a decimal beside NaN."""
_compare: Callable[[rdflib.Literal, rdflib.Literal], int] = compare_literal
_VALUE_SPACES: tuple[tuple[type, ...], ...] = ((int, float, Decimal), (str,), (datetime,), (timedelta, Duration))
"""The Python classes of values that have an order whatever their datatypes are."""


def _value_space(literal: rdflib.Literal) -> object:
    """What literals with an order have in common: the classes of their values, or else their datatype."""
    kind = type(literal.value)
    return next((classes for classes in _VALUE_SPACES if kind in classes), literal.datatype)


def _compare_in_order(one: rdflib.Literal, other: rdflib.Literal) -> int:
    """How two literals compare: negative, zero or positive. Raises one of UNORDERED where they have no order."""
    if _value_space(one) != _value_space(other):
        raise TypeError("the two have no order")
    return _compare(one, other)


@contextmanager
def only_ordered() -> Iterator[None]:
    """In the block, a value passes a limit of pySHACL only if the two have an order."""
    module = vars(value_range_constraints)
    module["compare_literal"] = _compare_in_order
    try:
        yield
    finally:
        module["compare_literal"] = compare_literal


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
        return _compare_in_order(one, other)
    except UNORDERED:
        return None
