"""What the value of an operational parameter is to a component's code."""

from __future__ import annotations

from selfconf.model.number import DATATYPES, plain_number
from selfconf.model.term import Literal, Term
from selfconf.model.truth import BOOLEAN, TRUTH


def as_python(term: Term) -> bool | int | float | str:
    """A term as code likes it: a truth value or a number where its datatype is one of these, else its text.

    Raises ValueError for a literal that is no truth value, or no finite number, of its datatype.
    """
    if not isinstance(term, Literal):
        return str(term)
    if term.datatype == BOOLEAN and term.lexical in TRUTH:
        return TRUTH[term.lexical]
    if term.datatype != BOOLEAN and term.datatype not in DATATYPES:
        return term.lexical
    number = plain_number(term)
    if number is None:
        raise ValueError(f"{term.lexical!r} is no xsd:{term.datatype.short}")
    return number
