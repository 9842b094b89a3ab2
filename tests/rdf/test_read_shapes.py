"""Shapes that are read once find what pySHACL finds that reads them anew for each graph."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import pyshacl
import pytest
from pyshacl import validator
from pyshacl.constraints.constraint_component import ConstraintComponent
from pyshacl.errors import ValidationFailure
from rdflib import SH, BNode, Graph, URIRef
from rdflib.term import Node

from selfconf.rdf.read_shapes import ReadShapes
from tests.bad_files import BAD
from tests.lab import PREFIXES
from tests.shipped import shape_graph

FACTS = (SH.sourceShape, SH.focusNode, SH.value, SH.sourceConstraintComponent, SH.resultSeverity, SH.resultMessage)
SHAPE = ":s a sh:NodeShape ; sh:targetClass :C ; sh:property [ sh:path :p ; sh:maxCount 1 ] ."
QUERY = 'sh:sparql [ sh:select "SELECT $this WHERE {{ $this ?p 1 {} }}" ]'


def graph(text: str) -> Graph:
    return Graph().parse(data=PREFIXES + text, format="turtle")


def fact(node: Node | None) -> Node | None:
    """A node of a result; the nodes of paths are named anew in each report."""
    return None if isinstance(node, BNode) else node


@pytest.mark.parametrize("kind", ["advertisement", "template", "task"])
@pytest.mark.parametrize("path", BAD[::40], ids=lambda path: path.stem)
def test_the_results_are_those_of_a_report(path: Path, kind: str) -> None:
    data = Graph()
    try:
        data.parse(path)
    except SyntaxError:
        data = graph(":a a sc:Component . :t a sc:Template . :k a sc:Task .")
    _, report, _ = pyshacl.validate(data, shacl_graph=Graph() + shape_graph(kind))
    assert isinstance(report, Graph)
    expected = Counter(
        tuple(fact(report.value(result, one)) for one in FACTS) for result in report.objects(None, SH.result)
    )
    found = ReadShapes(shape_graph(kind)).results(data)
    assert Counter(tuple(fact(result.get(one)) for one in FACTS) for result in found) == expected


def test_shapes_are_read_once_and_the_graph_that_they_come_from_is_as_before(monkeypatch: pytest.MonkeyPatch) -> None:
    shapes = graph(SHAPE)
    before = set(shapes)
    read = ReadShapes(shapes)
    assert set(shapes) == before
    shapes.remove((None, None, None))
    monkeypatch.delattr(validator, "ShapesGraph")
    for name in "ab":
        (result,) = read.results(graph(f":{name} a :C ; :p 1 , 2 ."))
        assert result[SH.focusNode].endswith(f"#{name}")  # type: ignore[attr-defined]  # it is an IRI


def test_only_the_shapes_that_are_named_are_asked() -> None:
    read = ReadShapes(graph(SHAPE + SHAPE.replace(":s ", ":other ")))
    data = graph(":a a :C ; :p 1 , 2 .")
    assert len(read.results(data)) == 2
    (one,) = [shape for shape in graph(SHAPE).subjects(SH.targetClass) if isinstance(shape, URIRef)]
    assert len(read.results(data, {one})) == 1
    assert not read.results(data, set())


def test_a_query_that_may_not_be_asked_is_refused_each_time() -> None:
    allowed, forbidden = (
        ReadShapes(graph(f":s a sh:NodeShape ; sh:targetClass :C ; {QUERY.format(more)} ."))
        for more in ("", "MINUS { $this ?q 2 }")
    )
    data = graph(":a a :C ; :p 1 . :b a :C ; :p 2 .")
    for _ in range(2):
        assert len(allowed.results(data)) == 1
        with pytest.raises(ValidationFailure, match="MINUS"):
            forbidden.results(data)


def test_pyshacl_describes_what_it_finds_to_others_as_before() -> None:
    shapes, data = graph(SHAPE), graph(":a a :C ; :p 1 , 2 .")
    before = ConstraintComponent.make_v_result_description
    assert ReadShapes(shapes).results(data)
    assert ConstraintComponent.make_v_result_description is before
    assert "Constraint Violation" in pyshacl.validate(data, shacl_graph=shapes)[2]
