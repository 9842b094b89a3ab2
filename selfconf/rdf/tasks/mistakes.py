"""Mistakes in templates and tasks, with the statement that each is about, and the place of it in the text.

Reading for speed forgets lines. So a mistake carries the way to the statement at fault from the nearest node that has
an IRI; to find its place, the text is read once more by the parser that knows places, and the way is followed there.
"""

from __future__ import annotations

from selfconf.errors import TemplateError
from selfconf.model.term import IRI, BlankNode, Term
from selfconf.rdf.turtle import Document, Node
from selfconf.rdf.vocabulary import REST

Steps = tuple[tuple[str, int], ...]


class DocumentReader:
    """Reads values from one document; every method raises TemplateError with a sentence for the author."""

    def __init__(self, document: Document) -> None:
        self.document = document

    def only(self, subject: Term, predicate: IRI, problem: str) -> Term:
        """The value of a property that has exactly one."""
        values = self.document.values(subject, predicate)
        if len(values) != 1:
            raise self.mistake(problem, subject, predicate, *values[1:2])
        return values[0]

    def iri(self, subject: Term, predicate: IRI, problem: str) -> IRI:
        """The value of a property that has exactly one, an IRI."""
        value = self.only(subject, predicate, problem)
        if not isinstance(value, IRI):
            raise self.mistake(problem, subject, predicate, value)
        return value

    def cell(self, head: Term, number: int) -> Term:
        """A cell of a list, counted from zero."""
        for _ in range(number):
            head = self.document.value(head, REST) or head
        return head

    def mistake(self, message: str, subject: Term, predicate: IRI | None = None, *values: Term) -> TemplateError:
        """An error about a subject, or about one value of a predicate of it."""
        root, steps = _way(self.document, subject)
        if root is None and not steps:
            return TemplateError(message, file=self.document.source)
        if predicate is not None and values and values[0] in (said := self.document.values(subject, predicate)):
            steps = *steps, (predicate, said.index(values[0]))
        return TemplateError(message, file=self.document.source, subject=root, steps=steps)


def _way(document: Document, node: Term) -> tuple[IRI | None, Steps]:
    """From which IRI a node is reached, and how; nothing where it is reached from blank nodes in a circle."""
    steps: Steps = ()
    seen: set[tuple[Node, IRI]] = set()
    while not isinstance(node, IRI):
        above = next(((s, p) for s, p, value in document.triples() if value == node), None)
        if above is None:
            roots = _roots(document)
            return (None, (("", roots.index(node)), *steps)) if node in roots else (None, ())
        if above in seen:
            return None, ()
        seen.add(above)
        subject, predicate = above
        steps = (predicate, document.values(subject, predicate).index(node)), *steps
        node = subject
    return node, steps


def _roots(document: Document) -> list[Node]:
    """The blank nodes that something is said of and to which nothing leads, in the order of the text."""
    values = {value for _, _, value in document.triples()}
    return [node for node in document.statements if isinstance(node, BlankNode) and node not in values]


def worded(term: Term) -> str:
    """A term as a message names it."""
    if isinstance(term, IRI):
        return repr(term)
    return "a blank node" if isinstance(term, BlankNode) else f'"{term.lexical}"'


def misplaced(parameter: Term, predicate: IRI) -> str:
    """The sentence about a parameter that stands for something that is the same for all tasks of a template."""
    return (
        f"the parameter {worded(parameter)} cannot stand for sc:{predicate.short}, which is the same for all tasks of "
        "a template; parameters stand in shapes, for what sc:sets sets, and for the sc:property of a cost"
    )


def placed(error: TemplateError, text: str, base: str) -> TemplateError:
    """The error with the line and column of what it speaks of, where that can be found in the text of the file."""
    from selfconf.rdf.positions import NotTurtleError, parse_with_positions  # loads rdflib

    if error.subject is None and not error.steps:
        return error
    try:
        _, positions = parse_with_positions(text, error.file or "", base)
    except (NotTurtleError, RecursionError):
        return error
    place = positions.at_the_end_of(error.subject, error.steps)
    if place is None:
        return error
    return TemplateError(
        error.message,
        file=error.file,
        line=place.line,
        column=place.column,
        subject=error.subject,
        steps=error.steps,
    )
