"""The ports that a template has for those outside: inputs, outputs and operations of the players of its roles."""

from __future__ import annotations

from collections.abc import Iterator

from selfconf.model.profile import Condition, Input, Output, needed_operation, offered_operation
from selfconf.model.template import Role, TemplatePort
from selfconf.model.term import IRI, Literal, Term
from selfconf.rdf.permitted_fields import NAME_TEXT, NAMED_OR_TEXT
from selfconf.rdf.tasks.mistakes import DocumentReader, worded
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import SC

PORT_LINKS = (SC.hasInput, SC.needsOperation, SC.hasOutput, SC.hasOperation)


def template_ports(document: Document, template: IRI, roles: tuple[Role, ...]) -> tuple[TemplatePort, ...]:
    """The ports of a template with some roles, inputs and needed operations first, by name. Raises TemplateError."""
    found = [*_PortReader(document).ports(template, frozenset(role.iri for role in roles))]
    return tuple(sorted(found, key=lambda port: (not port.is_input, port.name)))


class _PortReader(DocumentReader):
    """Reads the ports of a template; every method raises TemplateError with a sentence for the author."""

    def ports(self, template: IRI, roles: frozenset[IRI]) -> Iterator[TemplatePort]:
        for link in PORT_LINKS:
            names: set[str] = set()
            for node in self.document.values(template, link):
                what = f"a sc:{link.short} of the template {worded(template)}"
                name = self.only(node, SC.name, f"{what} has exactly one sc:name, a string")
                if not isinstance(name, Literal) or not NAME_TEXT.allows(name):
                    problem = f"{what} has exactly one sc:name, {NAME_TEXT.words}"
                    raise self.mistake(problem, node, SC.name, name)
                if name.lexical in names:
                    problem = f"{what} is called {name.lexical!r}, and another one as well"
                    raise self.mistake(problem, node, SC.name, name)
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
