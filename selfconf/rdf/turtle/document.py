"""Turtle in, plain triples out: the fast way to read what needs no line numbers.

The parser is Oxigraph's, some thirty times as fast as rdflib's; its syntax errors carry line and column.
Nothing here opens a file or a socket: the caller hands in a text, with the name by which errors call it.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import Enum
from typing import Any

import pyoxigraph as ox

from selfconf.errors import TurtleError
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.turtle.advice import with_advice
from selfconf.rdf.turtle.refused_text import TAKES_RDF_1_2, check_turtle_1_1
from selfconf.rdf.vocabulary import FIRST, NIL, REST, TYPE

Node = IRI | BlankNode
Triple = tuple[Node, IRI, Term]
SKOLEM = "urn:selfconf:blank:"
"""What IRIs begin with that stand for blank nodes with labels (RDF 1.1 Concepts, section 3.5)."""


def term(node: ox.NamedNode | ox.BlankNode | ox.Literal | ox.Triple) -> Term:
    """One of Oxigraph's terms as a value of the model."""
    if isinstance(node, ox.NamedNode):
        return resource(node.value)
    if isinstance(node, ox.Literal):
        return Literal(node.value, IRI.unchecked(node.datatype.value), node.language)
    return BlankNode(str(node))


def resource(iri: str) -> Node:
    """What an IRI names: a blank node, if it stands for one."""
    return BlankNode(f"_:{iri[len(SKOLEM) :]}") if iri.startswith(SKOLEM) else IRI.unchecked(iri)


def named(node: Node) -> str:
    """The name of a resource in Turtle: of a blank node, the IRI that would stand for it."""
    return f"<{SKOLEM}{node[2:]}>" if isinstance(node, BlankNode) else f"<{node}>"


_NO_BASE = "No scheme found in an absolute IRI"
"""What Oxigraph says of a relative IRI where it has no base."""


class ListFault(Enum):
    """What is wrong with an RDF list."""

    NO_LIST = "it has neither members nor a rest"
    CELL = "a cell of it has not exactly one member and one rest"
    ENDLESS = "a rest leads back to a cell before it"


@dataclass(slots=True)
class Document:
    """The triples of one source by subject, in the order of the text, with the prefixes it declares."""

    source: str
    statements: dict[Node, list[tuple[IRI, Term]]]
    prefixes: dict[str, str]
    base: str | None = None

    def triples(self) -> Iterator[Triple]:
        """Every triple of the document."""
        for subject, statements in self.statements.items():
            for predicate, value in statements:
                yield subject, predicate, value

    def numbered(self) -> list[Triple]:
        """Every triple, with blank nodes numbered in the order of the text: a text has the same ones each time."""
        numbers: dict[Term, BlankNode] = {}

        def of(term: Term) -> Any:
            return numbers.setdefault(term, BlankNode(f"_:{len(numbers)}")) if isinstance(term, BlankNode) else term

        return [(of(subject), predicate, of(value)) for subject, predicate, value in self.triples()]

    def about(self, subject: Term) -> list[tuple[IRI, Term]]:
        """The predicates and objects of a subject; none for a literal."""
        return [] if isinstance(subject, Literal) else self.statements.get(subject, [])

    def values(self, subject: Term, predicate: IRI) -> list[Term]:
        """The objects of a subject and predicate, in the order of the text, each once."""
        return list(dict.fromkeys(o for p, o in self.about(subject) if p == predicate))

    def value(self, subject: Term, predicate: IRI) -> Term | None:
        """The first object, or None."""
        return next(iter(self.values(subject, predicate)), None)

    def instances(self, kind: IRI) -> list[Node]:
        """The subjects that the document types as `kind` itself."""
        wanted = (TYPE, kind)
        return [subject for subject, statements in self.statements.items() if wanted in statements]

    def items(self, head: Term) -> list[Term]:
        """The members of an RDF list; a broken or circular one ends where it breaks."""
        members: list[Term] = []
        seen: set[Term] = set()
        while head != NIL and head not in seen:
            seen.add(head)
            first, rest = self.value(head, FIRST), self.value(head, REST)
            if first is None or rest is None:
                break
            members.append(first)
            head = rest
        return members

    def list_fault(self, head: Term) -> ListFault | None:
        """Why a term is no RDF list, which is cells of one member and one rest each, up to the end; None if it is."""
        passed: set[Term] = set()
        cell = head
        while cell != NIL:
            if cell in passed:
                return ListFault.ENDLESS
            passed.add(cell)
            members, rests = self.values(cell, FIRST), self.values(cell, REST)
            if len(members) != 1 or len(rests) != 1:
                return ListFault.CELL if members or rests or cell != head else ListFault.NO_LIST
            cell = rests[0]
        return None


def parse(text: str | bytes, source: str, base: str | None = None, predicates: Iterable[IRI] | None = None) -> Document:
    """Read Turtle, or of it the triples with some predicates.

    Raises TurtleError with line and column where it is not Turtle.
    """
    check_turtle_1_1(text.encode() if isinstance(text, str) else text, source)
    reader = ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri=base, rename_blank_nodes=True)
    try:
        return document_of(reader, source, base, predicates)
    except (SyntaxError, MemoryError) as error:
        raise not_turtle(error, source, text) from None


def document_of(reader: ox.QuadParser, source: str, base: str | None, predicates: Iterable[IRI] | None) -> Document:
    """What a parser of Oxigraph reads, or of it the triples with some predicates. Raises what the parser does."""
    only = None if predicates is None else frozenset(map(ox.NamedNode, predicates))
    statements: dict[Node, list[tuple[IRI, Term]]] = defaultdict(list)
    known: dict[object, Any] = {}  # a subject is never a literal, a predicate always an IRI
    for subject, predicate, value, _ in reader:
        if only is not None and predicate not in only:
            continue
        for node in (subject, predicate, value):
            if node not in known:
                if isinstance(node, ox.Triple):
                    raise SyntaxError(TAKES_RDF_1_2)
                known[node] = term(node)
        statements[known[subject]].append((known[predicate], known[value]))
    return Document(source, dict(statements), dict(reader.prefixes), base)


def not_turtle(error: SyntaxError | MemoryError, source: str, text: str | bytes) -> TurtleError:
    """Oxigraph's complaint as selfconf's: its message without the position, which the error carries on its own.

    Of a text in another format of RDF it says what to do. The parser keeps a token in a buffer of 16 MiB, and lacks
    memory for one that is larger.
    """
    from selfconf.rdf.turtle.formats import conversion, other_format  # which reads by way of this module

    other = other_format(source, text.encode() if isinstance(text, str) else text)
    if other is not None:
        message = f"this is {other.name}, where Turtle is read; convert it: {conversion(source, other)}"
        return TurtleError(message, file=source)
    if isinstance(error, MemoryError):
        return TurtleError("a literal in it is over 16 MiB, which is more than can be read", file=source)
    head, found, tail = str(error.msg).partition(": ")
    message = tail if found and head.startswith("Parser error") else str(error.msg)
    if message == _NO_BASE:
        message = "this IRI is relative, and the text is in no file that it could start from; begin with @base <...> ."
    return TurtleError(f"not Turtle: {with_advice(message)}", file=source, line=error.lineno, column=error.offset)
