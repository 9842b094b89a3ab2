"""The fields of a kind of signal, and whether a value has them: what an output emits is checked against its type.

A signal is a JSON object with a member for each field; further members are allowed, as a kind of signal below this one
has more. A field holds one value of its datatype, or, if it is repeated, any number of them in order. JSON has numbers,
truth values and text: numeric datatypes of XML Schema are checked as numbers (whole ones by their bounds, and as in
JSON Schema 2.0 is a whole number; all others by what a double holds), xsd:boolean as a truth value, dates, times,
durations and languages as text that is written as one, every other datatype of XML Schema as text, such as that of
bytes, which may be long, and a datatype that is of none of these kinds is not checked.

A signal that travels as bytes, or as an array, has no fields that could be checked; its kind says whether it may.

The check has to cost less than writing the value as JSON. So a value of the usual Python types is judged by operations
that run in C for a whole list, and words are looked for only where something is wrong.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from operator import countOf, eq
from reprlib import Repr
from typing import Any, NamedTuple

from selfconf.model.literal_values import DATATYPES, TEXT_PATTERNS, WHOLE_NUMBERS
from selfconf.model.term import IRI, XSD_NAMESPACE

_SHORT = Repr()
_SHORT.maxstring = _SHORT.maxother = 40
_MOST_NAMES = 8
"""How many members a problem names."""
_ABSENT = object()
_BINARY = frozenset((XSD_NAMESPACE + "base64Binary", XSD_NAMESPACE + "hexBinary"))
"""The datatypes of bytes; a signal with a field of these, or with repeated ones, may travel as bytes or an array."""
_LISTS = frozenset((list, tuple))


class SignalField(NamedTuple):
    """A field of a kind of signal: its name, the datatype of its value, or of each of its values if it is repeated."""

    name: str
    datatype: IRI
    required: bool = True
    repeated: bool = False


class _JsonKind(NamedTuple):
    """What a datatype is in JSON."""

    usual: frozenset[type]
    """The Python types of most values."""
    bounded: bool
    least: float
    greatest: float
    holds: Callable[[Any], bool]
    """Whether any other value is of the kind, its bounds aside."""
    finite: bool = False
    """Whether the bounds hold for every double but NaN and infinity."""


class _Check(NamedTuple):
    """A field with what is asked of it."""

    field: SignalField
    name: str
    required: bool
    repeated: bool
    usual: frozenset[type]
    bounded: bool
    least: float
    greatest: float
    holds: Callable[[Any], bool]
    finite: bool


@dataclass(frozen=True)
class SignalFields:
    """The fields of one kind of signal, in order."""

    signal: IRI
    fields: tuple[SignalField, ...]
    _checks: tuple[_Check, ...] = field(init=False, repr=False, compare=False)
    _holds_bulk: bool = field(init=False, repr=False, compare=False)
    """Whether it has a field of bytes or of many values, or no field at all."""

    def __post_init__(self) -> None:
        checks = [_Check(one, one.name, one.required, one.repeated, *_kind(one.datatype)) for one in self.fields]
        object.__setattr__(self, "_checks", tuple(checks))
        holds_bulk = not self.fields or any(one.repeated or one.datatype in _BINARY for one in self.fields)
        object.__setattr__(self, "_holds_bulk", holds_bulk)

    # complexity: this runs for every signal; a call for each field would double what most signals cost
    def problem(self, value: object) -> str | None:
        """What keeps a value from being such a signal, as a sentence without its subject; None if nothing does."""
        if not isinstance(value, dict):
            return self._no_object(f"is {_SHORT.repr(value)}")
        for check in self._checks:
            _, name, required, repeated, usual, bounded, least, greatest, _, _ = check
            found = value.get(name, _ABSENT)
            if not repeated:
                if type(found) in usual and (not bounded or least <= found <= greatest):
                    continue
            elif type(found) in _LISTS and _are_usual(check, found):
                continue
            if found is _ABSENT and not required:
                continue
            said = self._carefully(check, found, value)
            if said is not None:
                return said
        return None

    def problem_of_bytes(self) -> str | None:
        """What keeps bytes from being such a signal; None for a kind with a field of bytes or of many values."""
        return None if self._holds_bulk else self._no_object("is bytes")

    def _carefully(self, check: _Check, found: Any, value: dict[Any, Any]) -> str | None:
        """What is wrong with the value of a field that is not plainly right."""
        wanted = f"{'a list of ' if check.repeated else ''}{_short(check.field.datatype)}"
        if not check.required and (found is _ABSENT or found is None):
            return None
        if found is _ABSENT:
            names = ", ".join(map(_SHORT.repr, list(value)[:_MOST_NAMES])) or "no members"
            return f"lacks {check.name!r} ({wanted}), which {self.signal.short} has; it has {names}"
        if not check.repeated:
            right = found is not None and _holds(check, found)
            return None if right else f"has {_SHORT.repr(found)} as {check.name!r}, which is {wanted}"
        if not isinstance(found, list | tuple):
            return f"has {_SHORT.repr(found)} as {check.name!r}, which is {wanted}"
        for number, item in enumerate(found):
            if not _holds(check, item):
                return f"has {_SHORT.repr(item)} at {number} in {check.name!r}, which is {wanted}"
        return None

    def _no_object(self, what: str) -> str:
        return f"{what}, where {self.signal.short} is an object with {self._names()}"

    def _names(self) -> str:
        return ", ".join(repr(one.name) for one in self.fields[:_MOST_NAMES])


def _are_usual(check: _Check, values: Sequence[Any]) -> bool:
    """Whether all values of a list are of the usual types, and within the bounds of the datatype.

    Doubles with a finite sum are finite each, as NaN and infinity stay in a sum; it is had in a sixth of the time of
    the least and the greatest, which decide where finite doubles have a sum beyond all doubles. NaN is neither of these
    unless it comes first; it alone is not equal to itself.
    """
    if check.finite and countOf(map(type, values), float) == len(values) and math.isfinite(sum(values)):
        return True
    if not check.usual.issuperset(map(type, values)):
        return False
    if check.finite and not all(map(eq, values, values)):
        return False
    return not (check.bounded and values) or (check.least <= min(values) and max(values) <= check.greatest)


def _holds(check: _Check, value: Any) -> bool:
    return check.holds(value) and (not check.bounded or check.least <= value <= check.greatest)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _is_whole(value: object) -> bool:
    return _is_number(value) and (isinstance(value, int) or (isinstance(value, float) and value.is_integer()))


def _kind(datatype: IRI) -> _JsonKind:
    """What a datatype is in JSON."""
    if datatype in WHOLE_NUMBERS:
        least, greatest = WHOLE_NUMBERS[datatype]
        bounded = (least, greatest) != (None, None)
        low, high = -math.inf if least is None else least, math.inf if greatest is None else greatest
        return _JsonKind(frozenset((int,)), bounded, low, high, _is_whole)
    if datatype in DATATYPES:
        most = sys.float_info.max
        return _JsonKind(frozenset((int, float)), True, -most, most, _is_number, finite=True)
    unbounded = (False, -math.inf, math.inf)
    if datatype == XSD_NAMESPACE + "boolean":
        return _JsonKind(frozenset((bool,)), *unbounded, lambda value: isinstance(value, bool))
    if datatype in TEXT_PATTERNS:
        written = TEXT_PATTERNS[datatype].fullmatch
        return _JsonKind(frozenset(), *unbounded, lambda value: isinstance(value, str) and written(value) is not None)
    if datatype.startswith(XSD_NAMESPACE):
        return _JsonKind(frozenset((str,)), *unbounded, lambda value: isinstance(value, str))
    return _JsonKind(frozenset(), *unbounded, lambda _: True)


def _short(datatype: IRI) -> str:
    return f"xsd:{datatype.short}" if datatype.startswith(XSD_NAMESPACE) else str(datatype)
