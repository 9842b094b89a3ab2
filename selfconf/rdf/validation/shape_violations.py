"""Judging one file by the shapes: pySHACL finds the violations, and each is taken to its place in the text.

A file is judged alone, on its own triples, so that no file can change the verdict on another; the shapes
come from nowhere else than from selfconf. Configurations alone are judged with descriptions from other files. In which
mode one was computed is not known: types of its ports match along the hierarchy of the loaded ontologies, and only
ports of equal types have to be connected. A violation (SHACL, 3.6.2) names a focus node and mostly a
value or a path. It is shown where its author would look for it: at the value that must not be there, at
the second of two values where one is allowed, at the node that lacks something.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any

from pyshacl.errors import ReportableRuntimeError, ValidationFailure
from rdflib import RDF, RDFS, Graph, Literal, Namespace, URIRef
from rdflib.plugins.sparql import prepareQuery
from rdflib.plugins.sparql.sparql import Query
from rdflib.query import Result
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.model.immutable import immutable
from selfconf.rdf import vocabulary
from selfconf.rdf.permitted_fields import COMPONENT, LINKED
from selfconf.rdf.positions import Positions
from selfconf.rdf.pyshacl_corrections import only_ordered
from selfconf.rdf.rdflib_terms import merged
from selfconf.rdf.read_shapes import ReadShapes
from selfconf.rdf.validation.described_elsewhere import with_hierarchy
from selfconf.rdf.validation.diagnostics import at
from selfconf.rdf.validation.term_index import TermIndex

_SC, _SH, _SHAPES = (Namespace(one.base) for one in (vocabulary.SC, vocabulary.SH, vocabulary.SHAPES))
"""The vocabularies of which rdflib makes terms."""

_MADE_DISTINCT_BY: dict[Node, URIRef] = {
    _SHAPES.PortNamesDistinct: _SC.name,
    _SHAPES.TemplatePortNamesDistinct: _SC.name,
    _SHAPES.OperationNamesDistinct: _SC.name,
    _SHAPES.OperationalNamesDistinct: _SC.name,
    _SHAPES.ParameterNamesDistinct: _SC.name,
    _SHAPES.SettingsAgree: _SC.parameterType,
    _SHAPES.BindingsDistinct: _SC.parameter,
    _SHAPES.ComponentPlaysOnce: _SC.component,
}
"""Shapes that want values to differ, and the property in which they have to."""
_MORE_OF_NODE: dict[Node, frozenset[Node]] = {
    _SHAPES.CountOrder: frozenset((_SHAPES.MinCount, _SHAPES.MaxCount)),
    **dict.fromkeys((_SHAPES.SettingTypeOnce, _SHAPES.SettingValueOnce), frozenset((_SHAPES.SettingNode,))),
    **dict.fromkeys((_SHAPES.BindingParameterOnce, _SHAPES.BindingValueOnce), frozenset((_SHAPES.BindingNode,))),
}
"""Shapes that say nothing more of a node of which others are broken, as what is no number is not compared."""
_MORE_OF_VALUE: dict[Node, frozenset[Node]] = {
    _SHAPES.RoleTyped: frozenset((_SHAPES.RoleIri,)),
    _SHAPES.ParameterTyped: frozenset((_SHAPES.ParameterIri,)),
    **dict.fromkeys(
        (
            *(_SHAPES.MinCount, _SHAPES.MaxCount, _SHAPES.TermWeight, _SHAPES.TermOtherwise, _SHAPES.Priority),
            *(_SHAPES.InteractionOutput, _SHAPES.InteractionInput),
        ),
        frozenset((_SHAPES.FixedValue,)),
    ),
    **dict.fromkeys((_SHAPES.PortNameText, _SHAPES.OperationNameText), frozenset((_SHAPES.TemplatePortFixed,))),
}
"""Shapes that say nothing more of a value of a node of which others are broken."""


@immutable
class ReportedViolation:
    """One result of a validation report."""

    shape: URIRef
    message: str
    focus: Node
    path: Node | None
    value: Node | None
    constraint: Node | None
    """The constraint component that was broken."""

    @property
    def too_many(self) -> bool:
        """Whether there are more values than allowed, so that no one value is to blame."""
        return self.constraint == _SH.MaxCountConstraintComponent


_NAMING = (_SHAPES.PortNamesDistinct, _SHAPES.OperationalNamesDistinct)
"""Shapes whose queries only find what `_names_repeat` sees first."""
_LISTING = (_SHAPES.RolesList, _SHAPES.RolesDistinct, _SHAPES.FedRoleListed)
"""Shapes whose queries only find what `_lists_stray` sees first; rdflib goes down a list by recursion."""


_IN_BRACKETS = (*LINKED, vocabulary.SC.sets, vocabulary.SC.binding, vocabulary.SC.term)
"""What leads to a node that is described, mostly in brackets, and never to a list."""
_ANSWERS = ((_SH.targetClass, _SC.Configuration), (_SH.targetObjectsOf, _SC.task))
"""The targets of shapes that judge configurations."""
_ALONG_HIERARCHY = frozenset((_SHAPES.ConnectionMatches,))
"""The shapes that ask whether types match, which they may do by what lies above them."""
_TARGETS = (_SH.targetClass, _SH.targetSubjectsOf, _SH.targetObjectsOf)
"""The kinds of targets (SHACL, 2.1.3) of the shapes that ship with selfconf."""


@immutable
class Shapes:
    """The shapes, and for each file as few of them as may find something.

    pySHACL looks for the targets of each shape; which shapes have no target in a file is known sooner. It also asks the
    query of a SPARQL constraint for each focus node, which takes longer than all else.
    """

    all: Graph
    read: ReadShapes
    targets: tuple[tuple[Node, Node, Node], ...]
    """Shape, kind of target, and the class or predicate."""

    @classmethod
    def of(cls, shapes: Graph) -> Shapes:
        """Read the shapes, and find their targets."""
        targets = tuple((s, kind, o) for kind in _TARGETS for s, o in shapes.subject_objects(kind))
        return cls(shapes, ReadShapes(shapes), targets)

    @property
    def answers(self) -> frozenset[Node]:
        """The shapes that judge configurations."""
        return frozenset(shape for shape, kind, value in self.targets if (kind, value) in _ANSWERS)

    def needed(self, graph: Graph) -> frozenset[Node]:
        """The shapes with targets that a file may violate."""
        predicates, types = set(graph.predicates()), set(graph.objects(None, RDF.type))
        below = RDFS.subClassOf in predicates  # then a node may be an instance of a class that it does not name
        aimed = {
            shape
            for shape, kind, value in self.targets
            if (value in types or below if kind == _SH.targetClass else value in predicates)
        }
        unneeded = () if _names_repeat(graph) or _lists_stray(graph) else (*_NAMING, *_LISTING)
        return frozenset(aimed.difference(unneeded))


def _names_repeat(graph: Graph) -> bool:
    for link in COMPONENT.fields:
        for distinct in (named for named in link.into.fields if named.distinct):
            predicate, word = URIRef(link.predicate), URIRef(distinct.predicate)
            for component in set(graph.subjects(predicate)):
                names = [name for node in graph.objects(component, predicate) for name in graph.objects(node, word)]
                if len(names) != len(set(names)):
                    return True
    return False


def _lists_stray(graph: Graph) -> bool:
    """Whether a list of roles has no end or two, repeats a role, or holds one that feeds what is not in it."""
    for template in set(graph.subjects(_SC.roles)):
        roles: list[Node] = []
        passed: set[Node] = set()
        cells = list(graph.objects(template, _SC.roles))
        while len(cells) == 1 and cells[0] != RDF.nil and cells[0] not in passed:
            passed.add(cells[0])
            roles += graph.objects(cells[0], RDF.first)
            cells = list(graph.objects(cells[0], RDF.rest))
        known = set(roles)
        if cells != [RDF.nil] or len(known) != len(roles):
            return True
        if any(fed not in known for role in known for fed in graph.objects(role, _SC.feeds)):
            return True
    return False


class _PreparingGraph(Graph):
    """A graph that prepares each query once: pySHACL asks the query of a constraint anew for each focus node."""

    def query(self, query_object: str | Query, *given: Any, **options: Any) -> Result:
        prepared = _prepared(query_object) if isinstance(query_object, str) else query_object
        return super().query(prepared, *given, **options)


@lru_cache(maxsize=64)
def _prepared(text: str) -> Query:
    """A query of a constraint, which declares its prefixes itself (SHACL, 5.2.1): those of the file are not for it."""
    return prepareQuery(text)


def reported_violations(
    graph: Graph, shapes: ReadShapes, only: frozenset[Node] | None = None
) -> Iterator[ReportedViolation]:
    """What pySHACL finds in a graph, by all shapes with targets or by `only` some of them."""
    asked = _PreparingGraph(graph.store, graph.identifier, graph.namespace_manager)
    try:
        with only_ordered():  # by itself pySHACL fails beside a blank node, as in sc:minCount []
            results = list(shapes.results(asked, only))
    except ValidationFailure as error:
        raise ReportableRuntimeError(f"pySHACL cannot judge this file: {error.message}") from error
    for result in results:
        shape, focus, path = result[_SH.sourceShape], result[_SH.focusNode], result.get(_SH.resultPath)
        if not isinstance(shape, URIRef):
            continue
        if isinstance(focus, Literal) and path is not None:
            continue  # that it is a literal at all is the finding of another shape
        yield ReportedViolation(
            shape,
            str(result.get(_SH.resultMessage)),
            focus,
            path,
            result.get(_SH.value),
            result.get(_SH.sourceConstraintComponent),
        )


@immutable
class AnswerJudge:
    """By what the configurations of a file are judged besides the file."""

    beside: Graph
    """What other files say of their templates and components."""
    index: TermIndex

    def violations(self, graph: Graph, read: ReadShapes, only: frozenset[Node]) -> Iterator[ReportedViolation]:
        """What some shapes find in the configurations of a file."""
        if not only:
            return
        whole = merged(graph, self.beside)
        of_others = set(self.beside.subjects()) - set(graph.subjects())
        found = list(reported_violations(whole, read, only - _ALONG_HIERARCHY))
        if not only.isdisjoint(_ALONG_HIERARCHY):
            found += reported_violations(with_hierarchy(whole, self.index), read, only & _ALONG_HIERARCHY)
        yield from (violation for violation in found if violation.focus not in of_others)


def shape_violations(
    graph: Graph, positions: Positions, shapes: Shapes, judge: AnswerJudge | None = None
) -> list[Diagnostic]:
    """Every violation in one file, in no particular order."""
    judge = judge or AnswerJudge(Graph(), TermIndex())
    places = _Places(graph, positions, shapes.all)
    needed = shapes.needed(graph)
    reported = [
        *reported_violations(graph, shapes.read, needed - shapes.answers),
        *judge.violations(graph, shapes.read, needed & shapes.answers),
    ]
    broken = {(one.shape, *where) for one in reported for where in ((one.focus,), (one.focus, one.value))}
    found = [
        (places.offset(one), one)
        for one in reported
        if not any((shape, one.focus) in broken for shape in _MORE_OF_NODE.get(one.shape, ()))
        and not any((shape, one.focus, one.value) in broken for shape in _MORE_OF_VALUE.get(one.shape, ()))
    ]
    return [
        at(
            positions,
            offset,
            str(shapes.all.value(violation.shape, _SHAPES.code)),
            violation.message,
            hint=_remedy(violation, graph),
            shape=str(violation.shape),
        )
        for offset, violation in _without_firsts(_once_for_each_list(found, graph), graph)
    ]


def _remedy(violation: ReportedViolation, graph: Graph) -> str | None:
    """What to do where something is said in a wrong form, or of something else, as the shape itself cannot tell."""
    focus = violation.focus
    if _is_stray_list(focus, graph):
        return "These are no list: write a comma between one [ ... ] and the next, and no parentheses."
    is_part = any((None, URIRef(link), focus) in graph for link in LINKED)
    if is_part and violation.shape == _SHAPES.ComponentTyped:
        return "Here it is said of a part of a component: say it of the component."
    if violation.shape == _SHAPES.Feeder and (focus, RDF.type, _SC.Component) in graph:
        return "A component says nothing of others: say it of a role, in a template."
    return None


def _is_stray_list(node: Node, graph: Graph) -> bool:
    """Whether a node is a list, where one in brackets belongs."""
    return (node, RDF.first, None) in graph and any((None, URIRef(link), node) in graph for link in _IN_BRACKETS)


def _once_for_each_list(
    found: Iterable[tuple[int, ReportedViolation]], graph: Graph
) -> Iterator[tuple[int, ReportedViolation]]:
    """Of a list where a node in brackets belongs one violation: it has nothing of what such a node has."""
    of_lists: dict[Node, tuple[int, ReportedViolation]] = {}
    for offset, violation in found:
        if _is_stray_list(violation.focus, graph):
            one = of_lists.setdefault(violation.focus, (offset, violation))
            of_lists[violation.focus] = min(one, (offset, violation), key=lambda pair: pair[1].message)
        else:
            yield offset, violation
    yield from of_lists.values()


@immutable
class _Places:
    """Takes violations to their places in one text."""

    graph: Graph
    positions: Positions
    shapes: Graph

    def offset(self, violation: ReportedViolation) -> int:
        predicates = self._predicates(violation)
        distinct_by = _MADE_DISTINCT_BY.get(violation.shape)
        if distinct_by is not None and violation.value is not None:
            candidates = self._objects(violation.value, frozenset((distinct_by,)))
        elif violation.too_many:
            values = self._objects(violation.focus, predicates)
            candidates = values[1:] or values
        elif isinstance(violation.focus, Literal) or violation.value == violation.focus:
            candidates = self._mentions(violation.focus, self._links(violation.shape))
        elif violation.value is not None and predicates:
            own = self._objects(violation.focus, predicates, violation.value)
            candidates = own or self._mentions(violation.value, predicates)
        else:
            candidates = []
        return candidates[0] if candidates else self.positions.offset(violation.focus)

    def _objects(self, subject: Node, predicates: frozenset[Node], value: Node | None = None) -> list[int]:
        """Where the objects of a subject stand, or those equal to `value`, in the order of the text."""
        return sorted(
            self.positions.triples[subject, predicate, other].object
            for predicate in predicates
            for other in self.graph.objects(subject, predicate)
            if value is None or other == value
        )

    def _mentions(self, value: Node, predicates: frozenset[Node]) -> list[int]:
        """Where a value stands as the object of one of the predicates, in the order of the text."""
        return sorted(
            self.positions.triples[subject, predicate, value].object
            for predicate in predicates
            for subject in self.graph.subjects(predicate, value)
        )

    def _predicates(self, violation: ReportedViolation) -> frozenset[Node]:
        """The predicates that the path of a violation goes along."""
        if isinstance(violation.path, URIRef):
            return frozenset((violation.path,))
        path = self.shapes.value(violation.shape, _SH.path) if violation.path is not None else None
        return frozenset() if path is None else _iris(path, self.shapes)

    def _links(self, shape: Node) -> frozenset[Node]:
        """The predicates whose objects a shape is about."""
        return frozenset(self.shapes.objects(shape, _SH.targetObjectsOf))


def _iris(path: Node, shapes: Graph) -> frozenset[Node]:
    """The predicates in a property path (SHACL, 2.3.1)."""
    if isinstance(path, URIRef):
        return frozenset((path,)) - {RDF.nil}
    return frozenset(iri for part in shapes.objects(path) for iri in _iris(part, shapes))


def _without_firsts(
    found: Iterable[tuple[int, ReportedViolation]], graph: Graph
) -> Iterator[tuple[int, ReportedViolation]]:
    """Of values that have to differ and do not, the first is not to blame."""
    equals: dict[tuple[Node | None, ...], list[tuple[int, ReportedViolation]]] = defaultdict(list)
    for offset, violation in found:
        distinct_by = _MADE_DISTINCT_BY.get(violation.shape)
        if distinct_by is None or violation.value is None:
            yield offset, violation
        else:
            name = graph.value(violation.value, distinct_by)
            equals[violation.shape, violation.focus, violation.path, name].append((offset, violation))
    for group in equals.values():
        yield from sorted(group, key=lambda pair: pair[0])[1:]
