"""Which literals are numbers and which are truth values, what they stand for, and what they are in Python.

A literal is a *number* here if its datatype is one of XML Schema's numeric datatypes, its text is in the lexical space
of that datatype (XSD 1.1 part 2, sections 3.3.3 to 3.3.5 and 3.4.13 to 3.4.25), and its value is finite. Infinity and
not-a-number measure nothing. `shapes:Number` in `shapes/advertisement.ttl` says the same; a test holds the two
together.

It is a *truth value* if its datatype is xsd:boolean and its text is in the lexical space of that datatype (section
3.3.2.2): `true`, `false`, `1` or `0`. The shapes say the same by `sh:datatype xsd:boolean`.
"""

from __future__ import annotations

import math
import re
from decimal import Decimal
from fractions import Fraction

from selfconf.model.term import STRING, XSD_NAMESPACE, Literal, Term

MOST_CHARACTERS = 300
"""A longer text is no measurement. The bound also keeps every decimal within the range of a double, and its fraction
small."""

_Bounds = tuple[int | None, int | None]
_WHOLE: dict[str, _Bounds] = {
    "integer": (None, None),
    "nonNegativeInteger": (0, None),
    "positiveInteger": (1, None),
    "nonPositiveInteger": (None, 0),
    "negativeInteger": (None, -1),
    "byte": (-(1 << 7), (1 << 7) - 1),
    "short": (-(1 << 15), (1 << 15) - 1),
    "int": (-(1 << 31), (1 << 31) - 1),
    "long": (-(1 << 63), (1 << 63) - 1),
    "unsignedByte": (0, (1 << 8) - 1),
    "unsignedShort": (0, (1 << 16) - 1),
    "unsignedInt": (0, (1 << 32) - 1),
    "unsignedLong": (0, (1 << 64) - 1),
}
WHOLE_NUMBERS: dict[str, _Bounds] = {XSD_NAMESPACE + name: bounds for name, bounds in _WHOLE.items()}
"""The datatypes of whole numbers, each with its least and its greatest value."""
FLOATING = frozenset((XSD_NAMESPACE + "double", XSD_NAMESPACE + "float"))
"""The datatypes with an exponent; both are read with the range of a double."""
LIMITLESS = frozenset(("INF", "+INF", "-INF", "NaN"))
"""The texts of a datatype with an exponent that stand for no number."""
DATATYPES = frozenset((*WHOLE_NUMBERS, XSD_NAMESPACE + "decimal", *FLOATING))
"""The datatypes of numbers."""
_DECIMAL = r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)"
_LEXICAL = {
    **dict.fromkeys(WHOLE_NUMBERS, re.compile("[+-]?[0-9]+")),
    XSD_NAMESPACE + "decimal": re.compile(_DECIMAL),
    **dict.fromkeys(FLOATING, re.compile(_DECIMAL + "(?:[eE][+-]?[0-9]+)?")),
}

_DATE = r"-?(?:[1-9][0-9]{3,}|0[0-9]{3})-(?:0[1-9]|1[0-2])-(?:0[1-9]|[12][0-9]|3[01])"
_TIME = r"(?:(?:[01][0-9]|2[0-3]):[0-5][0-9]:[0-5][0-9](?:\.[0-9]+)?|24:00:00(?:\.0+)?)"
_ZONE = r"(?:Z|[+-](?:(?:0[0-9]|1[0-3]):[0-5][0-9]|14:00))"
_DAYS = r"(?:[0-9]+D)?(?:T(?=[0-9])(?:[0-9]+H)?(?:[0-9]+M)?(?:[0-9]+(?:\.[0-9]+)?S)?)?"
_TEXTS = {
    "dateTime": f"{_DATE}T{_TIME}{_ZONE}?",
    "dateTimeStamp": f"{_DATE}T{_TIME}{_ZONE}",
    "date": f"{_DATE}{_ZONE}?",
    "time": f"{_TIME}{_ZONE}?",
    "duration": f"-?P(?=[0-9T])(?:[0-9]+Y)?(?:[0-9]+M)?{_DAYS}",
    "dayTimeDuration": f"-?P(?=[0-9T]){_DAYS}",
    "yearMonthDuration": "-?P(?=[0-9])(?:[0-9]+Y)?(?:[0-9]+M)?",
    "language": "[A-Za-z]{1,8}(?:-[A-Za-z0-9]{1,8})*",
}
TEXT_PATTERNS = {XSD_NAMESPACE + name: re.compile(pattern) for name, pattern in _TEXTS.items()}
"""The lexical spaces of datatypes of short texts; that a month has that day is not looked at."""
_DERIVED = {
    XSD_NAMESPACE + "dateTime": (XSD_NAMESPACE + "dateTimeStamp",),
    XSD_NAMESPACE + "duration": (XSD_NAMESPACE + "dayTimeDuration", XSD_NAMESPACE + "yearMonthDuration"),
}
"""Those of them whose values are values of another, too (XSD 1.1, part 2, section 3.4)."""


