"""Turtle with the place of every triple: line and column of its subject, its predicate and its object.

An RDF graph has no lines, and rdflib's parser forgets them; a report that says which file is wrong, but
not where, leaves the search to its reader. rdflib's Turtle parser hands every term on together with its
offset in the text, though, so a subclass can write the offsets down as they go by. The methods it
overrides are private to rdflib: `tests/rdf/test_positions.py` pins them, and checks every position
against a tokenizer that shares nothing with them.

The parser works depth first. An object list is complete before its statements are made, so each keeps the
offsets of its own objects until then; each list in parentheses does so with its members, which have a
cell each.
"""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator, MutableSequence, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from rdflib import RDF, XSD, BNode, Graph, Literal, URIRef
from rdflib.plugins.parsers.notation3 import BadSyntax, RDFSink, SinkParser
from rdflib.term import Node

from selfconf.rdf.rdflib_literals import literal
from selfconf.rdf.subject_lines import with_plain_lines

RdflibTriple = tuple[Node, Node, Node]

_BLANK = re.compile(r"(?:[ \t\r\n]+|#[^\n]*)*")
_NUMBER = re.compile(
    r"(?P<double>[+-]?(?:[0-9]+\.[0-9]*|\.?[0-9]+)[eE][+-]?[0-9]+)"
    r"|(?P<decimal>[+-]?[0-9]*\.[0-9]+)|(?P<integer>[+-]?[0-9]+)"
)
_DOTTED_PREFIX = re.compile(r"\.[\w.\-\u00B7\u0300-\u036F\u203F\u2040]*[\w\-\u00B7\u0300-\u036F\u203F\u2040]:")
"""The rest of a prefixed name whose prefix begins like a keyword, up to the colon: of `a.b:c`, `.b:`."""
_TOKEN = re.compile(
    r"""<[^>\n]*>|(?:"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*')(?:@[\w-]+|\^\^(?:<[^>]*>|[^\s;,.\])]+))?"""
    r"""|[^\s"'<>\[\](){};,]*[^\s"'<>\[\](){};,.]"""
)


class TextPosition(NamedTuple):
    """A place in a text; line and column count from one, columns in characters."""

    line: int
    column: int


class Offsets(NamedTuple):
    """Where the three terms of a triple begin, as offsets into the text."""

    subject: int
    predicate: int
    object: int


class NotTurtleError(ValueError):
    """A text is not Turtle, with the offset where that shows."""

    def __init__(self, message: str, offset: int) -> None:
        super().__init__(message)
        self.message, self.offset = message, offset


