"""Shapes that pySHACL has read once, to judge any number of graphs.

`pyshacl.validate` reads the shapes anew for each graph that it judges, looks for the targets of shapes that have none,
and writes a report as a graph and as a text. Of small graphs, as files mostly are, that takes most of the time. Here
the shapes are read once, what pySHACL asks about them again and again is looked up by hash, only shapes that have
targets are asked for focus nodes, and each result is taken as pySHACL makes it, without words that nothing reads.
"""

from __future__ import annotations

from collections.abc import Container, Generator, Mapping
from functools import lru_cache
from typing import Any

from pyshacl.constraints.constraint_component import ConstraintComponent
from pyshacl.constraints.core import (
    cardinality_constraints,
    logical_constraints,
    other_constraints,
    shape_based_constraints,
    value_constraints,
)
from pyshacl.graph_abstraction import DataGraph
from pyshacl.helper.sparql_query_helper import SPARQLQueryHelper
from pyshacl.monkey import apply_patches
from pyshacl.validator import Validator
from rdflib import Graph
from rdflib.term import Node

from selfconf.rdf.pyshacl_corrections import index_constraints, replaced

_DEEPEST = 50
"""How many shapes within shapes pySHACL follows.

By itself it follows 15; the shape of shapes nests 16, which are needed for a path of alternatives in a list of shapes.
"""


class ReadShapes:
    """Some shapes, read by pySHACL. The graph that they come from is copied."""

    def __init__(self, shapes: Graph) -> None:
        """Raises what pySHACL raises where the shapes are ill-formed, as far as that shows without a graph."""
        apply_patches()  # type: ignore[no-untyped-call]  # pySHACL does not say that it returns nothing
        index_constraints()
        graph = _IndexedGraph()
        for triple in shapes:
            graph.add(triple)
        nothing = DataGraph.from_rdflib(Graph(bind_namespaces="none"))
        validator = Validator(nothing, shacl_graph=graph, options={"max_validation_depth": _DEEPEST})
        self._executor = validator.make_executor()
        self._with_targets = [shape for shape in validator.shacl_graph.shapes if any(map(list, shape.target()))]

    def results(self, graph: Graph, only: Container[Node] | None = None) -> list[Mapping[Node, Node]]:
        """Each result of validating a graph (SHACL, 3.6.2), as its properties; of several values, one.

        `only` names the shapes with targets that are to be asked, where not all of them are. Raises ValidationFailure.
        """
        with replaced(_NOTHING_IN_VAIN):
            return [
                _properties(result, triples)
                for shape in self._with_targets
                if only is None or shape.node in only
                for _, result, triples in shape.validate(self._executor, graph)[1]
            ]


_check: Any = SPARQLQueryHelper.check_invalid_sparql


@lru_cache(maxsize=64)
def _may_be_asked(text: str) -> bool:
    """Whether a query keeps to what SHACL (5.2.1) allows; raises ValidationFailure if it does not."""
    return bool(_check(SPARQLQueryHelper, text))


def _checked_once(helper: object, text: str, valuenode: object = None, extravars: object = None) -> bool:
    """What pySHACL looks for in a query whenever it asks it about a node."""
    alone = valuenode is None and not extravars
    return _may_be_asked(text) if alone else bool(_check(helper, text, valuenode, extravars))


def _undescribed(*_: object, **__: object) -> str:
    """A result, or a term, in words: pySHACL looks up the prefix of every IRI, and writes blank nodes out."""
    return ""


_WORDING = (
    cardinality_constraints,
    logical_constraints,
    other_constraints,
    shape_based_constraints,
    value_constraints,
)
"""The modules of pySHACL that word a message where the shape has none, in particular of each part of a `sh:or`."""
_NOTHING_IN_VAIN: tuple[tuple[object, str, object], ...] = (
    (SPARQLQueryHelper, "check_invalid_sparql", _checked_once),
    (ConstraintComponent, "make_v_result_description", _undescribed),
    *((module, "stringify_node", _undescribed) for module in _WORDING),
)
"""By which pySHACL looks at the text of a query once, and describes no result in words."""


def _properties(result: Node, triples: list[tuple[Node, Node, Any]]) -> dict[Node, Node]:
    """The properties of a result, each value of which is a node, or a node with the graph that it comes from."""
    found: dict[Node, Node] = {}
    for subject, predicate, value in triples:
        if subject == result:
            found.setdefault(predicate, value[1] if isinstance(value, tuple) else value)
    return found


class _IndexedGraph(Graph):
    """A graph to which triples are only added, and that looks up by hash what it says of a subject."""

    def __init__(self) -> None:
        super().__init__(bind_namespaces="none")
        self._said: dict[Any, dict[Any, list[Any]]] = {}

    def add(self, triple: tuple[Any, Any, Any]) -> _IndexedGraph:
        subject, predicate, value = triple
        if triple not in self:
            self._said.setdefault(subject, {}).setdefault(predicate, []).append(value)
            super().add(triple)
        return self

    def objects(self, subject: Any = None, predicate: Any = None, unique: bool = False) -> Generator[Any, None, None]:
        if subject is None or predicate is None or isinstance(subject, list) or unique:
            yield from super().objects(subject, predicate, unique)
        else:
            yield from self._said.get(subject, _NOTHING).get(predicate, ())

    def predicate_objects(self, subject: Any = None, unique: bool = False) -> Generator[tuple[Any, Any], None, None]:
        if subject is None or unique:
            yield from super().predicate_objects(subject, unique)
        else:
            for predicate, values in self._said.get(subject, _NOTHING).items():
                for value in values:
                    yield predicate, value


_NOTHING: Mapping[Any, list[Any]] = {}
