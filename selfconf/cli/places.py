"""Where a role or a component is spoken of: file and line, looked up only when somebody has to be told.

Reading for speed forgets lines. So the files of the few that a refusal names are read again, with positions
(`rdf.positions`), if they are files of this machine and not too long for that.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from rdflib import URIRef

from selfconf.model.profile import Place
from selfconf.model.template import Template
from selfconf.model.term import IRI
from selfconf.rdf import positions
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.positions import NotTurtleError, Positions

LARGEST = 1 << 20
"""Bytes of a file that is read again; of a larger one the name has to do."""


class Places:
    """The places of the roles of a template and of the components of an ecology."""

    def __init__(self, template: Template, ecology: Mapping[IRI, Advertisement]) -> None:
        self._roles = {role.iri: role.place for role in template.roles}
        self._ecology = ecology
        self._read: dict[str, Positions | None] = {}

    def __call__(self, named: IRI) -> Place | None:
        """Where a role or component is described; the line only where it is known."""
        if named in self._roles:
            place = self._roles[named]
        else:
            place = self._ecology[named].profile.place if named in self._ecology else None
        if place is None or not Path(place.source).is_file():
            return None  # it comes from another machine, and its lines are not ours to point to
        if place.source not in self._read:
            self._read[place.source] = _positions(place.source)
        found = self._read[place.source]
        spot = None if found is None else found.of_node(URIRef(named))
        return place if spot is None else Place(place.source, spot.line)


def _positions(source: str) -> Positions | None:
    path = Path(source)
    try:
        if path.stat().st_size > LARGEST:
            return None
        return positions.parse_with_positions(path.read_text("utf-8"), source, path.resolve().as_uri())[1]
    except (OSError, UnicodeDecodeError, NotTurtleError, RecursionError):
        return None
