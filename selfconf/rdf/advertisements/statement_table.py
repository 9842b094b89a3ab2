"""Statements: a predicate with its objects, as text, kept once however many components make the statement.

A *statement* is here one line of what Oxigraph writes about a subject: one predicate with all of its objects, so one
triple or several. Equal texts make equal statements, so all that follows from a statement alone is worked out once.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from operator import attrgetter

from selfconf.model.profile import Ports, Profile
from selfconf.model.term import IRI, Term
from selfconf.rdf import turtle
from selfconf.rdf.advertisements import reader as advertisements
from selfconf.rdf.advertisements.advertisement import LANGUAGES, RDF_PROPERTY, allowed
from selfconf.rdf.advertisements.recognition import SUBJECT, port_of, ported, property_of, setting_of
from selfconf.rdf.permitted_fields import LINKS, NEXT, OF_PORTS_ALONE, STRUCTURE
from selfconf.rdf.vocabulary import SC, TYPE

END = " .\n"
"""What Oxigraph writes after the last statement about a subject."""
_NAME = attrgetter("name")
_KIND = IRI("urn:selfconf:kind")
_NOTHING = Profile(SUBJECT)
_NO_TYPES: frozenset[IRI] = frozenset()
_BEYOND = f"<{SC.Component}>"
"""What a blank node may not say if it is to be inlined: that it is a component itself."""
_STRUCTURE = {f"<{predicate}>" for predicate in STRUCTURE if predicate != TYPE} | {"a"}
_SILENT = {f"<{predicate}>" for predicate in OF_PORTS_ALONE}
_LINK = {f"<{predicate}>" for predicate in LINKS}
_LINKS = re.compile(r"<[^<>]*>(?: , <[^<>]*>)*")
_GOOD_TYPE = f"<(?!{'|'.join(map(re.escape, (*LANGUAGES, RDF_PROPERTY, turtle.SKOLEM)))})[^<> ]*>"
_GOOD_TYPES = re.compile(f"a {_GOOD_TYPE}(?: , {_GOOD_TYPE})*")
"""A statement of types of which an advertisement may give each."""


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
        self.part: Profile | Ports | None = None
        """What it adds to a profile, once that is known; most add ports alone."""
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
        simple = property_of(self.text)
        if simple is not None:
            return (simple,)
        part = self.read()
        return () if isinstance(part, Ports) else part.properties

    def read(self) -> Profile | Ports:
        """What it adds to a profile."""
        if self.part is None:
            port = port_of(self.predicate, self.text)
            self.part = ported(self.predicate, port) if port else self.carefully()[0]
        return self.part

    def carefully(self) -> tuple[Profile, bool]:
        """What it adds to a profile by the careful reader, and whether that finds a problem in it."""
        text = f"<{SUBJECT}> a <{SC.Component}> , <{_KIND}>{NEXT}{self.text}{END}"
        ((_, profile, problems),) = advertisements.profiles(turtle.parse(text, ""))
        return profile or Profile(SUBJECT), bool(problems)


def bracketed(predicate: str, said: Iterable[str]) -> str:
    """The text of a statement whose object is a blank node that says something."""
    return f"{predicate} [ {NEXT.join(said)} ]"


def links(predicate: str, text: str) -> Sequence[str]:
    """The names of ports, or of a grounding, to which a statement links, if it does nothing else."""
    said = text[len(predicate) + 1 :]
    return list(dict.fromkeys(said.split(" , "))) if predicate in _LINK and _LINKS.fullmatch(said) else ()


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
        self._typed: dict[tuple[Statement, ...], Statement | None] = {}
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
                self._allowed[predicate] = allowed(IRI.unchecked(predicate[1:-1]), SUBJECT)
            if not self._allowed[predicate]:
                self.suspects.add(statement)
        return statement

    def typed(self, said: list[Statement]) -> None:
        """Make one statement of all that give types to a subject, unless one of them has brackets."""
        kinds = [statement for statement in said if statement.slot is TYPE]
        if len(kinds) < 2:
            return
        key = tuple(kinds)
        if key not in self._typed:
            texts = [statement.text for statement in dict.fromkeys(kinds)]
            in_brackets = any(statement.bracketed for statement in kinds)
            self._typed[key] = None if in_brackets else self["a " + " , ".join(text[len("a ") :] for text in texts)]
        whole = self._typed[key]
        if whole is not None:
            place = said.index(kinds[0])
            said[place:] = [whole, *[statement for statement in said[place:] if statement.slot is not TYPE]]

    def _types(self, statement: WrittenStatement) -> None:
        text = statement.text
        if not _GOOD_TYPES.fullmatch(text):
            types = set(turtle.parse(f"<{SUBJECT}> {text}{END}", "").values(SUBJECT, TYPE))
            good = frozenset([type_ for type_ in types if isinstance(type_, IRI) and allowed(TYPE, type_)])
            if len(good) < len(types):
                self.suspects.add(statement)
        else:
            good = frozenset(map(IRI.unchecked, text[len("a <") : -1].split("> , <")))
        statement.slot, statement.part, statement.types = TYPE, _NOTHING, good

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
            part, faulty = setting_of(predicate, statement.text), False
            if part is None:
                part, faulty = statement.carefully()
            statement.part = part
            names = [*map(_NAME, part.inputs), *map(_NAME, part.outputs), *map(_NAME, part.parameters)]
            if faulty or len(names) > 1:
                self.suspects.add(statement)
        statement.slot = self.slot(predicate, *names)

    def slot(self, predicate: str, *names: str) -> object:
        """What only one statement of a component can have; compared by identity, which is quicker."""
        return self._slots.setdefault((predicate, *names), object())
