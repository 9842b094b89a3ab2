"""Turtle as clauses: a predicate with its objects, as text, kept once however many components say it.

Making an object of every triple costs more than parsing it. So Oxigraph's parser is connected to Oxigraph's own
serialiser, a few hundred triples at a time, and what comes out is text of one form only: a line for each predicate of
a subject. Such a line with its objects is a *clause* here. Equal text means equal statements, so all that follows
from a clause alone is worked out once.

Blank nodes become part of the clause that leads to them: `sc:hasInput [ sc:name "pose" ; ... ]`, as their author
wrote them. That is sound where every blank node of a document is written in brackets, so that exactly one statement
leads to it. A document that gives labels to blank nodes, has lists, or leaves any blank node over, is not folded.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from itertools import islice
from operator import attrgetter

import pyoxigraph as ox

from selfconf.model.profile import Input, OperationalParameter, Output, Profile
from selfconf.model.term import IRI, STRING, Literal, Term
from selfconf.rdf import advertisements, turtle
from selfconf.rdf.advertisements import STRUCTURE, allowed
from selfconf.rdf.vocabulary import FIRST, RDF, REST, SC, TYPE, XSD

CHUNK = 512
"""Triples per piece of text: the text of so many stays in the processor's cache."""
END, NEXT = " .\n", " ;\n\t"
"""What Oxigraph writes after the last clause of a subject, and between two; no term has a line break in it."""
_NAME = attrgetter("name")
_SPOKEN_FOR = IRI("urn:selfconf:component")
_KIND = IRI("urn:selfconf:kind")
_BEYOND = re.compile(f"<({SC.Component}|{FIRST}|{REST})>")
"""What a blank node may not say if it is to be folded: that it is a component itself, or a cell of a list."""
_STRUCTURE = {f"<{predicate}>" for predicate in STRUCTURE if predicate != TYPE} | {"a"}
_SIMPLE = re.compile(
    r"<(?P<predicate>[^<>]*)> (?:"
    r"<(?P<iri>[^<>]*)>"
    r'|"(?P<lexical>[^"\\]*)"(?:\^\^<(?P<datatype>[^<>]*)>|@(?P<language>[A-Za-z0-9]+(?:-[A-Za-z0-9]+)*))?'
    r"|(?P<integer>[+-]?[0-9]+)"
    r"|(?P<decimal>[+-]?[0-9]*\.[0-9]+)"
    r")"
)
_PORT = re.compile(
    rf"<{SC.base}(?P<link>hasInput|hasOutput|hasParameter)> \["
    rf" (?:a <{SC.base}(?:Input|Output|OperationalParameter)>{NEXT})?"
    rf'<{SC.name}> "(?P<name>[^"\\]+)"{NEXT}<{SC.base}(?P<kind>signalType|parameterType)> <(?P<type>[^<>]*)> \]'
)


class Clause:
    """A predicate with its objects, as Turtle: what one or many components say."""

    __slots__ = ("part", "slot", "text", "types")

    def __init__(self, text: str) -> None:
        self.text = text
        self.part: Profile | None = None
        """What it adds to a profile, once that is known."""
        self.types: frozenset[IRI] = frozenset()
        """The types that it gives."""
        self.slot: object = self
        """What a component can have only one of: a port of that name, a preference."""

    def read(self) -> Profile:
        """What it adds to a profile."""
        if self.part is None:
            self.part = _property(self.text) or self.carefully()[0]
        return self.part

    def carefully(self) -> tuple[Profile, bool]:
        """The same by the careful reader, and whether it finds fault with it."""
        text = f"<{_SPOKEN_FOR}> a <{SC.Component}> , <{_KIND}>{NEXT}{self.text}{END}"
        ((_, profile, problems),) = advertisements.profiles(turtle.parse(text, ""))
        return profile or Profile(_SPOKEN_FOR), bool(problems)


def _port(text: str) -> Profile | None:
    """The part of a clause with one port, or one operational parameter, that says nothing but name and type."""
    found = _PORT.fullmatch(text)
    if found is None or (found["link"] == "hasParameter") != (found["kind"] == "parameterType"):
        return None
    name, type_ = found["name"], IRI(found["type"])
    if found["link"] == "hasInput":
        return Profile(_SPOKEN_FOR, inputs=(Input(name, type_),))
    if found["link"] == "hasOutput":
        return Profile(_SPOKEN_FOR, outputs=(Output(name, type_),))
    return Profile(_SPOKEN_FOR, parameters=(OperationalParameter(name, type_),))


