"""`template`: a task specification, to be bound and configured (section 3.1 of the paper)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import field
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING

from selfconf.api.arguments import checked_text
from selfconf.api.document_texts import text_of
from selfconf.api.tables import Tabular
from selfconf.errors import BindingError, ProgrammerError, TemplateError
from selfconf.model.immutable import immutable, replace
from selfconf.model.setting_names import binding, setting
from selfconf.model.template import Parameter, Role
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf import tasks, turtle
from selfconf.rdf.tasks import TaskDocument
from selfconf.rdf.vocabulary import XSD
from selfconf.render import Names

if TYPE_CHECKING:
    import rdflib

Value = str | int | float | Decimal | IRI | Literal
"""What a parameter can be bound to: a string is a CURIE in the template's prefixes, an `<IRI>`, a Turtle literal or
plain words; a number or truth value stands for the literal of its kind."""


@immutable
class TaskSpecification(Tabular):
    """A template with values for some of its parameters. Immutable: `bind` returns another one.

    Two are equal if their texts, and where these are from, and the values of their parameters are.

    >>> template("examples/clock/tell-the-time.ttl")
    <task :tell-the-time>
               name     asks for, or is
    ---------  -------  ---------------
    role       :source  :Clock
    role       :screen  rob:Display
    parameter  room     (free)
    """

    document: TaskDocument
    texts: tuple[str, ...] = field(default=(), repr=False, compare=False)
    """What it was read from, if that is text in no file, in which lines are looked up; else none."""

    @property
    def iri(self) -> IRI:
        """The name of the template."""
        return self.document.template.iri

    @property
    def roles(self) -> tuple[Role, ...]:
        """The roles of the template, in its order."""
        return self.document.template.roles

    @property
    def parameters(self) -> tuple[Parameter, ...]:
        """The parameters of the template, by name."""
        return self.document.template.parameters

    @property
    def bindings(self) -> dict[str, Term]:
        """The values that parameters are bound to, by name."""
        return self.document.task.by_name()

    @property
    def names(self) -> Names:
        """Shortens IRIs by the prefixes of the template's document."""
        return Names(self.document.document.prefixes)

    def bind(self, /, **values: Value) -> TaskSpecification:
        """The task with values for its parameters by name.

        Text is read as `--bind` reads it: `:kitchen` is a CURIE in the prefixes of the template, `<urn:x>` an IRI, `7`,
        `true` and `"7"` are literals of Turtle, and other words are a string; `Literal("7")` is a string in any case.
        Raises BindingError for what cannot be bound, and for a parameter that is bound already: a value does not
        change, so bind it on the task as it was before.

        >>> template("examples/clock/tell-the-time.ttl").bind(room=":kitchen").bindings
        {'room': <https://example.org/my-home#kitchen>}
        """
        return replace(self, document=tasks.bind(self.document, [(n, _text(n, v)) for n, v in values.items()]))

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, TaskSpecification):
            return NotImplemented
        own, others = self.document.document, other.document.document
        if (self.iri, self.bindings, own.source, own.base) != (other.iri, other.bindings, others.source, others.base):
            return False
        return own is others or (own.prefixes == others.prefixes and own.numbered() == others.numbered())

    def __hash__(self) -> int:
        return hash((self.iri, self.document.document.source, frozenset(self.bindings.items())))

    def complete(self) -> TaskSpecification:
        """The task with defaults filled in and every value checked. Raises BindingError."""
        return replace(self, document=tasks.complete(self.document))

    def _head(self) -> Sequence[str]:
        return "", "name", "asks for, or is"

    def _cells(self) -> Iterator[list[str]]:
        names, bound = self.names, self.bindings
        yield from (["role", names(role.iri), ", ".join(map(names, role.types))] for role in self.roles)
        for parameter in self.parameters:
            value = bound.get(parameter.name)
            if value is not None:
                shown = names(value)
            else:
                shown = "(free)" if parameter.default is None else f"{names(parameter.default)}  (default)"
            yield ["parameter", parameter.name, shown]

    def __repr__(self) -> str:
        return f"<task {self.names(self.iri)}>\n{Tabular.__repr__(self)}"


