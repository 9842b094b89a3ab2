"""The tests that a role makes of a profile, compiled from its shape.

Whether a component is eligible is decided in `partitioner.py`: these tests say all that most shapes say, and pySHACL
judges the rest.

Each test returns the obstacle by which it keeps a component out (`selfconf.model.obstacle`), or None.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import immutable
from selfconf.model.obstacle import (
    Excluded,
    NoAlternative,
    NotJudged,
    Obstacle,
    ParameterUndeclared,
    PropertyUnmet,
    WrongComponent,
    WrongType,
)
from selfconf.model.profile import Profile
from selfconf.model.property_fault import (
    Ambiguous,
    ConstraintFailed,
    Fault,
    Missing,
    NotAmong,
    WrongCount,
    WrongShareOfValues,
)
from selfconf.model.term import IRI, Term
from selfconf.rdf.shacl import MatchTooCostly, PairTest, ValueTest


@immutable
class ClassTest:
    """The component's type is at or below a class."""

    kind: IRI

    def admits(self, types: Iterable[IRI], hierarchy: Hierarchy) -> bool:
        """Whether one of some types serves."""
        return any(hierarchy.matches(offered, self.kind) for offered in types)

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> Obstacle | None:
        return None if self.admits(profile.types, hierarchy) else WrongType(self.kind)


@immutable
class SelfTest:
    """The component is one of some components."""

    members: frozenset[Term]

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> Obstacle | None:
        return None if profile.component in self.members else WrongComponent(self.members)


@immutable
class QualifiedCount:
    """How many values of a property conform to a shape over single values: at least and at most so many."""

    value: PropertyTest
    """The shape, as what it asks of the only value of a property."""
    minimum: int = 0
    maximum: int | None = None

    def fault(self, values: frozenset[Term]) -> WrongShareOfValues | None:
        """What is wrong with the number of those that conform among some values."""
        found = sum(not any(self.value.faults(frozenset((value,)))) for value in values)
        if found < self.minimum:
            return WrongShareOfValues(found, self.minimum, too_many=False)
        if self.maximum is not None and found > self.maximum:
            return WrongShareOfValues(found, self.maximum, too_many=True)
        return None


@immutable
class PropertyTest:
    """The values of one property: how many, which ones are allowed, which ones must be there, what each is like."""

    path: IRI
    minimum: int = 0
    maximum: int | None = None
    allowed: tuple[frozenset[Term], ...] = ()
    required: tuple[Term, ...] = ()
    free_in: tuple[tuple[IRI, frozenset[Term]], ...] = ()
    """For each `sh:in` that mentions a free parameter: the parameter, and the other members of the list."""
    free_required: tuple[IRI, ...] = ()
    """The free parameters that stand in `sh:hasValue`."""
    each: tuple[ValueTest, ...] = ()
    compared: tuple[PairTest, ...] = ()
    qualified: tuple[QualifiedCount, ...] = ()
    message: str = ""
    """What the author says of a component that fails (`sh:message`)."""

    @property
    def looked_at(self) -> Iterator[IRI]:
        """The properties whose values decide."""
        yield self.path
        yield from (pair.other for pair in self.compared)

    def values(self, profile: Profile, hierarchy: Hierarchy) -> frozenset[Term]:
        """The values of the path: those of the property itself and of every property below it."""
        return _values(self.path, profile, hierarchy)

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> Obstacle | None:
        values = self.values(profile, hierarchy)
        faults = [*self.faults(values)]
        for pair in self.compared if values else ():
            others = _values(pair.other, profile, hierarchy)
            wrong = frozenset([value for value in values if not pair.passes(value, others)])
            if wrong:
                faults.append(ConstraintFailed(wrong, pair.constraint, pair.other))
        return PropertyUnmet(self.path, tuple(faults), self.message) if faults else None

    # complexity: one case for each field of the test, in the order in which faults are reported
    def faults(self, values: frozenset[Term]) -> Iterator[Fault]:
        """All that is wrong with some values: one property is one obstacle, with all that it takes to remove it."""
        asked = self.minimum or self.required or self.free_required or any(one.minimum for one in self.qualified)
        if not values and asked:
            yield Missing()
            return
        too_many = self.maximum is not None and len(values) > self.maximum
        if too_many or len(values) < self.minimum:
            yield WrongCount(len(values), too_many)
        for members in self.allowed:
            if not values <= members:
                yield NotAmong(values - members, members, partly=not values.isdisjoint(members))
        yield from (NotAmong(values, frozenset((value,))) for value in self.required if value not in values)
        for test in self.each:
            wrong = frozenset([value for value in values if not test.passes(value)])
            if wrong:
                yield ConstraintFailed(wrong, test.constraint, test.wanted)
        yield from (fault for one in self.qualified if (fault := one.fault(values)) is not None)
        for parameter, members in self.free_in:
            if len(values - members) > 1:
                yield Ambiguous(parameter)

    def allows(self, profile: Profile, hierarchy: Hierarchy) -> dict[IRI, frozenset[Term]]:
        """For each free parameter that this component constrains, the values it allows."""
        found: dict[IRI, frozenset[Term]] = {}
        values = self.values(profile, hierarchy)
        for parameter, members in self.free_in:
            rest = values - members
            if rest:
                found[parameter] = found.get(parameter, rest) & rest
        for parameter in self.free_required:
            found[parameter] = found.get(parameter, values) & values
        return found


