"""Whether what inputs accept are shapes that an advertisement may hold, judged by the reader of advertisements."""

from __future__ import annotations

from collections.abc import Iterator

import rdflib
from rdflib import BNode, Graph, URIRef

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.advertisements import ShapeNotAccepted, statements_of_shape
from selfconf.rdf.positions import Positions
from selfconf.rdf.rdflib_terms import from_rdflib, to_document
from selfconf.rdf.shacl import misfit
from selfconf.rdf.turtle import Triple
from selfconf.rdf.validation.diagnostics import at
from selfconf.rdf.vocabulary import SC


def unaccepted_shapes(graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """What keeps a shape of `sc:accepts` from being one of an advertisement, at the statement at fault."""
    shapes = sorted({shape for shape in graph.objects(None, URIRef(SC.accepts)) if isinstance(shape, BNode)})
    places = {
        tuple(map(from_rdflib, triple)): offsets.object for triple, offsets in positions.triples.items() if shapes
    }
    # In the order of the text, so that of two statements that do not go together the later one is blamed.
    said = sorted(graph, key=lambda one: _offset(positions, one)) if shapes else ()
    document = to_document(said, positions.file)
    wrong: tuple[Triple | None, str] | None
    for shape in shapes:
        try:
            wrong = misfit(document, list(statements_of_shape(document, from_rdflib(shape))), frozenset())
        except ShapeNotAccepted as error:
            wrong = error.statement, f"This is no shape that an advertisement may hold: {error}"
        if wrong is not None:
            statement, message = wrong
            yield at(positions, places.get(statement or (), positions.offset(shape)), "SC-A20", f"{message}.")


def _offset(positions: Positions, triple: tuple[rdflib.term.Node, rdflib.term.Node, rdflib.term.Node]) -> int:
    """Where the object of a statement stands; the beginning, where that is not known."""
    offsets = positions.triples.get(triple)
    return 0 if offsets is None else offsets.object
