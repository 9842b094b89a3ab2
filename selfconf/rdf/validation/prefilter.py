"""A first look at a file, as fast as Oxigraph reads it: is it Turtle, and could anything be wrong with it?

Most files of an ecology are right, and saying so must not cost what finding the place of an error costs.
The first look clears an advertisement only if every statement in it is one that the shapes are known to
allow, and leaves all else to `judging`. So it may suspect a good file, which costs time, but it clears no
bad one; that is a property test.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field
from typing import NamedTuple

import pyoxigraph as ox

from selfconf.model.term import STRING
from selfconf.rdf.vocabulary import OWL, RDF, RDFS, SC, SH, TYPE, UNIT, XSD

MOST_PROBLEMS = 100
"""After so many syntax errors a file is taken for something else than Turtle."""

_NUMBER: dict[str, re.Pattern[str]] = {
    XSD.integer: re.compile(r"[+-]?\d+"),
    XSD.decimal: re.compile(r"[+-]?\d+(\.\d+)?"),
    XSD.double: re.compile(r"[+-]?\d+(\.\d+)?([eE][+-]?\d+)?"),
    XSD.float: re.compile(r"[+-]?\d+(\.\d+)?([eE][+-]?\d+)?"),
}
_PREFIX = re.compile(rb"(?i:@?\bprefix)\s+([^\s:]*):\s*<([^>\s]*)>")
_OWN = frozenset((SC.hasInput, SC.hasOutput, SC.hasParameter, SC.preference, SC.grounding))
"""What only a component has."""
_PART_TERMS = frozenset((SC.name, SC.signalType, SC.parameterType, SC.rate, SC.value, SC.unit, SC.command))
_PARTS = frozenset((SC.Input, SC.Output, SC.OperationalParameter, SC.Grounding))
_PLAIN = frozenset((RDFS.label, RDFS.comment, RDFS.seeAlso, RDFS.isDefinedBy))
_SCHEMA = frozenset((OWL.Class, OWL.ObjectProperty, OWL.DatatypeProperty, RDFS.Class, RDF.Property))
_PLACING = frozenset((RDFS.subClassOf, OWL.equivalentClass, RDFS.subPropertyOf, OWL.equivalentProperty))
"""What gives its subject a place in a hierarchy."""
TERM_POSITIONS = frozenset(
    (TYPE, SC.signalType, SC.parameterType, RDFS.subClassOf, RDFS.subPropertyOf, RDFS.domain, RDFS.range)
) | {SH[name] for name in ("class", "path", "datatype", "nodeKind", "targetClass", "inversePath")}
"""Where an object is a term of some vocabulary, not a thing in the world."""


class Lexical(NamedTuple):
    """A literal as it is written."""

    form: str
    datatype: str
    language: str | None


FileTerm = str | Lexical
"""An IRI, a blank node (which starts with `_:`), or a literal."""
Properties = dict[str, dict[FileTerm, None]]
"""The values of each property of one subject, each once, in the order of the text."""
Statements = dict[str, Properties]


@dataclass(frozen=True, slots=True)
class SyntaxProblem:
    """A place where a file is not Turtle; line and column count from one, columns in characters."""

    line: int
    column: int
    width: int
    message: str


@dataclass(slots=True)
class Prefiltered:
    """What the first look tells about a file."""

    problems: list[SyntaxProblem] = field(default_factory=list)
    clear: bool = True
    """Whether every shape is certain to hold."""
    relevant: bool = False
    """Whether the file speaks of anything that is validated."""
    components: list[str] = field(default_factory=list)
    used: set[str] = field(default_factory=set)
    """The terms of vocabularies that the file uses: predicates, classes, signal types, datatypes."""
    signals: set[str] = field(default_factory=set)
    """The signal types of ports."""
    literal_of: set[str] = field(default_factory=set)
    """The predicates that have a literal as an object."""
    subjects: set[str] = field(default_factory=set)
    """What the file says something of."""
    terms: set[str] = field(default_factory=set)
    """The classes and properties that the file declares."""
    object_properties: set[str] = field(default_factory=set)
    placed: set[str] = field(default_factory=set)
    """What the file gives a place in a hierarchy, which it may have declared or not."""
    above: set[tuple[str, str]] = field(default_factory=set)
    """Each class that the file places, with the one right above it; equal ones are above each other."""
    prefixes: set[tuple[str, str]] = field(default_factory=set)


def prefilter(octets: bytes, base: str | None = None) -> Prefiltered:
    """Look at a Turtle text in UTF-8 without a byte order mark."""
    found = Prefiltered(prefixes={(match[1].decode(), match[2].decode()) for match in _PREFIX.finditer(octets)})
    statements = _read(octets, base, found)
    for subject, properties in statements.items():
        _note(found, subject, properties)
    advertisements = _Advertisements(statements)
    found.clear = (
        found.clear
        and all(_harmless(properties) and advertisements.rated(properties) for properties in statements.values())
        and all(advertisements.clear(component) for component in found.components)
    )
    return found


def _read(octets: bytes, base: str | None, found: Prefiltered) -> Statements:
    """The statements of a text; what is no Turtle is noted, and reading goes on after it."""
    statements: Statements = {}
    reader = ox.parse(octets, format=ox.RdfFormat.TURTLE, base_iri=base)
    while len(found.problems) < MOST_PROBLEMS:
        try:
            for quad in reader:
                subject, value = quad.subject, quad.object
                if isinstance(subject, ox.Triple) or isinstance(value, ox.Triple):
                    found.clear = False  # RDF 1.2; who reads Turtle 1.1 will say where
                    continue
                key = subject.value if isinstance(subject, ox.NamedNode) else f"_:{subject.value}"
                term: FileTerm
                if isinstance(value, ox.NamedNode):
                    term = value.value
                elif isinstance(value, ox.Literal):
                    term = Lexical(value.value, value.datatype.value, value.language)
                else:
                    term = f"_:{value.value}"
                statements.setdefault(key, {}).setdefault(quad.predicate.value, {})[term] = None
            break
        except SyntaxError as error:
            found.clear = False
            found.problems.append(_problem(error))
    return statements


def _problem(error: SyntaxError) -> SyntaxProblem:
    line, column = error.lineno or 1, error.offset or 1
    width = (error.end_offset or 0) - column if error.end_lineno == line else 1
    head, _, tail = error.msg.partition(": ")
    return SyntaxProblem(line, column, max(width, 1), tail if head.startswith("Parser error") else error.msg)


def _note(found: Prefiltered, subject: str, properties: Properties) -> None:
    """Note which terms a subject uses, and whether it declares one."""
    for predicate, values in properties.items():
        found.used.add(predicate)
        for value in values:
            if isinstance(value, Lexical):
                found.literal_of.add(predicate)
                found.used.add(value.datatype)
            elif predicate in TERM_POSITIONS or value in SC or value in SH:
                found.used.add(value)
    if subject[:2] != "_:":
        found.subjects.add(subject)
    types = properties.get(TYPE, {})
    if not _PLACING.isdisjoint(properties):
        found.placed.add(subject)
        found.above.update(
            pair
            for predicate in (RDFS.subClassOf, OWL.equivalentClass)
            for value in properties.get(predicate, ())
            if isinstance(value, str)
            for pair in ((subject, value), *([(value, subject)] if predicate == OWL.equivalentClass else ()))
        )
    if not _SCHEMA.isdisjoint(types):
        found.terms.add(subject)
        if OWL.ObjectProperty in types:
            found.object_properties.add(subject)
    if SC.Component in types:
        found.components.append(subject)
    found.signals.update(value for value in properties.get(SC.signalType, ()) if isinstance(value, str))
    found.relevant = found.relevant or any(_validated(term) for term in (*properties, *types))


def _validated(term: FileTerm) -> bool:
    """Whether a predicate or type is one of those that validation looks at."""
    return term in SC or term in SH or term in OWL or (term in RDFS and term not in _PLAIN) or term in _SCHEMA


def _harmless(properties: Properties) -> bool:
    """Whether a subject is at most a component or a part of one, and says nothing else that a shape sees."""
    component = SC.Component in properties.get(TYPE, ())
    for predicate, values in properties.items():
        if predicate == TYPE:
            if not all(isinstance(kind, str) and _harmless_type(kind) for kind in values):
                return False
        elif predicate in _OWN:
            if not component:
                return False
        elif predicate in SC:
            if predicate not in _PART_TERMS:
                return False
        elif predicate in SH or predicate in OWL or (predicate in RDFS and predicate not in _PLAIN):
            return False
    return True


def _harmless_type(kind: str) -> bool:
    if kind in SC:
        return kind == SC.Component or kind in _PARTS
    return not (kind in SH or kind in OWL or kind in RDFS or kind in RDF)


@dataclass(frozen=True, slots=True)
class _Advertisements:
    """The shapes of an advertisement over again, for files that are right."""

    statements: Statements

    def clear(self, component: str) -> bool:
        """Whether a component certainly conforms, but for the rates of its outputs."""
        properties = self.statements[component]
        types = properties[TYPE]
        preferences = properties.get(SC.preference, {})
        return (
            component[:2] != "_:"
            and len(types) > 1
            and all(isinstance(kind, str) and kind[:2] != "_:" for kind in types)
            and len(preferences) < 2
            and all(_number(value) is not None for value in preferences)
            and self._named(properties, SC.hasInput, SC.signalType)
            and self._named(properties, SC.hasOutput, SC.signalType)
            and self._named(properties, SC.hasParameter, SC.parameterType)
            and not any(SC.rate in self._of(port) for port in properties.get(SC.hasInput, ()))
            and self._grounded(properties.get(SC.grounding, {}))
        )

    def _of(self, node: FileTerm) -> Properties:
        return self.statements.get(node, {}) if isinstance(node, str) else {}

    def _named(self, properties: Properties, link: str, kind: str) -> bool:
        """Whether each port or parameter has one name, which no other has, and one type."""
        names: set[str] = set()
        nodes = properties.get(link, {})
        for node in nodes:
            name, type_ = _only(self._of(node), SC.name), _only(self._of(node), kind)
            if not (_text(name) and isinstance(type_, str) and type_[:2] != "_:"):
                return False
            names.add(str(name))
        return len(names) == len(nodes)

    def rated(self, properties: Properties) -> bool:
        """Whether something keeps to the shape of a rate, if it has one."""
        if SC.rate not in properties:
            return True
        rate = self._of(_only(properties, SC.rate) or "")
        return (_number(_only(rate, SC.value)) or 0) > 0 and _only(rate, SC.unit) == UNIT.HZ

    def _grounded(self, groundings: dict[FileTerm, None]) -> bool:
        if len(groundings) > 1 or any(isinstance(node, Lexical) for node in groundings):
            return False
        described = [self._of(node) for node in groundings]
        commands = [_only(node, SC.command) for node in described if SC.command in node]
        return all(isinstance(text, Lexical) and _text(text) and text.form.strip() for text in commands)


def _only(properties: Properties, predicate: str) -> FileTerm | None:
    """The value of a property, if it has exactly one."""
    values = properties.get(predicate, {})
    return next(iter(values)) if len(values) == 1 else None


def _text(value: FileTerm | None) -> bool:
    return isinstance(value, Lexical) and value.datatype == STRING and bool(value.form)


def _number(value: FileTerm | None) -> float | None:
    pattern = _NUMBER.get(value.datatype) if isinstance(value, Lexical) else None
    if pattern is None or not isinstance(value, Lexical) or not pattern.fullmatch(value.form):
        return None
    number = float(value.form)
    return number if math.isfinite(number) else None