def _values(path: IRI, profile: Profile, hierarchy: Hierarchy) -> frozenset[Term]:
    return frozenset([value for key, value in profile.properties if path in hierarchy.superproperties(key)])


@immutable
class ParameterTest:
    """The component declares an operational parameter of the type that the role sets."""

    type: IRI

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> Obstacle | None:
        if any(hierarchy.matches(self.type, declared.type) for declared in profile.parameters):
            return None
        return ParameterUndeclared(self.type)


@immutable
class Count:
    """Between `minimum` and `maximum` groups of tests pass: `sh:or`, `sh:xone`, `sh:not`, `sh:and`."""

    groups: tuple[tuple[RoleTest, ...], ...]
    minimum: int
    maximum: int | None = None

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> Obstacle | None:
        lacking = tuple(reason for group in self.groups if (reason := _first(group, profile, hierarchy)) is not None)
        passed = len(self.groups) - len(lacking)
        if passed < self.minimum:
            return NoAlternative(lacking)
        if self.maximum is not None and passed > self.maximum:
            passing = list(self._passing(profile, hierarchy))
            classes = dict.fromkeys(test.kind for test in passing if isinstance(test, ClassTest))
            paths = dict.fromkeys(test.path for test in passing if isinstance(test, PropertyTest))
            return Excluded(self.maximum > 0, tuple(classes), tuple(paths))
        return None

    def _passing(self, profile: Profile, hierarchy: Hierarchy) -> Iterator[RoleTest]:
        """The tests of the groups that a component passes; of groups in groups likewise."""
        for group in self.groups:
            if _first(group, profile, hierarchy) is None:
                for test in group:
                    yield from test._passing(profile, hierarchy) if isinstance(test, Count) else (test,)


RoleTest = ClassTest | SelfTest | PropertyTest | ParameterTest | Count


def _first(tests: Iterable[RoleTest], profile: Profile, hierarchy: Hierarchy) -> Obstacle | None:
    return next((reason for test in tests if (reason := test.obstacle(profile, hierarchy)) is not None), None)


def obstacles(tests: Iterable[RoleTest], profile: Profile, hierarchy: Hierarchy) -> tuple[Obstacle, ...]:
    """Everything by which some tests keep a component out, in their order; only that, where it cannot be judged."""
    try:
        found = [test.obstacle(profile, hierarchy) for test in tests]
    except MatchTooCostly as error:
        return (NotJudged(str(error)),)
    return tuple([reason for reason in found if reason is not None])


@immutable
class CompiledRole:
    """The tests of a role, and whether they say all that its shape says."""

    iri: IRI
    tests: tuple[RoleTest, ...]
    complete: bool
    local: bool = True
    """Whether the shape looks at nothing but the component's own statements."""
    settled: frozenset[Term] = frozenset()
    """The property shapes with free parameters that are left to the tests alone, where pySHACL judges the rest."""

    @property
    def classes(self) -> tuple[ClassTest, ...]:
        """The tests of which the types alone decide."""
        return tuple(test for test in self.tests if isinstance(test, ClassTest))

    @property
    def ways_of_classes(self) -> list[list[frozenset[IRI]]]:
        """Sets of classes, grouped: a component is of all classes of one set of each group, or it does not conform."""
        choices = [test.groups for test in self.tests if isinstance(test, Count) and test.minimum]
        return [[_classes(way) for way in some] for some in ((self.tests,), *choices)]

    def obstacles(self, profile: Profile, hierarchy: Hierarchy) -> tuple[Obstacle, ...]:
        """Everything that keeps a component out, in the order of the shape; only that, where it cannot be judged."""
        return obstacles(self.tests, profile, hierarchy)

    def allows(self, profile: Profile, hierarchy: Hierarchy) -> dict[IRI, frozenset[Term]]:
        """For each free parameter that the component constrains, the values it allows (perhaps none)."""
        found: dict[IRI, frozenset[Term]] = {}
        for test in self.tests:
            if isinstance(test, PropertyTest) and (test.free_in or test.free_required):
                for parameter, values in test.allows(profile, hierarchy).items():
                    found[parameter] = found.get(parameter, values) & values
        return found


def _classes(tests: Iterable[RoleTest]) -> frozenset[IRI]:
    return frozenset(test.kind for test in tests if isinstance(test, ClassTest))