@dataclass
class Positions:
    """The places of the triples and of the prefixes of one text."""

    file: str
    text: str
    triples: dict[RdflibTriple, Offsets] = field(default_factory=dict)
    prefixes: list[tuple[str, str, int]] = field(default_factory=list)
    """Each declaration in order: prefix, namespace, offset."""

    def __post_init__(self) -> None:
        self._lines = [0, *(match.end() for match in re.finditer("\n", self.text))]
        self._nodes: dict[Node, int] | None = None

    def place(self, offset: int) -> TextPosition:
        """Line and column of an offset; the end of the text for one beyond it."""
        offset = min(max(offset, 0), len(self.text))
        line = bisect_right(self._lines, offset)
        return TextPosition(line, offset - self._lines[line - 1] + 1)

    def bounds(self, number: int) -> tuple[int, int]:
        """The offsets at which a line begins, and the next one does."""
        end = self._lines[number] if number < len(self._lines) else len(self.text)
        return self._lines[number - 1], end

    def width(self, place: TextPosition) -> int:
        """How many characters the token at a place takes, at least one: as much as there is to underline."""
        begin, end = self.bounds(place.line)
        match = _TOKEN.match(self.text, begin + place.column - 1, end)
        return match.end() - match.start() if match else 1

    def of_node(self, node: Node) -> TextPosition | None:
        """Where a node is first the subject of a statement, or else where it is first spoken of."""
        offset = self._known_offset(node)
        return None if offset is None else self.place(offset)

    def line_of(self, iri: str) -> int | None:
        """The line in which a named node is first described."""
        place = self.of_node(URIRef(iri))
        return None if place is None else place.line

    def at_the_end_of(self, subject: str | None, steps: Sequence[tuple[str, int]]) -> TextPosition | None:
        """Where the steps of a TemplateError end, or the last place to which they can be followed."""
        node: Node | None = None if subject is None else URIRef(subject)
        offset = None if node is None else self._known_offset(node)
        for predicate, index in steps:
            found = self._values(node, predicate) if node is not None else self._roots()
            if index >= len(found):
                break
            offset, node = found[index]
        return None if offset is None else self.place(offset)

    def _values(self, subject: Node, predicate: str) -> list[tuple[int, Node]]:
        """The values of a property with their offsets, in the order of the text."""
        wanted = (subject, URIRef(predicate))
        return sorted((offsets.object, value) for (*said, value), offsets in self.triples.items() if (*said,) == wanted)

    def _roots(self) -> list[tuple[int, Node]]:
        """The blank nodes to which nothing leads, with their offsets, in the order of the text."""
        values = {value for _, _, value in self.triples}
        roots = {subject for subject, _, _ in self.triples if isinstance(subject, BNode)} - values
        return sorted((self.offset(node), node) for node in roots)

    def offset(self, node: Node) -> int:
        """Where a node is first described, or else first spoken of; 0, the beginning, where the text has none."""
        return self._known_offset(node) or 0

    def _known_offset(self, node: Node) -> int | None:
        if self._nodes is None:
            self._nodes = {}
            for (subject, _, _), offsets in self.triples.items():
                self._nodes[subject] = min(offsets.subject, self._nodes.get(subject, offsets.subject))
            for (_, _, value), offsets in self.triples.items():
                self._nodes.setdefault(value, offsets.object)
        return self._nodes.get(node)


def parse_with_positions(text: str, file: str, base: str = "file:///") -> tuple[Graph, Positions]:
    """The triples of a Turtle text and their places; raises NotTurtleError, or RecursionError for brackets too deep."""
    text = with_plain_lines(text)
    graph = Graph()
    positions = Positions(file, text)
    parser = _Parser(_Sink(graph, positions), base)
    try:
        parser.loadBuf(text)
    except BadSyntax as error:
        raise NotTurtleError(str(error._why), parser.blamed(error)) from None
    except IndexError:
        raise NotTurtleError("the text ends in the middle of a statement", len(text)) from None
    except (AssertionError, ValueError) as error:
        raise NotTurtleError(str(error) or "cannot be read", parser.reached) from None
    for prefix, namespace, _ in positions.prefixes:
        graph.bind(prefix, namespace, replace=True)
    return graph, positions


class _Sink(RDFSink):
    """Takes the triples from the parser, and writes down where it says they stand."""

    def __init__(self, graph: Graph, positions: Positions) -> None:
        super().__init__(graph)
        self.positions = positions
        self.at = Offsets(0, 0, 0)
        self.open: list[list[int]] = []
        """For each node being read: its own offset and, if it is a list, those of its members so far."""

    def makeStatement(self, quadruple: tuple[Any, Any, Any, Any], why: Any = None) -> None:
        _, predicate, subject, value = (self.normalise(None, term) for term in quadruple)
        self.graph.add((subject, predicate, value))
        self.positions.triples.setdefault((subject, predicate, value), self.at)

    def newLiteral(self, s: str, dt: URIRef | None, lang: str | None) -> Literal:
        return literal(s, dt, lang)  # as it is written, so that shapes see its text

    def newList(self, n: list[Any], f: Any) -> Any:
        opening, *members = self.open[-1]
        head: Any = RDF.nil
        for index in reversed(range(len(n))):
            cell, member = self.newBlankNode(f), members[index]
            start = member if index else opening
            following = members[index + 1] if index + 1 < len(n) else member
            self.at = Offsets(start, member, member)
            self.makeStatement((f, RDF.first, cell, n[index]))
            self.at = Offsets(start, following, following)
            self.makeStatement((f, RDF.rest, cell, head))
            head = cell
        return head


