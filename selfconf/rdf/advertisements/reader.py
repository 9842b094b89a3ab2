"""Advertisements: from triples to the profile of each component, and what an advertisement may say.

A document may hold several components. The advertisement of one is every statement that can be reached from it,
through blank nodes and through named things that are not themselves components (a place, a robot), but not through
its types: what a class means is for ontologies to say. An advertisement therefore speaks for its own component
alone, and statements that would change what shapes or classes mean are left out of it, whoever serves it.

`shapes/advertisement.ttl` is the authority on which advertisements conform. Reading builds the profile and notices
on its way everything that the shape forbids; a test holds the two verdicts together.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from decimal import Decimal, InvalidOperation

from selfconf.model.profile import NO_PREFERENCE, Input, OperationalParameter, Output, Place, Profile, shared_ports
from selfconf.model.term import IRI, STRING, BlankNode, Literal, Term, sort_key
from selfconf.rdf.turtle import Document, Node, Triple
from selfconf.rdf.vocabulary import OWL, RDF, RDFS, SC, SH, TYPE, UNIT, XSD

NUMBERS = frozenset(
    XSD[name]
    for name in (
        "integer", "decimal", "double", "float", "int", "long", "short", "byte", "nonNegativeInteger",
        "positiveInteger", "nonPositiveInteger", "negativeInteger", "unsignedInt", "unsignedLong", "unsignedShort",
        "unsignedByte",
    )
)  # fmt: skip
STRUCTURE = frozenset(
    (TYPE, SC.hasInput, SC.hasOutput, SC.hasParameter, SC.preference, SC.grounding, SC.name, SC.signalType)
)
AXIOMS = frozenset((RDFS.subClassOf, RDFS.subPropertyOf, RDFS.domain, RDFS.range))


class Advertisement(ABC):
    """What is said about one component, as a profile and as triples.

    Advertisements are equal if they say the same; blank nodes of different documents never are the same.
    """

    __slots__ = ("component", "types")
    component: IRI
    """Whom it advertises."""
    types: frozenset[IRI]
    """The types of the component."""

    @property
    @abstractmethod
    def profile(self) -> Profile:
        """What it says, as a value."""

    @property
    @abstractmethod
    def triples(self) -> tuple[Triple, ...]:
        """What it says, in RDF."""

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Advertisement):
            return NotImplemented
        return self is other or (self.profile == other.profile and self.triples == other.triples)

    def __hash__(self) -> int:
        return hash(self.component)

    def __repr__(self) -> str:
        return f"<advertisement of {self.component}>"


class ParsedAdvertisement(Advertisement):
    """An advertisement that has been read in full."""

    __slots__ = ("_profile", "_triples")

    def __init__(self, profile: Profile, triples: tuple[Triple, ...]) -> None:
        self.component, self.types = profile.component, profile.types
        self._profile, self._triples = profile, triples

    @property
    def profile(self) -> Profile:
        """What it says, as a value."""
        return self._profile

    @property
    def triples(self) -> tuple[Triple, ...]:
        """What it says, in RDF."""
        return self._triples


@dataclass(frozen=True, slots=True)
class MalformedAdvertisement:
    """An advertisement that does not conform, and why: one sentence for each problem."""

    component: IRI | BlankNode
    place: Place
    problems: tuple[str, ...]


def read(document: Document) -> tuple[list[Advertisement], list[MalformedAdvertisement]]:
    """Every advertisement of a document, in the order of the text, and those that do not conform."""
    good: list[Advertisement] = []
    bad: list[MalformedAdvertisement] = []
    others = frozenset(document.instances(SC.Component))
    for component, profile, problems in profiles(document):
        if problems or profile is None:
            bad.append(MalformedAdvertisement(component, Place(document.source), problems))
        else:
            good.append(ParsedAdvertisement(profile, tuple(about(document, component, others))))
    return good, bad


def profiles(document: Document) -> Iterator[tuple[Node, Profile | None, tuple[str, ...]]]:
    """Every component of a document with as much of a profile as can be read, and what is wrong with it."""
    for component in document.instances(SC.Component):
        reader = _Reader(document, component)
        profile = reader.profile()
        yield component, profile, tuple(reader.problems)


def about(document: Document, component: Node, components: frozenset[Node]) -> Iterator[Triple]:
    """The statements that the advertisement of a component makes."""
    waiting: list[Node] = [component]
    seen: set[Term] = {component}
    while waiting:
        subject = waiting.pop()
        for predicate, value in document.statements.get(subject, ()):
            if not allowed(predicate, value):
                continue
            yield subject, predicate, value
            if predicate == TYPE or isinstance(value, Literal) or value in seen or value in components:
                continue
            seen.add(value)
            waiting.append(value)


def allowed(predicate: IRI, value: Term) -> bool:
    """Whether an advertisement may say so: no axioms, no shapes, no ontology terms of its own making."""
    if predicate in AXIOMS or predicate in OWL or predicate in SH:
        return False
    return predicate != TYPE or not (value in OWL or value in SH or value in RDFS or value == RDF.Property)


def property_order(pair: tuple[IRI, Term]) -> tuple[str, tuple[int, str, str, str]]:
    """The order of the properties of a profile: by predicate, then by value."""
    return pair[0], sort_key(pair[1])


class _Reader:
    """Reads one component and notes every problem instead of stopping at the first."""

    def __init__(self, document: Document, component: Node) -> None:
        self.document, self.component = document, component
        self.problems: list[str] = []

    def profile(self) -> Profile | None:
        if not isinstance(self.component, IRI):
            self.problems.append("a component needs an IRI, so that others can speak of it")
            return None
        statements = self.document.statements[self.component]
        types = frozenset(o for p, o in statements if p == TYPE and isinstance(o, IRI) and allowed(p, o))
        if any(p == TYPE and not isinstance(o, IRI) for p, o in statements):
            self.problems.append("the type of a component is an IRI")
        if len({o for p, o in statements if p == TYPE}) < 2:
            self.problems.append("a component needs a type of its own besides sc:Component")
        inputs = []
        for name, signal, node in self._ports(SC.hasInput, SC.signalType):
            inputs.append(Input(name, signal))
            if self.document.values(node, SC.rate):
                self._problem(f"only an output promises a sc:rate, and {name!r} is an input")
        outputs = [
            Output(name, signal, self._rate(node, name))
            for name, signal, node in self._ports(SC.hasOutput, SC.signalType)
        ]
        parameters = [
            OperationalParameter(name, kind) for name, kind, _ in self._ports(SC.hasParameter, SC.parameterType)
        ]
        return Profile(
            component=self.component,
            types=types,
            properties=tuple(
                sorted({(p, o) for p, o in statements if p not in STRUCTURE and allowed(p, o)}, key=property_order)
            ),
            ports=shared_ports(
                tuple(sorted(inputs, key=lambda port: port.name)),
                tuple(sorted(outputs, key=lambda port: port.name)),
            ),
            parameters=tuple(sorted(parameters, key=lambda parameter: parameter.name)),
            preference=self._preference(),
            command=self._command(),
            place=Place(self.document.source),
        )

    def _ports(self, link: IRI, kind: IRI) -> Iterator[tuple[str, IRI, Term]]:
        """Name and type of each port or parameter; a problem for each that lacks one or doubles a name."""
        names: set[str] = set()
        for node in self.document.values(self.component, link):
            name = self._one(node, SC.name, f"{_word(link)} needs exactly one sc:name, a string that is not empty")
            type_ = self._one(node, kind, f"{_word(link)} needs exactly one {_word(kind)}, an IRI")
            if not isinstance(name, Literal) or name.datatype != STRING or not name.lexical:
                self._problem(f"{_word(link)} needs exactly one sc:name, a string that is not empty")
            elif not isinstance(type_, IRI):
                self._problem(f"{_word(link)} {name.lexical!r} needs exactly one {_word(kind)}, an IRI")
            else:
                if name.lexical in names:
                    self._problem(f"the name {name.lexical!r} stands for two values of {_word(link)}")
                names.add(name.lexical)
                yield name.lexical, type_, node

    def _one(self, node: Term, predicate: IRI, problem: str) -> Term | None:
        values = self.document.values(node, predicate)
        if len(values) > 1:
            self._problem(problem)
        return values[0] if len(values) == 1 else None

    def _problem(self, problem: str) -> None:
        if problem not in self.problems:
            self.problems.append(problem)

    def _preference(self) -> Decimal:
        values = self.document.values(self.component, SC.preference)
        if not values:
            return NO_PREFERENCE
        number = _number(values[0])
        if len(values) > 1 or number is None:
            self._problem("sc:preference is one number, if it is there at all")
            return NO_PREFERENCE
        try:
            return Decimal(str(values[0]))  # as it is written, so that of two the higher is the higher
        except InvalidOperation:
            return Decimal(number)  # the exponent is beyond all bounds

    def _rate(self, port: Term, name: str) -> float | None:
        rates = self.document.values(port, SC.rate)
        if not rates:
            return None
        value = self._one(rates[0], SC.value, "") if len(rates) == 1 else None
        unit = self._one(rates[0], SC.unit, "") if len(rates) == 1 else None
        number = _number(value) if value is not None else None
        if number is None or number <= 0 or unit != UNIT.HZ:
            self._problem(f"the sc:rate of output {name!r} is [ sc:value NUMBER ; sc:unit unit:HZ ], above zero")
            return None
        return number

    def _command(self) -> str | None:
        groundings = self.document.values(self.component, SC.grounding)
        if not groundings:
            return None
        commands = self.document.values(groundings[0], SC.command)
        if len(groundings) > 1 or isinstance(groundings[0], Literal) or len(commands) > 1:
            self._problem('a component has at most one sc:grounding, such as [ sc:command "..." ]')
        elif commands:
            command = commands[0]
            if isinstance(command, Literal) and command.datatype == STRING and command.lexical.strip():
                return command.lexical
            self._problem("sc:command is a string that is not blank, without a language")
        return None


def _number(value: Term) -> float | None:
    if not isinstance(value, Literal) or value.datatype not in NUMBERS:
        return None
    try:
        number = float(value.lexical)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def _word(term: IRI) -> str:
    return f"sc:{term.short}"
