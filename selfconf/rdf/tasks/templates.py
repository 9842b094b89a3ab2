"""Templates and tasks: from triples to the roles, interactions and parameters of a task.

The shape of each role stays where it is, in the document; `selfconf.rdf.roles` compiles it. What makes a template
readable is checked here, with one sentence per mistake; the authority is `shapes/template.ttl`, and a test holds
the two together: whatever file about templates or tasks is wrong, nothing of it is read.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from selfconf.errors import TemplateError
from selfconf.model.cost import CostLevel, CostTerm
from selfconf.model.number import fraction
from selfconf.model.profile import Place
from selfconf.model.template import Interaction, Parameter, Role, Setting, Task, Template
from selfconf.model.term import IRI, STRING, BlankNode, Literal, Term
from selfconf.rdf.shacl import ONLY_WITH_A_PATH, misfit
from selfconf.rdf.turtle import Document, Node
from selfconf.rdf.vocabulary import LABEL, NIL, REST, SC, SH, TYPE, XSD

WHOLE = frozenset(XSD[name] for name in ("integer", "int", "long", "short", "nonNegativeInteger", "positiveInteger"))
_WORD = re.compile(r"\S+")
_COUNT = re.compile(r"\+?[0-9]{1,18}")
ROLE_STRUCTURE = frozenset((TYPE, SC.feeds, SC.sets, SC.minCount, SC.maxCount))
_SAID_OF = {**dict.fromkeys((SC.feeds, SC.sets, SC.minCount, SC.maxCount), SC.Role), SC.cost: SC.Template}
"""What is said only of things of a kind."""
_KINDS_OF_VALUE: dict[Term, type] = {SH.IRI: IRI, SH.Literal: Literal}


@dataclass(frozen=True, slots=True)
class TaskDocument:
    """A task with the document that holds the shapes of its roles."""

    task: Task
    document: Document


def read_task(document: Document, wanted: IRI | None = None) -> TaskDocument:
    """The task or template of a document; `wanted` names one where there are several. Raises TemplateError."""
    tasks, templates = document.instances(SC.Task), document.instances(SC.Template)
    if wanted is not None:
        if wanted not in tasks and wanted not in templates:
            raise TemplateError(f"there is no template or task {wanted!r} in it", file=document.source)
        chosen: Node = wanted
    elif len(tasks or templates) == 1:
        chosen = (tasks or templates)[0]
    elif not templates and not tasks:
        raise TemplateError("no sc:Template and no sc:Task in it; is it the right file?", file=document.source)
    else:
        names = ", ".join(sorted(repr(node) for node in tasks or templates))
        raise TemplateError(f"it holds several; say which with --template: {names}", file=document.source)
    if chosen in tasks:
        return TaskDocument(_Reader(document).task(chosen), document)
    return TaskDocument(Task(_Reader(document).template(chosen)), document)


def mentions(document: Document, role: IRI, parameters: frozenset[IRI]) -> set[IRI]:
    """The parameters that stand somewhere in the shape of a role."""
    found: set[IRI] = set()
    for _, value in shape_statements(document, role):
        if value in parameters and isinstance(value, IRI):
            found.add(value)
    return found


def shape_statements(document: Document, role: IRI) -> Iterator[tuple[IRI, Term]]:
    """Predicate and object of each statement of a role's shape, nested and named shapes included."""
    waiting: list[Node] = [role]
    seen: set[Term] = {role}
    while waiting:
        subject = waiting.pop()
        for predicate, value in document.statements.get(subject, ()):
            if subject == role and predicate in ROLE_STRUCTURE:
                continue
            yield predicate, value
            if not isinstance(value, Literal) and value not in seen:
                seen.add(value)
                waiting.append(value)


