"""Templates and tasks: from triples to the roles, interactions and parameters of a task.

The shape of each role stays where it is, in the document; `selfconf.rdf.eligibility` compiles it. What makes a template
readable is checked here, with one sentence per mistake; the authority is `shapes/template.ttl`, and a test holds
the two together: of a file with a wrong template or task nothing is read.
"""

from __future__ import annotations

import re
from collections import Counter

from selfconf.errors import TemplateError
from selfconf.model.immutable import immutable
from selfconf.model.profile import Place
from selfconf.model.setting_names import setting
from selfconf.model.template import MOST_PRIORITY, Role, Setting, Task, Template
from selfconf.model.term import IRI, Literal, Term
from selfconf.model.truth import truth
from selfconf.rdf.shacl import ONLY_WITH_A_PATH, misfit
from selfconf.rdf.tasks.costs import cost_of
from selfconf.rdf.tasks.interactions import interactions_of
from selfconf.rdf.tasks.mistakes import DocumentReader, worded
from selfconf.rdf.tasks.parameters import parameters_of
from selfconf.rdf.tasks.role_shapes import shape_triples
from selfconf.rdf.tasks.template_ports import template_ports
from selfconf.rdf.turtle import Document, Node
from selfconf.rdf.vocabulary import FIRST, LABEL, NIL, REST, SC, SH, TYPE, XSD

WHOLE = frozenset(XSD[name] for name in ("integer", "int", "long", "short", "nonNegativeInteger", "positiveInteger"))
_COUNT = re.compile(r"\+?[0-9]{1,18}")
_PRIORITY = re.compile(r"[+-]?[0-9]{1,300}")
_SAID_OF = {
    **dict.fromkeys((SC.feeds, SC.sets, SC.minCount, SC.maxCount, SC.recruits), (SC.Role,)),
    SC.cost: (SC.Template,),
    SC.priority: (SC.Template, SC.Task),
}
"""What is said only of instances of a class, or of one of two."""


@immutable
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
        raise TemplateError(f"it holds several; say which with {setting('template')}: {names}", file=document.source)
    if chosen in tasks:
        return TaskDocument(_Reader(document).task(chosen), document)
    return TaskDocument(Task(_Reader(document).template(chosen)), document)


def read_inside(document: Document, component: IRI) -> TaskDocument:
    """The task that a composite is inside, from the document that advertises it. Raises TemplateError."""
    grounding = document.value(component, SC.grounding)
    if grounding is None or isinstance(grounding, Literal) or not document.values(grounding, SC.template):
        raise TemplateError(
            f"{worded(component)} is no composite: its grounding has no sc:template", file=document.source
        )
    return TaskDocument(_Reader(document).task(grounding), document)