class _Parser(SinkParser):
    """rdflib's parser; its methods know where in the text they are, so each notes it before it goes on.

    It also reads what Turtle allows and rdflib does not: prefixes that begin like a keyword (`a.b:c`), blanks before
    `^^` and before a language, numbers as they are written, whatever their length.
    """

    _store: _Sink

    def __init__(self, store: _Sink, base: str) -> None:
        super().__init__(store, baseURI=base, turtle=True)
        self.reached = 0
        """How far the reading has come."""
        self._statement = 0
        self._latest = 0
        """Where the term stands that was read last; a property list that follows now speaks of it."""
        self._subject = 0
        self._verb = 0
        self._objects: list[int] = []
        self._made: Iterator[Offsets] = iter(())

    def blamed(self, error: BadSyntax) -> int:
        """Where an error shows; rdflib says -1 when it ran out of text, or did not find the end of an IRI."""
        if error._i >= 0:
            return int(error._i)
        return len(self._store.positions.text) if str(error._why).startswith("EOF") else self.reached

    def _start(self, argstr: str, i: int) -> int:
        blank = _BLANK.match(argstr, i)
        self.reached = blank.end() if blank else i
        return self.reached

    def directiveOrStatement(self, argstr: str, h: int) -> int:
        self._statement = self._start(argstr, h)
        return super().directiveOrStatement(argstr, h)

    def bind(self, qn: str, uri: bytes) -> None:
        super().bind(qn, uri)
        self._store.positions.prefixes.append((qn, str(self._bindings[qn]), self._statement))

    def node(self, argstr: str, i: int, res: MutableSequence[Any], subjectAlready: Any = None) -> int:
        start = self._latest = self._start(argstr, i)
        self._store.open.append([start])
        try:
            return super().node(argstr, i, res, subjectAlready)
        finally:
            self._store.open.pop()

    def nodeOrLiteral(self, argstr: str, i: int, res: MutableSequence[Any]) -> int:
        start = self._start(argstr, i)
        number = _NUMBER.match(argstr, start)
        if number is None or number.lastgroup is None:
            return super().nodeOrLiteral(argstr, i, res)
        self._latest = start
        res.append(self._store.newLiteral(number[0], XSD[number.lastgroup], None))
        return number.end()

    def strconst(self, argstr: str, i: int, delim: str) -> tuple[int, str]:
        end, text = super().strconst(argstr, i, delim)
        after = _BLANK.match(argstr, end)
        return (after.end() if after and argstr.startswith(("^^", "@"), after.end()) else end), text

    def tok(self, tok: str, argstr: str, i: int, colon: bool = False) -> int:
        end = super().tok(tok, argstr, i, colon)
        return -1 if end >= 0 and _DOTTED_PREFIX.match(argstr, end) else end

    def item(self, argstr: str, i: int, res: MutableSequence[Any]) -> int:
        self._store.open[-1].append(self._start(argstr, i))
        return self.path(argstr, i, res)

    def subject(self, argstr: str, i: int, res: MutableSequence[Any]) -> int:
        return self.path(argstr, i, res)  # not by way of `item`, which is left to the members of lists

    def prop(self, argstr: str, i: int, res: MutableSequence[Any]) -> int:
        return self.path(argstr, i, res)

    def object(self, argstr: str, i: int, res: MutableSequence[Any]) -> int:
        start = self._start(argstr, i)
        end = super().object(argstr, i, res)
        self._latest = start
        self._objects.append(start)
        return end

    def verb(self, argstr: str, i: int, res: MutableSequence[Any]) -> int:
        self._verb = self._start(argstr, i)
        return super().verb(argstr, i, res)

    def property_list(self, argstr: str, i: int, subj: Any) -> int:
        outer, self._subject = self._subject, self._latest
        try:
            return super().property_list(argstr, i, subj)
        finally:
            self._subject = outer

    def objectList(self, argstr: str, i: int, res: MutableSequence[Any]) -> int:
        outer, verb, self._objects = self._objects, self._verb, []
        try:
            return super().objectList(argstr, i, res)
        finally:
            self._made = iter([Offsets(self._subject, verb, start) for start in self._objects])
            self._objects = outer

    def makeStatement(self, quadruple: Any) -> None:
        self._store.at = next(self._made)
        super().makeStatement(quadruple)