class _Reader:
    """Reads one document; every method raises TemplateError with a sentence for the author."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self._variables = frozenset[Term](document.instances(SC.Parameter))

    def task(self, task: Node) -> Task:
        template_iri = self._only(task, SC.template, "a task names exactly one template by sc:template")
        if template_iri not in self.document.instances(SC.Template):
            raise self._error(f"the template {_show(template_iri)} of the task is not in this file")
        template = self.template(template_iri)
        known = {parameter.iri for parameter in template.parameters}
        bindings: dict[IRI, Term] = {}
        for binding in self.document.values(task, SC.binding):
            parameter = self._only(binding, SC.parameter, "a binding names exactly one sc:parameter")
            value = self._only(binding, SC.value, "a binding has exactly one sc:value")
            if parameter not in known or not isinstance(parameter, IRI):
                raise self._error(f"the task binds {_show(parameter)}, which is no parameter of its template")
            if parameter in bindings:
                raise self._error(f"the task binds the parameter {_show(parameter)} twice")
            bindings[parameter] = value
        return Task(template, bindings, task if isinstance(task, IRI) else None)

    def template(self, template: Node | Term) -> Template:
        if not isinstance(template, IRI):
            raise self._error("a template needs an IRI")
        head = self._only(template, SC.roles, "a template has exactly one list of roles, sc:roles ( ... )")
        names = self.document.items(head)
        end: Term | None = head
        for _ in names:
            end = self.document.value(end, REST) if end is not None else None
        if names and end != NIL:
            raise self._error("the list sc:roles has no end; write it in parentheses, sc:roles ( ... )")
        if not names:
            raise self._error("the list sc:roles is empty; a template needs at least one role")
        for name, times in Counter(names).items():
            if times > 1:
                raise self._error(f"the role {_show(name)} stands {times} times in sc:roles")
        known = frozenset(name for name in names if isinstance(name, IRI))
        for subject, statements in self.document.statements.items():
            for predicate, kind in _SAID_OF.items():
                if (TYPE, kind) not in statements and any(said == predicate for said, _ in statements):
                    what = f"has sc:{predicate.short}, but is not described as a sc:{kind.short}"
                    raise self._error(f"{_show(subject)} {what}")
        roles = tuple(self._role(name) for name in names)
        interactions = (*self._feeds(roles, known), *self._interactions(known))
        return Template(
            iri=template,
            roles=roles,
            interactions=tuple(dict.fromkeys(interactions)),
            parameters=self._parameters(template, roles),
            label=self._label(template),
            cost=tuple(self._cost(template, known)),
        )

    def _role(self, name: Term) -> Role:
        if not isinstance(name, IRI):
            raise self._error("every role needs an IRI")
        if SC.Role not in self.document.values(name, TYPE):
            raise self._error(f"{_show(name)} stands in sc:roles, but is not described as a sc:Role")
        self._shape(name)
        minimum, maximum = self._count(name, SC.minCount), self._count(name, SC.maxCount)
        least = 1 if minimum is None else minimum
        most = 1 if minimum is None and maximum is None else maximum
        if most is not None and least > most:
            raise self._error(f"the role {_show(name)} asks for at least {least} and at most {most} components")
        settings = dict.fromkeys(
            Setting(
                self._iri(node, SC.parameterType, f"what {_show(name)} sets needs one sc:parameterType, an IRI"),
                self._only(node, SC.value, f"what {_show(name)} sets needs exactly one sc:value"),
            )
            for node in self.document.values(name, SC.sets)
        )
        for kind, times in Counter(setting.type for setting in settings).items():
            if times > 1:
                raise self._error(f"the role {_show(name)} sets {_show(kind)} to {times} different values")
        types = tuple(value for value in self.document.values(name, SH["class"]) if isinstance(value, IRI))
        return Role(name, least, most, tuple(settings), types, Place(self.document.source))

    def _shape(self, role: IRI) -> None:
        """Raises where the shape of a role is certainly no shape."""
        for predicate, _ in self.document.about(role):
            if predicate in ONLY_WITH_A_PATH:
                raise self._error(
                    f"the role {_show(role)} has sh:{predicate.short}, which belongs into sh:property [ sh:path ... ]"
                )
        wrong = misfit(self.document, shape_statements(self.document, role), self._variables)
        if wrong is not None:
            raise self._error(f"the shape of the role {_show(role)} is not well-formed: {wrong}")

    def _count(self, role: IRI, predicate: IRI) -> int | None:
        values = self.document.values(role, predicate)
        if not values:
            return None
        value = values[0]
        whole = isinstance(value, Literal) and value.datatype in WHOLE and _COUNT.fullmatch(value.lexical)
        if len(values) > 1 or not isinstance(value, Literal) or not whole:
            raise self._error(
                f"sc:{predicate.short} of the role {_show(role)} is one whole number from 0 on, of at most 18 digits"
            )
        return int(value.lexical)

    def _feeds(self, roles: tuple[Role, ...], known: frozenset[IRI]) -> Iterator[Interaction]:
        for role in roles:
            for sink in self.document.values(role.iri, SC.feeds):
                if sink not in known or not isinstance(sink, IRI):
                    raise self._error(
                        f"the role {_show(role.iri)} feeds {_show(sink)}, which is no role of the template"
                    )
                yield Interaction(role.iri, sink)

    def _interactions(self, known: frozenset[IRI]) -> Iterator[Interaction]:
        every_role = {
            role
            for template in self.document.instances(SC.Template)
            for role in self.document.items(self.document.value(template, SC.roles) or template)
        }
        interactions = self.document.instances(SC.Interaction)
        for node, statements in self.document.statements.items():
            speaks = {SC["from"], SC.to} <= {predicate for predicate, _ in statements}
            if speaks and node not in interactions and (TYPE, SC.Connection) not in statements:
                raise self._error("what has sc:from and sc:to is a sc:Interaction; say so with its type")
        for node in interactions:
            source = self._only(node, SC["from"], "an interaction has exactly one sc:from")
            sink = self._only(node, SC.to, "an interaction has exactly one sc:to")
            unknown = [end for end in (source, sink) if end not in known]
            if len(unknown) == 2 and source in every_role and sink in every_role:
                continue  # it belongs to another template of the same file
            if unknown or not isinstance(source, IRI) or not isinstance(sink, IRI):
                raise self._error(f"an interaction speaks of {_show(unknown[0])}, which is no role of the template")
            yield Interaction(source, sink, self._port(node, SC.output), self._port(node, SC.input))

    def _port(self, node: Node, predicate: IRI) -> str | None:
        values = self.document.values(node, predicate)
        if not values:
            return None
        if len(values) > 1 or not isinstance(values[0], Literal) or not values[0].lexical:
            raise self._error(f"sc:{predicate.short} of an interaction is the name of one port, a string")
        return values[0].lexical

    def _cost(self, template: IRI, known: frozenset[IRI]) -> Iterator[CostLevel]:
        heads = self.document.values(template, SC.cost)
        levels = self.document.items(heads[0]) if heads else []
        if len(heads) > 1 or (heads and not levels):
            raise self._error("the cost of a template is one list of levels, sc:cost ( [ sc:term ... ] )")
        for level in levels:
            terms = self.document.values(level, SC.term)
            if not terms:
                raise self._error("each level of sc:cost has at least one sc:term")
            yield tuple(self._term(term, known) for term in terms)

    def _term(self, term: Term, known: frozenset[IRI]) -> CostTerm:
        counted = self._iri(term, SC.property, "a term of sc:cost needs exactly one sc:property, an IRI")
        weight, otherwise = self._number(term, SC.weight), self._number(term, SC.otherwise)
        roles = self.document.values(term, SC.ofRole)
        role = roles[0] if roles else None
        if len(roles) > 1:
            raise self._error("a term of sc:cost has at most one sc:ofRole; write a term for each role")
        if role is not None and (role not in known or not isinstance(role, IRI)):
            raise self._error(f"a term of sc:cost counts {_show(role)}, which is no role of the template")
        return CostTerm(counted, Fraction(1) if weight is None else weight, otherwise, role)

    def _number(self, term: Term, predicate: IRI) -> Fraction | None:
        values = self.document.values(term, predicate)
        found = fraction(values[0]) if values else None
        if len(values) > 1 or (values and found is None):
            raise self._error(f"sc:{predicate.short} of a term of sc:cost is one finite number")
        return found

    def _parameters(self, template: IRI, roles: tuple[Role, ...]) -> tuple[Parameter, ...]:
        listed = self.document.values(template, SC.parameter)
        iris = frozenset(value for value in listed if isinstance(value, IRI))
        in_shapes: set[IRI] = set()
        for role in roles:
            in_shapes |= mentions(self.document, role.iri, iris)
        is_set = {setting.value for role in roles for setting in role.settings}
        parameters: list[Parameter] = []
        for value in listed:
            if not isinstance(value, IRI):
                raise self._error("a parameter of a template needs an IRI")
            name = self._only(value, SC.name, f"the parameter {_show(value)} needs exactly one sc:name")
            if not isinstance(name, Literal) or name.datatype != STRING or not _WORD.fullmatch(name.lexical):
                raise self._error(f"the sc:name of the parameter {_show(value)} is one word, a string")
            defaults = self.document.values(value, SH.defaultValue)
            if len(defaults) > 1:
                raise self._error(f"the parameter {_show(value)} has several defaults")
            default = defaults[0] if defaults else None
            if default is not None and not self._allows(value, default):
                raise self._error(
                    f"the default of the parameter {_show(value)} is not of its sh:datatype or sh:nodeKind"
                )
            parameters.append(Parameter(value, name.lexical, default, value in in_shapes, value in is_set))
        for name_, times in Counter(parameter.name for parameter in parameters).items():
            if times > 1:
                raise self._error(f"two parameters have the name {name_!r}")
        return tuple(sorted(parameters, key=lambda parameter: parameter.name))

    def _allows(self, parameter: IRI, value: Term) -> bool:
        """Whether a parameter can have a value, by its datatype and its kind."""
        kinds = [_KINDS_OF_VALUE.get(kind, object) for kind in self.document.values(parameter, SH.nodeKind)]
        datatypes = self.document.values(parameter, SH.datatype)
        datatype = value.datatype if isinstance(value, Literal) else None
        return all(isinstance(value, kind) for kind in kinds) and all(datatype == wanted for wanted in datatypes)

    def _label(self, subject: IRI) -> str | None:
        label = self.document.value(subject, LABEL)
        return label.lexical if isinstance(label, Literal) else None

    def _only(self, subject: Term, predicate: IRI, problem: str) -> Term:
        values = self.document.values(subject, predicate)
        if len(values) != 1:
            raise self._error(problem)
        return values[0]

    def _iri(self, subject: Term, predicate: IRI, problem: str) -> IRI:
        value = self._only(subject, predicate, problem)
        if not isinstance(value, IRI):
            raise self._error(problem)
        return value

    def _error(self, message: str) -> TemplateError:
        return TemplateError(message, file=self.document.source)


def _show(term: Term) -> str:
    if isinstance(term, IRI):
        return repr(term)
    return "a blank node" if isinstance(term, BlankNode) else f'"{term.lexical}"'
