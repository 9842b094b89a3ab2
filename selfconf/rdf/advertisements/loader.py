"""Advertisements by the hundred thousand: from the bytes of a document to profiles, without a store in between.

A component is its IRI and a tuple of statements that it shares with others (`statements`). Its profile and its triples
are made from them when they are asked for, which for a component that no role wants is never. A document that cannot be
inlined is read by the careful reader (`reader.read_document`) instead, and so is each component about which anything is
unusual: the careful reader is the authority on what conforms, and on how to say what does not.

A port may have a name of its own, and be described elsewhere. What is said of it there says as much of the port as if
it stood in brackets, so that is how it is read: `sc:hasInput :in` as `sc:hasInput [ sc:name "in" ; ... ]`, which most
components have in common. In the triples it keeps its name.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection, Container, Iterable, Mapping
from hashlib import blake2s
from operator import attrgetter
from typing import Any

from selfconf.model.profile import Input, OperationalParameter, Output, Place, Ports, Profile, shared_ports
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.model.wording import is_one_line
from selfconf.rdf import turtle
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.advertisements.advertisement import Advertisement, MalformedAdvertisement, about, property_order
from selfconf.rdf.advertisements.segments import SegmentCache, inlined_document
from selfconf.rdf.advertisements.statement_table import (
    END,
    NotInlinableError,
    Statement,
    StatementTable,
    bracketed,
)
from selfconf.rdf.permitted_fields import LINKS, NEXT, OF_COMPONENT, SETTINGS, SHAPE_LINKS
from selfconf.rdf.turtle import SKOLEM, Document, Node, Triple
from selfconf.rdf.vocabulary import SC, TYPE

Keyed = tuple[tuple[str, tuple[int, str, str, str]], tuple[IRI, Term]]
_NAME, _PREDICATE = attrgetter("name"), attrgetter("predicate")
_SETTINGS = {f"<{predicate}>": setting.member for predicate, setting in SETTINGS.items()}
_GROUNDING = f"<{SC.grounding}>"
_LINKS = LINKS | SHAPE_LINKS
_FIELDS = {f"<{predicate}>" for predicate in OF_COMPONENT}
_NONE: frozenset[IRI] = frozenset()


class LoadedAdvertisement(Advertisement):
    """An advertisement as statements, of which profile and triples are made when they are asked for."""

    __slots__ = ("_origin", "_profile", "_statements")

    def __init__(
        self, component: IRI, types: frozenset[IRI], statements: tuple[Statement, ...], origin: Origin
    ) -> None:
        self.component, self.types, self._statements, self._origin = component, types, statements, origin
        self._profile: Profile | None = None

    @property
    def statements(self) -> tuple[Statement, ...]:
        """What its profile is made of; nothing where only the careful reader could make it."""
        return self._statements

    @property
    def profile(self) -> Profile:
        """What it says, as a value."""
        if self._profile is None:
            self._profile = _merged(self.component, self.types, self._statements, self._origin.place)
        return self._profile

    @property
    def triples(self) -> tuple[Triple, ...]:
        """What it says, in RDF; made anew, with blank nodes of its own, each time."""
        return self._origin.triples(self.component, self._statements)

    @property
    def place(self) -> Place:
        """Where it is written: only the document is known."""
        return self._origin.place

    @property
    def self_contained(self) -> bool:
        """Whether its document says nothing of things with names of their own that are no components."""
        return not self._origin.things

    @property
    def breadth(self) -> int:
        """A bound on how many values it gives of one property: a comma in a string counts as well."""
        counts = Counter[str]()
        for statement in self._statements:
            counts[statement.predicate] += 1 + statement.text.count(" , ")
        return max(counts.values(), default=0)

    def __eq__(self, other: object) -> bool:
        if isinstance(other, LoadedAdvertisement) and self._origin is other._origin:
            return self.component == other.component
        return super().__eq__(other)

    __hash__ = Advertisement.__hash__


class LinkedAdvertisement(LoadedAdvertisement):
    """A streamed advertisement with ports that have names of their own, read as if they stood in brackets."""

    __slots__ = ("_said",)

    def __init__(
        self,
        component: IRI,
        types: frozenset[IRI],
        statements: tuple[Statement, ...],
        origin: Origin,
        said: tuple[Statement, ...],
    ) -> None:
        super().__init__(component, types, statements, origin)
        self._said = said

    @property
    def triples(self) -> tuple[Triple, ...]:
        """What it says, in RDF, with the names of its ports."""
        return self._origin.triples(self.component, self._said)


class CheckedAdvertisement(LoadedAdvertisement):
    """A streamed advertisement about which something was unusual, with the profile that the careful reader made."""

    __slots__ = ()

    def __init__(self, profile: Profile, statements: tuple[Statement, ...], origin: Origin) -> None:
        super().__init__(profile.component, profile.types, statements, origin)
        self._profile = profile

    @property
    def statements(self) -> tuple[Statement, ...]:
        """Nothing: its profile is all that counts."""
        return ()


def _merged(component: IRI, types: frozenset[IRI], statements: tuple[Statement, ...], place: Place) -> Profile:
    """The profile of a component about which nothing is unusual."""
    properties: list[Keyed] = []
    inputs: list[Input] = []
    outputs: list[Output] = []
    parameters: list[OperationalParameter] = []
    settings: dict[str, Any] = {}
    for statement in statements:
        if statement.slot is statement:
            properties += statement.keyed or _keyed(statement, component)
            continue
        part = statement.part or statement.read()
        inputs += part.inputs
        outputs += part.outputs
        if isinstance(part, Ports):
            continue
        if part.parameters:
            parameters += part.parameters
        elif statement.predicate in _SETTINGS:
            member = _SETTINGS[statement.predicate]
            settings[member] = getattr(part, member)
        elif statement.predicate == _GROUNDING:
            settings["command"], settings["inside"] = part.command, part.inside
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
        place=place,
        **settings,
    )


def _keyed(statement: Statement, component: IRI) -> list[Keyed]:
    """The properties that a statement gives, each behind what they are ordered by; remembered if all may share them."""
    pairs = statement.properties
    own = [(p, _own(v, component) if isinstance(v, BlankNode) and statement.bracketed else v) for p, v in pairs]
    keyed = [(property_order(pair), pair) for pair in own]
    if not statement.bracketed:
        statement.keyed = keyed
    return keyed


def _own(value: BlankNode, component: IRI) -> BlankNode:
    """A blank node of a statement that several components share, made the component's own."""
    return BlankNode(f"{value}.{blake2s(component.encode(), digest_size=8).hexdigest()}")


