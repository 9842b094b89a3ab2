"""Statements: a predicate with its objects, as text, kept once however many components make the statement.

A *statement* is here one line of what Oxigraph writes about a subject: one predicate with all of its objects, so one
triple or several. Equal texts make equal statements, so all that follows from a statement alone is worked out once.
"""

from __future__ import annotations

import math
import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from decimal import Decimal
from operator import attrgetter
from typing import NamedTuple

from selfconf.model.profile import Input, OperationalParameter, Output, Ports, Profile
from selfconf.model.term import IRI, STRING, Literal, Term
from selfconf.rdf import turtle
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.advertisements.advertisement import allowed
from selfconf.rdf.advertisements.fields import COMPONENT, GROUNDING, LINKS, NEXT, PORT_NAME, PORTS, STRUCTURE, Field
from selfconf.rdf.vocabulary import RDF, SC, TYPE, XSD

END = " .\n"
"""What Oxigraph writes after the last statement about a subject."""
_NAME = attrgetter("name")
_SUBJECT = IRI("urn:selfconf:component")
_KIND = IRI("urn:selfconf:kind")
_NOTHING = Profile(_SUBJECT)
_NO_TYPES: frozenset[IRI] = frozenset()
_BEYOND = f"<{SC.Component}>"
"""What a blank node may not say if it is to be inlined: that it is a component itself."""
_STRUCTURE = {f"<{predicate}>" for predicate in STRUCTURE if predicate != TYPE} | {"a"}
_SILENT = {f"<{predicate}>" for predicate in STRUCTURE - COMPONENT.predicates}
"""What says nothing of a component itself."""
_SIMPLE = re.compile(
    r"<(?P<predicate>[^<>]*)> (?:"
    r"<(?P<iri>[^<>]*)>"
    r'|"(?P<lexical>[^"\\]*)"(?:\^\^<(?P<datatype>[^<>]*)>|@(?P<language>[A-Za-z0-9]+(?:-[A-Za-z0-9]+)*))?'
    r"|(?P<integer>[+-]?[0-9]+)"
    r"|(?P<decimal>[+-]?[0-9]*\.[0-9]+)"
    r")"
)
_LINK = {f"<{predicate}>" for predicate in LINKS}
_LINKS = re.compile(r"<[^<>]*>(?: , <[^<>]*>)*")
_KINDS = r"a <[^<>]*>(?: , <[^<>]*>)*"
_VALUE = r'(?:<[^<>]*>|"[^"\\]*"(?:\^\^<[^<>]*>|@[A-Za-z0-9]+(?:-[A-Za-z0-9]+)*)?|[+-]?[0-9]+|[+-]?[0-9]*\.[0-9]+)'


class _PortPattern(NamedTuple):
    """What is recognised of the ports, or operational parameters, that one predicate links to."""

    once: tuple[str, ...]
    """How the fields begin in Turtle that have exactly one value."""
    bounded: tuple[tuple[str, int, float], ...]
    """How the other fields begin, and how often they may be there."""
    pattern: re.Pattern[str]
    groups: tuple[int, int, int]
    """Which groups of the pattern are the name, the type, and the number of the rate."""

    @classmethod
    def of(cls, link: Field) -> _PortPattern:
        """The pattern from the table."""
        fields = link.into.fields
        allowed = [field.turtle for field in fields if field.most != 0]
        if not any(field.into.fields for field in fields if field.most != 0):
            allowed.append(f"(?P<{SC.value.short}>(?!))")  # there is no rate: a group that matches nothing
        statement = f"(?:{_KINDS}|{'|'.join(allowed)}|<[^<>]*> {_VALUE})"
        pattern = re.compile(rf"<{link.predicate}> \[ (?:{statement}(?:{NEXT}| (?=\])))+\]")
        (kind,) = (field.predicate for field in fields if field.least and field is not PORT_NAME)
        name, type_, rate = (pattern.groupindex[predicate.short] for predicate in (SC.name, kind, SC.value))
        return cls(
            tuple([f"<{f.predicate}> " for f in fields if (f.least, f.most) == (1, 1)]),
            tuple(
                [
                    (f"<{f.predicate}> ", f.least, math.inf if f.most is None else f.most)
                    for f in fields
                    if (f.least, f.most) != (1, 1)
                ]
            ),
            pattern,
            (name, type_, rate),
        )


