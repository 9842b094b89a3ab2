"""Faults: what is wrong with the values of one property of a component, each worded by the name of the property.

All faults of a property together are one obstacle (`PropertyUnmet` of `selfconf.model.obstacle`).
"""

from __future__ import annotations

from selfconf.model.immutable import immutable
from selfconf.model.literal_values import DATATYPES
from selfconf.model.term import IRI, Literal, Term
from selfconf.model.wording import in_full, in_words, term_in_words, with_article

_LIMITS = {
    "minInclusive": "at least",
    "minExclusive": "more than",
    "maxInclusive": "at most",
    "maxExclusive": "less than",
}
_PAIRS = {"lessThan": "less than", "lessThanOrEquals": "at most"}
_LENGTHS = {"minLength": "at least", "maxLength": "at most"}


@immutable
class Missing:
    """There is no value where one has to be."""

    def said(self, name: str) -> str:
        """The fault of the property of that name."""
        return f"has no {name}"


@immutable
class WrongCount:
    """There are fewer or more values than the role allows."""

    found: int
    too_many: bool

    def said(self, name: str) -> str:
        """The fault of the property of that name."""
        return f"has {self.found} of {name}, too {'many' if self.too_many else 'few'}"


@immutable
class WrongShareOfValues:
    """Fewer or more values are of some kind than the role allows (`sh:qualifiedValueShape`)."""

    found: int
    wanted: int
    too_many: bool

    def said(self, name: str) -> str:
        """The fault of the property of that name."""
        limit = "most" if self.too_many else "least"
        return f"has {self.found} of {name} that are as asked for, not at {limit} {self.wanted}"


@immutable
class NotAmong:
    """Some values are not among those that the role allows (`sh:in`), or not the one that it requires."""

    values: frozenset[Term]
    members: frozenset[Term]
    partly: bool = False
    """Whether the property has further values, which are among them."""

    def said(self, name: str) -> str:
        """The fault of the property of that name."""
        alike = {_bare(value) for value in self.values} & {_bare(member) for member in self.members}
        worded = in_full if alike else in_words
        said, wanted = worded(self.values), worded(self.members)
        return f"{name} is {said} as well, not only {wanted}" if self.partly else f"{name} is {said}, not {wanted}"


def _bare(term: Term) -> str:
    """What a term is called without the marks that distinguish a literal from an IRI."""
    return term.lexical if isinstance(term, Literal) else term_in_words(term)


@immutable
class ConstraintFailed:
    """Some values fail a constraint of SHACL on each value; `constraint` is its parameter, such as `sh:pattern`.

    Where that compares two properties (`sh:lessThan`), `wanted` is the other one.
    """

    values: frozenset[Term]
    constraint: IRI
    wanted: Term

    def said(self, name: str) -> str:
        """The fault of the property of that name."""
        return f"{name} is {in_words(self.values)}{self._number}, not {self._wanted}"

    @property
    def _number(self) -> str:
        """Which datatype numbers have where another is asked for: 5 is an integer, 5.0 a decimal and 5e0 a double."""
        kinds = {value.datatype for value in self.values if isinstance(value, Literal)}
        if (
            self.constraint.short != "datatype"
            or len(kinds) != 1
            or self.wanted in kinds
            or kinds.isdisjoint(DATATYPES)
        ):
            return ""
        return f", {with_article(kinds.pop().short)}"

    @property
    def _wanted(self) -> str:
        constraint = self.constraint.short
        wanted = self.wanted.short if isinstance(self.wanted, IRI) else str(self.wanted)
        if constraint in _LIMITS:
            return f"{_LIMITS[constraint]} {term_in_words(self.wanted)}"
        if constraint in _LENGTHS:
            return f"{_LENGTHS[constraint]} {wanted} characters long"
        if constraint in _PAIRS:
            return f"{_PAIRS[constraint]} its {wanted}"
        return f"like /{wanted}/" if constraint == "pattern" else with_article(wanted)


@immutable
class Ambiguous:
    """There are several values where a free parameter has to be equal to each."""

    parameter: IRI

    def said(self, name: str) -> str:
        """The fault of the property of that name."""
        return f"{name} has several values, so that no one {self.parameter.short} fits"


Fault = Missing | WrongCount | WrongShareOfValues | NotAmong | ConstraintFailed | Ambiguous


def subject_of(fault: Fault) -> str:
    """What a fault is said of: the component, or its property."""
    return "it" if isinstance(fault, Missing | WrongCount | WrongShareOfValues) else "its"