class Origin:
    """The document that advertisements came from: its name, and what it says about things that are no components."""

    def __init__(self, source: str) -> None:
        self.place = Place(source)
        self.things: dict[str, list[Statement]] = {}
        self._linked: dict[tuple[object, ...], Statement] = {}
        self._parsed: dict[str, Mapping[Node, list[tuple[IRI, Term]]]] = {}

    def linked(self, said: Iterable[Statement], known: StatementTable) -> tuple[Statement, ...] | None:
        """What a component says, with what things it links to say of themselves; None if only the reader finds it."""
        found: list[Statement] = []
        for statement in said:
            names = statement.links if statement in known.suspects else ()
            if not names:
                found.append(statement)
            for name in names:
                if name not in self.things:
                    return None
                key = (statement.predicate, *self.things[name])
                if key not in self._linked:
                    text = bracketed(statement.predicate, [part.text for part in self.things[name]])
                    try:
                        self._linked[key] = known[text]
                    except NotInlinableError:
                        return None
                found.append(self._linked[key])
        return tuple(found)

    def document(
        self, component: str, statements: Iterable[Statement], links: Container[IRI] | None = None
    ) -> Document:
        """What is said about one component, and about the things that can be reached from it, by some links or all."""
        document = turtle.parse(_written(component, statements), self.place.source)
        waiting = list(document.statements.values())
        while waiting:
            for predicate, value in waiting.pop():
                if predicate == TYPE or isinstance(value, Literal) or value in document.statements:
                    continue
                if links is None or predicate in links:
                    thing = self._thing(turtle.named(value))
                    document.statements.update(thing)
                    waiting += thing.values()
        return document

    def _thing(self, name: str) -> Mapping[Node, list[tuple[IRI, Term]]]:
        """What is said about a thing, each time with the same blank nodes."""
        if name not in self.things:
            return {}
        if name not in self._parsed:
            self._parsed[name] = turtle.parse(_written(name, self.things[name]), self.place.source).statements
        return self._parsed[name]

    def triples(self, component: IRI, statements: Iterable[Statement]) -> tuple[Triple, ...]:
        """The statements that the advertisement of a component makes."""
        return tuple(about(self.document(f"<{component}>", statements), component, frozenset()))


