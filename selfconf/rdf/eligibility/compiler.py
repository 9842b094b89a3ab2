"""Roles as tests: the common subset of SHACL compiled, the rest left to pySHACL.

`compile_role` turns the shape of a role into tests that look at a profile and need no graph. What it compiles:

* `sh:class`, `sh:in` and `sh:hasValue` on the node (SHACL 4.1.1, 4.8.2, 4.8.3);
* property shapes over one predicate with `sh:in`, `sh:hasValue`, `sh:minCount`, `sh:maxCount` (4.8, 4.2), and what
  `selfconf.rdf.shacl.value_tests` knows of single values (4.1.2, 4.1.3, 4.3, 4.4) and of pairs (4.5.3, 4.5.4);
* `sh:qualifiedValueShape` over a node shape that asks such things of single values (4.7.3);
* `sh:and`, `sh:or`, `sh:xone`, `sh:not` and `sh:node` over shapes of that kind (4.6, 4.7.1);
* a parameter inside `sh:in` or `sh:hasValue`, as the set of values that a component allows it.

A shape that says more is *incomplete* here: its tests are still necessary, so they are the prefilter, and pySHACL
judges the survivors by the whole shape, but for property shapes that are compiled and have free parameters to
themselves: those need not be judged for each value. That both ways give one partition is a property test. Left out on
purpose: `sh:class` on the values of a property, which depends on what other advertisements say.
"""

from __future__ import annotations

from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from itertools import chain
from typing import TypeGuard

from selfconf.errors import TemplateError
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.eligibility.role_tests import (
    ClassTest,
    CompiledRole,
    Count,
    ParameterTest,
    PropertyTest,
    QualifiedCount,
    RoleTest,
    SelfTest,
)
from selfconf.rdf.permitted_fields import SHAPE_ANNOTATIONS, STRUCTURE
from selfconf.rdf.shacl import PAIRS, PairTest, compiled, component_parameters
from selfconf.rdf.tasks import ROLE_STRUCTURE, mentions, substituted
from selfconf.rdf.turtle import Document, Node, Triple
from selfconf.rdf.vocabulary import SC, SH, TYPE

TARGETS = frozenset((SH.targetClass, SH.targetNode, SH.targetSubjectsOf, SH.targetObjectsOf, SH.target))
_SILENT = SHAPE_ANNOTATIONS | TARGETS | {SH.severity, SH.deactivated, TYPE, SH.path}
_SHAPES_OF_A_LIST = frozenset((SH["and"], SH["or"], SH.xone))
_SHAPES = frozenset((SH["not"], SH.node, SH.property))
_LOGIC = _SHAPES_OF_A_LIST | {SH["not"], SH.node}
_OWN_STATEMENTS = frozenset((SH["class"], SH.closed, SH.ignoredProperties))
"""What looks at the statements about the node it is asked about."""
_OWN_VALUES = frozenset(
    SH[name]
    for name in (
        "in", "hasValue", "nodeKind", "datatype", "pattern", "flags", "minLength", "maxLength", "languageIn",
        "uniqueLang", "minCount", "maxCount", "minInclusive", "maxInclusive", "minExclusive", "maxExclusive", "equals",
        "disjoint", "lessThan", "lessThanOrEquals",
    )
)  # fmt: skip
"""What looks at values alone, or compares the values of two properties of the node that has them."""
_QUALIFIED = frozenset(SH[f"qualified{name}"] for name in ("ValueShape", "MinCount", "MaxCount", "ValueShapesDisjoint"))
"""How many values conform to a shape."""


def compile_role(
    document: Document,
    role: IRI,
    settings: tuple[IRI, ...],
    free: frozenset[IRI],
) -> CompiledRole:
    """Compile the shape of a role, in which parameters stand that are `free`; `settings` are the types that it sets.

    Raises TemplateError for shapes within shapes without end, or nearly so.
    """
    compiler = _Compiler(document, free)
    try:
        tests = (*compiler.shape(role), *map(ParameterTest, settings))
        settled = _settled(document, role, free) if compiler.rest and free else frozenset[Term]()
        return CompiledRole(role, tests, not compiler.rest, local(document, role), settled)
    except RecursionError:
        raise TemplateError(f"the shape of the role {role!r} nests too deeply", file=document.source) from None


