"""The partition F1 ... Fn of an ecology by the roles of a task (section 3.2 of the paper).

Every role is compiled once; its tests run over every profile; where the shape says more than the tests, pySHACL
judges the survivors. Components that share a *signature* (types, properties, parameter types) pass the same tests
and are tested once.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from selfconf.errors import TemplateError
from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy
from selfconf.model.partition import ANY_VALUE, Candidate, NearMiss, Partition, Variable, ordered
from selfconf.model.profile import Profile
from selfconf.model.template import Role
from selfconf.model.term import IRI, Term, sort_key
from selfconf.rdf import turtle
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.bindings import free_parameters
from selfconf.rdf.roles import ClassTest, CompiledRole, bound_shape, compile_role
from selfconf.rdf.shacl import violations
from selfconf.rdf.templates import TaskDocument, mentions
from selfconf.rdf.turtle import Triple
from selfconf.rdf.vocabulary import TYPE

ANOTHER = IRI("urn:selfconf:another-value")
"""A value that no component has: what it lets pass, any value lets pass."""


@dataclass(frozen=True, slots=True)
class Eligible:
    """A component that is eligible for a role, and for each free parameter it constrains, the values it allows."""

    profile: Profile
    allows: dict[IRI, frozenset[Term]]


class Partitioner:
    """Partitions ecologies for one task; compile once, use for each new set of advertisements."""

    def __init__(self, given: TaskDocument, hierarchy: Hierarchy = NOTHING_ABOVE) -> None:
        self.task, self.document, self.hierarchy = given.task, given.document, hierarchy
        self.free = free_parameters(given.task.template, given.task.bindings)
        self.roles = tuple(
            compile_role(given.document, role.iri, tuple(s.type for s in role.settings), given.task.bindings, self.free)
            for role in given.task.template.roles
        )

    def partition(self, advertisements: Sequence[Advertisement]) -> Partition:
        """F1 ... Fn and the variables that the free parameters are. Raises TemplateError for a shape that is none."""
        eligible = [list(self.eligible(role, advertisements)) for role in self.roles]
        variables = tuple(self._variables(eligible))
        return Partition(
            tuple(
                ordered([Candidate(e.profile, tuple(_mask(e, variable) for variable in variables)) for e in role])
                for role in eligible
            ),
            variables,
        )

    def near_misses(self, advertisements: Iterable[Advertisement]) -> Iterator[NearMiss]:
        """For each role the components of its class that exactly one other test keeps out, with that obstacle."""
        everything = list(advertisements)
        for role in self.roles:
            classes = [test for test in role.tests if isinstance(test, ClassTest)]
            for advertisement in everything:
                profile = advertisement.profile
                if any(test.obstacle(profile, self.hierarchy) for test in classes):
                    continue
                obstacles = list(role.obstacles(profile, self.hierarchy))
                if len(obstacles) == 1:
                    yield NearMiss(role.iri, profile.component, obstacles[0])

    def eligible(self, role: CompiledRole, advertisements: Sequence[Advertisement]) -> Iterator[Eligible]:
        """The components that conform to a role, unordered."""
        passed = [a for a in advertisements if role.obstacle(a.profile, self.hierarchy) is None]
        if role.complete:
            for advertisement in passed:
                allows = role.allows(advertisement.profile, self.hierarchy)
                if all(allows.values()):
                    yield Eligible(advertisement.profile, allows)
        elif not mentions(self.document, role.iri, self.free):
            outside = self._violations(role, passed, advertisements, {})
            yield from (Eligible(a.profile, {}) for a in passed if a.profile.component not in outside)
        else:
            yield from self._by_value(role, passed, advertisements)

    def _by_value(
        self, role: CompiledRole, passed: Sequence[Advertisement], everything: Sequence[Advertisement]
    ) -> Iterator[Eligible]:
        """A shape that mentions a free parameter where only pySHACL can tell: judged once for each value."""
        parameters = mentions(self.document, role.iri, self.free)
        if len(parameters) > 1:
            names = " and ".join(sorted(p.name for p in self.task.template.parameters if p.iri in parameters))
            raise TemplateError(
                f"the role {role.iri!r} mentions the free parameters {names} in one shape that is judged by pySHACL; "
                "bind all but one of them",
                file=self.document.source,
            )
        (parameter,) = parameters
        values = {value for a in passed for _, value in a.profile.properties} | {
            kind for a in passed for kind in a.profile.types
        }
        allowed: dict[IRI, set[Term]] = {a.profile.component: set() for a in passed}
        for value in (*sorted(values, key=sort_key), ANOTHER):
            outside = self._violations(role, passed, everything, {parameter: value})
            for advertisement in passed:
                if advertisement.profile.component not in outside:
                    allowed[advertisement.profile.component].add(value)
        for advertisement in passed:
            found = allowed[advertisement.profile.component]
            if ANOTHER in found:
                yield Eligible(advertisement.profile, {})
            elif found:
                yield Eligible(advertisement.profile, {parameter: frozenset(found)})

    def _violations(
        self,
        role: CompiledRole,
        focus: Sequence[Advertisement],
        everything: Sequence[Advertisement],
        values: dict[IRI, Term],
    ) -> dict[IRI, str]:
        shapes = turtle.to_rdflib(bound_shape(self.document, {**self.task.bindings, **values}))
        subjects = turtle.to_rdflib(self._visible(everything))
        nodes = [a.profile.component for a in focus]
        return violations(subjects, shapes, role.iri, nodes, self.document.source)

    def _visible(self, advertisements: Iterable[Advertisement]) -> Iterator[Triple]:
        """What the shape sees: the advertisements, and under a hierarchy what follows for types and properties."""
        for advertisement in advertisements:
            for subject, predicate, value in advertisement.triples:
                yield subject, predicate, value
                for above in self.hierarchy.superproperties(predicate):
                    yield subject, above, value
                if predicate == TYPE and isinstance(value, IRI):
                    for kind in self.hierarchy.superclasses(value):
                        yield subject, TYPE, kind

    def _variables(self, eligible: list[list[Eligible]]) -> Iterator[Variable]:
        for parameter in sorted(self.free):
            domain = {value for role in eligible for e in role for value in e.allows.get(parameter, ())}
            if domain:
                yield Variable(parameter, tuple(sorted(domain, key=sort_key)))


def _mask(eligible: Eligible, variable: Variable) -> int:
    allowed = eligible.allows.get(variable.parameter)
    if allowed is None:
        return ANY_VALUE
    return sum(1 << index for index, value in enumerate(variable.domain) if value in allowed)


def role_types(role: Role) -> str:
    """What a role asks for, for people: the classes of its shape, or the role's own name."""
    return " and ".join(kind.short for kind in role.types) or role.iri.short