def _written(subject: str, statements: Iterable[Statement]) -> str:
    return f"{subject} {NEXT.join(statement.text for statement in statements)}{END}"


# complexity: the loop over all components; calls in it would cost a tenth of the load
def read_advertisements(
    text: bytes, source: str, base: str | None = None, segments: SegmentCache | None = None
) -> tuple[list[Advertisement], list[MalformedAdvertisement]]:
    """Every advertisement of a document, in the order of the text, and those that do not conform.

    What the careful reader finds, in less time and memory; documents may share their segments.

    Raises TurtleError.
    """
    turtle.check_turtle_1_1(text, source)
    segments = SegmentCache() if segments is None else segments
    subjects = inlined_document(text, source, base, segments)
    if subjects is None:
        return advertisements.read_document(turtle.parse(text, source, base))
    del text  # as large as what is made of it
    origin = Origin(source)
    found: list[Advertisement | tuple[str, list[Statement]]] = []
    undeclared: list[MalformedAdvertisement] = []
    suspects, slot, component_type = segments.suspects, attrgetter("slot"), SC.Component
    blank = f"<{SKOLEM}"
    unusual = False
    for subject, said in subjects.items():
        unlike = len(set(map(slot, said))) == len(said)
        if not unlike:
            segments.typed(said)
            unlike = len(set(map(slot, said))) == len(said)
        types = said[0].types or next((statement.types for statement in said if statement.types), _NONE)
        if (
            component_type in types
            and len(types) > 1
            and unlike
            and (not suspects or suspects.isdisjoint(said))
            and not subject.startswith(blank)
            and (subject.isascii() or is_one_line(subject))
        ):
            found.append(LoadedAdvertisement(IRI.unchecked(subject[1:-1]), types, tuple(said), origin))
            said.clear()
        elif types and any(component_type in statement.types for statement in said):
            found.append((subject, said))
            unusual = True
        else:
            origin.things[subject] = said
            if not _FIELDS.isdisjoint(map(_PREDICATE, said)) and not any(SC.Template in one.types for one in said):
                node = turtle.resource(subject[1:-1])
                undeclared.append(MalformedAdvertisement(node, origin.place, advertisements.UNDECLARED))
    if not unusual:
        return [one for one in found if isinstance(one, Advertisement)], undeclared
    good, bad = _judged(found, origin, segments)
    return good, bad + undeclared


def _judged(
    found: Iterable[Advertisement | tuple[str, list[Statement]]], origin: Origin, known: StatementTable
) -> tuple[list[Advertisement], list[MalformedAdvertisement]]:
    """All advertisements, with the careful reader's verdict on those about which something is unusual."""
    good: list[Advertisement] = []
    bad: list[MalformedAdvertisement] = []
    for one in found:
        if isinstance(one, Advertisement):
            good.append(one)
            continue
        subject, said = one
        statements = origin.linked(said, known)
        if statements is not None and _plain(subject, statements, known):
            types = next(statement.types for statement in statements if statement.types)
            good.append(LinkedAdvertisement(IRI.unchecked(subject[1:-1]), types, statements, origin, tuple(said)))
            continue
        ((component, profile, problems),) = advertisements.profiles(origin.document(subject, said, _LINKS))
        if profile is None or problems:
            bad.append(MalformedAdvertisement(component, origin.place, problems))
        else:
            good.append(CheckedAdvertisement(profile, tuple(said), origin))
    return good, bad


def _plain(subject: str, statements: Collection[Statement], known: StatementTable) -> bool:
    """Whether nothing is unusual about what a component says."""
    types = [statement.types for statement in statements if statement.slot is TYPE]
    return (
        not subject.startswith(f"<{SKOLEM}")
        and is_one_line(subject)
        and len(types) == 1
        and len(types[0]) > 1
        and len({statement.slot for statement in statements}) == len(statements)
        and known.suspects.isdisjoint(statements)
    )
