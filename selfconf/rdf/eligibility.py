"""The tests that a role makes of a profile, compiled from its shape: who passes them all may play the role.

Each test tells why it keeps a component out, in words that follow "it": `is no SonarArray`, `has no support`.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.profile import Profile
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.values import ValueTest


@dataclass(frozen=True, slots=True)
class ClassTest:
    """The component's type is at or below a class."""

    kind: IRI

    def admits(self, types: Iterable[IRI], hierarchy: Hierarchy) -> bool:
        """Whether one of some types serves."""
        return any(hierarchy.matches(offered, self.kind) for offered in types)

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> str | None:
        return None if self.admits(profile.types, hierarchy) else f"is no {self.kind.short}"


@dataclass(frozen=True, slots=True)
class SelfTest:
    """The component is one of some components."""

    members: frozenset[Term]

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> str | None:
        return None if profile.component in self.members else f"is not {words(self.members)}"


@dataclass(frozen=True, slots=True)
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

    def values(self, profile: Profile, hierarchy: Hierarchy) -> set[Term]:
        """The values of the path: those of the property itself and of every property below it."""
        return {value for key, value in profile.properties if self.path in hierarchy.superproperties(key)}

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> str | None:
        return "; ".join(self._wrong(self.values(profile, hierarchy))) or None

    def _wrong(self, values: set[Term]) -> Iterator[str]:
        """All that is wrong with some values: one property is one obstacle, with all that it takes to mend it."""
        name = self.path.short
        if not values and (self.minimum or self.required or self.free_required):
            yield f"has no {name}"
            return
        if len(values) < self.minimum:
            yield f"has {len(values)} of {name}, too few"
        if self.maximum is not None and len(values) > self.maximum:
            yield f"has {len(values)} of {name}, too many"
        for members in self.allowed:
            if not values <= members:
                yield f"{name} is {words(values - members)}, not {words(members)}"
        for value in self.required:
            if value not in values:
                yield f"{name} is {words(values)}, not {words({value})}"
        for test in self.each:
            wrong = {value for value in values if not test.passes(value)}
            if wrong:
                yield f"{name} is {words(wrong)}, not {test}"
        for parameter, members in self.free_in:
            if len(values - members) > 1:
                yield f"{name} has several values, so that no one {parameter.short} fits"

    def allows(self, profile: Profile, hierarchy: Hierarchy) -> dict[IRI, frozenset[Term]]:
        """For each free parameter that this component constrains, the values it allows."""
        found: dict[IRI, frozenset[Term]] = {}
        values = frozenset(self.values(profile, hierarchy))
        for parameter, members in self.free_in:
            rest = values - members
            if rest:
                found[parameter] = found.get(parameter, rest) & rest
        for parameter in self.free_required:
            found[parameter] = found.get(parameter, values) & values
        return found


@dataclass(frozen=True, slots=True)
class ParameterTest:
    """The component declares an operational parameter of the type that the role sets."""

    type: IRI

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> str | None:
        if any(hierarchy.matches(self.type, declared.type) for declared in profile.parameters):
            return None
        return f"declares no parameter of type {self.type.short}"


@dataclass(frozen=True, slots=True)
class Count:
    """Of several groups of tests, at least and at most so many are passed: `sh:or`, `sh:xone`, `sh:not`, `sh:and`."""

    groups: tuple[tuple[Test, ...], ...]
    minimum: int
    maximum: int | None = None

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> str | None:
        reasons = [
            next((reason for test in group if (reason := test.obstacle(profile, hierarchy)) is not None), None)
            for group in self.groups
        ]
        passed = reasons.count(None)
        if passed < self.minimum:
            return " and ".join(dict.fromkeys(reason for reason in reasons if reason is not None))
        if self.maximum is not None and passed > self.maximum:
            return "is what it must not be" if self.maximum == 0 else "is several things of which it must be one"
        return None


Test = ClassTest | SelfTest | PropertyTest | ParameterTest | Count


@dataclass(frozen=True, slots=True)
class CompiledRole:
    """The tests of a role, and whether they say all that its shape says."""

    iri: IRI
    tests: tuple[Test, ...]
    complete: bool
    local: bool = True
    """Whether the shape looks at nothing but the component's own statements."""

    @property
    def classes(self) -> tuple[ClassTest, ...]:
        """The tests of which the types alone decide."""
        return tuple(test for test in self.tests if isinstance(test, ClassTest))

    def obstacles(self, profile: Profile, hierarchy: Hierarchy) -> Iterator[str]:
        """Everything that keeps a component out, in the order of the shape."""
        for test in self.tests:
            reason = test.obstacle(profile, hierarchy)
            if reason is not None:
                yield reason

    def allows(self, profile: Profile, hierarchy: Hierarchy) -> dict[IRI, frozenset[Term]]:
        """For each free parameter that the component constrains, the values it allows (perhaps none)."""
        found: dict[IRI, frozenset[Term]] = {}
        for test in self.tests:
            if isinstance(test, PropertyTest) and (test.free_in or test.free_required):
                for parameter, values in test.allows(profile, hierarchy).items():
                    found[parameter] = found.get(parameter, values) & values
        return found


def words(values: Iterable[Term]) -> str:
    """Values for people: `Astrid or Pippi`; of literals also what tells them from others, `"1"` from `1`."""
    names = sorted(_word(value) for value in values)
    return " or ".join(names) if names else "nothing"


def _word(value: Term) -> str:
    if isinstance(value, Literal):
        return value.turtle(lambda datatype: datatype.short)
    return value.short if isinstance(value, IRI) else str(value)
