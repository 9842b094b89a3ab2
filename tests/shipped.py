"""The ontologies and shapes that ship with selfconf as graphs of rdflib, read once for all tests; none changes them."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache

from rdflib import Graph

from selfconf import library
from selfconf.rdf.validation.file_check import shapes_of
from selfconf.rdf.validation.shape_violations import Shapes


@cache
def ontology_graphs() -> Mapping[str, Graph]:
    """Each ontology by the name of its file."""
    return {path.stem: Graph().parse(path) for path in library.ontologies()}


@cache
def shape_graph(name: str) -> Graph:
    """The shapes in the file of that name."""
    return Graph().parse(next(path for path in library.shapes() if path.stem == name))


@cache
def shipped_shapes() -> Shapes:
    """All shapes."""
    return shapes_of(*(path.read_text("utf-8") for path in library.shapes()))
