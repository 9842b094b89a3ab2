"""The prefilter: a file read as fast as Oxigraph can, to see whether it is Turtle, and whether all is certainly right.

Most files of an ecology are right, and saying so must not cost what finding the place of an error costs.
The prefilter clears an advertisement only if every statement in it is one that the shapes are known to
allow, and leaves all else to `file_check`. So it may leave a good file uncleared, which costs time, but it clears no
bad one; that is a property test.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import pyoxigraph as ox

from selfconf.model.immutable import immutable
from selfconf.model.term import IRI
from selfconf.model.unit_dimension import meant_unit
from selfconf.model.wording import is_one_line
from selfconf.rdf.permitted_fields import COMPONENT, LINKED, OF_COMPONENT, SAID_BY, Field, Subject, foreign_terms
from selfconf.rdf.vocabulary import OWL, RDF, RDFS, ROB, SC, SH, TYPE, UNIT, XSD

MOST_PROBLEMS = 100
"""After so many syntax errors a file is taken for something else than Turtle."""

_PREFIX = re.compile(rb"(?i:@?\bprefix)\s+([^\s:]*):\s*<([^>\s]*)>")
_SUBJECTS = tuple(COMPONENT.walk())
_RATE = COMPONENT[SC.hasOutput].into[SC.rate]
_TYPED = frozenset((SC.signalType, SC.parameterType))
"""What a port or an operational parameter has."""
_LINKS = (SC.hasInput, SC.hasOutput, SC.hasParameter)
"""How a component has them."""
_FIELDS = frozenset((ROB.field, ROB.fieldName, ROB.datatype, ROB.repeated, ROB.optional))
"""What is said of kinds of signals and their fields."""
_PART_TERMS = frozenset().union(*(subject.predicates for subject in _SUBJECTS)) - OF_COMPONENT - {TYPE, *SAID_BY}
_PARTS = frozenset(subject.type for subject in _SUBJECTS if subject.type is not None) - {SC.Component}
_MISPLACED = {link: foreign_terms(subject) for link, subject in LINKED.items()}
_MISPLACED_AT_COMPONENT = foreign_terms(COMPONENT)
_PLAIN = frozenset((RDFS.label, RDFS.comment, RDFS.seeAlso, RDFS.isDefinedBy))
_CLASSES = frozenset((OWL.Class, RDFS.Class))
_PROPERTIES = frozenset((OWL.ObjectProperty, OWL.DatatypeProperty, RDF.Property))
_SCHEMA = _CLASSES | _PROPERTIES
_STRINGS = frozenset((XSD.string, RDF.langString))
_EQUIVALENCES = (OWL.equivalentClass, OWL.equivalentProperty)
_PLACING = frozenset((RDFS.subClassOf, RDFS.subPropertyOf, *_EQUIVALENCES))
"""What gives its subject a place in a hierarchy."""
_PARTS_OF_TEMPLATE = frozenset((SC.Role, SC.Parameter))
_REFERRING = (SC.template, SC.component, SC.recruited, SC["from"], SC.to)
"""How tasks and configurations name their templates and components."""
TERM_POSITIONS = (
    frozenset((TYPE, SC.signalType, SC.parameterType, SC.request, SC.response, SC.property, ROB.datatype))
    | {RDFS[name] for name in ("subClassOf", "subPropertyOf", "domain", "range")}
    | {OWL[name] for name in ("equivalentClass", "equivalentProperty", "disjointWith", "inverseOf", "onProperty")}
    | {OWL[name] for name in ("onClass", "someValuesFrom", "allValuesFrom")}
    | {SH[name] for name in ("class", "datatype", "nodeKind", "targetClass", "equals", "disjoint", "lessThan")}
    | {SH[name] for name in ("lessThanOrEquals", "path", "inversePath", "zeroOrMorePath", "oneOrMorePath")}
    | {SH[name] for name in ("zeroOrOnePath", "targetSubjectsOf", "targetObjectsOf")}
)
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
TemplateDescription = Counter[tuple[FileTerm, str, FileTerm]]
"""What is said of a thing and of its parts: subject, predicate and object of each statement, and how often."""


@immutable
class SyntaxProblem:
    """A place where a file is not Turtle; line and column count from one, columns in characters."""

    line: int
    column: int
    width: int
    message: str


@dataclass(slots=True)
class Prefiltered:
    """What the prefilter tells about a file."""

    problems: list[SyntaxProblem] = field(default_factory=list)
    too_large: bool = False
    """Whether the file has a token that is larger than Oxigraph's buffer, so that it cannot be read."""
    clear: bool = True
    """Whether every shape is certain to hold."""
    size: int = 0
    """How many statements the file makes."""
    relevant: bool = False
    """Whether the file speaks of anything that is validated."""
    components: list[str] = field(default_factory=list)
    templates: dict[str, TemplateDescription] = field(default_factory=dict)
    answers: bool = False
    """Whether the file has a configuration."""
    referred: set[str] = field(default_factory=set)
    """What is named as a template or a component of a task or a configuration, and other things."""
    used: set[str] = field(default_factory=set)
    """The terms of vocabularies that the file uses: predicates, classes, signal types, datatypes."""
    signals: set[str] = field(default_factory=set)
    """The signal types of ports."""
    component_types: set[str] = field(default_factory=set)
    """The types of components."""
    port_types: set[str] = field(default_factory=set)
    """The signal types of ports, and what operations take and answer."""
    literals: set[tuple[str, str, str]] = field(default_factory=set)
    """The literals by predicate, datatype and text; of strings, which are many and all of one kind, without text."""
    subjects: set[str] = field(default_factory=set)
    """What the file says something of."""
    terms: set[str] = field(default_factory=set)
    """The classes and properties that the file declares."""
    classes: set[str] = field(default_factory=set)
    """The classes among them."""
    properties: set[str] = field(default_factory=set)
    """The properties among them; one IRI may be both."""
    object_properties: set[str] = field(default_factory=set)
    ranges: set[tuple[str, str]] = field(default_factory=set)
    """The properties of others that the file declares to have literals, each with the datatype of these."""
    placed: set[str] = field(default_factory=set)
    """What the file gives a place in a hierarchy, which it may have declared or not."""
    above: set[tuple[str, str]] = field(default_factory=set)
    """Each class or property that the file places, with the one right above it; equal ones are above each other."""
    equal: set[tuple[str, str]] = field(default_factory=set)
    """The pairs of `above` that the file says are equal."""
    prefixes: set[tuple[str, str]] = field(default_factory=set)