def _settled(document: Document, role: IRI, free: frozenset[IRI]) -> frozenset[Term]:
    """The property shapes of a role that tests say all of, with free parameters that stand nowhere else in its shape.

    None of shapes that are disjoint, which look at the other property shapes of the role.
    """
    settled = {
        shape: parameters
        for shape in document.values(role, SH.property)
        if (parameters := mentions(document, shape, free))
        and document.value(shape, SH.qualifiedValueShape) is None
        and _compiled_in_full(document, shape, free)
    }
    while settled:
        elsewhere = mentions(_without(document, role, settled), role, free)
        shared = [shape for shape, parameters in settled.items() if parameters & elsewhere]
        if not shared:
            break
        for shape in shared:
            del settled[shape]
    return frozenset(settled)


def _compiled_in_full(document: Document, shape: Term, free: frozenset[IRI]) -> bool:
    """Whether tests say all that a shape says."""
    compiler = _Compiler(document, free)
    for _ in compiler.shape(shape):
        pass
    return not compiler.rest


def _without(document: Document, role: IRI, shapes: Container[Term]) -> Document:
    """A template in which a role lacks some of its property shapes, but for their paths, which `sh:closed` asks for."""
    said, paths = list[tuple[IRI, Term]](), dict[Node, list[tuple[IRI, Term]]]()
    for predicate, value in document.about(role):
        if predicate == SH.property and value in shapes:
            node = BlankNode(f"_:path{len(paths)}")
            paths[node] = [(SH.path, path) for path in document.values(value, SH.path)]
            said.append((predicate, node))
        else:
            said.append((predicate, value))
    return replace(document, statements=document.statements | paths | {role: said})


def left_to_judge(document: Document, role: CompiledRole) -> Document:
    """A template in which the shape of a role says what pySHACL has to be asked, if it has to."""
    return _without(document, role.iri, role.settled) if role.settled else document


def bound_shape(document: Document, values: Mapping[IRI, Term]) -> list[Triple]:
    """The triples of a template for pySHACL: parameters replaced, roles typed as node shapes without targets."""
    triples: list[Triple] = []
    roles = set(document.instances(SC.Role))
    for subject, predicate, value in substituted(document, values).triples():
        if subject in roles and (predicate in TARGETS or (predicate in ROLE_STRUCTURE and predicate != TYPE)):
            continue
        triples.append((subject, predicate, value))
    triples.extend((role, TYPE, SH.NodeShape) for role in roles)
    return triples


_INNER = _SHAPES | _SHAPES_OF_A_LIST


def _constraining(document: Document, predicates: Iterable[IRI]) -> set[IRI]:
    """Those of some predicates that constrain: SHACL's, and those of the document's own constraint components."""
    own = component_parameters(document)
    return {predicate for predicate in predicates if predicate in SH or predicate in own}


def local(document: Document, shape: Term, at_value: bool = False, above: frozenset[Term] = frozenset()) -> bool:
    """Whether a shape looks at nothing but statements about the node it is asked about."""
    if shape in above:
        return True
    paths = document.values(shape, SH.path)
    if paths and (at_value or not all(isinstance(path, IRI) for path in paths)):
        return False
    at_value = at_value or bool(paths)
    said = document.about(shape)
    inner = chain.from_iterable(
        document.items(value) if predicate in _SHAPES_OF_A_LIST else [value]
        for predicate, value in said
        if predicate in _INNER
    )
    known = _INNER | _SILENT | _OWN_VALUES | (frozenset() if at_value else _OWN_STATEMENTS)
    return _constraining(document, (predicate for predicate, _ in said)) <= known and all(
        local(document, one, at_value, above | {shape}) for one in inner
    )


@dataclass(slots=True)
class _PropertyParts:
    """What a property shape asks for, as far as it has been read."""

    minimum: int = 0
    maximum: int | None = None
    allowed: list[frozenset[Term]] = field(default_factory=list)
    required: list[Term] = field(default_factory=list)
    free_in: list[tuple[IRI, frozenset[Term]]] = field(default_factory=list)
    free_required: list[IRI] = field(default_factory=list)
    compared: list[PairTest] = field(default_factory=list)
    qualified: dict[IRI, list[Term]] = field(default_factory=dict)
    """How many values conform to which shape."""
    others: dict[IRI, list[Term]] = field(default_factory=dict)
    """The values of all other constraints."""

    def takes(self, predicate: IRI, value: Term) -> bool:
        """Take a constraint of how many values, or which, if it is one."""
        number = int(value.lexical) if isinstance(value, Literal) and value.lexical.isdecimal() else None
        if predicate == SH.hasValue:
            self.required.append(value)
        elif predicate == SH.minCount and number is not None:
            self.minimum = max(self.minimum, number)
        elif predicate == SH.maxCount and number is not None:
            self.maximum = number if self.maximum is None else min(self.maximum, number)
        else:
            return False
        return True


