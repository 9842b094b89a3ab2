"""What connects the roles of a template: which feeds which, and the ports that it has for those outside.

*Interactions* are `sc:feeds`, and `sc:Interaction` where ports are named. A *port* of the template is an input, output
or operation that the players of one of its roles have.
"""

from __future__ import annotations

from collections.abc import Iterator

from selfconf.model.profile import (
    CALL_MARK,
    Condition,
    Input,
    Output,
    needed_operation,
    offered_operation,
)
from selfconf.model.template import Interaction, Role, TemplatePort
from selfconf.model.term import IRI, STRING, Literal, Term
from selfconf.rdf.permitted_fields import NAME_TEXT, NAMED_OR_TEXT
from selfconf.rdf.tasks.mistakes import DocumentReader, misplaced, worded
from selfconf.rdf.turtle import Document, Node
from selfconf.rdf.vocabulary import SC, TYPE


def interactions_of(document: Document, roles: tuple[Role, ...]) -> tuple[Interaction, ...]:
    """The interactions of a template with some roles, each once, by these roles and then by the names of the ports.

    Raises TemplateError.
    """
    return _InteractionReader(document).interactions(roles)


def _names(interaction: Interaction) -> tuple[str, str]:
    """The names of the ports that an interaction names; empty where it names none."""
    return interaction.output or "", interaction.input or ""


class _InteractionReader(DocumentReader):
    """Reads the interactions of a template; every method raises TemplateError with a sentence for the author."""

    def interactions(self, roles: tuple[Role, ...]) -> tuple[Interaction, ...]:
        known = frozenset(role.iri for role in roles)
        found = {*self._short(roles, known), *self._long(known)}
        number = {role.iri: position for position, role in enumerate(roles)}
        # Which of several reasons or changes comes first depends on this order, and must not on that of the triples.
        return tuple(sorted(found, key=lambda one: (number[one.source], number[one.sink], *_names(one))))

    def _short(self, roles: tuple[Role, ...], known: frozenset[IRI]) -> Iterator[Interaction]:
        for role in roles:
            for sink in self.document.values(role.iri, SC.feeds):
                if sink not in known or not isinstance(sink, IRI):
                    problem = f"the role {worded(role.iri)} feeds {worded(sink)}, which is no role of the template"
                    raise self.mistake(problem, role.iri, SC.feeds, sink)
                yield Interaction(role.iri, sink)

    def _long(self, known: frozenset[IRI]) -> Iterator[Interaction]:
        templates: dict[Term, set[Node]] = {}  # by role, as several may share one
        for template in self.document.instances(SC.Template):
            for role in self.document.items(self.document.value(template, SC.roles) or template):
                templates.setdefault(role, set()).add(template)
        for node in self._nodes():
            source = self.only(node, SC["from"], "an interaction has exactly one sc:from")
            sink = self.only(node, SC.to, "an interaction has exactly one sc:to")
            unknown = [(end, of) for end, of in ((source, SC["from"]), (sink, SC.to)) if end not in known]
            if unknown and templates.get(source, set()) & templates.get(sink, set()):
                continue  # it belongs to another template of the same file
            if unknown or not isinstance(source, IRI) or not isinstance(sink, IRI):
                problem = f"an interaction speaks of {worded(unknown[0][0])}, which is no role of the template"
                raise self.mistake(problem, node, unknown[0][1], unknown[0][0])
            yield Interaction(source, sink, *self._ports(node))

    def _nodes(self) -> list[Node]:
        """The interactions of the document."""
        interactions = self.document.instances(SC.Interaction)
        for node, statements in self.document.statements.items():
            speaks = {SC["from"], SC.to} <= {predicate for predicate, _ in statements}
            if speaks and node not in interactions and (TYPE, SC.Connection) not in statements:
                raise self.mistake("what has sc:from and sc:to is a sc:Interaction; say so with its type", node)
        return interactions

    def _ports(self, node: Node) -> tuple[str | None, str | None]:
        """The output and the input that an interaction names, as far as it does."""
        output, wanted = self._port(node, SC.output), self._port(node, SC.input)
        if output is not None and wanted is not None and output.endswith(CALL_MARK) is not wanted.endswith(CALL_MARK):
            problem = "an interaction joins an output with an input, or an operation with an operation"
            raise self.mistake(f"{problem}; the names of operations end in ()", node, SC.input, Literal(wanted))
        return output, wanted

    def _port(self, node: Node, predicate: IRI) -> str | None:
        values = self.document.values(node, predicate)
        if not values:
            return None
        if (
            len(values) > 1
            or not isinstance(value := values[0], Literal)
            or value.datatype != STRING
            or not value.lexical
        ):
            problem = f"sc:{predicate.short} of an interaction is the name of one port, a string"
            raise self.mistake(problem, node, predicate, values[-1])
        return value.lexical


