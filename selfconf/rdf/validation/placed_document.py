"""A checked file as the readers of templates and advertisements take it, with the place of each statement."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

from selfconf.model.immutable import immutable
from selfconf.rdf.positions import Offsets, Positions
from selfconf.rdf.rdflib_terms import from_rdflib, to_document
from selfconf.rdf.turtle import Document, Triple


@immutable
class PlacedDocument:
    """The statements of a file in the order of the text, so that of two that do not go together the later is blamed."""

    document: Document
    places: Mapping[Triple, Offsets]

    @classmethod
    def of(cls, positions: Positions) -> PlacedDocument:
        """The document of a text that was read with positions."""
        said = sorted(positions.triples.items(), key=lambda one: one[1].object)
        places = {cast(Triple, tuple(map(from_rdflib, triple))): offsets for triple, offsets in said}
        return cls(to_document((triple for triple, _ in said), positions.file), places)