def template(source: str | Path | rdflib.Graph, name: str | None = None) -> TaskSpecification:
    """The template or task in a file, in Turtle text, or in an rdflib graph; `name` says which, where it holds several.

    Raises TemplateError with file, line and column for what is Turtle but no template, TurtleError and AuthorError for
    what cannot be read, and ProgrammerError for what is no source or no name.

    >>> [role.iri.short for role in template("examples/clock/tell-the-time.ttl").roles]
    ['source', 'screen']
    """
    read = text_of(source)
    document = turtle.parse(*read)
    wanted = None
    if name is not None:
        checked_text(name, "the name of a template")
        term = name if isinstance(name, IRI) else tasks.read_term(name, document.prefixes)
        if not isinstance(term, IRI):
            raise BindingError(f"a template is named by a CURIE or an <IRI>, not by {name!r}")
        wanted = term
    try:
        return TaskSpecification(tasks.read_task(document, wanted), read.in_no_file)
    except TemplateError as error:
        raise tasks.placed(error, read.octets.decode(), read.base or "file:///") from None


def completed(task: object) -> TaskSpecification:
    """A task with defaults filled in and every value checked. Raises BindingError, ProgrammerError for what is none."""
    if not isinstance(task, TaskSpecification):
        raise ProgrammerError(f"a task is what selfconf.template() gives, not {type(task).__name__}")
    return task.complete()


def pairs(bound: Iterable[str]) -> dict[str, str]:
    """NAME=TERM taken apart, as on a command line. Raises BindingError."""
    found: dict[str, str] = {}
    for text in bound:
        name, equals, term = text.partition("=")
        if not equals or not name:
            example = binding("robot", ":Astrid")
            raise BindingError(f"{setting('bind')} takes NAME=TERM, not {text!r}; for example {example}")
        if name.strip() in found:
            raise BindingError(f"the parameter {name.strip()!r} is bound twice")
        found[name.strip()] = term
    return found


_UNUSUAL = {"inf": "INF", "-inf": "-INF", "nan": "NaN"}
"""What XSD writes otherwise than Python does."""


def _number(name: str, value: bool | int | float | Decimal) -> Literal:
    """The literal of a number or truth value. Their classes may have heirs that print otherwise."""
    if isinstance(value, bool):
        return Literal(str(value).lower(), XSD.boolean)
    if isinstance(value, int):
        return Literal(int.__repr__(value), XSD.integer)
    if isinstance(value, float):
        text = float.__repr__(value)
        return Literal(_UNUSUAL.get(text, text), XSD.double)
    if not value.is_finite():
        raise BindingError(f"{name} cannot be {value}: xsd:decimal has no such number; float({str(value)!r}) has")
    return Literal(format(value, "f"), XSD.decimal)  # xsd:decimal knows no exponents


def _checked_literal(name: str, value: Literal) -> Literal:
    """A literal that a program has made. Raises BindingError where its parts are of other classes than those of one."""
    language = value.language
    if isinstance(value.lexical, str) and isinstance(value.datatype, IRI) and isinstance(language, str | None):
        return value
    raise BindingError(
        f"a Literal has a text, an IRI as its datatype, and a language or None; {name} is not, by {value!r}"
    )


def _text(name: str, value: Value) -> str | Term:
    """A value as the reader of terms takes it: text, or a term."""
    if getattr(value, "shape", None) == ():  # a number or truth value of NumPy: what Python has for it
        value = value.item()  # type: ignore[union-attr]  # what has a shape has this, too
    if isinstance(value, bool | int | float | Decimal):
        return _number(name, value)
    if isinstance(value, IRI):
        return value
    if isinstance(value, Literal):
        return _checked_literal(name, value)
    if hasattr(value, "n3"):  # one of rdflib's terms; they are strings too
        from selfconf.rdf.rdflib_terms import from_rdflib

        value = from_rdflib(value)  # type: ignore[arg-type]  # no other text has a method `n3`
        if not isinstance(value, BlankNode):
            return value
    if not isinstance(value, str):
        raise BindingError(f"a parameter is bound to text, a number, an IRI or a Literal; {name} is not, by {value!r}")
    if isinstance(value, BlankNode) or value.startswith("_:"):
        raise BindingError(f"{value} is a blank node, which has a name in its own file alone; bind {name} to an IRI")
    return value
