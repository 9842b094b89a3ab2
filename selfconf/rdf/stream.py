"""Advertisements by the hundred thousand: from the bytes of a document to profiles, without a store in between.

A component is its IRI and a tuple of clauses that it shares with others (`selfconf.rdf.clauses`). Its profile and its
triples are made from them when somebody asks, which for a component that no role wants is never. A document that
cannot be folded into clauses is read by `advertisements.read` instead, and so is each component about which anything
is unusual: the careful reader is the authority on what conforms, and on how to say what does not.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from hashlib import blake2s
from itertools import starmap
from operator import attrgetter

from selfconf.model.profile import Input, OperationalParameter, Output, Place, Profile, shared_ports
from selfconf.model.term import IRI, BlankNode, Term
from selfconf.rdf import advertisements, turtle
from selfconf.rdf.advertisements import Advertisement, Malformed, about
from selfconf.rdf.clauses import END, NEXT, Clause
from selfconf.rdf.pieces import Pieces, folded
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import SC

Keyed = tuple[tuple[str, tuple[int, str, str, str]], tuple[IRI, Term]]
_NAME = attrgetter("name")
_NONE: frozenset[IRI] = frozenset()


class Streamed(Advertisement):
    """An advertisement as clauses, of which profile and triples are made when somebody asks."""

    __slots__ = ("_clauses", "_origin", "_profile")

    def __init__(self, component: IRI, types: frozenset[IRI], clauses: tuple[Clause, ...], origin: Origin) -> None:
        self.component, self.types, self._clauses, self._origin = component, types, clauses, origin
        self._profile: Profile | None = None

    @property
    def clauses(self) -> tuple[Clause, ...]:
        """What its profile is made of; nothing where only the careful reader could make it."""
        return self._clauses

    @property
    def profile(self) -> Profile:
        """What it says, as a value."""
        if self._profile is None:
            self._profile = _merged(self.component, self.types, self._clauses, self._origin.place)
        return self._profile

    @property
    def triples(self) -> tuple[Triple, ...]:
        """What it says, in RDF; made anew, with blank nodes of its own, each time."""
        return self._origin.triples(self.component, self._clauses)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Streamed) and self._origin is other._origin:
            return self.component == other.component
        return super().__eq__(other)

    __hash__ = Advertisement.__hash__


class Judged(Streamed):
    """A streamed advertisement about which something was unusual, with the profile that the careful reader made."""

    __slots__ = ()

    def __init__(self, profile: Profile, clauses: tuple[Clause, ...], origin: Origin) -> None:
        super().__init__(profile.component, profile.types, clauses, origin)
        self._profile = profile

    @property
    def clauses(self) -> tuple[Clause, ...]:
        """Nothing: its profile is all that counts."""
        return ()


def _merged(component: IRI, types: frozenset[IRI], clauses: tuple[Clause, ...], place: Place) -> Profile:
    """The profile of a component about which nothing is unusual."""
    properties: list[Keyed] = []
    inputs: list[Input] = []
    outputs: list[Output] = []
    parameters: list[OperationalParameter] = []
    preference, command = 0.0, None
    for clause in clauses:
        if clause.slot is clause:
            properties += clause.keyed or _keyed(clause, component)
            continue
        part = clause.part or clause.read()
        if part.inputs:
            inputs += part.inputs
        elif part.outputs:
            outputs += part.outputs
        elif part.parameters:
            parameters += part.parameters
        else:
            preference = preference or part.preference
            command = part.command if command is None else command
    properties.sort()
    return Profile(
        component,
        types,
        tuple(dict.fromkeys([pair for _, pair in properties])),
        shared_ports(
            tuple(inputs) if len(inputs) < 2 else tuple(sorted(inputs, key=_NAME)),
            tuple(outputs) if len(outputs) < 2 else tuple(sorted(outputs, key=_NAME)),
        ),
        tuple(parameters) if len(parameters) < 2 else tuple(sorted(parameters, key=_NAME)),
        preference,
        command,
        place,
    )


def _keyed(clause: Clause, component: IRI) -> list[Keyed]:
    """The properties that a clause states, each behind what they are ordered by; remembered if all may share them."""
    pairs = clause.properties
    own = [(p, _own(v, component) if isinstance(v, BlankNode) else v) for p, v in pairs]
    keyed = [(advertisements.property_order(pair), pair) for pair in own]
    if not any(isinstance(value, BlankNode) for _, value in pairs):
        clause.keyed = keyed
    return keyed


def _own(value: BlankNode, component: IRI) -> BlankNode:
    """A blank node of a clause that several components share, made the component's own."""
    return BlankNode(f"{value}.{blake2s(component.encode(), digest_size=8).hexdigest()}")


