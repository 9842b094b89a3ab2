"""The roles of a template: how many components each asks for, what it sets, and the statements that make up its shape.

The shape of a role stays where it is, in the document of its template; `selfconf.rdf.eligibility` compiles it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence

from selfconf.model.immutable import replace
from selfconf.model.literal_values import plain_number, truth
from selfconf.model.profile import Place
from selfconf.model.template import Role, Setting
from selfconf.model.term import IRI, Literal, Term
from selfconf.model.wording import counted
from selfconf.rdf.shacl import ONLY_WITH_A_PATH, component_parameters, misfit
from selfconf.rdf.tasks.mistakes import DocumentReader, worded
from selfconf.rdf.turtle import Document, Node, Triple
from selfconf.rdf.vocabulary import FIRST, SC, SH, TYPE, XSD

ROLE_STRUCTURE = frozenset((TYPE, SC.feeds, SC.sets, SC.minCount, SC.maxCount, SC.recruits))
"""What is said of a role besides its shape."""
WHOLE = frozenset(XSD[name] for name in ("integer", "int", "long", "short", "nonNegativeInteger", "positiveInteger"))
BEYOND_COUNTING = 10**18
"""No role asks for so many components."""


def roles_of(document: Document, head: Term, names: Sequence[Term]) -> tuple[Role, ...]:
    """The roles of a template, from the head and the members of its list of them. Raises TemplateError."""
    reader = _RoleReader(document)
    return tuple(reader.role(name, reader.cell(head, number)) for number, name in enumerate(names))


class _RoleReader(DocumentReader):
    """Reads the roles of a template; every method raises TemplateError with a sentence for the author."""

    def __init__(self, document: Document) -> None:
        super().__init__(document)
        self._variables = frozenset[Term](document.instances(SC.Parameter))

    def role(self, name: Term, cell: Term) -> Role:
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
            problem = f"the role {worded(name)} asks for at least {least} and at most {counted(most, 'component')}"
            raise self.mistake(problem, name, SC.minCount, *self.document.values(name, SC.minCount))
        types = tuple(value for value in self.document.values(name, SH["class"]) if isinstance(value, IRI))
        return Role(name, least, most, self._settings(name), types, self._recruits(name), Place(self.document.source))

    def _settings(self, role: IRI) -> tuple[Setting, ...]:
        """What a role sets, each once; two values for one type of parameter are a mistake."""
        nodes: dict[Setting, Term] = {}
        for node in self.document.values(role, SC.sets):
            if node in self._variables:
                problem = f"what {worded(role)} sets is {worded(node)} itself, not a node with a type and a value"
                raise self.mistake(problem, role, SC.sets, node)
            kind = self.iri(node, SC.parameterType, f"what {worded(role)} sets needs one sc:parameterType, an IRI")
            value = self.only(node, SC.value, f"what {worded(role)} sets needs exactly one sc:value")
            nodes.setdefault(Setting(kind, value), node)
        for kind, times in Counter(one.type for one in nodes).items():
            if times > 1:
                problem = f"the role {worded(role)} sets {worded(kind)} to {times} different values"
                again = [node for setting, node in nodes.items() if setting.type == kind][1]
                raise self.mistake(problem, again, SC.parameterType, kind)
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
            if predicate == SH.path or predicate in ONLY_WITH_A_PATH:
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
        number = plain_number(value) if isinstance(value, Literal) and value.datatype in WHOLE else None
        if len(values) > 1 or not isinstance(number, int) or not 0 <= number < BEYOND_COUNTING:
            what = f"sc:{predicate.short} of the role {worded(role)}"
            problem = f"{what} is one whole number from 0 on, of at most 18 digits"
            raise self.mistake(problem, role, predicate, values[-1])
        return number


def substituted(document: Document, values: Mapping[IRI, Term]) -> Document:
    """A template with parameters replaced by their values wherever they stand in shapes: in lists and paths too.

    And where constraint components of the document itself (SHACL, section 6) have them as values of their parameters.
    """
    if not values:
        return document
    own = component_parameters(document)
    statements = {
        subject: [
            (predicate, values[value])
            if isinstance(value, IRI)
            and value in values
            and (predicate in SH or predicate == FIRST or predicate in own)
            else (predicate, value)
            for predicate, value in said
        ]
        for subject, said in document.statements.items()
    }
    return replace(document, statements=statements)


def mentions(document: Document, shape: Term, parameters: frozenset[IRI]) -> set[IRI]:
    """The parameters that stand somewhere in a shape, such as that of a role."""
    found: set[IRI] = set()
    for _, value in [] if isinstance(shape, Literal) else shape_statements(document, shape):
        if value in parameters and isinstance(value, IRI):
            found.add(value)
    return found


def shape_statements(document: Document, role: Node) -> Iterator[tuple[IRI, Term]]:
    """Predicate and object of each statement of a role's shape, nested and named shapes included."""
    for _, predicate, value in shape_triples(document, role):
        yield predicate, value


def shape_triples(document: Document, role: Node) -> Iterator[Triple]:
    """Each statement of a role's shape, nested and named shapes included."""
    waiting: list[Node] = [role]
    seen: set[Term] = {role}
    while waiting:
        subject = waiting.pop()
        for predicate, value in document.statements.get(subject, ()):
            if subject == role and predicate in ROLE_STRUCTURE:
                continue
            yield subject, predicate, value
            if not isinstance(value, Literal) and value not in seen:
                seen.add(value)
                waiting.append(value)