def _property(text: str) -> Profile | None:
    """The part of a clause with one object of a common form."""
    found = _SIMPLE.fullmatch(text)
    if found is None:
        return None
    value: Term
    if found["iri"] is not None:
        value = IRI(found["iri"])
    elif found["lexical"] is None:
        value = Literal(found["integer"] or found["decimal"], XSD.integer if found["integer"] else XSD.decimal)
    elif found["language"]:
        value = Literal(found["lexical"], RDF.langString, found["language"])
    else:
        value = Literal(found["lexical"], IRI(found["datatype"]) if found["datatype"] else STRING)
    return Profile(_SPOKEN_FOR, properties=((IRI(found["predicate"]), value),))


class BeyondFoldingError(Exception):
    """Something that only the careful reader can read."""


class Clauses(dict[str, Clause]):
    """Every clause of one or more documents by its text, made when it is first met."""

    def __init__(self) -> None:
        self.suspects: set[Clause] = set()
        """Clauses about which only the careful reader can tell."""

    def __missing__(self, text: str) -> Clause:
        predicate, _, said = text.partition(" ")
        if said.startswith("[") and _BEYOND.search(said):
            raise BeyondFoldingError
        clause = self[text] = Clause(text)
        if predicate in _STRUCTURE:
            self._structure(clause, predicate)
        elif not allowed(IRI(predicate[1:-1]), _SPOKEN_FOR):
            self.suspects.add(clause)
        return clause

    def _structure(self, clause: Clause, predicate: str) -> None:
        if predicate == "a":
            types = turtle.parse(f"<{_SPOKEN_FOR}> {clause.text}{END}", "").values(_SPOKEN_FOR, TYPE)
            clause.slot, clause.part = TYPE, Profile(_SPOKEN_FOR)
            clause.types = frozenset(type_ for type_ in types if isinstance(type_, IRI) and allowed(TYPE, type_))
            faulty = len(clause.types) != len(types)
        else:
            clause.part, faulty = _port(clause.text), False
            if clause.part is None:
                clause.part, faulty = clause.carefully()
            part = clause.part
            names = [*map(_NAME, part.inputs), *map(_NAME, part.outputs), *map(_NAME, part.parameters)]
            clause.slot = (predicate, *names)
            faulty = faulty or len(names) > 1
        if faulty:
            self.suspects.add(clause)


def fold(text: bytes, source: str, base: str | None, clauses: Clauses) -> dict[str, list[Clause]] | None:
    """What a document says of each named subject, blank nodes folded into the clauses that lead to them.

    None where that cannot be done: labelled blank nodes, lists, blank nodes that nobody leads to, or that are
    components. Raises TurtleError.
    """
    if b"_:" in text:
        return None
    triples = ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri=base)
    subjects: dict[str, list[Clause]] = {}
    nodes: dict[str, str] = {}
    known, take = clauses.get, nodes.pop
    said: list[Clause] = []
    add, last = said.append, ""
    predicate = node = content = ""
    try:
        # Every microsecond in this loop is one twentieth of what an advertisement costs.
        while piece := ox.serialize(islice(triples, CHUNK), format=ox.RdfFormat.TURTLE):
            for lines in piece[: -len(END)].decode().split(END):
                subject, _, rest = lines.partition(" ")
                if subject != last:
                    if subject[0] == "_":
                        if "_:" in rest:
                            rest = NEXT.join([_folded(line, take) for line in rest.split(NEXT)])
                        if subject == node:  # a string at the end of the brackets comes after them
                            content = f"{content}{NEXT}{rest}" if content else rest
                            line = f"{predicate} [ {content} ]"
                            said[-1] = known(line) or clauses[line]
                        else:
                            nodes[subject] = f"{nodes[subject]}{NEXT}{rest}" if subject in nodes else rest
                        continue
                    last = subject
                    said = subjects[subject] if subject in subjects else subjects.setdefault(subject, [])
                    add = said.append
                for line in rest.split(NEXT):
                    clause = known(line)
                    if clause is None:
                        if "_:" in line:
                            predicate, _, node = line.partition(" ")
                            content = take(node, "")
                            if not content and " " in node:
                                return None  # several objects in one line
                            line = f"{predicate} [ {content} ]"
                            clause = known(line)
                        if clause is None:
                            clause = clauses[line]
                    add(clause)
    except SyntaxError as error:
        raise turtle.not_turtle(error, source) from None
    except BeyondFoldingError:
        return None
    return None if nodes else subjects


def _folded(line: str, take: Callable[[str], str]) -> str:
    """A clause of a blank node, with what its own blank node says in brackets."""
    if "_:" not in line:
        return line
    predicate, _, node = line.partition(" ")
    try:
        return f"{predicate} [ {take(node)} ]"
    except KeyError:
        raise BeyondFoldingError from None