class Origin:
    """The document that advertisements came from: its name, and what it says about things that are no components."""

    def __init__(self, source: str) -> None:
        self.place = Place(source)
        self.things: dict[str, list[Clause]] = {}

    @cached_property
    def surroundings(self) -> Document:
        """All that is said about other things than components."""
        return turtle.parse("".join(starmap(_written, self.things.items())), self.place.source)

    def document(self, component: IRI, clauses: Iterable[Clause]) -> Document:
        """What is said about one component and about everything that is no component."""
        document = turtle.parse(_written(f"<{component}>", clauses), self.place.source)
        if self.things:
            document.statements.update(self.surroundings.statements)
        return document

    def triples(self, component: IRI, clauses: Iterable[Clause]) -> tuple[Triple, ...]:
        """The statements that the advertisement of a component makes."""
        return tuple(about(self.document(component, clauses), component, frozenset()))


def _written(subject: str, clauses: Iterable[Clause]) -> str:
    return f"{subject} {NEXT.join(clause.text for clause in clauses)}{END}"


def read(
    text: bytes, source: str, base: str | None = None, pieces: Pieces | None = None
) -> tuple[list[Advertisement], list[Malformed]]:
    """What `advertisements.read` makes of a document, sooner and smaller; documents may share their pieces.

    Raises TurtleError.
    """
    pieces = Pieces() if pieces is None else pieces
    subjects = folded(text, source, base, pieces)
    if subjects is None:
        return advertisements.read(turtle.parse(text, source, base))
    del text  # as large as what is made of it
    origin = Origin(source)
    found: list[Advertisement | tuple[IRI, list[Clause]]] = []
    suspects, slot, component_type = pieces.suspects, attrgetter("slot"), SC.Component
    unusual = False
    for subject, said in subjects.items():
        unlike = len(set(map(slot, said))) == len(said)
        if not unlike:
            pieces.typed(said)
            unlike = len(set(map(slot, said))) == len(said)
        types = said[0].types or next((clause.types for clause in said if clause.types), _NONE)
        if component_type in types and len(types) > 1 and unlike and (not suspects or suspects.isdisjoint(said)):
            found.append(Streamed(IRI(subject[1:-1]), types, tuple(said), origin))
            said.clear()
        elif types and any(component_type in clause.types for clause in said):
            found.append((IRI(subject[1:-1]), said))
            unusual = True
        else:
            origin.things[subject] = said
    if not unusual:
        return [one for one in found if isinstance(one, Advertisement)], []
    return _judged(found, origin)


def _judged(
    found: Iterable[Advertisement | tuple[IRI, list[Clause]]], origin: Origin
) -> tuple[list[Advertisement], list[Malformed]]:
    """The same advertisements, after the careful reader has looked at those about which something is unusual."""
    good: list[Advertisement] = []
    bad: list[Malformed] = []
    for one in found:
        if isinstance(one, Advertisement):
            good.append(one)
            continue
        component, said = one
        ((_, profile, problems),) = advertisements.profiles(origin.document(component, said))
        if profile is None or problems:
            bad.append(Malformed(component, origin.place, problems))
        else:
            good.append(Judged(profile, tuple(said), origin))
    return good, bad
