"""What an advertisement may say: one table of its fields, which all that reads or checks advertisements is made from.

Each subject (a component, an input, an output, an operational parameter, a rate, a duration, a grounding) has fields;
a field is a predicate with the number of its values and what kind of value it takes. The careful reader, the prefilter
of validation, the patterns of the fast loader and the lints take both from here. `shapes/advertisement.ttl` says the
same in SHACL, for use without selfconf; a test holds the two together, both ways.

A kind of value is given three times: as a test of a value, as the words that an author reads, and as the Turtle that
the fast loader recognises without looking closer. The last may accept less than the first, never more.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal

from selfconf.model.immutable import immutable
from selfconf.model.literal_values import BOOLEAN, TRUTH, number_of
from selfconf.model.profile import LONGEST_PORT_NAME, is_port_name
from selfconf.model.term import IRI, STRING, BlankNode, Literal, Term
from selfconf.model.wording import STEERING_OR_BREAKING
from selfconf.rdf.turtle import SKOLEM
from selfconf.rdf.vocabulary import LABEL, RDF, RDFS, SC, SH, TYPE, UNIT, XSD

NEXT = " ;\n\t"
"""What Oxigraph writes between two statements about one subject; no term has a line break in it."""


def _never(_: str) -> bool:
    return False


def _always(_: str) -> bool:
    return True


def _whole(lexical: str, datatype: str) -> int:
    """The value of a literal of xsd:integer; of any other literal, and of text that is no number, less than zero."""
    return -1 if datatype != XSD.integer or number_of(lexical, datatype) is None else int(lexical)


def _no_literal(_: str, __: str) -> bool:
    return False


@immutable
class ValueKind:
    """A kind of value: which IRIs, literals (text and datatype) and blank nodes are of it."""

    words: str
    turtle: str = ""
    """A regular expression for some values of the kind as Oxigraph writes them, with one group: the IRI or the text."""
    iri: Callable[[str], bool] = _never
    literal: Callable[[str, str], bool] = _no_literal
    blank: bool = False

    def allows(self, value: Term) -> bool:
        """Whether a value is of this kind."""
        if isinstance(value, Literal):
            return self.literal(value.lexical, value.datatype)
        return self.blank if isinstance(value, BlankNode) else self.iri(value)


# A literal with a language has the datatype rdf:langString, so a test for xsd:string refuses it.
RESOURCE = ValueKind("an IRI", rf"<((?!{SKOLEM})[^<>]*)>", iri=_always)
NAME_TEXT = ValueKind(
    f"a string of 1 to {LONGEST_PORT_NAME} characters that has no control characters and does not end in ()",
    rf'"([^"\\{STEERING_OR_BREAKING}]{{0,{LONGEST_PORT_NAME - 1}}}[^"\\{STEERING_OR_BREAKING})])"',
    literal=lambda lexical, datatype: datatype == STRING and is_port_name(lexical),
)
COMMAND_LINE = ValueKind(
    "a string that is not blank, without a language",
    r'"([^"\\]*[^\s"\\][^"\\]*)"',
    literal=lambda lexical, datatype: datatype == STRING and lexical.strip() != "",
)
NUMBER = ValueKind(
    "a finite number",
    r"([+-]?[0-9]{1,9}(?:\.[0-9]{1,9})?)",
    literal=lambda lexical, datatype: number_of(lexical, datatype) is not None,
)
POSITIVE = ValueKind(
    "a number above zero",
    r"((?=[0-9.]*[1-9])[0-9]{1,9}(?:\.[0-9]{1,9})?)",
    literal=lambda lexical, datatype: (number_of(lexical, datatype) or 0) > 0,
)
HERTZ = ValueKind("unit:HZ", f"<({UNIT.HZ})>", iri=UNIT.HZ.__eq__)
SECOND = ValueKind("unit:SEC", f"<({UNIT.SEC})>", iri=UNIT.SEC.__eq__)
MOST = 1_000_000
"""The largest whole number that a field takes; the component or site that obeys it keeps room for so many."""
COUNT = ValueKind(
    "a whole number from 0 to 1000000",
    r"([0-9]{1,6})",
    literal=lambda lexical, datatype: 0 <= _whole(lexical, datatype) <= MOST,
)
COUNT_FROM_ONE = ValueKind(
    "a whole number from 1 to 1000000",
    r"((?=[0-9]*[1-9])[0-9]{1,6})",
    literal=lambda lexical, datatype: 1 <= _whole(lexical, datatype) <= MOST,
)
TRUE_OR_FALSE = ValueKind(
    "true or false",
    r"(true|false)",
    literal=lambda lexical, datatype: datatype == BOOLEAN and lexical in TRUTH,
)
NODE = ValueKind("a node with properties", iri=_always, blank=True)
ACCEPTED_SHAPE = ValueKind("a shape in brackets", blank=True)
NAMED_OR_TEXT = ValueKind(
    "an IRI or a string that is not empty",
    iri=_always,
    literal=lambda lexical, datatype: datatype == STRING and lexical != "",
)


@immutable
class Subject:
    """What an advertisement may speak of, with its fields."""

    fields: tuple[Field, ...] = ()
    type: IRI | None = None
    """The class that it may, and a component has to, be declared as."""

    def __getitem__(self, predicate: IRI) -> Field:
        for field in self.fields:  # each port of each advertisement passes here
            if field.predicate == predicate:
                return field
        raise KeyError(predicate)

    @property
    def predicates(self) -> frozenset[IRI]:
        """The predicates of its fields."""
        return frozenset(field.predicate for field in self.fields)

    def walk(self) -> Iterator[Subject]:
        """The subject, and all that its fields lead to."""
        yield self
        for field in self.fields:
            if field.into.fields:
                yield from field.into.walk()


LEAF = Subject()
"""What a value is that has no fields of its own."""


@immutable
class Field:
    """A predicate of a subject: how many values it may have, and of which kind."""

    predicate: IRI
    kind: ValueKind
    least: int = 0
    most: int | None = 1
    into: Subject = LEAF
    """What the values are themselves, where they are nodes with fields."""
    distinct: bool = False
    """Whether no two values of one link may agree in it, as the inputs of a component may not in their names."""

    @property
    def turtle(self) -> str:
        """A regular expression for what the fast loader recognises of it; the value is a group named as the predicate.

        Of a value with fields of its own it recognises those, each once, in the order of the table, in brackets.
        """
        if self.into.fields:
            value = rf"\[ {NEXT.join(field.turtle for field in self.into.fields)} \]"
        else:
            value = self.kind.turtle.replace("(", f"(?P<{self.predicate.short}>", 1)
        return f"<{self.predicate}> {value}"

    def counts(self, values: int) -> bool:
        """Whether it may have so many values."""
        return self.least <= values and (self.most is None or values <= self.most)


_SHAPES = ("property", "node", "not", "qualifiedValueShape")
_LISTS = ("and", "or", "xone", "in", "languageIn", "ignoredProperties", "alternativePath")
_PATHS = ("path", "inversePath", "zeroOrMorePath", "oneOrMorePath", "zeroOrOnePath")
DEEPEST_SHAPE = 15
"""How many shapes within shapes pySHACL follows, the outermost among them."""
LISTS_OF_SHAPES = frozenset(SH[name] for name in ("and", "or", "xone"))
"""The predicates of SHACL Core whose values are lists of shapes."""
SHAPE_VALUED = LISTS_OF_SHAPES | {SH[name] for name in _SHAPES}
"""The predicates of SHACL Core whose values are shapes, or lists of shapes."""
SHAPE_ANNOTATIONS = frozenset((LABEL, RDFS.comment, RDFS.isDefinedBy, RDFS.seeAlso)).union(
    SH[name] for name in ("name", "description", "message", "order", "group", "defaultValue")
)
"""What a shape says to those that read or show it; it constrains nothing (SHACL, section 2.3.2)."""
PERMITTED_IN_SHAPES = SHAPE_ANNOTATIONS.union((TYPE, RDF.first, RDF.rest)).union(
    SH[name]
    for name in (
        *_SHAPES, *_LISTS, *_PATHS, "class", "datatype", "nodeKind", "hasValue", "minCount", "maxCount", "pattern",
        "flags", "minLength", "maxLength", "uniqueLang", "minInclusive", "maxInclusive", "minExclusive",
        "maxExclusive", "equals", "disjoint", "lessThan", "lessThanOrEquals", "closed", "qualifiedMinCount",
        "qualifiedMaxCount", "qualifiedValueShapesDisjoint", "severity", "deactivated",
    )
)  # fmt: skip
"""What may be said in the shape of `sc:accepts`: SHACL Core, without targets, and annotations."""

PORT_NAME = Field(SC.name, NAME_TEXT, least=1, distinct=True)
SIGNAL_TYPE = Field(SC.signalType, RESOURCE, most=None)
PARAMETER_TYPE = Field(SC.parameterType, RESOURCE, least=1)
PORT = (PORT_NAME, SIGNAL_TYPE, Field(SC.unit, RESOURCE), Field(SC.frame, NAMED_OR_TEXT))
"""What an input and an output may both say."""
NO_RATE = Field(SC.rate, NODE, most=0)
NO_SHAPE = Field(SC.accepts, ACCEPTED_SHAPE, most=0)
RATE = Subject((Field(SC.value, POSITIVE, least=1), Field(SC.unit, HERTZ, least=1)))
DURATION = Subject((Field(SC.value, POSITIVE, least=1), Field(SC.unit, SECOND, least=1)))
INPUT = Subject(
    (
        *PORT,
        Field(SC.rate, NODE, most=0, into=RATE),
        Field(SC.depth, COUNT_FROM_ONE),
        Field(SC.optional, TRUE_OR_FALSE),
        Field(SC.accepts, ACCEPTED_SHAPE),
    ),
    SC.Input,
)
OUTPUT = Subject(
    (
        *PORT,
        Field(SC.rate, NODE, into=RATE),
        Field(SC.depth, COUNT_FROM_ONE, most=0),
        Field(SC.optional, TRUE_OR_FALSE, most=0),
        NO_SHAPE,
    ),
    SC.Output,
)
PARAMETER = Subject((PORT_NAME, PARAMETER_TYPE, NO_RATE, NO_SHAPE), SC.OperationalParameter)
REQUEST, RESPONSE = Field(SC.request, RESOURCE), Field(SC.response, RESOURCE)
OPERATION_FIELDS = (PORT_NAME, REQUEST, RESPONSE, NO_RATE, NO_SHAPE)
"""What an operation that is offered and one that is needed may both say."""
OPERATION = Subject((*OPERATION_FIELDS, Field(SC.optional, TRUE_OR_FALSE, most=0)), SC.Operation)
NEEDED_OPERATION = Subject((*OPERATION_FIELDS, Field(SC.optional, TRUE_OR_FALSE)), SC.Operation)
GROUNDING = Subject(
    (Field(SC.command, COMMAND_LINE), Field(SC.template, RESOURCE), Field(SC.binding, NODE, most=None)), SC.Grounding
)
COMPONENT = Subject(
    (
        Field(TYPE, RESOURCE, least=2, most=None),  # sc:Component, and what kind of component it is
        Field(SC.hasInput, NODE, most=None, into=INPUT),
        Field(SC.hasOutput, NODE, most=None, into=OUTPUT),
        Field(SC.hasParameter, NODE, most=None, into=PARAMETER),
        Field(SC.hasOperation, NODE, most=None, into=OPERATION),
        Field(SC.needsOperation, NODE, most=None, into=NEEDED_OPERATION),
        Field(SC.preference, NUMBER),
        Field(SC.shareable, TRUE_OR_FALSE),
        Field(SC.tolerates, NODE, into=DURATION),
        Field(SC.deadline, NODE, into=DURATION),
        Field(SC.restarts, COUNT),
        Field(SC.grounding, NODE, into=GROUNDING),
        NO_RATE,
        NO_SHAPE,
    ),
    SC.Component,
)

OF_COMPONENT = frozenset(field.predicate for field in COMPONENT.fields if field.most != 0) - {TYPE}
"""What only a component says of itself, and of its ports a template."""
PORTS = tuple(COMPONENT[link] for link in (SC.hasInput, SC.hasOutput, SC.hasParameter))
"""The fields of a component that lead to what most components have: inputs, outputs, operational parameters."""


@immutable
class SingleValue:
    """How the profile of a component holds a field that says one thing."""

    member: str
    """The name of the member of the profile."""
    value: Callable[[str, str], Decimal | float | bool | None]
    """Its value, from the text and the datatype of a literal that the kind of the field allows."""


def _seconds(lexical: str, datatype: str) -> float:
    return float(number_of(lexical, datatype) or 0)


SETTINGS: Mapping[IRI, SingleValue] = {
    SC.preference: SingleValue("preference", number_of),
    SC.shareable: SingleValue("shareable", lambda lexical, _: TRUTH[lexical]),
    SC.tolerates: SingleValue("tolerates", _seconds),
    SC.deadline: SingleValue("deadline", _seconds),
    SC.restarts: SingleValue("restarts", lambda lexical, _: int(lexical)),
}
"""The fields of a component that say one thing each. The careful reader and the fast loader both read them by this."""
LINKED: Mapping[IRI, Subject] = {
    field.predicate: field.into for subject in COMPONENT.walk() for field in subject.fields if field.into.fields
}
"""What leads from a component to what else its profile is made of, with what that is."""
LINKS = frozenset(LINKED)
"""What leads from a component to what else its profile is made of."""
SHAPE_LINKS = PERMITTED_IN_SHAPES - {TYPE} | {SC.accepts}
"""What leads from an input to what the shape that it accepts is made of."""
SAID_BY: Mapping[IRI, tuple[IRI, ...]] = {
    SC.roles: (SC.Template,),
    SC.cost: (SC.Template,),
    SC.priority: (SC.Template, SC.Task),
    SC.binding: (SC.Task,),
    **dict.fromkeys((SC.feeds, SC.sets, SC.minCount, SC.maxCount, SC.recruits), (SC.Role,)),
    **dict.fromkeys((SC["from"], SC.to), (SC.Interaction, SC.Connection)),
    **dict.fromkeys((SC.assignment, SC.connection, SC.setting, SC.epoch), (SC.Configuration,)),
}
"""What a component and its ports do not say, with the classes of what does."""
OF_PORTS_ALONE = frozenset((SC.name, SC.signalType))
"""What only ports and parameters say; of a component it says nothing, and is no mistake."""
_PARTS = tuple(subject for subject in LINKED.values() if subject.type is not None)
_TOLD_OTHERWISE = OF_COMPONENT.union(OF_PORTS_ALONE, SAID_BY, (TYPE, SC.parameterType))
OF_PARTS: Mapping[IRI, tuple[IRI, ...]] = {
    predicate: tuple(
        dict.fromkeys(
            part.type
            for part in _PARTS
            if part.type is not None and predicate in part.predicates and part[predicate].most != 0
        )
    )
    for part in _PARTS
    for predicate in part.predicates - _TOLD_OTHERWISE
}
"""What parts of a component say of themselves, with the classes of those that do; their names and types apart."""


def foreign_terms(subject: Subject) -> frozenset[IRI]:
    """What a subject does not say, and another part of an advertisement does: here nothing reads it."""
    return frozenset(OF_PARTS).union((SC.value,)) - subject.predicates


STRUCTURE = COMPONENT.predicates.union(OF_PORTS_ALONE, SAID_BY)
"""The predicates that are no properties of a component: those that its profile has fields for, and those that only its
ports, or roles, templates and their like have."""
