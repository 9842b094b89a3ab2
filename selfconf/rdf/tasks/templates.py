"""Templates and tasks: from triples to the roles, interactions, parameters, costs and ports of a task.

What makes a template readable is checked here, with one sentence per mistake; the authority is `shapes/template.ttl`,
and a test holds the two together: no wrong template or task is read, whatever else the file has.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from fractions import Fraction

from selfconf.errors import TemplateError
from selfconf.model.cost import CostLevel, CostTerm
from selfconf.model.immutable import immutable
from selfconf.model.literal_values import fraction, integer
from selfconf.model.profile import Condition, Input, Output, needed_operation, offered_operation
from selfconf.model.setting_names import setting
from selfconf.model.template import MOST_PRIORITY, Role, Task, Template, TemplatePort
from selfconf.model.term import IRI, Literal, Term
from selfconf.model.wording import in_full
from selfconf.rdf.permitted_fields import NAME_TEXT, NAMED_OR_TEXT, SAID_BY
from selfconf.rdf.tasks.interactions import interactions_of
from selfconf.rdf.tasks.mistakes import DocumentReader, misplaced, worded
from selfconf.rdf.tasks.parameters import misfits, parameters_of
from selfconf.rdf.tasks.roles import roles_of
from selfconf.rdf.turtle import Document, ListFault, Node
from selfconf.rdf.vocabulary import FIRST, LABEL, SC, TYPE

_PORT_LINKS = (SC.hasInput, SC.needsOperation, SC.hasOutput, SC.hasOperation)
_SAID_OF = {
    SC[name]: SAID_BY[SC[name]] for name in ("feeds", "sets", "minCount", "maxCount", "recruits", "cost", "priority")
}
"""What is said only of instances of a class, or of one of two."""
_FIXED = frozenset(
    SC[name] for name in ("minCount", "maxCount", "recruits", "output", "input", "weight", "otherwise", "priority")
)
"""What is the same for all tasks of a template, so that no parameter can stand there."""
_FIXED_OF_PORTS = frozenset(SC[name] for name in ("name", "signalType", "unit", "frame", "request", "response"))
"""What else is so where a port of the template says it."""
_BROKEN = {
    ListFault.NO_LIST: "{head} is no list of roles",
    ListFault.CELL: "each cell of the list sc:roles has exactly one rdf:first and one rdf:rest",
    ListFault.ENDLESS: "the list sc:roles has no end",
}


@immutable
class TaskDocument:
    """A task with the document that holds the shapes of its roles."""

    task: Task
    document: Document

    @property
    def template(self) -> Template:
        """The template of the task."""
        return self.task.template


def read_task(document: Document, wanted: IRI | None = None) -> TaskDocument:
    """The task or template of a document; `wanted` names one where there are several. Raises TemplateError."""
    tasks, templates = document.instances(SC.Task), document.instances(SC.Template)
    if not templates and not tasks:
        raise TemplateError("no sc:Template and no sc:Task in it; is it the right file?", file=document.source)
    if wanted is not None:
        if wanted not in tasks and wanted not in templates:
            names = ", ".join(sorted(repr(node) for node in {*tasks, *templates}))
            raise TemplateError(f"there is no template or task {wanted!r} in it; it has {names}", file=document.source)
        chosen: Node = wanted
    elif len(tasks or templates) == 1:
        chosen = (tasks or templates)[0]
    else:
        names = ", ".join(sorted(repr(node) for node in tasks or templates))
        raise TemplateError(f"it holds several; say which with {setting('template')}: {names}", file=document.source)
    if chosen in tasks:
        return TaskDocument(_Reader(document).task(chosen), document)
    return TaskDocument(Task(_Reader(document).template(chosen)), document)


class InsideReader:
    """Reads what the composites of one document are inside; of a template that many have inside it is read once."""

    def __init__(self, document: Document) -> None:
        self._document, self._reader = document, _Reader(document)

    def read(self, component: IRI) -> TaskDocument:
        """The task that a composite is inside. Raises TemplateError."""
        document = self._document
        grounding = document.value(component, SC.grounding)
        if grounding is None or isinstance(grounding, Literal) or not document.values(grounding, SC.template):
            raise TemplateError(
                f"{worded(component)} is no composite: its grounding has no sc:template", file=document.source
            )
        return TaskDocument(self._reader.task(grounding), document)


class _Reader(DocumentReader):
    """Reads one document; every method raises TemplateError with a sentence for the author."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._templates: dict[Term, Template] = {}

    def task(self, task: Node) -> Task:
        template_iri = self.only(task, SC.template, "a task names exactly one template by sc:template")
        if (TYPE, SC.Template) not in self.document.about(template_iri):
            problem = f"the template {worded(template_iri)} of the task is not in this file"
            raise self.mistake(problem, task, SC.template, template_iri)
        template = self.template(template_iri)
        known = {parameter.iri: parameter for parameter in template.parameters}
        bindings: dict[IRI, Term] = {}
        for binding in self.document.values(task, SC.binding):
            if binding in known:
                problem = f"the task has the binding {worded(binding)}, which is no node with a parameter and a value"
                raise self.mistake(problem, task, SC.binding, binding)
            parameter = self.only(binding, SC.parameter, "a binding names exactly one sc:parameter")
            value = self.only(binding, SC.value, "a binding has exactly one sc:value")
            if parameter not in known or not isinstance(parameter, IRI):
                problem = f"the task binds {worded(parameter)}, which is no parameter of its template"
                raise self.mistake(problem, binding, SC.parameter, parameter)
            if parameter in bindings:
                problem = f"the task binds the parameter {worded(parameter)} twice"
                raise self.mistake(problem, binding, SC.parameter, parameter)
            for reason in misfits(known[parameter], (value,), self.document).values():
                what = f"{in_full([value])} cannot stand for the parameter {known[parameter].name!r}"
                problem = f"{what}: {reason.rstrip('.')}"
                raise self.mistake(problem, binding, SC.value, value)
            bindings[parameter] = value
        return Task(template, bindings, task if isinstance(task, IRI) else None, self._priority(task))

    def template(self, template: Term) -> Template:
        if template not in self._templates:
            self._templates[template] = self._template(template)
        return self._templates[template]

    def _template(self, template: Term) -> Template:
        if not isinstance(template, IRI):
            raise self.mistake("a template needs an IRI", template)
        names = self._listed(template)
        self._said_of_others()
        self._without_parameters(template)
        head = self.only(template, SC.roles, "")
        roles = roles_of(self.document, head, names)
        return Template(
            iri=template,
            roles=roles,
            interactions=interactions_of(self.document, roles),
            parameters=parameters_of(self.document, template, roles),
            label=self._label(template),
            cost=cost_of(self.document, template, frozenset(role.iri for role in roles)),
            priority=self._priority(template) or 0,
            ports=_template_ports(self.document, template, roles),
        )

    def _priority(self, subject: Node) -> int | None:
        """The priority that a task or template states, if it states one."""
        values = self.document.values(subject, SC.priority)
        if not values:
            return None
        priority = integer(values[0])
        if len(values) > 1 or priority is None or abs(priority) > MOST_PRIORITY:
            problem = (
                f"the sc:priority of {worded(subject)} is one whole number from {-MOST_PRIORITY} to {MOST_PRIORITY}"
            )
            raise self.mistake(problem, subject, SC.priority, values[-1])
        return priority

    def _listed(self, template: IRI) -> list[Term]:
        """The members of the list of roles."""
        head = self.only(template, SC.roles, "a template has exactly one list of roles, sc:roles ( ... )")
        fault = self.document.list_fault(head)
        if fault is not None:
            problem = f"{_BROKEN[fault].format(head=worded(head))}; write it in parentheses, sc:roles ( ... )"
            raise self.mistake(problem, template, SC.roles, head)
        names = self.document.items(head)
        if not names:
            problem = "the list sc:roles is empty; a template needs at least one role"
            raise self.mistake(problem, template, SC.roles, head)
        for name, times in Counter(names).items():
            if times > 1:
                problem = f"the role {worded(name)} stands {times} times in sc:roles"
                again = names.index(name, names.index(name) + 1)
                raise self.mistake(problem, self.cell(head, again), FIRST, name)
        return names

    def _said_of_others(self) -> None:
        """Raises where something is said that is said of roles or templates alone."""
        for subject, statements in self.document.statements.items():
            if _SAID_OF.keys().isdisjoint([said for said, _ in statements]):
                continue  # nearly all that a file says
            for predicate, kinds in _SAID_OF.items():
                described = any((TYPE, kind) in statements for kind in kinds)
                if not described and any(said == predicate for said, _ in statements):
                    words = " or a ".join(f"sc:{kind.short}" for kind in kinds)
                    what = f"has sc:{predicate.short}, but is not described as a {words}"
                    raise self.mistake(f"{worded(subject)} {what}", subject)

    def _without_parameters(self, template: IRI) -> None:
        """Raises where a parameter stands for something that is the same for all tasks."""
        parameters = frozenset[Term](self.document.instances(SC.Parameter))
        ports = frozenset(port for link in _PORT_LINKS for port in self.document.values(template, link))
        for subject, predicate, value in self.document.triples() if parameters else ():
            fixed = predicate in _FIXED or (predicate in _FIXED_OF_PORTS and subject in ports)
            if fixed and value in parameters:
                raise self.mistake(misplaced(value, predicate), subject, predicate, value)

    def _label(self, subject: IRI) -> str | None:
        label = self.document.value(subject, LABEL)
        return label.lexical if isinstance(label, Literal) else None


