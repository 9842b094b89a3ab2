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

from selfconf.model.profile import Input, OperationalParameter, Output, Ports, Profile
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
_NOTHING = Profile(_SPOKEN_FOR)
_BEYOND = re.compile(f"<({SC.Component}|{FIRST}|{REST})>")
"""What a blank node may not say if it is to be folded: that it is a component itself, or a cell of a list."""
_STRUCTURE = {f"<{predicate}>" for predicate in STRUCTURE if predicate != TYPE} | {"a"}
_GROUNDING = f"<{SC.grounding}>"
_SIMPLE = re.compile(
    r"<(?P<predicate>[^<>]*)> (?:"
    r"<(?P<iri>[^<>]*)>"
    r'|"(?P<lexical>[^"\\]*)"(?:\^\^<(?P<datatype>[^<>]*)>|@(?P<language>[A-Za-z0-9]+(?:-[A-Za-z0-9]+)*))?'
    r"|(?P<integer>[+-]?[0-9]+)"
    r"|(?P<decimal>[+-]?[0-9]*\.[0-9]+)"
    r")"
)
_PORT = re.compile(
    rf"<{SC.base}(?P<link>hasInput|hasOutput|(?P<set>hasParameter))> \["
    rf" (?:a <{SC.base}(?:Input|Output|OperationalParameter)>{NEXT})?"
    rf'<{SC.name}> "(?P<name>[^"\\]+)"{NEXT}<{SC.base}(?(set)parameterType|signalType)> <(?P<type>[^<>]*)> \]'
)
_TYPES = re.compile("a <[^<> ]*>(?: , <[^<> ]*>)*")


class Clause:
    """A predicate with its objects, as Turtle: what one or many components say."""

    __slots__ = ("bracketed", "keyed", "part", "predicate", "slot", "text", "types")

    def __init__(self, predicate: str, text: str) -> None:
        self.predicate, self.text = predicate, text
        self.bracketed = text.endswith("]")
        """Whether its object is a blank node."""
        self.part: Profile | None = None
        """What it adds to a profile, once that is known."""
        self.keyed: list[tuple[tuple[str, tuple[int, str, str, str]], tuple[IRI, Term]]] = []
        """Its properties behind what properties are ordered by, once that is known."""
        self.types: frozenset[IRI] = frozenset()
        """The types that it gives."""
        self.slot: object = self
        """What a component can have only one of: a port of that name, a preference."""

    @property
    def properties(self) -> tuple[tuple[IRI, Term], ...]:
        """The properties that it states."""
        simple = _property(self.text)
        return self.read().properties if simple is None else (simple,)

    def read(self) -> Profile:
        """What it adds to a profile."""
        if self.part is None:
            port = _PORT.fullmatch(self.text)
            self.part = _port(port) if port else self.carefully()[0]
        return self.part

    def carefully(self) -> tuple[Profile, bool]:
        """The same by the careful reader, and whether it finds fault with it."""
        text = f"<{_SPOKEN_FOR}> a <{SC.Component}> , <{_KIND}>{NEXT}{self.text}{END}"
        ((_, profile, problems),) = advertisements.profiles(turtle.parse(text, ""))
        return profile or Profile(_SPOKEN_FOR), bool(problems)


def _port(found: re.Match[str]) -> Profile:
    """The part of a clause with one port, or one operational parameter, that says nothing but name and type."""
    name, type_ = found["name"], IRI(found["type"])
    if found["link"] == "hasInput":
        return Profile(_SPOKEN_FOR, ports=Ports(inputs=(Input(name, type_),)))
    if found["link"] == "hasOutput":
        return Profile(_SPOKEN_FOR, ports=Ports(outputs=(Output(name, type_),)))
    return Profile(_SPOKEN_FOR, parameters=(OperationalParameter(name, type_),))


def _property(text: str) -> tuple[IRI, Term] | None:
    """The property that a clause with one object of a common form states."""
    found = _SIMPLE.fullmatch(text)
    if found is None:
        return None
    predicate, iri, lexical, datatype, language, integer, decimal = found.groups()
    value: Term
    if iri is not None:
        value = IRI(iri)
    elif lexical is None:
        value = Literal(integer, XSD.integer) if integer else Literal(decimal, XSD.decimal)
    elif language:
        value = Literal(lexical, RDF.langString, language)
    else:
        value = Literal(lexical, IRI(datatype) if datatype else STRING)
    return IRI(predicate), value


class BeyondFoldingError(Exception):
    """Something that only the careful reader can read."""


class Clauses(dict[str, Clause]):
    """Every clause of one or more documents by its text, made when it is first met."""

    def __init__(self) -> None:
        self.suspects: set[Clause] = set()
        """Clauses about which only the careful reader can tell."""
        self._slots: dict[object, object] = {}
        self._predicates: dict[str, str] = {}
        self._allowed: dict[str, bool] = {}

    def __missing__(self, text: str) -> Clause:
        predicate, _, said = text.partition(" ")
        if said.startswith("[") and _BEYOND.search(said):
            raise BeyondFoldingError
        clause = self[text] = Clause(self._predicates.setdefault(predicate, predicate), text)
        if predicate == "a":
            self._types(clause)
        elif predicate in _STRUCTURE:
            self._structure(clause, predicate)
        else:
            if predicate not in self._allowed:
                self._allowed[predicate] = allowed(IRI(predicate[1:-1]), _SPOKEN_FOR)
            if not self._allowed[predicate]:
                self.suspects.add(clause)
        return clause

    def typed(self, said: list[Clause]) -> None:
        """Make one clause of all that give types to a subject, unless one of them has brackets."""
        kinds = [clause for clause in said if clause.slot is TYPE]
        if len(kinds) > 1 and not any("[" in clause.text for clause in kinds):
            said[said.index(kinds[0])] = self["a " + " , ".join(clause.text[len("a ") :] for clause in kinds)]
            said[:] = [clause for clause in said if clause not in kinds]

    def _types(self, clause: Clause) -> None:
        if _TYPES.fullmatch(clause.text):
            types: set[Term] = {IRI(type_) for type_ in clause.text[len("a <") : -1].split("> , <")}
        else:
            types = set(turtle.parse(f"<{_SPOKEN_FOR}> {clause.text}{END}", "").values(_SPOKEN_FOR, TYPE))
        clause.slot, clause.part = TYPE, _NOTHING
        clause.types = frozenset([type_ for type_ in types if isinstance(type_, IRI) and allowed(TYPE, type_)])
        if len(clause.types) < len(types):
            self.suspects.add(clause)

    def _structure(self, clause: Clause, predicate: str) -> None:
        port = _PORT.fullmatch(clause.text)
        if port is not None:
            names = [port["name"]]
        else:
            clause.part, faulty = clause.carefully()
            part = clause.part
            names = [*map(_NAME, part.inputs), *map(_NAME, part.outputs), *map(_NAME, part.parameters)]
            elsewhere = predicate == _GROUNDING and not clause.bracketed  # what it says is said of a thing with a name
            if faulty or elsewhere or len(names) > 1:
                self.suspects.add(clause)
        clause.slot = self._slots.setdefault((predicate, *names), object())  # compared by identity: quicker


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
