"""Roles as tests: the common subset of SHACL compiled, the rest left to pySHACL.

`compile_role` turns the shape of a role into tests that look at a profile and need no graph. What it compiles:

* `sh:class` on the node (SHACL 4.1.1);
* property shapes over one predicate with `sh:in`, `sh:hasValue`, `sh:minCount`, `sh:maxCount` (4.9.2, 4.9.1, 4.2);
* a parameter left unbound inside `sh:in` or `sh:hasValue`, as the set of values that a component allows it.

A shape that says more is *incomplete* here: its tests are still necessary, so they are the prefilter, and pySHACL
judges the survivors by the whole shape. That both ways give one partition is a property test.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.profile import Profile
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.advertisements import STRUCTURE
from selfconf.rdf.templates import ROLE_STRUCTURE
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import LABEL, RDF, RDFS, SC, SH, TYPE

ANNOTATIONS = frozenset(
    (
        LABEL,
        RDFS.comment,
        RDFS.isDefinedBy,
        RDFS.seeAlso,
        SH.name,
        SH.description,
        SH.message,
        SH.order,
        SH.group,
    )
)
TARGETS = frozenset((SH.targetClass, SH.targetNode, SH.targetSubjectsOf, SH.targetObjectsOf, SH.target))


@dataclass(frozen=True, slots=True)
class ClassTest:
    """The component's type is at or below a class."""

    kind: IRI

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> str | None:
        if any(hierarchy.matches(offered, self.kind) for offered in profile.types):
            return None
        return f"is no {self.kind.short}"


@dataclass(frozen=True, slots=True)
class PropertyTest:
    """The values of one property: how many, which ones are allowed, which ones must be there."""

    path: IRI
    minimum: int = 0
    maximum: int | None = None
    allowed: tuple[frozenset[Term], ...] = ()
    required: tuple[Term, ...] = ()
    free_in: tuple[tuple[IRI, frozenset[Term]], ...] = ()
    """For each `sh:in` that mentions a free parameter: the parameter, and the other members of the list."""
    free_required: tuple[IRI, ...] = ()
    """The free parameters that stand in `sh:hasValue`."""

    def values(self, profile: Profile, hierarchy: Hierarchy) -> set[Term]:
        """The values of the path: those of the property itself and of every property below it."""
        return {value for key, value in profile.properties if self.path in hierarchy.superproperties(key)}

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> str | None:
        values = self.values(profile, hierarchy)
        name = self.path.short
        if len(values) < self.minimum:
            return f"has no {name}" if not values else f"has {len(values)} of {name}, too few"
        if self.maximum is not None and len(values) > self.maximum:
            return f"has {len(values)} of {name}, too many"
        for members in self.allowed:
            if not values <= members:
                return f"{name} is {_words(values - members)}, not {_words(members)}"
        for value in self.required:
            if value not in values:
                return f"{name} is {_words(values)}, not {_words({value})}" if values else f"has no {name}"
        for parameter, members in self.free_in:
            if len(values - members) > 1:
                return f"{name} has several values, so that no one {parameter.short} fits"
        if self.free_required and not values:
            return f"has no {name}"
        return None

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


Test = ClassTest | PropertyTest | ParameterTest


@dataclass(frozen=True, slots=True)
class CompiledRole:
    """The tests of a role, and whether they say all that its shape says."""

    iri: IRI
    tests: tuple[Test, ...]
    complete: bool
    free: frozenset[IRI] = field(default_factory=frozenset)
    """The free parameters that only the whole shape can tell about."""

    def obstacle(self, profile: Profile, hierarchy: Hierarchy) -> str | None:
        """The first thing that keeps a component out, or None if every test lets it pass."""
        return next(self.obstacles(profile, hierarchy), None)

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


def compile_role(
    document: Document,
    role: IRI,
    settings: tuple[IRI, ...],
    bindings: Mapping[IRI, Term],
    free: frozenset[IRI],
) -> CompiledRole:
    """Compile the shape of a role, with bound parameters replaced by their values; `settings` are the types it sets."""
    return _Compiler(document, role, bindings, free).compile(settings)


def bound_shape(document: Document, bindings: Mapping[IRI, Term]) -> list[Triple]:
    """The triples of a template for pySHACL: parameters replaced, roles typed as node shapes without targets."""
    triples: list[Triple] = []
    roles = set(document.instances(SC.Role))
    for subject, predicate, value in document.triples():
        if subject in roles and (predicate in TARGETS or (predicate in ROLE_STRUCTURE and predicate != TYPE)):
            continue
        if predicate in SH or predicate == RDF.first:
            value = bindings.get(value, value) if isinstance(value, IRI) else value
        triples.append((subject, predicate, value))
    triples.extend((role, TYPE, SH.NodeShape) for role in roles)
    return triples