def cost_of(document: Document, template: IRI, roles: frozenset[IRI]) -> tuple[CostLevel, ...]:
    """The levels of the cost of a template with some roles, each of terms of properties. Raises TemplateError."""
    return tuple(_CostReader(document).levels(template, roles))


class _CostReader(DocumentReader):
    """Reads the levels of a cost; every method raises TemplateError with a sentence for the author."""

    def levels(self, template: IRI, roles: frozenset[IRI]) -> Iterator[CostLevel]:
        heads = self.document.values(template, SC.cost)
        levels = self.document.items(heads[0]) if heads else []
        if len(heads) > 1 or (heads and not levels):
            problem = "the cost of a template is one list of levels, sc:cost ( [ sc:term ... ] )"
            raise self.mistake(problem, template, SC.cost, heads[-1])
        for level in levels:
            terms = self.document.values(level, SC.term)
            if not terms:
                raise self.mistake("each level of sc:cost has at least one sc:term", level)
            yield tuple(self._term(term, roles) for term in terms)

    def _term(self, term: Term, known: frozenset[IRI]) -> CostTerm:
        counted = self.iri(term, SC.property, "a term of sc:cost needs exactly one sc:property, an IRI")
        weight, otherwise = self._number(term, SC.weight), self._number(term, SC.otherwise)
        roles = self.document.values(term, SC.ofRole)
        role = roles[0] if roles else None
        if len(roles) > 1:
            problem = "a term of sc:cost has at most one sc:ofRole; write a term for each role"
            raise self.mistake(problem, term, SC.ofRole, roles[1])
        if role is not None and (role not in known or not isinstance(role, IRI)):
            problem = f"a term of sc:cost counts {worded(role)}, which is no role of the template"
            raise self.mistake(problem, term, SC.ofRole, role)
        return CostTerm(counted, Fraction(1) if weight is None else weight, otherwise, role)

    def _number(self, term: Term, predicate: IRI) -> Fraction | None:
        values = self.document.values(term, predicate)
        found = fraction(values[0]) if values else None
        if len(values) > 1 or (values and found is None):
            problem = f"sc:{predicate.short} of a term of sc:cost is one finite number"
            raise self.mistake(problem, term, predicate, values[-1])
        return found


def _template_ports(document: Document, template: IRI, roles: tuple[Role, ...]) -> tuple[TemplatePort, ...]:
    """The ports of a template with some roles, inputs and needed operations first, by name. Raises TemplateError."""
    found = [*_PortReader(document).ports(template, frozenset(role.iri for role in roles))]
    return tuple(sorted(found, key=lambda port: (not port.is_input, port.name)))


class _PortReader(DocumentReader):
    """Reads the ports of a template; every method raises TemplateError with a sentence for the author."""

    def ports(self, template: IRI, roles: frozenset[IRI]) -> Iterator[TemplatePort]:
        for link in _PORT_LINKS:
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
