"""What an importer yields: Turtle files to be written, and what of the sources is not in them.

Every format comes down to components with ports and operations. A component becomes a `Description`, which is what the
writer of Turtle takes; a format that is RDF already makes descriptions without the detour.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import field

from selfconf.model.immutable import immutable, replace
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.model.wording import listed
from selfconf.rdf.vocabulary import LABEL, SC, TYPE, XSD


@immutable
class NestedNode:
    """A node without a name, written in brackets where it stands."""

    statements: tuple[DescribedStatement, ...]


@immutable
class TermList:
    """An RDF list, written in parentheses."""

    members: tuple[DescribedValue, ...]


DescribedValue = Term | NestedNode | TermList
DescribedStatement = tuple[IRI, tuple[DescribedValue, ...]]


@immutable
class Description:
    """All that a file says of one subject, in the order in which it is written."""

    subject: IRI | BlankNode
    statements: tuple[DescribedStatement, ...]

    def with_statement(self, predicate: IRI, *values: DescribedValue) -> Description:
        """The description with one statement more, at its end."""
        return replace(self, statements=(*self.statements, (predicate, values)))

    def values(self, predicate: IRI) -> tuple[DescribedValue, ...]:
        """The values of a predicate."""
        return tuple(value for found, values in self.statements if found == predicate for value in values)


@immutable
class ImportedPort:
    """An input or output: its name, any number of signal types, and what else the source says of it."""

    name: str
    types: tuple[IRI, ...] = ()
    unit: IRI | None = None
    optional: bool = False
    depth: int | None = None
    properties: tuple[tuple[IRI, DescribedValue], ...] = ()

    def node(self) -> NestedNode:
        """The port as an advertisement states it."""
        return _nested(
            (SC.name, Literal(self.name)),
            *((SC.signalType, kind) for kind in self.types),
            (SC.unit, self.unit),
            (SC.depth, None if self.depth is None else Literal(str(self.depth), XSD.integer)),
            (SC.optional, TRUE if self.optional else None),
            *self.properties,
        )


@immutable
class ImportedOperation:
    """An operation that a component offers or needs: its name, what a request and what a response is."""

    name: str
    request: IRI | None = None
    response: IRI | None = None
    optional: bool = False
    properties: tuple[tuple[IRI, Term], ...] = ()

    def node(self) -> NestedNode:
        """The operation as an advertisement states it."""
        return _nested(
            (SC.name, Literal(self.name)),
            (SC.request, self.request),
            (SC.response, self.response),
            (SC.optional, TRUE if self.optional else None),
            *self.properties,
        )


FEW = 2
"""How many sources a sentence names; the rest become a number."""
TRUE = Literal("true", XSD.boolean)


@immutable
class ImportedComponent:
    """A component as some other format describes it."""

    iri: IRI
    types: tuple[IRI, ...]
    labels: tuple[Literal, ...] = ()
    properties: tuple[tuple[IRI, Term], ...] = ()
    inputs: tuple[ImportedPort, ...] = ()
    outputs: tuple[ImportedPort, ...] = ()
    parameters: tuple[tuple[str, IRI], ...] = ()
    """The name and type of each operational parameter."""
    operations: tuple[ImportedOperation, ...] = ()
    needs: tuple[ImportedOperation, ...] = ()

    def described(self) -> Description:
        """The component as an advertisement."""
        parameters = (_nested((SC.name, Literal(name)), (SC.parameterType, kind)) for name, kind in self.parameters)
        statements: list[tuple[IRI, tuple[DescribedValue, ...]]] = [
            (TYPE, (SC.Component, *self.types)),
            (LABEL, self.labels),
            *grouped(self.properties),
            (SC.hasInput, tuple(port.node() for port in self.inputs)),
            (SC.hasOutput, tuple(port.node() for port in self.outputs)),
            (SC.hasParameter, tuple(parameters)),
            (SC.hasOperation, tuple(operation.node() for operation in self.operations)),
            (SC.needsOperation, tuple(operation.node() for operation in self.needs)),
        ]
        return Description(self.iri, tuple((predicate, values) for predicate, values in statements if values))


def _nested(*pairs: tuple[IRI, DescribedValue | None]) -> NestedNode:
    """A node with those of some statements that have a value."""
    return NestedNode(grouped((predicate, value) for predicate, value in pairs if value is not None))


def grouped(pairs: Iterable[tuple[IRI, DescribedValue]]) -> tuple[DescribedStatement, ...]:
    """Statements with the values of each predicate together, in the order in which both come first.

    A term is stated once; two nodes without a name are two, even if the same is said of both.
    """
    values: dict[IRI, list[DescribedValue]] = {}
    stated: set[tuple[IRI, Term]] = set()
    for predicate, value in pairs:
        each = values.setdefault(predicate, [])
        if isinstance(value, NestedNode | TermList):
            each.append(value)
        elif (predicate, value) not in stated:
            stated.add((predicate, value))
            each.append(value)
    return tuple((predicate, tuple(each)) for predicate, each in values.items())


@immutable
class ImportedDocument:
    """A Turtle file to be: where it goes, without its ending, what it was made from, and what stands in it."""

    name: str
    source: str
    descriptions: tuple[Description, ...]
    prefixes: Mapping[str, str] = field(default_factory=dict)
    """Prefixes that the source declares."""

    def subjects(self, kind: IRI) -> Iterator[Description]:
        """The descriptions of what is declared to be of a class."""
        return (each for each in self.descriptions if kind in each.values(TYPE))


@immutable
class Omission:
    """Something of a source that is not in the advertisements, why, and how often."""

    what: str
    reason: str
    sources: tuple[str, ...]
    number: int = 1

    def __str__(self) -> str:
        first, others = self.sources[:FEW], len(self.sources) - FEW
        where = listed([*first, f"{others} others"] if others > 1 else self.sources)
        return f"left out {self.what} ({self.number}): {self.reason}; in {where}"


@immutable
class Renaming:
    """A component that got another name than its source gives it, because that one is taken."""

    component: IRI
    was: IRI
    source: str

    def __str__(self) -> str:
        return f"{self.source}: another component is called {self.was} already; here it is called {self.component}"