def prefilter(octets: bytes, base: str | None = None, syntax: ox.RdfFormat = ox.RdfFormat.TURTLE) -> Prefiltered:
    """Look at a text in UTF-8 without a byte order mark: Turtle, or of an ontology another format."""
    found = Prefiltered(prefixes={(match[1].decode(), match[2].decode()) for match in _PREFIX.finditer(octets)})
    statements = _read(octets, base, syntax, found)
    for subject, properties in statements.items():
        _note(found, subject, properties)
    found.templates = {one: _description(statements, one) for one in found.templates}
    advertisements = _Advertisements(statements)
    found.clear = (
        found.clear
        and SC.template not in found.used  # a composite has that or a command
        and SC.accepts not in found.used  # a shape that says nothing is none
        and all(_harmless(said) and advertisements.rated(said) for said in statements.values())
        and all(is_one_line(component) and advertisements.clear(component) for component in found.components)
        and _owned(statements)
        and _of_one_unit(statements)
    )
    return found


def _read(octets: bytes, base: str | None, syntax: ox.RdfFormat, found: Prefiltered) -> Statements:
    """The statements of a text; what is no Turtle is noted, and reading goes on after it."""
    statements: Statements = {}
    reader = ox.parse(octets, format=syntax, base_iri=base)
    while len(found.problems) < MOST_PROBLEMS:
        try:
            for quad in reader:
                subject, value = quad.subject, quad.object
                if isinstance(subject, ox.Triple) or isinstance(value, ox.Triple):
                    found.clear = False  # RDF 1.2; the parser of Turtle 1.1 will say where
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
        except MemoryError:
            found.clear, found.too_large = False, True
            break
    return statements


