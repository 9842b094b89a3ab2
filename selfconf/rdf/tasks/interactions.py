"""Which roles of a template feed which: by `sc:feeds`, and by `sc:Interaction` where ports are named."""

from __future__ import annotations

from collections.abc import Iterator

from selfconf.model.profile import CALL_MARK
from selfconf.model.template import Interaction, Role
from selfconf.model.term import IRI, STRING, Literal, Term
from selfconf.rdf.tasks.mistakes import DocumentReader, worded
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
