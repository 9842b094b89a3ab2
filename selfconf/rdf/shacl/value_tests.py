"""What SHACL asks of one value: its kind, datatype, range, length and pattern (SHACL 4.1.2, 4.1.3, 4.3, 4.4), and
that it is less than the values of another property (4.5.3, 4.5.4).

Whether a literal is well-formed, and which of two is the greater, is decided by rdflib, as it is in pySHACL
(`selfconf.rdf.literal_comparison`): two opinions on what `"07"^^xsd:integer` is would be one too many. Verdicts are
remembered, as values recur.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import lru_cache
from types import ModuleType

from selfconf.model.immutable import immutable
from selfconf.model.literal_values import natural_number
from selfconf.model.term import IRI, STRING, BlankNode, Literal, Term
from selfconf.rdf.shacl.patterns import MatchTooCostly, pattern_fault, shacl_pattern
from selfconf.rdf.vocabulary import RDFS, SH, XSD

_KINDS: Mapping[IRI, tuple[type, ...]] = {
    SH.IRI: (IRI,),
    SH.BlankNode: (BlankNode,),
    SH.Literal: (Literal,),
    SH.BlankNodeOrIRI: (BlankNode, IRI),
    SH.BlankNodeOrLiteral: (BlankNode, Literal),
    SH.IRIOrLiteral: (IRI, Literal),
}
_LIMITS: Mapping[IRI, Callable[[int], bool]] = {
    SH.minInclusive: lambda order: order >= 0,
    SH.minExclusive: lambda order: order > 0,
    SH.maxInclusive: lambda order: order <= 0,
    SH.maxExclusive: lambda order: order < 0,
}
PAIRS: Mapping[IRI, Callable[[int], bool]] = {
    SH.lessThan: lambda order: order < 0,
    SH.lessThanOrEquals: lambda order: order <= 0,
}
"""The constraints that compare a value with those of another property of the node that has it."""
_LOWER, _UPPER = (SH.minInclusive, SH.minExclusive), (SH.maxInclusive, SH.maxExclusive)
_STRICT = (SH.minExclusive, SH.maxExclusive)
_NOTHING_BEYOND = {SH.minExclusive: Literal("INF", XSD.double), SH.maxExclusive: Literal("-INF", XSD.double)}
_SAMPLES = ("1", "true", "2000-01-01", "2000-01-01T00:00:00", "12:00:00", "P1D")
"""Texts of which one at least is a literal of each datatype whose values have an order."""
_ANY: frozenset[type] = frozenset((IRI, BlankNode, Literal))
_LENGTHS = frozenset((SH.minLength, SH.maxLength))
_SOLE = frozenset((SH.nodeKind, SH.datatype, SH.minLength, SH.maxLength))
"""Constraints of which a shape may state only one."""


@immutable
class ValueTest:
    """One constraint on each value: the SHACL parameter, its value, and for patterns the flags."""

    constraint: IRI
    wanted: Term
    flags: str = ""

    def passes(self, value: Term) -> bool:
        """Whether a value is as wanted. Raises MatchTooCostly for a pattern that takes too long to find out about."""
        return _passes(self, value)


def passes_all(tests: Iterable[ValueTest], value: Term) -> bool:
    """Whether a value passes all of some tests, and that is found in time."""
    try:
        return all(test.passes(value) for test in tests)
    except MatchTooCostly:
        return False


@immutable
class PairTest:
    """Each value is less than each of another property: one of PAIRS, and the other property."""

    constraint: IRI
    other: IRI

    def passes(self, value: Term, others: Iterable[Term]) -> bool:
        """Whether a value is as wanted beside the values of the other property; what has no order is not."""
        return all(_ordered(self.constraint, value, other) for other in others)


@lru_cache(maxsize=1 << 12)
def _ordered(constraint: IRI, value: Term, other: Term) -> bool:
    order = _literals().order(value, other)
    return order is not None and PAIRS[constraint](order)


def exclude(one: ValueTest, other: ValueTest) -> bool:
    """Whether no value passes both of two tests, where that is certain: nothing lies between two limits, and so on."""
    if _kinds(one).isdisjoint(_kinds(other)):
        return True
    first, second = sorted((one, other), key=lambda test: _SIDES.get(test.constraint, len(_SIDES)))
    kinds = first.constraint, second.constraint
    if kinds == (SH.datatype, SH.datatype):
        return first.wanted != second.wanted
    if kinds == (SH.minLength, SH.maxLength):
        return _length(first.wanted) > _length(second.wanted)
    if kinds[0] in _LIMITS and kinds[1] == SH.datatype:
        sample = _sample(second.wanted)
        return sample is not None and not _literals().comparable(sample, first.wanted)
    return kinds[0] in _LIMITS and kinds[1] in _LIMITS and _nothing_between(first, second)


def _nothing_between(one: ValueTest, other: ValueTest) -> bool:
    """Whether no value lies within two limits: nothing is between them, or has an order beside both."""
    if not _literals().comparable(one.wanted, other.wanted):
        return True
    if one.constraint not in _LOWER or other.constraint not in _UPPER:
        return False
    order = _order_of_limits(one.wanted, other.wanted)
    strict = one.constraint in _STRICT or other.constraint in _STRICT
    return order is not None and (order > 0 or (order == 0 and strict))


def passed_by_none(test: ValueTest) -> bool:
    """Whether no value passes a test: its limit is NaN, which has no order, or there is nothing beyond it."""
    if test.constraint not in _LIMITS or not isinstance(test.wanted, Literal):
        return False
    beyond = _NOTHING_BEYOND.get(test.constraint)
    return _order_of_limits(test.wanted, test.wanted) is None or (
        beyond is not None and _order_of_limits(test.wanted, beyond) == 0
    )


_SIDES = {kind: number for number, kind in enumerate((SH.minLength, SH.maxLength, *_LOWER, *_UPPER, SH.datatype))}
"""The side on which a constraint stands when two are compared: lower limits first, datatypes last."""


def _kinds(test: ValueTest) -> frozenset[type]:
    """What a value that passes can be at all: an IRI, a blank node, a literal."""
    if test.constraint == SH.nodeKind:
        return frozenset(_KINDS.get(test.wanted, _ANY)) if isinstance(test.wanted, IRI) else _ANY
    if test.constraint == SH.datatype or test.constraint in _LIMITS:
        return frozenset((Literal,))
    return frozenset((IRI, Literal)) if test.constraint == SH.pattern else _ANY


def _length(wanted: Term) -> int:
    return natural_number(wanted) or 0


def _order_of_limits(low: Term, high: Term) -> int | None:
    """How two limits compare: negative, zero or positive; None where they have no order."""
    order: int | None = _literals().order(low, high)
    return order


@lru_cache
def _sample(datatype: Term) -> Literal | None:
    """A literal of a datatype whose values have an order."""
    if not isinstance(datatype, IRI):
        return None
    literals = (Literal(text, datatype) for text in _SAMPLES)
    return next((one for one in literals if _literals().well_typed(one) and _literals().has_value(one)), None)


def compiled(constraints: Mapping[IRI, list[Term]]) -> tuple[list[ValueTest], set[IRI]]:
    """The tests for those constraints that are compiled, and the constraints that they cover."""
    tests: list[ValueTest] = []
    covered: set[IRI] = set()
    for constraint, wanted in constraints.items():
        flags = constraints.get(SH.flags, []) if constraint == SH.pattern else []
        if len(flags) > 1 or (constraint in _SOLE and len(wanted) > 1):
            continue
        found = [ValueTest(constraint, value, str(flags[0]) if flags else "") for value in wanted]
        if all(map(_compiles, found)):
            tests += found
            covered |= {constraint, SH.flags} if constraint == SH.pattern else {constraint}
    return tests, covered


def _compiles(test: ValueTest) -> bool:
    """Whether the constraint is one of those here and its value is one that it can have."""
    wanted = test.wanted
    if test.constraint == SH.nodeKind:
        return wanted in _KINDS
    if test.constraint == SH.datatype:
        return isinstance(wanted, IRI) and wanted not in (RDFS.Literal, RDFS.Datatype)
    if not isinstance(wanted, Literal):
        return False
    if test.constraint in _LENGTHS:
        return natural_number(wanted) is not None
    if test.constraint in _LIMITS:
        return bool(_literals().has_value(wanted))
    if test.constraint != SH.pattern or wanted.datatype != XSD.string:
        return False
    return pattern_fault(wanted.lexical, test.flags) is None


@lru_cache(maxsize=1 << 16)
def _passes(test: ValueTest, value: Term) -> bool:
    wanted = test.wanted
    if test.constraint == SH.nodeKind:
        assert isinstance(wanted, IRI)
        return isinstance(value, _KINDS[wanted])
    if test.constraint == SH.datatype:
        if not isinstance(value, Literal) or value.datatype != wanted:
            return False
        return bool(wanted == STRING or _literals().well_typed(value))  # every lexical form is a string
    if test.constraint in _LIMITS:
        order = _literals().order(value, wanted)
        return order is not None and _LIMITS[test.constraint](order)
    if test.constraint in _LENGTHS:
        least = test.constraint == SH.minLength
        number = int(str(wanted))
        return not isinstance(value, BlankNode) and (len(str(value)) >= number if least else len(str(value)) <= number)
    return not isinstance(value, BlankNode) and shacl_pattern(str(wanted), test.flags).finds(str(value))


def _literals() -> ModuleType:
    """rdflib's and pySHACL's view of literals, loaded when a value first needs it: most tasks ask for none."""
    from selfconf.rdf import literal_comparison

    return literal_comparison