class _Compiler:
    """Compiles one shape; `rest` is raised as soon as something is met that only pySHACL can judge."""

    def __init__(self, document: Document, free: frozenset[IRI]) -> None:
        self.document, self.free = document, free
        self.own = component_parameters(document)
        """The predicates by which shapes use constraint components of the document."""
        self.rest = False
        self._above: list[Term] = []

    def shape(self, shape: Term) -> Iterator[RoleTest]:
        """The tests of a node shape or, inside a logical constraint, of a property shape."""
        if self._true(shape, SH.deactivated):
            return
        if shape in self._above:
            self.rest = True
            return
        if self.document.value(shape, SH.path) is not None:
            yield from self._property(shape)
            return
        self._above.append(shape)
        self.rest = self.rest or self._repeats(shape)
        for predicate, raw in self.document.about(shape):
            yield from self._constraint(predicate, raw)
        self._above.pop()

    def _constraint(self, predicate: IRI, value: Term) -> Iterator[RoleTest]:
        """One constraint of a node shape."""
        if predicate == SH["class"] and isinstance(value, IRI) and value not in self.free:
            yield ClassTest(value)
        elif predicate == SH.hasValue and value not in self.free:
            yield SelfTest(frozenset((value,)))
        elif predicate == SH["in"] and not self._mentions(value):
            yield SelfTest(frozenset(self.document.items(value)))
        elif predicate == SH.property:
            yield from self._property(value)
        elif predicate in _LOGIC:
            yield from self._logic(predicate, value)
        elif predicate in self.own or (predicate in SH and predicate not in _SILENT):
            self.rest = True

    def _logic(self, predicate: IRI, raw: Term) -> Iterator[RoleTest]:
        """A constraint over other shapes: how many of them the component conforms to."""
        shapes = self.document.items(raw) if predicate in _SHAPES_OF_A_LIST else [raw]
        wrong = predicate == SH.node and self.document.value(raw, SH.path) is not None
        if not shapes or wrong or any(map(self._mentions, shapes)):
            self.rest = True
            return
        whole, self.rest = self.rest, False
        groups = tuple(tuple(self.shape(shape)) for shape in shapes)
        exact, self.rest = not self.rest, whole or self.rest
        if predicate in (SH["and"], SH.node):
            yield Count(groups, len(groups))
        elif predicate == SH["or"] or (predicate == SH.xone and not exact):
            yield Count(groups, 1)
        elif predicate == SH.xone:
            yield Count(groups, 1, 1)
        elif exact:
            yield Count(groups, 0, 0)

    def _property(self, shape: Term) -> Iterator[PropertyTest]:
        """One property shape; `rest` where its path or any of its constraints is beyond the subset."""
        if self._true(shape, SH.deactivated):
            return
        path = self._path(shape)
        if path is None:
            self.rest = True
            return
        parts = _PropertyParts()
        for predicate, raw in dict.fromkeys(self.document.about(shape)):
            self._constraint_of_values(predicate, raw, parts)
        test = self._test(path, parts)
        self.rest = self.rest or self._repeats(shape)
        yield replace(test, qualified=tuple(self._qualified(parts.qualified))) if parts.qualified else test

    def _test(self, path: IRI, parts: _PropertyParts) -> PropertyTest:
        """The test of the values of a path, but for how many of them conform to another shape."""
        each, covered = compiled(parts.others)
        self.rest = self.rest or not parts.others.keys() <= covered
        return PropertyTest(
            path,
            parts.minimum,
            parts.maximum,
            tuple(parts.allowed),
            tuple(parts.required),
            tuple(parts.free_in),
            tuple(parts.free_required),
            tuple(each),
            tuple(parts.compared),
        )

    def _qualified(self, said: Mapping[IRI, list[Term]]) -> Iterator[QualifiedCount]:
        """How many values conform to a shape; `rest` where only pySHACL can judge that, or part of it."""
        shapes, *counts = (said.get(SH[f"qualified{name}"], []) for name in ("ValueShape", "MinCount", "MaxCount"))
        numbers = [
            [int(n.lexical) for n in some if isinstance(n, Literal) and n.lexical.isdecimal()] for some in counts
        ]
        ill_formed = len(shapes) != 1 or not any(counts) or any(len(some) > 1 for some in counts) or numbers == [[], []]
        if ill_formed or SH.qualifiedValueShapesDisjoint in said:
            self.rest = True
            return
        whole, self.rest = self.rest, False
        value = self._of_a_value(shapes[0])
        exact, self.rest = not self.rest, whole or self.rest
        # Of a shape that is compiled in part, more values may seem to conform than do.
        least, most = next(iter(numbers[0]), 0), next(iter(numbers[1]), None)
        yield QualifiedCount(value, least, most if exact else None)

    def _of_a_value(self, shape: Term) -> PropertyTest:
        """What a node shape asks of a single value; `rest` where it asks for more."""
        parts = _PropertyParts()
        if (
            self.document.value(shape, SH.path) is not None
            or self._true(shape, SH.deactivated)
            or self._mentions(shape)
        ):
            self.rest = True
        else:
            for predicate, raw in dict.fromkeys(self.document.about(shape)):
                self._constraint_of_values(predicate, raw, parts)
        # These are no constraints of node shapes.
        if parts.minimum or parts.maximum is not None or parts.compared or parts.qualified:
            self.rest = True
            parts = _PropertyParts()
        self.rest = self.rest or self._repeats(shape)
        return self._test(SH.value, parts)

    def _constraint_of_values(self, predicate: IRI, value: Term, parts: _PropertyParts) -> None:
        """One constraint of a property shape."""
        if predicate == SH["in"]:
            self._among(value, parts)
        elif predicate == SH.hasValue and value in self.free and isinstance(value, IRI):
            parts.free_required.append(value)
        elif predicate in _QUALIFIED:
            parts.qualified.setdefault(predicate, []).append(value)
        elif predicate in PAIRS and self._plain(value):
            parts.compared.append(PairTest(predicate, value))
        elif predicate in self.own:
            self.rest = True
        elif predicate in SH and predicate not in _SILENT and not parts.takes(predicate, value):
            if self._mentions(value):
                self.rest = True
            else:
                parts.others.setdefault(predicate, []).append(value)

    def _path(self, shape: Term) -> IRI | None:
        """The path of a property shape, if it is one property that a component states of itself."""
        paths = self.document.values(shape, SH.path)
        return paths[0] if len(paths) == 1 and self._plain(paths[0]) else None

    def _plain(self, path: Term) -> TypeGuard[IRI]:
        """Whether a path is one property that a profile keeps as statements."""
        return isinstance(path, IRI) and path not in self.free and path not in STRUCTURE and path not in SC

    def _among(self, head: Term, parts: _PropertyParts) -> None:
        """A list of values: all known, or all but one free parameter, which may be any other value."""
        members = self.document.items(head)
        variables = [m for m in dict.fromkeys(members) if isinstance(m, IRI) and m in self.free]
        constants = frozenset(m for m in members if m not in variables)
        if not variables:
            parts.allowed.append(constants)
        elif len(variables) == 1:
            parts.free_in.append((variables[0], constants))
        else:
            self.rest = True

    def _repeats(self, shape: Term) -> bool:
        """Whether something is stated twice that a shape may state once; pySHACL then says so."""
        said = [predicate for predicate, _ in dict.fromkeys(self.document.about(shape))]
        return any(said.count(predicate) > 1 for predicate in (SH["in"], SH.minCount, SH.maxCount))

    def _true(self, subject: Term, predicate: IRI) -> bool:
        value = self.document.value(subject, predicate)
        return isinstance(value, Literal) and value.lexical in ("true", "1")

    def _mentions(self, start: Term) -> bool:
        """Whether a free parameter stands in a term or anywhere below it."""
        waiting, seen = [start], set[Term]()
        while waiting:
            value = waiting.pop()
            if value in self.free:
                return True
            if value not in seen:
                seen.add(value)
                waiting.extend(o for _, o in self.document.about(value))
        return False