def in_lexical_space(lexical: str, datatype: str) -> bool:
    """Whether a text may be one of a datatype of numbers or short texts; of any other datatype, that is not known.

    Whether a whole number is within the bounds of its datatype is not looked at.
    """
    pattern = _LEXICAL.get(datatype) or TEXT_PATTERNS.get(datatype)
    if pattern is None or pattern.fullmatch(lexical):
        return True
    return datatype in FLOATING and lexical in LIMITLESS


def number_of(lexical: str, datatype: str) -> Decimal | None:
    """The number that a text of a datatype stands for, exactly as it is written; None if it stands for none.

    An xsd:double or xsd:float that is too small for a double is zero.
    """
    pattern = _LEXICAL.get(datatype)
    if pattern is None or len(lexical) > MOST_CHARACTERS or not pattern.fullmatch(lexical):
        return None
    if datatype in FLOATING:
        rounded = float(lexical)
        if rounded == 0 or not math.isfinite(rounded):
            return Decimal(0) if rounded == 0 else None
    number = Decimal(lexical)
    least, greatest = WHOLE_NUMBERS.get(datatype, (None, None))
    if (least is not None and number < least) or (greatest is not None and number > greatest):
        return None
    return number


def number(term: Term) -> Decimal | None:
    """The number that a term stands for, exactly as it is written; None for anything else."""
    return number_of(term.lexical, term.datatype) if isinstance(term, Literal) else None


def fraction(term: Term) -> Fraction | None:
    """The number that a term stands for as an exact fraction; None for anything else."""
    found = number(term)
    return None if found is None else Fraction(found)


def plain_number(term: Term) -> int | float | None:
    """The number that a term stands for as Python's `int` where its datatype is one of whole numbers, else `float`."""
    found = number(term)
    if found is None or not isinstance(term, Literal):
        return None
    return int(found) if term.datatype in WHOLE_NUMBERS else float(found)


def integer(term: Term) -> int | None:
    """The number that a literal of xsd:integer stands for, as in `sc:priority`; None for anything else."""
    if not isinstance(term, Literal) or term.datatype != INTEGER:
        return None
    found = number(term)
    return None if found is None else int(found)


def natural_number(term: Term) -> int | None:
    """The number from zero on that a literal of xsd:integer stands for, as in `sh:minCount`; None for anything else."""
    found = integer(term)
    return None if found is None or found < 0 else found


INTEGER = XSD_NAMESPACE + "integer"
BOOLEAN = XSD_NAMESPACE + "boolean"
TRUTH = {"true": True, "1": True, "false": False, "0": False}
"""The texts of a truth value, each with what it stands for."""


def truth(term: Term | None) -> bool | None:
    """What a literal of xsd:boolean stands for; None for anything else."""
    return TRUTH.get(term.lexical) if isinstance(term, Literal) and term.datatype == BOOLEAN else None


def of_range(lexical: str, datatype: str, wanted: str) -> bool:
    """Whether a literal is what a property of a datatype wants: any number for one of fractions, else just that.

    Infinity and not-a-number are values of a float. A text is whatever is no number and no truth value. Everything is
    what a datatype wants that is none of numbers, truth values, texts or short texts (`TEXT_PATTERNS`).
    """
    if wanted == STRING:
        return datatype not in DATATYPES and datatype != BOOLEAN
    if wanted in WHOLE_NUMBERS:
        return datatype in DATATYPES and number_of(lexical, wanted) is not None
    if wanted in DATATYPES:
        limitless = datatype in FLOATING and lexical in LIMITLESS
        return limitless or number_of(lexical, datatype) is not None
    if wanted == BOOLEAN:
        return datatype == wanted and lexical in TRUTH
    pattern = TEXT_PATTERNS.get(wanted)
    datatypes = (wanted, *_DERIVED.get(wanted, ()))
    return pattern is None or (datatype in datatypes and pattern.fullmatch(lexical) is not None)


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
        limitless = term.datatype in FLOATING and in_lexical_space(term.lexical, term.datatype)
        raise ValueError(f"{term.lexical!r} is no {'finite ' * limitless}xsd:{term.datatype.short}")
    return number