_RATED = f"<{SC.rate}> "
_PORTS = {f"<{link.predicate}>": _PortPattern.of(link) for link in PORTS}
_PREFERENCE = re.compile(COMPONENT[SC.preference].turtle)
_COMMAND = re.compile(rf"<{SC.grounding}> \[ (?:{_KINDS}{NEXT})?{GROUNDING[SC.command].turtle} \]")
_TYPES = re.compile("a <[^<> ]*>(?: , <[^<> ]*>)*")


class Statement(ABC):
    """A predicate with its objects, as Turtle: what one or many components say."""

    __slots__ = ("bracketed", "keyed", "part", "predicate", "slot")
    types: frozenset[IRI] = frozenset()
    """The types that it gives."""

    def __init__(self, predicate: str, bracketed: bool) -> None:
        self.predicate = predicate
        """Its predicate, in angle brackets, or `a`."""
        self.bracketed = bracketed
        """Whether its object is a blank node of its own."""
        self.part: Profile | None = None
        """What it adds to a profile, once that is known."""
        self.keyed: Sequence[tuple[tuple[str, tuple[int, str, str, str]], tuple[IRI, Term]]] = ()
        """Its properties behind what properties are ordered by, once that is known."""
        self.slot: object = self
        """What a component can have only one of: a port of that name, a preference."""

    @property
    @abstractmethod
    def text(self) -> str:
        """All of it."""

    @property
    def links(self) -> Sequence[str]:
        """The names of ports, or of a grounding, that are described elsewhere."""
        return links(self.predicate, self.text)

    @property
    def properties(self) -> tuple[tuple[IRI, Term], ...]:
        """The properties that it states."""
        simple = _property(self.text)
        return self.read().properties if simple is None else (simple,)

    def read(self) -> Profile:
        """What it adds to a profile."""
        if self.part is None:
            port = port_of(self.predicate, self.text)
            self.part = _ported(self.predicate, *port) if port else self.carefully()[0]
        return self.part

    def carefully(self) -> tuple[Profile, bool]:
        """What it adds to a profile by the careful reader, and whether that finds a problem in it."""
        text = f"<{_SUBJECT}> a <{SC.Component}> , <{_KIND}>{NEXT}{self.text}{END}"
        ((_, profile, problems),) = advertisements.profiles(turtle.parse(text, ""))
        return profile or Profile(_SUBJECT), bool(problems)


def bracketed(predicate: str, said: Iterable[str]) -> str:
    """The text of a statement whose object is a blank node that says something."""
    return f"{predicate} [ {NEXT.join(said)} ]"


def links(predicate: str, text: str) -> Sequence[str]:
    """The names of ports, or of a grounding, to which a statement links, if it does nothing else."""
    said = text[len(predicate) + 1 :]
    return list(dict.fromkeys(said.split(" , "))) if predicate in _LINK and _LINKS.fullmatch(said) else ()


def port_of(link: str, text: str) -> tuple[str, str, str | None] | None:
    """Name, type and number of the rate of the port in a statement, if it has one port in order and of a common form.

    Each field has to be there as often as the table says, and its value has to be recognised. To count the predicates
    in the text is enough: one in a string or in brackets would count too, and the statement would be read carefully.
    """
    known = _PORTS.get(link)
    if known is None:
        return None
    once, bounded, pattern, groups = known
    for mark in once:
        if text.count(mark) != 1:
            return None
    for mark, least, most in bounded:
        if not least <= text.count(mark) <= most:
            return None
    found = pattern.fullmatch(text)
    if found is None:
        return None
    name, type_, rate = found.group(*groups)
    return None if name is None or type_ is None or (rate is None and _RATED in text) else (name, type_, rate)


def _ported(link: str, name: str, kind: str, rate: str | None) -> Profile:
    """The part of a statement with one port."""
    type_ = IRI(kind)
    if link == f"<{SC.hasInput}>":
        return Profile(_SUBJECT, ports=Ports(inputs=(Input(name, type_),)))
    if link == f"<{SC.hasOutput}>":
        return Profile(_SUBJECT, ports=Ports(outputs=(Output(name, type_, None if rate is None else float(rate)),)))
    return Profile(_SUBJECT, parameters=(OperationalParameter(name, type_),))


