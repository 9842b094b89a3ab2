"""The values that a parameter which is left free may take.

For a component that is there: what the ecology states, and what the parameter permits. For one that does not exist yet:
what it could state of free parameters and be eligible for a role. The constraints of the role on the property in which
a parameter stands decide that: `sh:in ( :robot )` beside `sh:in ( :Pippi :Emil )` leaves a component for Pippi's or
Emil's robot. Where they contradict each other, no component can be eligible at all. Only constraints that are compiled
count, and those within `sh:or` and `sh:not` do not: what is said here to be impossible is so, and the rest is not
certain to be possible.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import chain, combinations

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import immutable
from selfconf.model.partition import Mention
from selfconf.model.template import Parameter
from selfconf.model.term import IRI, Term
from selfconf.rdf.eligibility.role_tests import Count, PropertyTest, RoleTest, SelfTest
from selfconf.rdf.shacl import ValueTest, component_parameters, exclude, passes_all
from selfconf.rdf.tasks import shape_statements, suitable
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import RDFS, SC, SH, TYPE

KEPT = 64
"""Of how many sets of values it is remembered which of them suit a parameter."""
_STAYING = frozenset((SH.zeroOrMorePath, SH.zeroOrOnePath))
"""Paths that lead to where they begin."""
_QUERIES = frozenset((SH.sparql, SH.select, SH.ask))
_MEMBERSHIP = frozenset((SH.hasValue, SH["in"]))


def seen(document: Document, role: IRI, shown: Iterable[Triple]) -> set[Term]:
    """The terms in what a shape is shown that its paths could lead to, and so all that a parameter in it could be.

    Any other value makes no difference to the shape: it is one that no component has.
    """
    predicates, named = set[IRI](), set[Term]()
    for predicate, value in shape_statements(document, role):
        predicates.add(predicate)
        named.add(value)
    if SH["class"] in predicates:
        named.add(TYPE)
    everything = _asks_queries(document, predicates)
    beginnings = everything or bool(predicates & _STAYING) or _about_themselves(document)
    found: set[Term] = set()
    for subject, predicate, value in shown:
        if everything or predicate in named:
            found.add(value)
            if SH.inversePath in predicates:
                found.add(subject)
        if beginnings:
            found.add(subject)
    return found


def looked_at(document: Document, role: IRI) -> frozenset[IRI] | None:
    """The predicates that the shape of a role can look at; None where it could be any."""
    said, named = set[IRI](), {TYPE, RDFS.subClassOf}
    for predicate, value in shape_statements(document, role):
        said.add(predicate)
        if isinstance(value, IRI):
            named.add(value)
    if SH.closed in said or _asks_queries(document, said):
        return None
    return frozenset(named)


def _asks_queries(document: Document, said: set[IRI]) -> bool:
    """Whether a shape that says so much asks queries, its own or those of constraint components of the document."""
    return bool(said & (_QUERIES | component_parameters(document)))


def enumerated(document: Document, parameter: IRI) -> set[Term]:
    """The values that a parameter lists (`sh:in`), so that it has no others; nothing if it lists none."""
    return {value for head in document.values(parameter, SH["in"]) for value in document.items(head)}


def _about_themselves(document: Document) -> bool:
    """Whether a shape asks which one its focus node is, not which values a path of it has."""
    for statements in document.statements.values():
        predicates = {predicate for predicate, _ in statements}
        if predicates & _MEMBERSHIP and SH.path not in predicates and (TYPE, SC.Parameter) not in statements:
            return True
    return False


class Suitable:
    """Which values conform to what parameters say of theirs, as a value that is bound has to.

    Answers are remembered, as an ecology that has changed states mostly what it stated before.
    """

    def __init__(self, parameters: Mapping[IRI, Parameter], document: Document) -> None:
        self._parameters, self._document = parameters, document
        self._known: dict[tuple[IRI, frozenset[Term]], frozenset[Term]] = {}

    def of(self, parameter: IRI, values: frozenset[Term]) -> frozenset[Term]:
        """The values, among some, that a parameter may have."""
        known = self._known.get((parameter, values))
        if known is None:
            known = self._fitting(parameter, values)
            if len(self._known) == KEPT:
                self._known.clear()
            self._known[parameter, values] = known
        return known

    def _fitting(self, parameter: IRI, values: frozenset[Term]) -> frozenset[Term]:
        """The values, among some, that conform to what a parameter says of its value."""
        return suitable(self._parameters[parameter], values, self._document)


Suiting = Callable[[IRI, frozenset[Term]], frozenset[Term]]
"""Which values, among some, a parameter may have."""
_NONE: frozenset[Term] = frozenset()


@immutable
class StatedOnPath:
    """What the tests of a role together ask of the values of one property."""

    tests: tuple[PropertyTest, ...]
    """The tests of the property itself."""
    above: tuple[PropertyTest, ...]
    """The tests of the property and of the properties above it, which see its values too."""

    @property
    def minimum(self) -> int:
        """How many values there have to be."""
        return max(test.minimum for test in self.tests)

    @property
    def required(self) -> frozenset[Term]:
        """The values that have to be there."""
        return frozenset(chain.from_iterable(test.required for test in self.tests))

    @property
    def allowed(self) -> frozenset[Term] | None:
        """The values that may be there, as far as they are listed; None if they are not."""
        lists = [members for test in self.above for members in test.allowed]
        return frozenset(filter(self.passes, _NONE.union(*lists).intersection(*lists))) if lists else None

    def passes(self, value: Term) -> bool:
        """Whether a value is like what each single value has to be, and that is found in time."""
        return passes_all(self._each, value)

    @property
    def contradictory(self) -> bool:
        """Whether no values at all are what the tests ask for, whatever free parameters are."""
        allowed, required = self.allowed, self.required
        maxima = [test.maximum for test in self.above if test.maximum is not None]
        return (
            (allowed is not None and (len(allowed) < self.minimum or not required <= allowed))
            or not all(map(self.passes, required))
            or any(most < max(self.minimum, len(required)) for most in maxima)
            or (self.minimum > 0 and any(exclude(*pair) for pair in combinations(self._each, 2)))
        )

    @property
    def _each(self) -> Iterator[ValueTest]:
        """What each single value has to be like."""
        return (one for test in self.above for one in test.each)

    def mentions(self, known: Mapping[IRI, Iterable[Term]]) -> Iterator[Mention]:
        """What is asked for each free parameter; `known` are values that each could have."""
        allowed, required = self.allowed, self.required
        for test in self.tests:
            for parameter in test.free_required:
                yield Mention(parameter, allowed, self._never(known.get(parameter, ())), required=True)
            for parameter, members in test.free_in:
                beside = frozenset(filter(self.passes, members if allowed is None else members & allowed))
                # What has to be there is among the other members, or it is the value of the parameter.
                only = allowed if required <= members else required - members if len(required - members) == 1 else _NONE
                must = not required <= members or len(beside) < self.minimum
                if len(beside) + 1 < self.minimum:
                    only = _NONE
                yield Mention(parameter, only, self._never(known.get(parameter, ())), required=must)

    def _never(self, known: Iterable[Term]) -> frozenset[Term]:
        return frozenset(value for value in known if not self.passes(value))


def stated_on_paths(tests: Iterable[RoleTest], hierarchy: Hierarchy) -> list[StatedOnPath]:
    """What the tests of a role ask of the values of each property that they look at."""
    found = [test for test in conjuncts(tests) if isinstance(test, PropertyTest)]
    paths = dict.fromkeys(test.path for test in found)
    return [
        StatedOnPath(
            tuple(test for test in found if test.path == path),
            tuple(test for test in found if test.path in hierarchy.superproperties(path)),
        )
        for path in paths
    ]


def mentions_of(
    parameters: Iterable[IRI], paths: Sequence[StatedOnPath], known: Mapping[IRI, Iterable[Term]], suiting: Suiting
) -> tuple[Mention, ...]:
    """What a role asks of each free parameter that its shape mentions, all its properties together."""
    found = {parameter: Mention(parameter) for parameter in parameters}
    for mention in chain.from_iterable(path.mentions(known) for path in paths):
        one = found.get(mention.parameter)
        found[mention.parameter] = mention if one is None else one.beside(mention)
    return tuple(one if one.only is None else one.among(suiting(one.parameter, one.only)) for one in found.values())


def contradictory(paths: Iterable[StatedOnPath], mentions: Iterable[Mention]) -> bool:
    """Whether no component can be eligible for a role, whatever it states."""
    return any(path.contradictory for path in paths) or any(one.required and one.only == _NONE for one in mentions)


def lists_components(tests: Iterable[RoleTest]) -> bool:
    """Whether a role lists the components that may play it: one that is added would have to have one of their names."""
    return any(isinstance(test, SelfTest) for test in conjuncts(tests))


def conjuncts(tests: Iterable[RoleTest]) -> Iterator[RoleTest]:
    """Yield the tests that all have to be passed, those within `sh:and` and `sh:node` too."""
    for test in tests:
        if isinstance(test, Count) and test.minimum == len(test.groups):
            yield from conjuncts(chain.from_iterable(test.groups))
        else:
            yield test
