"""Where roles and components are described: file and line, looked up only for what a refusal names.

Reading for speed forgets lines. So the files of the few that a refusal names are read again, with positions
(`selfconf.rdf.positions`), if they are files of this machine and not too long for that.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from selfconf.model.partition import NearMiss
from selfconf.model.profile import Place
from selfconf.model.refusal import InputUnfed, Reason, Refusal
from selfconf.model.relaxation import AcceptNearMiss, Relaxation
from selfconf.model.template import Template
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement

if TYPE_CHECKING:
    from selfconf.rdf.positions import Positions

LARGEST_REREAD = 1 << 20
"""Bytes of a file that is read again; of a larger one the name has to do."""
Fact = TypeVar("Fact", bound="Reason | Relaxation | NearMiss")


class Places:
    """The places of the roles of a template and of the components of an ecology."""

    def __init__(self, template: Template, ecology: Mapping[IRI, Advertisement]) -> None:
        self._roles = {role.iri: role.place for role in template.roles}
        self._ecology = ecology
        self._read: dict[str, Positions | None] = {}

    def of(self, named: IRI) -> Place | None:
        """Where a role or component is described; the line only where it is known."""
        if named in self._roles:
            place = self._roles[named]
        else:
            place = self._ecology[named].profile.place if named in self._ecology else None
        if place is None or not Path(place.source).is_file():
            return None  # it comes from another machine, whose lines cannot be looked up here
        if place.source not in self._read:
            self._read[place.source] = _positions(place.source)
        found = self._read[place.source]
        line = None if found is None else found.line_of(named)
        return place if line is None else Place(place.source, line)

    def placed(self, refusal: Refusal) -> Refusal:
        """The refusal with the place of each of its facts."""
        return replace(
            refusal,
            reasons=tuple(map(self._placed, refusal.reasons)),
            near_misses=tuple(map(self._placed, refusal.near_misses)),
            repairs=tuple(map(self._placed, refusal.repairs)),
        )

    def _placed(self, fact: Fact) -> Fact:
        return replace(fact, place=self.of(_spoken_of(fact)))


def _spoken_of(fact: Reason | Relaxation | NearMiss) -> IRI:
    """The role or component that a reason, a near miss or a relaxation is about."""
    if isinstance(fact, AcceptNearMiss):
        return fact.near.component
    return fact.component if isinstance(fact, InputUnfed | NearMiss) else fact.role


def _positions(source: str) -> Positions | None:
    from selfconf.rdf.positions import NotTurtleError, parse_with_positions  # loads rdflib, which answers do not need

    path = Path(source)
    try:
        if path.stat().st_size > LARGEST_REREAD:
            return None
        return parse_with_positions(path.read_text("utf-8"), source, path.resolve().as_uri())[1]
    except (OSError, UnicodeDecodeError, NotTurtleError, RecursionError):
        return None