def _problem(error: SyntaxError) -> SyntaxProblem:
    line, column = error.lineno or 1, error.offset or 1
    width = (error.end_offset or 0) - column if error.end_lineno == line else 1
    head, _, tail = error.msg.partition(": ")
    return SyntaxProblem(line, column, max(width, 1), tail if head.startswith("Parser error") else error.msg)


# complexity: a few branches for each of the things to note, in one pass over the statements
def _note(found: Prefiltered, subject: str, properties: Properties) -> None:
    """Note which terms a subject uses, and whether it declares one."""
    for predicate, values in properties.items():
        found.used.add(predicate)
        found.size += len(values)
        if len(values) > 1 and _of_two_numbers(values):
            found.clear = False
        for value in values:
            if isinstance(value, Lexical):
                found.literals.add((predicate, value.datatype, "" if value.datatype in _STRINGS else value.form))
                found.used.add(value.datatype)
            elif predicate in TERM_POSITIONS or value in SC or value in SH:
                found.used.add(value)
    if subject[:2] != "_:":
        found.subjects.add(subject)
    types = properties.get(TYPE, {})
    if not _PLACING.isdisjoint(properties):
        found.placed.add(subject)
        equal = set(_equal(subject, properties))
        found.equal |= equal
        found.above |= equal.union(_below(subject, properties))
    if not _SCHEMA.isdisjoint(types):
        found.terms.add(subject)
        if not _CLASSES.isdisjoint(types):
            found.classes.add(subject)
        if not _PROPERTIES.isdisjoint(types):
            found.properties.add(subject)
        if OWL.ObjectProperty in types:
            found.object_properties.add(subject)
        if OWL.DatatypeProperty in types and subject not in SC and subject not in _FIELDS:
            found.ranges.update((subject, kind) for kind in properties.get(RDFS.range, ()) if isinstance(kind, str))
    if SC.Component in types:
        found.components.append(subject)
        found.component_types.update(kind for kind in types if isinstance(kind, str))
    if SC.Template in types:
        found.templates[subject] = Counter()
    found.answers = found.answers or SC.Configuration in types
    for predicate in _REFERRING:
        found.referred.update(value for value in properties.get(predicate, ()) if isinstance(value, str))
    for predicate in (SC.signalType, SC.request, SC.response):
        found.port_types.update(value for value in properties.get(predicate, ()) if isinstance(value, str))
    signals = properties.get(SC.signalType, ())
    found.signals.update(value for value in signals if isinstance(value, str) and value[:2] != "_:")
    found.relevant = found.relevant or any(_validated(term) for term in (*properties, *types))


def _description(statements: Statements, template: str) -> TemplateDescription:
    """What is said of a template, its roles and its parameters, but for labels; blank nodes are all alike in it."""
    found: TemplateDescription = Counter()
    seen, waiting = {template}, [template]
    while waiting:
        subject = waiting.pop()
        for predicate, values in statements[subject].items():
            for value in values if predicate not in _PLAIN else ():
                found[_anonymous(subject), predicate, _anonymous(value)] += 1
                if isinstance(value, str) and value not in seen and _is_part(statements, value):
                    seen.add(value)
                    waiting.append(value)
    return found


def _anonymous(term: FileTerm) -> FileTerm:
    return "_:" if isinstance(term, str) and term[:2] == "_:" else term


def _is_part(statements: Statements, node: str) -> bool:
    """Whether a node is one of a template's own: in brackets, a role or a parameter."""
    said = statements.get(node, {})
    return bool(said) and (node[:2] == "_:" or not _PARTS_OF_TEMPLATE.isdisjoint(said.get(TYPE, ())))


def _below(subject: str, properties: Properties) -> Iterator[tuple[str, str]]:
    """A class or property with each that the file puts right above it."""
    for predicate in (RDFS.subClassOf, RDFS.subPropertyOf):
        yield from ((subject, value) for value in properties.get(predicate, ()) if isinstance(value, str))


