"""The careful reader: from triples to the profile of each component, with every problem named.

`shapes/advertisement.ttl` is the authority on which advertisements conform. Reading builds the profile and notes on
its way everything that the shape forbids; both follow the table of fields (`selfconf.rdf.permitted_fields`), and
a test holds the two verdicts together.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from selfconf.model.literal_values import number, truth
from selfconf.model.profile import (
    Condition,
    Input,
    OperationalParameter,
    Output,
    Place,
    Profile,
    needed_operation,
    offered_operation,
    shared_ports,
)
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.model.wording import is_one_line
from selfconf.rdf.advertisements.accepted_shapes import ShapeNotAccepted, accepted_shape
from selfconf.rdf.advertisements.advertisement import (
    Advertisement,
    MalformedAdvertisement,
    ParsedAdvertisement,
    about,
    allowed,
    property_order,
)
from selfconf.rdf.permitted_fields import (
    COMPONENT,
    INPUT,
    NEEDED_OPERATION,
    OF_COMPONENT,
    OUTPUT,
    PARAMETER_TYPE,
    PORT_NAME,
    REQUEST,
    RESPONSE,
    SAID_BY,
    SETTINGS,
    SIGNAL_TYPE,
    STRUCTURE,
    Field,
    Subject,
)
from selfconf.rdf.turtle import Document, Node
from selfconf.rdf.vocabulary import SC, TYPE

_COUNTERPARTS = {
    SC.hasInput: ("an input", "an output"),
    SC.hasOutput: ("an output", "an input"),
    SC.hasOperation: ("an operation that is offered", "one that is needed"),
    SC.needsOperation: ("an operation that is needed", "one that is offered"),
    SC.hasParameter: ("an operational parameter", ""),
}
"""What a link leads to, and what says what it may not say."""
_OWNERS = {SC.rate: "an output", SC.accepts: "an input"}
"""What alone says what neither a component nor any other part of it may say."""
UNDECLARED = ("it has ports, parameters, a preference or a grounding, and is not declared a sc:Component",)
"""What is wrong with what says such things and is no component."""


def read_document(document: Document) -> tuple[list[Advertisement], list[MalformedAdvertisement]]:
    """Every advertisement of a document, in the order of the text, and those that do not conform.

    The last of these are of what speaks as a component does, and is not declared one.
    """
    good: list[Advertisement] = []
    bad: list[MalformedAdvertisement] = []
    others = frozenset(document.instances(SC.Component))
    for component, profile, problems in profiles(document):
        if problems or profile is None:
            bad.append(MalformedAdvertisement(component, Place(document.source), problems))
        else:
            good.append(ParsedAdvertisement(profile, tuple(about(document, component, others))))
    bad += [MalformedAdvertisement(subject, Place(document.source), UNDECLARED) for subject in _undeclared(document)]
    return good, bad


def _undeclared(document: Document) -> Iterator[Node]:
    """What speaks as a component does, and is declared neither that nor a template; no part of something else."""
    found = [subject for subject, said in document.statements.items() if any(one in OF_COMPONENT for one, _ in said)]
    found = [one for one in found if not {SC.Component, SC.Template} & set(document.values(one, TYPE))]
    parts = {value for _, _, value in document.triples() if isinstance(value, BlankNode)} if found else set()
    return (subject for subject in found if subject not in parts)


def profiles(document: Document) -> Iterator[tuple[Node, Profile | None, tuple[str, ...]]]:
    """Every component of a document with as much of a profile as can be read, and what is wrong with it."""
    for component in document.instances(SC.Component):
        reader = _Reader(document, component)
        profile = reader.profile()
        yield component, profile, tuple(reader.problems)


class _Reader:
    """Reads one component and notes every problem instead of stopping at the first."""

    def __init__(self, document: Document, component: Node) -> None:
        self.document, self.component = document, component
        self.problems: list[str] = []

    def profile(self) -> Profile | None:
        if not isinstance(self.component, IRI):
            self.problems.append("a component needs an IRI, so that others can speak of it")
            return None
        if not is_one_line(self.component):  # RFC 3987, section 4.1, forbids them, and messages hold no such names
            self.problems.append("the IRI of a component has no characters that turn the direction of writing")
            return None
        statements = self.document.statements[self.component]
        types = self._types()
        self._look_for_misplaced(COMPONENT, self.component)
        for link in (SC.tolerates, SC.deadline, SC.grounding):
            self._look_for_misplaced_behind(self.component, COMPONENT[link])
        inputs = [self._input(name, node) for name, node in self._named(COMPONENT[SC.hasInput])]
        outputs = [self._output(name, node) for name, node in self._named(COMPONENT[SC.hasOutput])]
        inputs += [self._needed(name, node) for name, node in self._named(COMPONENT[SC.needsOperation])]
        outputs += [
            offered_operation(name, *self._types_of_call(name, node))
            for name, node in self._named(COMPONENT[SC.hasOperation])
        ]
        parameters = [
            OperationalParameter(name, kind)
            for name, node in self._named(COMPONENT[SC.hasParameter])
            if (kind := self._parameter_type(name, node)) is not None
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
            place=Place(self.document.source),
            **self._settings(),
            command=self._command(),
            inside=self._inside(),
        )

    def _types(self) -> frozenset[IRI]:
        values, field = self.document.values(self.component, TYPE), COMPONENT[TYPE]
        if not all(map(field.kind.allows, values)):
            self.problems.append("the type of a component is an IRI")
        if len(values) < field.least:
            self.problems.append("a component needs a type of its own besides sc:Component")
        return frozenset(value for value in values if isinstance(value, IRI) and allowed(TYPE, value))

    def _named(self, link: Field) -> Iterator[tuple[str, Term]]:
        """Name and node of each port or parameter; a problem for each that lacks a name or repeats one."""
        names: set[str] = set()
        for node in self.document.values(self.component, link.predicate):
            name = self._required(node, PORT_NAME)
            if not isinstance(name, Literal):
                self._problem(f"{_word(link.predicate)} needs {_one_of(PORT_NAME)}")
                continue
            if PORT_NAME.distinct and name.lexical in names:
                self._problem(f"the name {name.lexical!r} stands for two values of {_word(link.predicate)}")
            names.add(name.lexical)
            here, there = _COUNTERPARTS[link.predicate]
            self._look_for_misplaced(link.into, node, there, f", and {name.lexical!r} is {here}")
            yield name.lexical, node

    def _look_for_misplaced(self, subject: Subject, node: Term, counterpart: str = "", but: str = "") -> None:
        """Note what only a port of the other direction says, or only a component, or no part of an advertisement."""
        types = self.document.values(node, TYPE)
        for predicate, _ in self.document.about(node):
            if predicate in subject.predicates:  # as sc:binding, which besides tasks a grounding has
                continue
            if predicate in OF_COMPONENT and SC.Component not in types:
                self._problem(f"only a component has a {_word(predicate)}{but}")
            owners = SAID_BY.get(predicate)
            if owners is not None and not set(owners) & set(types):
                self._problem(
                    f"only {' or '.join(f'a {_word(owner)}' for owner in owners)} has {_word(predicate)}{but}"
                )
        for field in subject.fields:
            if field.most == 0 and self.document.values(node, field.predicate):
                owner = _OWNERS.get(field.predicate, counterpart)
                self._problem(f"only {owner} has a {_word(field.predicate)}{but}")

    def _look_for_misplaced_behind(self, node: Term, link: Field) -> None:
        """Note what a quantity or a grounding says that only a component says, or no part of an advertisement."""
        for value in self.document.values(node, link.predicate):
            self._look_for_misplaced(link.into, value, but=f", and this one stands in {_word(link.predicate)}")

    def _parameter_type(self, name: str, node: Term) -> IRI | None:
        type_ = self._required(node, PARAMETER_TYPE)
        if isinstance(type_, IRI):
            return type_
        self._problem(f"{_word(SC.hasParameter)} {name!r} needs {_one_of(PARAMETER_TYPE)}")
        return None

    def _types_of_call(self, name: str, node: Term) -> tuple[IRI | None, IRI | None]:
        """What is sent along with an operation, and what is answered, as far as that is said."""
        request, response = (self._field_of_port(node, name, field) for field in (REQUEST, RESPONSE))
        return request if isinstance(request, IRI) else None, response if isinstance(response, IRI) else None

    def _needed(self, name: str, node: Term) -> Input:
        optional = self._field_of_port(node, name, NEEDED_OPERATION[SC.optional])
        return needed_operation(name, *self._types_of_call(name, node), truth(optional) is True)

    def _input(self, name: str, node: Term) -> Input:
        unit, frame = self._unit(node, name), self._field_of_port(node, name, INPUT[SC.frame])
        accepts = self._accepts(node, name)
        optional = self._field_of_port(node, name, INPUT[SC.optional])
        depth = self._field_of_port(node, name, INPUT[SC.depth])
        return Input(
            name,
            self._signals(node, name),
            int(depth.lexical) if isinstance(depth, Literal) else None,
            truth(optional) is True,
            Condition(unit, frame, accepts) if unit or frame or accepts else None,
        )

    def _output(self, name: str, node: Term) -> Output:
        rate = self._quantity(node, OUTPUT[SC.rate], f"the sc:rate of output {name!r}")
        self._look_for_misplaced_behind(node, OUTPUT[SC.rate])
        hertz = None if rate is None else float(number(rate) or 0)
        frame = self._field_of_port(node, name, OUTPUT[SC.frame])
        return Output(name, self._signals(node, name), hertz, self._unit(node, name), frame)

    def _signals(self, node: Term, name: str) -> tuple[IRI, ...]:
        values = self.document.values(node, SIGNAL_TYPE.predicate)
        if not all(map(SIGNAL_TYPE.kind.allows, values)):
            self._problem(f"the {_word(SIGNAL_TYPE.predicate)} of {name!r} is {SIGNAL_TYPE.kind.words}")
        return tuple(sorted(value for value in values if isinstance(value, IRI)))

    def _unit(self, node: Term, name: str) -> IRI | None:
        unit = self._field_of_port(node, name, INPUT[SC.unit])
        return unit if isinstance(unit, IRI) else None

    def _field_of_port(self, node: Term, name: str, field: Field) -> Term | None:
        """The value of a field that a port need not have; a problem if it is there and not in order."""
        if not self.document.values(node, field.predicate):
            return None
        value = self._required(node, field)
        if value is None:
            self._problem(f"{name!r} has at most one {_word(field.predicate)}, {field.kind.words}")
        return value

    def _accepts(self, node: Term, name: str) -> str | None:
        """The text of the shape that an input accepts, if it states one."""
        shape = self._field_of_port(node, name, INPUT[SC.accepts])
        if shape is None:
            return None
        try:
            return accepted_shape(self.document, shape)
        except ShapeNotAccepted as error:
            self._problem(f"the sc:accepts of input {name!r} is no shape that an advertisement may hold: {error}")
            return None

    def _required(self, node: Term, field: Field) -> Term | None:
        """The value of a field that has exactly one, if it is of the kind that the field takes."""
        values = self.document.values(node, field.predicate)
        return values[0] if len(values) == 1 and field.kind.allows(values[0]) else None

    def _conforms(self, node: Term, subject: Subject) -> bool:
        """Whether a node has what each field of a subject asks for."""
        found = [(field, self.document.values(node, field.predicate)) for field in subject.fields]
        return all(field.counts(len(values)) and all(map(field.kind.allows, values)) for field, values in found)

    def _problem(self, problem: str) -> None:
        if problem not in self.problems:
            self.problems.append(problem)

    def _settings(self) -> dict[str, Any]:
        """The members of the profile that hold one value each, of those fields that are there and in order."""
        found: dict[str, Any] = {}
        for predicate, setting in SETTINGS.items():
            field = COMPONENT[predicate]
            if field.into.fields:
                said = "what a component sc:tolerates"
                if predicate != SC.tolerates:
                    said = f"the {_word(predicate)} of a component"
                value = self._quantity(self.component, field, said)
            else:
                value = self._setting(field)
            if value is not None:
                found[setting.member] = setting.value(value.lexical, value.datatype)
        return found

    def _setting(self, field: Field) -> Literal | None:
        """The value of a field that a component need not have; a problem if it is there and not in order."""
        if not self.document.values(self.component, field.predicate):
            return None
        value = self._required(self.component, field)
        if isinstance(value, Literal):
            return value
        self._problem(f"a component has at most one {_word(field.predicate)}, {field.kind.words}")
        return None

    def _quantity(self, node: Term, field: Field, what: str) -> Literal | None:
        """The number of a rate or of a duration, if there is one; a problem if it is not in order."""
        if not self.document.values(node, field.predicate):
            return None
        quantity = self._required(node, field)
        if quantity is None or not self._conforms(quantity, field.into):
            unit = field.into[SC.unit].kind.words
            self._problem(f"{what} is [ sc:value NUMBER ; sc:unit {unit} ], above zero")
            return None
        (value,) = self.document.values(quantity, SC.value)
        return value if isinstance(value, Literal) else None

    def _inside(self) -> IRI | None:
        """The template of a composite, if it is one."""
        field = COMPONENT[SC.grounding]
        template = self.document.value(self.component, SC.grounding)
        if template is None or not self.document.values(template, SC.template):
            return None
        value = self._required(template, field.into[SC.template])
        if value is None or self.document.values(template, SC.command):
            self._problem("a grounding has a sc:command or one sc:template, an IRI")
        return value if isinstance(value, IRI) else None

    def _command(self) -> str | None:
        field = COMPONENT[SC.grounding]
        groundings = self.document.values(self.component, field.predicate)
        if not groundings:
            return None
        grounding = self._required(self.component, field)
        commands = [] if grounding is None else self.document.values(grounding, SC.command)
        if grounding is None or len(commands) > 1:
            self._problem('a component has at most one sc:grounding, such as [ sc:command "..." ]')
        elif commands:
            command = field.into[SC.command]
            if command.kind.allows(commands[0]):
                return str(commands[0])
            self._problem(f"{_word(command.predicate)} is {command.kind.words}")
        return None


def _word(term: IRI) -> str:
    return f"sc:{term.short}"


def _one_of(field: Field) -> str:
    return f"exactly one {_word(field.predicate)}, {field.kind.words}"