class _Compiler:
    """Compiles one shape; `rest` is raised as soon as something is met that only pySHACL can judge."""

    def __init__(self, document: Document, role: IRI, bindings: Mapping[IRI, Term], free: frozenset[IRI]) -> None:
        self.document, self.role, self.bindings, self.free = document, role, bindings, free
        self.rest = False
        self.unseen: set[IRI] = set()

    def compile(self, settings: tuple[IRI, ...]) -> CompiledRole:
        tests: list[Test] = []
        if self._true(self.role, SH.deactivated):
            return CompiledRole(self.role, tuple(ParameterTest(kind) for kind in settings), True)
        for predicate, raw in self.document.statements.get(self.role, ()):
            value = self._bound(raw)
            if predicate == SH["class"] and isinstance(value, IRI) and value not in self.free:
                tests.append(ClassTest(value))
            elif predicate == SH.property:
                test = self._property(raw)
                if test is not None:
                    tests.append(test)
            elif predicate in SH and predicate not in ANNOTATIONS | TARGETS and predicate != SH.severity:
                self.rest = True
                self._note(raw)
        tests.extend(ParameterTest(kind) for kind in settings)
        return CompiledRole(self.role, tuple(tests), not self.rest, frozenset(self.unseen))

    def _property(self, shape: Term) -> PropertyTest | None:
        """One property shape; None (and `rest`) where its path or any of its constraints is beyond the subset."""
        path = self._bound(self.document.value(shape, SH.path) or shape)
        if self._true(shape, SH.deactivated):
            return None
        if not isinstance(path, IRI) or path in self.free or path in STRUCTURE or path in SC:
            self.rest = True
            self._note(shape)
            return None
        minimum, maximum = 0, None
        allowed: list[frozenset[Term]] = []
        required: list[Term] = []
        free_in: list[tuple[IRI, frozenset[Term]]] = []
        free_required: list[IRI] = []
        for predicate, raw in self.document.about(shape):
            value = self._bound(raw)
            if predicate == SH.minCount and isinstance(value, Literal) and value.lexical.isdecimal():
                minimum = max(minimum, int(value.lexical))
            elif predicate == SH.maxCount and isinstance(value, Literal) and value.lexical.isdecimal():
                most = int(value.lexical)
                maximum = most if maximum is None else min(maximum, most)
            elif predicate == SH.hasValue and value in self.free and isinstance(value, IRI):
                free_required.append(value)
            elif predicate == SH.hasValue:
                required.append(value)
            elif predicate == SH["in"]:
                members = [self._bound(member) for member in self.document.items(raw)]
                variables = [m for m in dict.fromkeys(members) if isinstance(m, IRI) and m in self.free]
                constants = frozenset(m for m in members if m not in variables)
                if not variables:
                    allowed.append(constants)
                elif len(variables) == 1:
                    free_in.append((variables[0], constants))
                else:
                    self.rest = True
                    self._note(raw)
            elif predicate in (SH.path, SH.severity, TYPE) or predicate in ANNOTATIONS or predicate not in SH:
                continue
            else:
                self.rest = True
                self._note(raw)
        return PropertyTest(
            path, minimum, maximum, tuple(allowed), tuple(required), tuple(free_in), tuple(free_required)
        )

    def _bound(self, value: Term) -> Term:
        return self.bindings.get(value, value) if isinstance(value, IRI) else value

    def _true(self, subject: Term, predicate: IRI) -> bool:
        value = self.document.value(subject, predicate)
        return isinstance(value, Literal) and value.lexical in ("true", "1")

    def _note(self, start: Term) -> None:
        """Remember the free parameters that stand where only the whole shape can tell what they may be."""
        waiting, seen = [start], set()
        while waiting:
            value = waiting.pop()
            if value in seen or isinstance(value, Literal):
                continue
            seen.add(value)
            if value in self.free and isinstance(value, IRI):
                self.unseen.add(value)
                continue
            waiting.extend(o for _, o in self.document.about(value))


def _words(values: set[Term] | frozenset[Term]) -> str:
    names = sorted(value.short if isinstance(value, IRI) else f'"{value}"' for value in values)
    return " or ".join(names) if names else "nothing"
