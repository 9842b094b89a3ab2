"""Where roles and components are described: file and line, looked up only for what a refusal or a complaint names.

Reading for speed forgets lines. So the files of the few that are named are read again, if they are files of this
machine and not too long for that: first for the lines of their subjects alone (`selfconf.rdf.subject_lines`), and by
the parser that knows every place (`selfconf.rdf.positions`) where that does not tell. Text that is in no file is kept
by the task or the ecology that was read from it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from selfconf import files
from selfconf.api.document_texts import GRAPH, KEPT_TEXTS
from selfconf.model.immutable import replace
from selfconf.model.left_out import LeftOut
from selfconf.model.partition import NearMiss
from selfconf.model.profile import Place
from selfconf.model.refusal import InputUnfed, Reason, Refusal
from selfconf.model.relaxation import AcceptNearMiss, Relaxation
from selfconf.model.template import Template
from selfconf.model.term import IRI, BlankNode
from selfconf.rdf.advertisements import Advertisement

if TYPE_CHECKING:
    from selfconf.rdf.positions import Positions

LARGEST_REREAD = 1 << 20
"""Bytes of a file or text that is read again; of a larger one the name has to do."""
MOST_REREAD = 20
"""Of how many files that something was left out of the lines are looked up; of the others the names have to do."""
Fact = TypeVar("Fact", bound="Reason | Relaxation | NearMiss")


class _TextReadAgain:
    """The lines of a Turtle text in which named nodes are described."""

    def __init__(self, text: str, source: str, base: str) -> None:
        from selfconf.rdf.subject_lines import subject_lines  # needed by refusals and complaints alone

        self._text, self._source, self._base = text, source, base
        self.subjects = subject_lines(text)
        """The line in which each named node is first described, where that is certain without a parser of RDF."""

    def line_of(self, named: IRI | BlankNode) -> int | None:
        """The line in which a node is first described, or else first spoken of."""
        if named in self.subjects:
            return self.subjects[named]
        return None if self._positions is None else self._positions.line_of(named)

    @cached_property
    def _positions(self) -> Positions | None:
        from selfconf.rdf.positions import NotTurtleError, parse_with_positions  # loads rdflib, seldom needed here

        try:
            return parse_with_positions(self._text, self._source, self._base)[1]
        except (NotTurtleError, RecursionError):
            return None


FilesRead = dict[str, _TextReadAgain | None]
"""Each file that was read again, if it could be."""


class Places:
    """The places of the roles of a template and of the components of an ecology."""

    def __init__(self, template: Template, ecology: Mapping[IRI, Advertisement], texts: Sequence[str] = ()) -> None:
        """`texts` are those that the template and the ecology were read from and that are in no file."""
        self._roles = {role.iri: role.place for role in template.roles}
        self._ecology = ecology
        self._read: FilesRead = {}
        self._texts = texts

    def of_role(self, role: IRI) -> Place | None:
        """Where a role is described; the line only where it is known."""
        return self._of(role, self._roles.get(role))

    def of_component(self, component: IRI) -> Place | None:
        """Where a component is described, which may have the IRI of a role; the line only where it is known."""
        found = self._ecology.get(component)
        return self._of(component, None if found is None else found.profile.place)

    def _of(self, named: IRI, place: Place | None) -> Place | None:
        if place is not None and place.source in (*KEPT_TEXTS, GRAPH):
            return Place(place.source, None if place.source == GRAPH else _line_in(self._texts_read, named))
        if place is None or not Path(place.source).is_file():
            return None  # it comes from another machine, whose lines cannot be looked up here
        return _with_line(named, place, self._read)

    @cached_property
    def _texts_read(self) -> list[_TextReadAgain]:
        return _read_texts(self._texts)

    def placed(self, refusal: Refusal) -> Refusal:
        """The refusal with the place of each of its facts."""
        return replace(
            refusal,
            reasons=tuple(map(self._placed, refusal.reasons)),
            near_misses=tuple(map(self._placed, refusal.near_misses)),
            repairs=tuple(map(self._placed, refusal.repairs)),
        )

    def _placed(self, fact: Fact) -> Fact:
        component = _component_of(fact)
        return replace(fact, place=self.of_role(fact.role) if component is None else self.of_component(component))


def _read_texts(texts: Sequence[str]) -> list[_TextReadAgain]:
    """The texts that are not too long to be read again."""
    return [_TextReadAgain(text, "", "file:///") for text in texts if len(text) <= LARGEST_REREAD]


def _line_in(texts: Sequence[_TextReadAgain], named: IRI | BlankNode) -> int | None:
    """The line in the first of some texts that describes what is named, or else speaks of it."""
    told = next((one.subjects[named] for one in texts if named in one.subjects), None)
    if told is not None:
        return told
    return next((line for one in texts if (line := one.line_of(named)) is not None), None)


def with_lines(left_out: Collection[LeftOut], texts: Sequence[str] = ()) -> Iterator[LeftOut]:
    """Yield what was left out of an ecology with the lines where it is described.

    `texts` are those that the ecology was read from and that are in no file.
    """
    read: FilesRead = {}
    texts_read = _read_texts(texts) if any(one.place.source in KEPT_TEXTS for one in left_out) else []
    for one in left_out:
        source = one.place.source
        if one.place.line is not None or (source not in KEPT_TEXTS and source not in read and len(read) >= MOST_REREAD):
            yield one
        elif source in KEPT_TEXTS:
            yield replace(one, place=Place(source, _line_in(texts_read, one.component)))
        else:
            yield replace(one, place=_with_line(one.component, one.place, read))


def _with_line(named: IRI | BlankNode, place: Place, read: FilesRead) -> Place:
    """A place with the line of what is named, if it has one and its file can be read again."""
    if place.source not in read:
        read[place.source] = _read_again(place.source)
    found = read[place.source]
    line = None if found is None else found.line_of(named)
    return place if line is None else Place(place.source, line)


def _component_of(fact: Reason | Relaxation | NearMiss) -> IRI | None:
    """The component that a reason, a near miss or a relaxation is about; None if it is about its role."""
    if isinstance(fact, AcceptNearMiss):
        return fact.near.component
    return fact.component if isinstance(fact, InputUnfed | NearMiss) else None


def _read_again(source: str) -> _TextReadAgain | None:
    path = Path(source)
    try:
        if path.stat().st_size > LARGEST_REREAD:
            return None
        return _TextReadAgain(path.read_text("utf-8"), source, files.base(path))
    except (OSError, UnicodeDecodeError):
        return None