class _Reader(DocumentReader):
    """Reads one document; every method raises TemplateError with a sentence for the author."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._variables = frozenset[Term](document.instances(SC.Parameter))

    def task(self, task: Node) -> Task:
        template_iri = self.only(task, SC.template, "a task names exactly one template by sc:template")
        if template_iri not in self.document.instances(SC.Template):
            problem = f"the template {worded(template_iri)} of the task is not in this file"
            raise self.mistake(problem, task, SC.template, template_iri)
        template = self.template(template_iri)
        known = {parameter.iri for parameter in template.parameters}
        bindings: dict[IRI, Term] = {}
        for binding in self.document.values(task, SC.binding):
            parameter = self.only(binding, SC.parameter, "a binding names exactly one sc:parameter")
            value = self.only(binding, SC.value, "a binding has exactly one sc:value")
            if parameter not in known or not isinstance(parameter, IRI):
                problem = f"the task binds {worded(parameter)}, which is no parameter of its template"
                raise self.mistake(problem, binding, SC.parameter, parameter)
            if parameter in bindings:
                problem = f"the task binds the parameter {worded(parameter)} twice"
                raise self.mistake(problem, binding, SC.parameter, parameter)
            bindings[parameter] = value
        return Task(template, bindings, task if isinstance(task, IRI) else None, self._priority(task))

    def template(self, template: Node | Term) -> Template:
        if not isinstance(template, IRI):
            raise self.mistake("a template needs an IRI", template)
        names = self._listed(template)
        self._said_of_others()
        head = self.only(template, SC.roles, "")
        roles = tuple(self._role(name, self.cell(head, number)) for number, name in enumerate(names))
        return Template(
            iri=template,
            roles=roles,
            interactions=interactions_of(self.document, roles),
            parameters=parameters_of(self.document, template, roles),
            label=self._label(template),
            cost=cost_of(self.document, template, frozenset(role.iri for role in roles)),
            priority=self._priority(template) or 0,
            ports=template_ports(self.document, template, roles),
        )

    def _priority(self, subject: Node) -> int | None:
        """The priority that a task or template states, if it states one."""
        values = self.document.values(subject, SC.priority)
        if not values:
            return None
        value = values[0]
        whole = isinstance(value, Literal) and value.datatype == XSD.integer and _PRIORITY.fullmatch(value.lexical)
        if len(values) > 1 or not isinstance(value, Literal) or not whole or abs(int(value.lexical)) > MOST_PRIORITY:
            problem = (
                f"the sc:priority of {worded(subject)} is one whole number from {-MOST_PRIORITY} to {MOST_PRIORITY}"
            )
            raise self.mistake(problem, subject, SC.priority, values[-1])
        return int(value.lexical)

    def _listed(self, template: IRI) -> list[Term]:
        """The members of the list of roles."""
        head = self.only(template, SC.roles, "a template has exactly one list of roles, sc:roles ( ... )")
        names = self.document.items(head)
        end: Term | None = head
        for _ in names:
            end = self.document.value(end, REST) if end is not None else None
        if names and end != NIL:
            problem = "the list sc:roles has no end; write it in parentheses, sc:roles ( ... )"
            raise self.mistake(problem, template, SC.roles, head)
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
            for predicate, kinds in _SAID_OF.items():
                described = any((TYPE, kind) in statements for kind in kinds)
                if not described and any(said == predicate for said, _ in statements):
                    words = " or a ".join(f"sc:{kind.short}" for kind in kinds)
                    what = f"has sc:{predicate.short}, but is not described as a {words}"
                    raise self.mistake(f"{worded(subject)} {what}", subject)

    def _role(self, name: Term, cell: Term) -> Role:
        if not isinstance(name, IRI):
            raise self.mistake("every role needs an IRI", cell, FIRST, name)
        if SC.Role not in self.document.values(name, TYPE):
            problem = f"{worded(name)} stands in sc:roles, but is not described as a sc:Role"
            raise self.mistake(problem, cell, FIRST, name)
        self._shape(name)
        minimum, maximum = self._count(name, SC.minCount), self._count(name, SC.maxCount)
        least = 1 if minimum is None else minimum
        most = 1 if minimum is None and maximum is None else maximum
        if most is not None and least > most:
            problem = f"the role {worded(name)} asks for at least {least} and at most {most} components"
            raise self.mistake(problem, name, SC.minCount, *self.document.values(name, SC.minCount))
        types = tuple(value for value in self.document.values(name, SH["class"]) if isinstance(value, IRI))
        return Role(name, least, most, self._settings(name), types, self._recruits(name), Place(self.document.source))

    def _settings(self, role: IRI) -> tuple[Setting, ...]:
        """What a role sets, each once; two values for one type of parameter are a mistake."""
        nodes: dict[Setting, Term] = {}
        for node in self.document.values(role, SC.sets):
            kind = self.iri(node, SC.parameterType, f"what {worded(role)} sets needs one sc:parameterType, an IRI")
            value = self.only(node, SC.value, f"what {worded(role)} sets needs exactly one sc:value")
            nodes.setdefault(Setting(kind, value), node)
        for kind, times in Counter(one.type for one in nodes).items():
            if times > 1:
                problem = f"the role {worded(role)} sets {worded(kind)} to {times} different values"
                again = [node for setting, node in nodes.items() if setting.type == kind][1]
                raise self.mistake(problem, role, SC.sets, again)
        return tuple(nodes)

    def _recruits(self, role: IRI) -> bool:
        """Whether a role recruits: it says so, or states the shape that its suppliers have to conform to."""
        values = self.document.values(role, SC.recruits)
        if not values:
            return False
        value = values[0]
        said = truth(value)
        if len(values) > 1 or (isinstance(value, Literal) and said is None):
            problem = f"sc:recruits of the role {worded(role)} is true, false, or one shape of its suppliers"
            raise self.mistake(problem, role, SC.recruits, values[-1])
        if not isinstance(value, Literal):
            if not self.document.about(value) or self.document.value(value, FIRST) is not None:
                problem = (
                    f"the role {worded(role)} recruits what conforms to {worded(value)}, which is no shape of this file"
                )
                raise self.mistake(problem, role, SC.recruits, value)
            wrong = misfit(self.document, shape_triples(self.document, value), self._variables)
            if wrong is not None:
                problem = f"the shape of what the role {worded(role)} recruits is not well-formed: {wrong[1]}"
                raise self.mistake(problem, *wrong[0])
            return True
        return said is True

    def _shape(self, role: IRI) -> None:
        """Raises where the shape of a role is certainly no shape."""
        for predicate, value in self.document.about(role):
            if predicate in ONLY_WITH_A_PATH:
                place = "which belongs into sh:property [ sh:path ... ]"
                raise self.mistake(f"the role {worded(role)} has sh:{predicate.short}, {place}", role, predicate, value)
        wrong = misfit(self.document, shape_triples(self.document, role), self._variables)
        if wrong is not None:
            problem = f"the shape of the role {worded(role)} is not well-formed: {wrong[1]}"
            raise self.mistake(problem, *wrong[0])

    def _count(self, role: IRI, predicate: IRI) -> int | None:
        values = self.document.values(role, predicate)
        if not values:
            return None
        value = values[0]
        whole = isinstance(value, Literal) and value.datatype in WHOLE and _COUNT.fullmatch(value.lexical)
        if len(values) > 1 or not isinstance(value, Literal) or not whole:
            what = f"sc:{predicate.short} of the role {worded(role)}"
            problem = f"{what} is one whole number from 0 on, of at most 18 digits"
            raise self.mistake(problem, role, predicate, values[-1])
        return int(value.lexical)

    def _label(self, subject: IRI) -> str | None:
        label = self.document.value(subject, LABEL)
        return label.lexical if isinstance(label, Literal) else None