_LINKS = (SC.hasInput, SC.needsOperation, SC.hasOutput, SC.hasOperation)
_FIXED = tuple(SC[name] for name in ("name", "signalType", "unit", "frame", "request", "response"))
"""What a port says that is the same for all tasks of the template, so that no parameter can stand there."""


def template_ports(document: Document, template: IRI, roles: tuple[Role, ...]) -> tuple[TemplatePort, ...]:
    """The ports of a template with some roles, inputs and needed operations first, by name. Raises TemplateError."""
    found = [*_PortReader(document).ports(template, frozenset(role.iri for role in roles))]
    return tuple(sorted(found, key=lambda port: (not port.is_input, port.name)))


class _PortReader(DocumentReader):
    """Reads the ports of a template; every method raises TemplateError with a sentence for the author."""

    def ports(self, template: IRI, roles: frozenset[IRI]) -> Iterator[TemplatePort]:
        parameters = frozenset[Term](self.document.instances(SC.Parameter))
        for link in _LINKS:
            names: set[str] = set()
            for node in self.document.values(template, link):
                for predicate in _FIXED:
                    for value in parameters.intersection(self.document.values(node, predicate)):
                        raise self.mistake(misplaced(value, predicate), node, predicate, value)
                what = f"a sc:{link.short} of the template {worded(template)}"
                name = self.only(node, SC.name, f"{what} has exactly one sc:name, a string")
                if not isinstance(name, Literal) or not NAME_TEXT.allows(name):
                    problem = f"{what} has exactly one sc:name, {NAME_TEXT.words}"
                    raise self.mistake(problem, node, SC.name, name)
                if name.lexical in names:
                    problem = f"{what} is called {name.lexical!r}, and another one as well"
                    raise self.mistake(problem, template, link, node)
                names.add(name.lexical)
                role = self.only(node, SC.of, f"{what} is that of exactly one role, sc:of")
                if role not in roles or not isinstance(role, IRI):
                    problem = f"{what} is that of {worded(role)}, which is no role of the template"
                    raise self.mistake(problem, node, SC.of, role)
                yield TemplatePort(role, self._port(link, node, name.lexical, what))

    def _port(self, link: IRI, node: Term, name: str, what: str) -> Input | Output:
        """A port as a component has it that is a task of the template."""
        if link in (SC.hasOperation, SC.needsOperation):
            operation = offered_operation if link == SC.hasOperation else needed_operation
            return operation(
                name, self._at_most_one(SC.request, node, what), self._at_most_one(SC.response, node, what)
            )
        signals = self.document.values(node, SC.signalType)
        if not signals or not all(isinstance(one, IRI) for one in signals):
            raise self.mistake(f"{what} has signal types, which are IRIs", node, SC.signalType, *signals)
        types = tuple(sorted(one for one in signals if isinstance(one, IRI)))
        unit, frame = self._at_most_one(SC.unit, node, what), self._frame(node, what)
        if link == SC.hasOutput:
            return Output(name, types, unit=unit, frame=frame)
        return Input(name, types, condition=Condition(unit, frame) if unit or frame else None)

    def _at_most_one(self, predicate: IRI, node: Term, what: str) -> IRI | None:
        """The value of a property that a port need not have; an IRI."""
        if not self.document.values(node, predicate):
            return None
        return self.iri(node, predicate, f"{what} has at most one sc:{predicate.short}, an IRI")

    def _frame(self, node: Term, what: str) -> Term | None:
        """The frame that a port refers to, if it says one."""
        frames = self.document.values(node, SC.frame)
        if len(frames) > 1 or not all(map(NAMED_OR_TEXT.allows, frames)):
            raise self.mistake(f"{what} has at most one sc:frame, {NAMED_OR_TEXT.words}", node, SC.frame, *frames[-1:])
        return frames[0] if frames else None