def setting_of(text: str) -> Profile | None:
    """The part of a statement with a preference or a command, in order and of a common form."""
    command = _COMMAND.fullmatch(text)
    if command is not None:
        return Profile(_SUBJECT, command=command["command"])
    preference = _PREFERENCE.fullmatch(text)
    return None if preference is None else Profile(_SUBJECT, preference=Decimal(preference["preference"]))


def _property(text: str) -> tuple[IRI, Term] | None:
    """The property that a statement with one object of a common form states."""
    found = _SIMPLE.fullmatch(text)
    if found is None:
        return None
    predicate, iri, lexical, datatype, language, integer, decimal = found.groups()
    value: Term
    if iri is not None:
        value = turtle.resource(iri)
    elif lexical is None:
        value = Literal(integer, XSD.integer) if integer else Literal(decimal, XSD.decimal)
    elif language:
        value = Literal(lexical, RDF.langString, language)
    else:
        value = Literal(lexical, IRI(datatype) if datatype else STRING)
    return IRI(predicate), value


class WrittenStatement(Statement):
    """A statement as it was written."""

    __slots__ = ("text", "types")
    text: str

    def __init__(self, predicate: str, text: str) -> None:
        super().__init__(predicate, text.endswith(("]", ")")))
        self.text, self.types = text, _NO_TYPES


class NotInlinableError(Exception):
    """Something that only the careful reader can read."""


class StatementTable(dict[str, Statement]):
    """Every statement of one or more documents by its text, made when it is first met."""

    def __init__(self) -> None:
        self.suspects: set[Statement] = set()
        """Statements that only the careful reader can judge."""
        self._slots: dict[object, object] = {}
        self._predicates: dict[str, str] = {}
        self._allowed: dict[str, bool] = {}

    def __missing__(self, text: str) -> Statement:
        predicate, _, said = text.partition(" ")
        if said[0] in "[(" and _BEYOND in said:
            raise NotInlinableError
        statement = self[text] = WrittenStatement(self._predicates.setdefault(predicate, predicate), text)
        if predicate == "a":
            self._types(statement)
        elif predicate in _STRUCTURE:
            self._structure(statement, predicate)
        else:
            if predicate not in self._allowed:
                self._allowed[predicate] = allowed(IRI(predicate[1:-1]), _SUBJECT)
            if not self._allowed[predicate]:
                self.suspects.add(statement)
        return statement

    def typed(self, said: list[Statement]) -> None:
        """Make one statement of all that give types to a subject, unless one of them has brackets."""
        kinds = [statement for statement in said if statement.slot is TYPE]
        if len(kinds) > 1 and not any("[" in statement.text for statement in kinds):
            said[said.index(kinds[0])] = self["a " + " , ".join(statement.text[len("a ") :] for statement in kinds)]
            said[:] = [statement for statement in said if statement not in kinds]

    def _types(self, statement: WrittenStatement) -> None:
        if _TYPES.fullmatch(statement.text) and turtle.SKOLEM not in statement.text:
            types: set[Term] = {IRI(type_) for type_ in statement.text[len("a <") : -1].split("> , <")}
        else:
            types = set(turtle.parse(f"<{_SUBJECT}> {statement.text}{END}", "").values(_SUBJECT, TYPE))
        statement.slot, statement.part = TYPE, _NOTHING
        statement.types = frozenset([type_ for type_ in types if isinstance(type_, IRI) and allowed(TYPE, type_)])
        if len(statement.types) < len(types):
            self.suspects.add(statement)

    def _structure(self, statement: Statement, predicate: str) -> None:
        port = port_of(predicate, statement.text)
        if port is None and statement.links:
            self.suspects.add(statement)
            return
        names: list[str] = []
        if port is not None:
            names = [port[0]]
        elif predicate in _SILENT:
            statement.part = _NOTHING
        else:
            statement.part, faulty = setting_of(statement.text), False
            if statement.part is None:
                statement.part, faulty = statement.carefully()
            part = statement.part
            names = [*map(_NAME, part.inputs), *map(_NAME, part.outputs), *map(_NAME, part.parameters)]
            if faulty or len(names) > 1:
                self.suspects.add(statement)
        statement.slot = self.slot(predicate, *names)

    def slot(self, predicate: str, *names: str) -> object:
        """What only one statement of a component can have; compared by identity, which is quicker."""
        return self._slots.setdefault((predicate, *names), object())
