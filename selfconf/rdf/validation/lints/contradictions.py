"""Contradictions: two statements of a shape, or of several, of which no value can satisfy both.

Only what is certain is found: whatever the advertisements say, and whatever a reasoning mode adds to them, no node
conforms. That is a property test against pySHACL. The converse cannot be had, since to tell whether a
shape of SHACL can be satisfied at all is undecidable (Pareti, Konstantinidis, Mogavero, Norman: *SHACL Satisfiability
and Containment*, ISWC 2020).
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

from rdflib import RDF, SH, XSD, BNode, Literal, URIRef
from rdflib.term import Node

from selfconf.model.term import IRI
from selfconf.rdf.rdflib_terms import from_rdflib
from selfconf.rdf.shacl import MatchTooCostly, ValueTest, compiled, exclude, passed_by_none
from selfconf.rdf.validation.lints.normal_form import NormalForm, ShapeStatement, ValueNormalForm, count_of

_KINDS: dict[Node, frozenset[type]] = {
    SH.IRI: frozenset((URIRef,)),
    SH.BlankNode: frozenset((BNode,)),
    SH.Literal: frozenset((Literal,)),
    SH.BlankNodeOrIRI: frozenset((BNode, URIRef)),
    SH.BlankNodeOrLiteral: frozenset((BNode, Literal)),
    SH.IRIOrLiteral: frozenset((URIRef, Literal)),
}
_ANY = frozenset((URIRef, BNode, Literal))
_LOWER, _UPPER = (SH.minInclusive, SH.minExclusive), (SH.maxInclusive, SH.maxExclusive)
_KINDS_OF: dict[Node, frozenset[type]] = {
    SH["class"]: _KINDS[SH.BlankNodeOrIRI],
    SH.datatype: _KINDS[SH.Literal],
    SH.languageIn: _KINDS[SH.Literal],
    SH.pattern: _KINDS[SH.IRIOrLiteral],
    **dict.fromkeys((*_LOWER, *_UPPER), _KINDS[SH.Literal]),
}
_OF_THE_TEXT = (SH.pattern, SH.minLength, SH.maxLength)
_TEXTS = (None, XSD.string, RDF.langString)


class ShapeContradiction(NamedTuple):
    """Two statements that cannot both hold, the one that gives way first."""

    one: ShapeStatement
    other: ShapeStatement


def contradictions(normal: NormalForm, choosing: bool = True) -> Iterator[ShapeContradiction]:
    """What makes it impossible to satisfy a normal form, at most once for the node itself and for each path."""
    yield from islice(_own(normal), 1)
    for path, values in list(normal.values.items()):
        yield from islice(_values(normal, values), 1)
        needed = values.needed()
        if needed is not None and isinstance(path[0], URIRef) and len(path) == 1:
            yield from (
                ShapeContradiction(closed, needed[1])
                for closed in normal.closed
                if path[0] not in _allowed(normal, closed)
            )
    for refused in normal.nots:
        if _asked(normal, refused[2]):
            yield ShapeContradiction(refused, refused)
            continue
        basis = _entailed(normal, refused[2])
        if basis is not None:
            yield ShapeContradiction(refused, basis)
    for choice in normal.choices if choosing else ():
        ways = normal.source.items(choice[2])
        if ways and all(_with(normal, way) for way in ways):
            yield ShapeContradiction(choice, choice)


def excluded_values(normal: NormalForm) -> Iterator[ShapeContradiction]:
    """What rules out all values of a path that may have none, at most once for each path.

    Only a node without such values conforms, for which `sh:maxCount 0` would be written. Paths of which the author says
    nothing are passed over: what holds of every advertisement has no contradictions.
    """
    written = normal.source.graphs[0]
    for values in list(normal.values.values()):
        if not any((shape, None, None) in written for shape in values.shapes):
            continue
        if values.needed() is None and all(most > 0 for most, _ in values.most):
            yield from islice(contradictions(values.each), 1)


def _with(normal: NormalForm, shape: Node) -> ShapeContradiction | None:
    """Why a normal form cannot be satisfied together with a further shape."""
    return next(contradictions(normal.plus(shape), choosing=False), None)


def _own(normal: NormalForm) -> Iterator[ShapeContradiction]:
    """Of the node itself: every two statements about it, and the values that are left of its lists."""
    own = normal.own
    for number, one in enumerate(own):
        if passed_by_none(_value_test(one)):
            yield ShapeContradiction(one, one)
        yield from (ShapeContradiction(one, other) for other in own[:number] if _exclude(one, other))
    for one in own:
        if one[1] == SH["in"]:
            culprits = [_culprit(normal, value, one) for value in normal.source.items(one[2])]
            if all(culprits):
                yield ShapeContradiction(one, next((culprit for culprit in culprits if culprit), one))
        elif one[1] == SH.hasValue:
            culprit = _culprit(normal, one[2], one)
            if culprit is not None:
                yield ShapeContradiction(one, culprit)
        elif _kinds(one).isdisjoint((URIRef, BNode)):
            yield from (ShapeContradiction(one, needed) for needed in _of_properties(normal))


# complexity: one rule for each way in which the values of a path can be impossible
def _values(normal: NormalForm, values: ValueNormalForm) -> Iterator[ShapeContradiction]:
    """Of the values of a path: their number, those that have to be there, and what holds of each."""
    needed = values.needed()
    for most, statement in values.most:
        if needed is not None and needed[0] > most:
            yield ShapeContradiction(needed[1], statement)
        required = [one for one in values.required if most < len({other[2] for other in values.required})]
        yield from (ShapeContradiction(one, statement) for one in required)
    for one in values.required:
        culprit = _culprit(values.each, one[2], one)
        if culprit is not None:
            yield ShapeContradiction(one, culprit)
    for shape in values.shapes:
        for most, few in _counts(normal, shape, SH.qualifiedMaxCount):
            for least, many in _counts(normal, shape, SH.qualifiedMinCount):
                if least > most:
                    yield ShapeContradiction(few, many)
    if needed is None:
        return
    for shape in values.shapes:  # no value is less than itself
        if values.path in [(other,) for other in normal.source.values(shape, SH.lessThan)]:
            yield ShapeContradiction((shape, SH.lessThan, values.path[0]), needed[1])
    for one in values.each.own:
        if one[1] == SH["in"]:
            left = [value for value in normal.source.items(one[2]) if _culprit(values.each, value, one) is None]
            literals = [value for value in left if isinstance(value, Literal)]  # may be equal only to rdflib
            if len(literals) + len({value for value in left if not isinstance(value, Literal)}) < needed[0]:
                yield ShapeContradiction(one, needed[1])
    yield from contradictions(values.each)


def _counts(normal: NormalForm, shape: Node, predicate: Node) -> Iterator[tuple[int, ShapeStatement]]:
    for value in normal.source.values(shape, predicate):
        number = count_of(value)
        if number is not None:
            yield number, (shape, predicate, value)


def _culprit(normal: NormalForm, value: Node, besides: ShapeStatement) -> ShapeStatement | None:
    """A statement that a value certainly does not satisfy."""
    if isinstance(value, Literal) and (needed := _of_properties(normal)):
        return needed[0]
    return next((one for one in normal.own if one != besides and _fails(normal, one, value)), None)


def _of_properties(normal: NormalForm) -> list[ShapeStatement]:
    """What asks the node itself to have properties, which a literal has not."""
    return [found[1] for values in normal.values.values() if (found := values.needed())]


def _fails(normal: NormalForm, statement: ShapeStatement, value: Node) -> bool:
    shape, predicate, wanted = statement
    if predicate == SH["in"]:
        return value not in normal.source.items(wanted)
    if predicate == SH.hasValue:
        return value != wanted
    if not any(isinstance(value, kind) for kind in _kinds(statement)):
        return True
    if predicate in _OF_THE_TEXT and isinstance(value, Literal) and value.datatype not in _TEXTS:
        return False  # rdflib may have written it in another way
    flags = [from_rdflib(flag) for flag in normal.source.values(shape, SH.flags)]
    tests, _ = compiled(
        {
            IRI.unchecked(str(predicate)): [from_rdflib(wanted)],
            **({IRI.unchecked(str(SH.flags)): flags} if flags else {}),
        }
    )
    try:
        return not all(test.passes(from_rdflib(value)) for test in tests)
    except MatchTooCostly:
        return False


def _kinds(statement: ShapeStatement) -> frozenset[type]:
    """What a value can be at all: an IRI, a blank node, a literal."""
    _, predicate, wanted = statement
    if predicate == SH.nodeKind:
        return _KINDS.get(wanted, _ANY)
    if predicate == SH.hasValue:
        return frozenset((type(wanted),)) if type(wanted) in _ANY else _ANY
    return _KINDS_OF.get(predicate, _ANY)


def _exclude(one: ShapeStatement, other: ShapeStatement) -> bool:
    """Whether no value satisfies both of two statements, neither of which lists values."""
    if _kinds(one).isdisjoint(_kinds(other)):
        return True
    if one[1] == other[1] == SH.hasValue:
        return one[2] != other[2]
    return exclude(_value_test(one), _value_test(other))


def _value_test(statement: ShapeStatement) -> ValueTest:
    _, predicate, wanted = statement
    return ValueTest(IRI.unchecked(str(predicate)), from_rdflib(wanted))


def _allowed(normal: NormalForm, closed: ShapeStatement) -> set[Node]:
    """The properties that a closed shape allows (SHACL, 4.8.1)."""
    source, shape = normal.source, closed[0]
    ignored = {item for head in source.values(shape, SH.ignoredProperties) for item in source.items(head)}
    return ignored | {path for each in source.values(shape, SH.property) for path in source.values(each, SH.path)}


def _asked(normal: NormalForm, shape: Node) -> bool:
    """Whether the very shape is one of those that make the normal."""
    paths = [normal.source.path(path) for path in normal.source.values(shape, SH.path)]
    if paths:
        return paths[0] in normal.values and shape in normal.values[paths[0]].shapes
    return shape in normal.shapes


def _entailed(normal: NormalForm, shape: Node) -> ShapeStatement | None:
    """A statement by which all that satisfies a normal form conforms to a shape, if that is certain."""
    basis: list[ShapeStatement] = []
    return basis[-1] if _covers(normal, NormalForm(normal.source, (shape,)), basis) and basis else None


def entails(more: NormalForm, less: NormalForm) -> bool:
    """Whether all that satisfies one normal form certainly satisfies another."""
    return _covers(more, less, [])


# complexity: one rule for each part of a normal form; each needs what the one before it has found
def _covers(more: NormalForm, less: NormalForm, basis: list[ShapeStatement]) -> bool:
    """Whether whatever satisfies `more` satisfies `less`; what shows it is added to `basis`."""
    if not _compared(less) or not _all_in(more, less, basis):
        return False
    for path, values in list(less.values.items()):  # what holds of each value looks for further paths
        ours = more.along(path)
        if not _compared(values.each) or values.each.values or not _all_in(ours.each, values.each, basis):
            return False
        wanted = {one[2] for one in values.required}
        fewer = [pair[1] for most in values.most for pair in ours.most if pair[0] <= most[0]][: len(values.most)]
        enough = [pair[1] for least in values.least for pair in ours.least if pair[0] >= least[0]]
        if (
            not wanted <= {one[2] for one in ours.required}
            or any(all(pair[0] > most for pair in ours.most) for most, _ in values.most)
            or any(least > 0 and all(pair[0] < least for pair in ours.least) for least, _ in values.least)
        ):
            return False
        basis += [*fewer, *enough]
    return True


def _compared(normal: NormalForm) -> bool:
    """Whether statements about the node and the values of paths are all that a normal form asks for."""
    return normal.whole and not (normal.closed or normal.nots or normal.choices)


def _all_in(more: NormalForm, less: NormalForm, basis: list[ShapeStatement]) -> bool:
    """Whether each statement about the node itself is made by `more` as well."""
    source = more.source
    for shape, predicate, value in less.own:
        same = [
            one
            for one in more.own
            if one[1] == predicate
            and source.form(one[2]) == source.form(value)
            and (predicate != SH.pattern or source.values(one[0], SH.flags) == source.values(shape, SH.flags))
        ]
        if not same:
            return False
        basis += same[:1]
    return True
