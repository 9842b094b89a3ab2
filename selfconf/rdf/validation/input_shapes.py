"""Whether what inputs accept are shapes that an advertisement may hold, judged by the reader of advertisements."""

from __future__ import annotations

from collections.abc import Iterator

from rdflib import BNode, Graph, URIRef

from selfconf.model.diagnostic import Diagnostic
from selfconf.rdf.advertisements import ShapeNotAccepted, statements_of_shape
from selfconf.rdf.positions import Positions
from selfconf.rdf.rdflib_terms import from_rdflib
from selfconf.rdf.shacl import misfit
from selfconf.rdf.turtle import Triple
from selfconf.rdf.validation.diagnostics import at
from selfconf.rdf.validation.placed_document import PlacedDocument
from selfconf.rdf.vocabulary import SC


def unaccepted_shapes(graph: Graph, positions: Positions) -> Iterator[Diagnostic]:
    """What keeps a shape of `sc:accepts` from being one of an advertisement, at the statement at fault."""
    shapes = sorted({shape for shape in graph.objects(None, URIRef(SC.accepts)) if isinstance(shape, BNode)})
    if not shapes:
        return
    placed = PlacedDocument.of(positions)
    wrong: tuple[Triple | None, str] | None
    for shape in shapes:
        try:
            said = list(statements_of_shape(placed.document, from_rdflib(shape)))
            wrong = misfit(placed.document, said, frozenset())
        except ShapeNotAccepted as error:
            wrong = error.statement, f"This is no shape that an advertisement may hold: {error}"
        if wrong is not None:
            statement, message = wrong
            offset = positions.offset(shape) if statement is None else placed.places[statement].object
            yield at(positions, offset, "SC-A20", f"{message}.")
