"""Shapes as tests: the common subset of SHACL compiled, the rest left to pySHACL.

A `ShapeCompiler` turns a shape into tests that look at a profile and need no graph. What it compiles:

* `sh:class`, `sh:in` and `sh:hasValue` on the node (SHACL 4.1.1, 4.8.2, 4.8.3);
* property shapes over one predicate with `sh:in`, `sh:hasValue`, `sh:minCount`, `sh:maxCount` (4.8, 4.2), and what
  `selfconf.rdf.shacl.value_tests` knows of single values (4.1.2, 4.1.3, 4.3, 4.4) and of pairs (4.5.3, 4.5.4);
* `sh:qualifiedValueShape` over a node shape that asks such things of single values (4.7.3);
* `sh:and`, `sh:or`, `sh:xone`, `sh:not` and `sh:node` over shapes of that kind (4.6, 4.7.1);
* a parameter inside `sh:in` or `sh:hasValue`, as the set of values that a component allows it.

A shape that says more is *incomplete* here: its tests are still necessary, so they are the prefilter. Left out on
purpose: `sh:class` on the values of a property, which depends on what other advertisements say.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TypeGuard

from selfconf.model.hierarchy import Hierarchy
from selfconf.model.immutable import replace
from selfconf.model.literal_values import natural_number
from selfconf.model.term import IRI, Literal, Term
from selfconf.model.wording import in_english
from selfconf.rdf.eligibility.role_tests import ClassTest, Count, PropertyTest, QualifiedCount, RoleTest, SelfTest
from selfconf.rdf.permitted_fields import LISTS_OF_SHAPES, SHAPE_ANNOTATIONS, STRUCTURE
from selfconf.rdf.shacl import PAIRS, PairTest, compiled, component_parameters, shapes_behind
from selfconf.rdf.tasks import mentions
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import SC, SH, TYPE

TARGETS = frozenset((SH.targetClass, SH.targetNode, SH.targetSubjectsOf, SH.targetObjectsOf, SH.target))
"""What says to which nodes a shape applies; a role says itself to which."""
SILENT = SHAPE_ANNOTATIONS | TARGETS | {SH.severity, SH.deactivated, TYPE, SH.path}
"""What is said of a shape and is no constraint."""
_LOGIC = LISTS_OF_SHAPES | {SH["not"], SH.node}
_QUALIFIED = frozenset(SH[f"qualified{name}"] for name in ("ValueShape", "MinCount", "MaxCount", "ValueShapesDisjoint"))
"""How many values conform to a shape."""


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
        number = natural_number(value)
        if predicate == SH.hasValue:
            self.required.append(value)
        elif predicate == SH.minCount and number is not None:
            self.minimum = number
        elif predicate == SH.maxCount and number is not None:
            self.maximum = number
        else:
            return False
        return True


class ShapeCompiler:
    """Compiles one shape; `rest` is raised as soon as something is met that only pySHACL can judge."""

    def __init__(self, document: Document, free: frozenset[IRI], hierarchy: Hierarchy) -> None:
        self.document, self.free = document, free
        self._structure = STRUCTURE.union(*map(hierarchy.superproperties, STRUCTURE))
        """What leads to more than the statements that a profile keeps as properties."""
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
        elif predicate in self.own or (predicate in SH and predicate not in SILENT):
            self.rest = True

    def _logic(self, predicate: IRI, raw: Term) -> Iterator[RoleTest]:
        """A constraint over other shapes: how many of them the component conforms to."""
        shapes = shapes_behind(self.document, predicate, raw)
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
        qualified = tuple(self._qualified(parts.qualified)) if parts.qualified else ()
        yield replace(self._test(path, parts), qualified=qualified, message=self._message(shape))

    def _message(self, shape: Term) -> str:
        """What the author of a shape says of a component that does not conform to it; empty where that is nothing."""
        said = self.document.values(shape, SH.message)
        return in_english((one.language or "", one.lexical) for one in said if isinstance(one, Literal))

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
        numbers = [[number for number in map(natural_number, some) if number is not None] for some in counts]
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
        elif predicate in SH and predicate not in SILENT and not parts.takes(predicate, value):
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
        return isinstance(path, IRI) and path not in self.free and path not in self._structure and path not in SC

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

    def _true(self, subject: Term, predicate: IRI) -> bool:
        value = self.document.value(subject, predicate)
        return isinstance(value, Literal) and value.lexical in ("true", "1")

    def _mentions(self, term: Term) -> bool:
        """Whether a term is a free parameter, or one stands anywhere below it."""
        return term in self.free or bool(mentions(self.document, term, self.free))