def _equal(subject: str, properties: Properties) -> Iterator[tuple[str, str]]:
    """A class or property with each that the file calls equal, both ways."""
    for predicate in _EQUIVALENCES:
        for value in properties.get(predicate, ()):
            if isinstance(value, str):
                yield subject, value
                yield value, subject


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
        elif predicate in OF_COMPONENT:
            if not component:
                return False
        elif predicate in SC:
            if predicate not in _PART_TERMS:
                return False
        elif (
            predicate in SH
            or predicate in OWL
            or predicate in _FIELDS
            or (predicate in RDFS and predicate not in _PLAIN)
        ):
            return False
    return True


def _harmless_type(kind: str) -> bool:
    if kind in SC:
        return kind == SC.Component or kind in _PARTS
    return not (kind in SH or kind in OWL or kind in RDFS or kind in RDF)


def _owned(statements: Statements) -> bool:
    """Whether something has each port and each operational parameter."""
    parts = {node for node, properties in statements.items() if not _TYPED.isdisjoint(properties)}
    for properties in statements.values():
        for predicate in _LINKS:
            if predicate in properties:
                parts.difference_update(properties[predicate])
    return not parts


def _of_one_unit(statements: Statements) -> bool:
    """Whether all ports that state a unit state the same one, by `sc:unit` and not spelt out.

    Others may be of another dimension.
    """
    ports = [said for said in statements.values() if not _TYPED.isdisjoint(said)]
    units = {unit for said in ports for unit in said.get(SC.unit, ())}
    otherwise = (said[predicate] for said in ports for predicate in said if predicate not in _PART_TERMS)
    return (
        len(units) < 2
        and all(isinstance(unit, str) and meant_unit(IRI(unit)) is None for unit in units)
        and not any(isinstance(value, str) and value in UNIT for values in otherwise for value in values)
    )


def _of_two_numbers(values: Iterable[FileTerm]) -> bool:
    """Whether values are two whole numbers, which may be one that is written with a comma."""
    return sum(isinstance(one, Lexical) and one.datatype == XSD.integer for one in values) > 1


@immutable
class _Advertisements:
    """The fields of an advertisement, looked for in the statements of a file."""

    statements: Statements

    def clear(self, component: str) -> bool:
        """Whether a component certainly conforms."""
        said = self.statements[component]
        in_place = _MISPLACED_AT_COMPONENT.isdisjoint(said)
        return component[:2] != "_:" and in_place and self._conforms(said, COMPONENT) and self._typed(said)

    def _typed(self, said: Properties) -> bool:
        """Whether each port has a signal type, without which there is a warning."""
        ports = (port for link in (SC.hasInput, SC.hasOutput) for port in said.get(link, ()))
        return all(isinstance(port, str) and SC.signalType in self.statements.get(port, {}) for port in ports)

    def rated(self, properties: Properties) -> bool:
        """Whether something keeps to the shape of a rate, if it has one."""
        return SC.rate not in properties or self._holds(properties, _RATE)

    def _conforms(self, properties: Properties, subject: Subject) -> bool:
        for asked in subject.fields:  # a loop, since this runs for each node of each file
            if not (self._holds(properties, asked) if asked.predicate in properties else asked.least == 0):
                return False
        return True

    def _holds(self, properties: Properties, asked: Field) -> bool:
        """Whether a field that is there has as many values as it may, each of its kind."""
        values = properties[asked.predicate]
        if not asked.counts(len(values)):
            return False
        for value in values:
            if not _allowed(asked, value):
                return False
        if not asked.into.fields:
            return True
        nodes = [self.statements.get(node, {}) for node in values if isinstance(node, str)]
        astray = _MISPLACED[asked.predicate]
        return all(astray.isdisjoint(node) and self._conforms(node, asked.into) for node in nodes) and _distinct(
            nodes, asked.into
        )


def _allowed(asked: Field, value: FileTerm) -> bool:
    """Whether a value is of the kind that a field takes."""
    if isinstance(value, Lexical):
        return asked.kind.literal(value.form, value.datatype)
    return asked.kind.blank if value[:2] == "_:" else asked.kind.iri(value)


def _distinct(nodes: Sequence[Properties], subject: Subject) -> bool:
    """Whether nodes differ in the fields in which they have to, each of which they have once."""
    return len(nodes) < 2 or all(
        len({next(iter(node[asked.predicate])) for node in nodes}) == len(nodes)
        for asked in subject.fields
        if asked.distinct
    )
