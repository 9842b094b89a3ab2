"""Everything that some shapes ask of one node, put together from wherever it stands.

A shape may say what it wants in many places: in several property shapes over one path, behind `sh:node` and `sh:and`,
in shapes with names. Whether all of it can hold at once shows only when it lies side by side. So here a node has a
*normal form*: what holds of the node itself, and for each path how many values it leads to and what holds of each of
them, which is a normal form again. Each constraint in it is the statement that makes it, so that it can be shown to its
author.

What is not understood is left out, and `whole` says so: what cannot hold without it cannot hold with it either.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cached_property

from rdflib import RDF, RDFS, SH, Graph, Literal, URIRef
from rdflib.term import Node

from selfconf.model.literal_values import natural_number
from selfconf.rdf.rdflib_terms import from_rdflib
from selfconf.rdf.vocabulary import SC

ShapeStatement = tuple[Node, Node, Node]
Path = tuple[object, ...]
"""A property path in a form in which equal paths are equal: `(iri,)`, `(rdf:first, iri, iri)` for a sequence, ..."""

DEEPEST_SHAPES = 6
"""Shapes that speak of themselves are followed no further than this."""
SINGLE = frozenset(
    (
        SH["class"], SH.nodeKind, SH.datatype, SH["in"], SH.languageIn, SH.pattern, SH.minLength, SH.maxLength,
        SH.minInclusive, SH.maxInclusive, SH.minExclusive, SH.maxExclusive,
    )
)  # fmt: skip
"""What SHACL asks of each value by itself."""
AT_LEAST = frozenset((SH.minCount, SH.qualifiedMinCount))
AT_MOST = frozenset((SH.maxCount,))
_SILENT = frozenset(
    (
        SH.path, SH.flags, SH.deactivated, SH.message, SH.severity, SH.name, SH.description, SH.order, SH.group,
        SH.targetNode, SH.targetClass, SH.targetSubjectsOf, SH.targetObjectsOf, SH.ignoredProperties,
    )
)  # fmt: skip


def count_of(value: Node) -> int | None:
    """The number of values that `sh:minCount` and the like say; None for what is no such number."""
    return natural_number(from_rdflib(value))


class ShapeSource:
    """The graphs that shapes stand in, as one; first what an author wrote, then what holds of every advertisement."""

    def __init__(self, *graphs: Graph) -> None:
        self.graphs = graphs
        self.parameters = frozenset(self.subjects(RDF.type, URIRef(SC.Parameter)))
        self.constraints = frozenset(
            path
            for graph in graphs
            for kind in graph.transitive_subjects(RDFS.subClassOf, SH.ConstraintComponent)
            for component in (self.subjects(RDF.type, kind) if kind is not None else ())
            for parameter in self.values(component, SH.parameter)
            for path in self.values(parameter, SH.path)
        )
        """The predicates by which a shape uses a constraint component of these graphs."""

    def about(self, subject: Node) -> Iterator[tuple[Node, Node]]:
        """Predicate and object of each statement about a subject."""
        for graph in self.graphs:
            yield from graph.predicate_objects(subject)

    def subjects(self, predicate: Node, value: Node) -> Iterator[Node]:
        """What has that value."""
        for graph in self.graphs:
            yield from graph.subjects(predicate, value)

    def applied(self, target: Node, value: Node) -> Iterator[Node]:
        """The shapes that apply to whatever they target: those of all graphs but the first.

        What an author writes there is judged by roles alone; the targets of other shapes are not looked for.
        """
        for graph in self.graphs[1:]:
            yield from graph.subjects(target, value)

    def values(self, subject: Node, predicate: Node) -> list[Node]:
        """The objects of a subject and predicate."""
        return [value for graph in self.graphs for value in graph.objects(subject, predicate)]

    def items(self, head: Node) -> list[Node]:
        """The members of a list, as far as it is one."""
        members: list[Node] = []
        seen: set[Node] = set()
        while head not in seen and (firsts := self.values(head, RDF.first)):
            seen.add(head)
            members += firsts[:1]
            head = next(iter(self.values(head, RDF.rest)), RDF.nil)
        return members

    def form(self, node: Node, depth: int = DEEPEST_SHAPES) -> object:
        """A value in which nodes in brackets are equal if they say the same."""
        if isinstance(node, (URIRef, Literal)) or depth == 0:
            return node
        return frozenset((predicate, self.form(value, depth - 1)) for predicate, value in self.about(node))

    def path(self, node: Node) -> Path:
        """A property path (SHACL, 2.3.1)."""
        if isinstance(node, URIRef):
            return (node,)
        members = self.items(node)
        return (RDF.first, *(self.form(member) for member in members)) if members else (self.form(node),)

    def variable(self, value: Node) -> bool:
        """Whether a value is not known before a parameter is bound."""
        return value in self.parameters or any(member in self.parameters for member in self.items(value))


class NormalForm:
    """What shapes ask of one node."""

    def __init__(self, source: ShapeSource, shapes: Iterable[Node], depth: int = DEEPEST_SHAPES) -> None:
        self.source, self._depth = source, depth
        self.whole = depth > 0
        """Whether nothing has been left out."""
        self.own: list[ShapeStatement] = []
        """What holds of the node itself."""
        self.values: dict[Path, ValueNormalForm] = {}
        self.closed: list[ShapeStatement] = []
        self.nots: list[ShapeStatement] = []
        self.choices: list[ShapeStatement] = []
        """`sh:or` and `sh:xone`: one of several shapes at least."""
        self.shapes: list[Node] = []
        for shape in shapes if depth else ():
            self.add(shape)

    def add(self, shape: Node) -> None:
        """Ask for what a shape asks for; of a property shape, the values of its path for it."""
        if shape in self.shapes or Literal(True) in self.source.values(shape, SH.deactivated):
            return
        for path in self.source.values(shape, SH.path):
            self.along(self.source.path(path)).add(shape)
            return
        self.require(shape)

    # complexity: one case for each constraint of SHACL that is understood
    def require(self, shape: Node) -> None:
        """Ask of the node what a node shape asks for, or a property shape of each of its values."""
        self.shapes.append(shape)
        counted = bool(self.source.values(shape, SH.path))
        for predicate, value in self.source.about(shape):
            statement = (shape, predicate, value)
            if predicate == SH.property or predicate == SH.node:
                self.add(value)
            elif predicate == SH["and"]:
                for member in self.source.items(value):
                    self.add(member)
            elif predicate == SH["not"]:
                self.nots.append(statement)
            elif predicate in (SH["or"], SH.xone):
                self.choices.append(statement)
            elif predicate == SH.closed:
                self.closed += [statement] if value == Literal(True) else []
            elif counted and predicate in AT_LEAST | AT_MOST | {SH.hasValue}:
                continue  # of all values together, not of each
            elif self.source.variable(value) or not isinstance(predicate, URIRef):
                self.whole = False
            elif predicate in SINGLE or predicate == SH.hasValue:
                self.own.append(statement)
            elif predicate in self.source.constraints or (predicate in SH and predicate not in _SILENT):
                self.whole = False

    def plus(self, shape: Node) -> NormalForm:
        """The normal form of these shapes and a further one."""
        found = NormalForm(self.source, (), self._depth)
        for one in self.shapes:
            found.require(one)
        for path, values in self.values.items():
            for one in values.shapes:
                found.along(path).add(one)
        found.add(shape)
        return found

    def along(self, path: Path) -> ValueNormalForm:
        """The values that a path leads to."""
        if path not in self.values:
            self.values[path] = ValueNormalForm(self, path, self._depth - 1)
        return self.values[path]


class ValueNormalForm:
    """What shapes ask of the values that a path leads to: of all together, and of each."""

    def __init__(self, node: NormalForm, path: Path, depth: int) -> None:
        self._node, self.path, self._depth = node, path, depth
        self.source = node.source
        self.shapes: list[Node] = []
        self.least: list[tuple[int, ShapeStatement]] = []
        self.most: list[tuple[int, ShapeStatement]] = []
        self.required: list[ShapeStatement] = []

    def add(self, shape: Node) -> None:
        """Ask for what a property shape asks for."""
        if shape in self.shapes:
            return
        self.shapes.append(shape)
        for predicate, value in self.source.about(shape):
            statement = (shape, predicate, value)
            if predicate == SH.hasValue:
                self.least.append((1, statement))
                if not self.source.variable(value):
                    self.required.append(statement)
            elif predicate in AT_LEAST | AT_MOST and (number := count_of(value)) is not None:
                (self.least if predicate in AT_LEAST else self.most).append((number, statement))
            if predicate in AT_LEAST | AT_MOST | {SH.hasValue} and self.source.variable(value):
                self._node.whole = False

    @cached_property
    def each(self) -> NormalForm:
        """What holds of each value; of what a sequence leads to, also what is said of its steps one by one."""
        found = NormalForm(self.source, (), self._depth)
        if self._depth > 0:
            for shape in (*self.shapes, *self._step_by_step()):
                found.require(shape)
            for shape in self.source.applied(SH.targetObjectsOf, self._last()):
                found.add(shape)
        return found

    def needed(self) -> tuple[int, ShapeStatement] | None:
        """How many values there have to be, if any, and what says so."""
        return max((pair for pair in self.least if pair[0] > 0), key=lambda pair: pair[0], default=None)

    def _last(self) -> Node:
        last = self.path[-1]
        return last if isinstance(last, URIRef) else RDF.nil

    def _step_by_step(self) -> list[Node]:
        """The property shapes over the last step of a sequence that hold of what the steps before it lead to."""
        if self.path[0] != RDF.first:
            return []
        node = self._node
        for step in self.path[1:-1]:
            node = node.along((step,)).each
        return node.along((self.path[-1],)).shapes
