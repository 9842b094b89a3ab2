"""What a lint looks at: one file, what is known besides, and how the file itself would write it."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from functools import cached_property

from rdflib import RDF, SH, Graph, Literal, URIRef
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic, Severity
from selfconf.rdf.positions import Positions
from selfconf.rdf.sparql import declared_prefixes, without
from selfconf.rdf.validation.diagnostics import at
from selfconf.rdf.validation.lints.normal_form import ShapeSource
from selfconf.rdf.validation.term_index import TermIndex, namespace

_NAME = re.compile(r"<([^<>\s]*)>|(?<![\w?$:.-])([\w.-]*):([\w.-]*[\w-])")
"""An IRI in a query, or a prefix and what follows it."""


@dataclass(frozen=True)
class LintedFile:
    """One file with the places of its statements."""

    graph: Graph
    positions: Positions
    index: TermIndex
    elsewhere: Mapping[str, str]
    """Components of it that another file, which is named, describes as well; templates that it describes otherwise."""
    shapes: Graph = field(default_factory=Graph)
    """What every advertisement and template keeps to."""

    @cached_property
    def source(self) -> ShapeSource:
        """The shapes of the file, and beside them those that hold of every advertisement."""
        return ShapeSource(self.graph, self.shapes)

    def short(self, iri: str) -> str:
        """An IRI as the file would write it."""
        home = namespace(iri)
        for prefix, known, _ in self.positions.prefixes:
            if known == home:
                return f"{prefix}:{iri[len(home) :]}"
        return f"<{iri}>"

    def at(
        self, offset: int, code: str, message: str, severity: Severity | None = None, hint: str | None = None
    ) -> Diagnostic:
        """A diagnostic at an offset; as severe as its code usually is, unless it is said otherwise."""
        return at(self.positions, offset, code, message, severity, hint)

    def offset(self, node: Node) -> int:
        """Where a node is described."""
        return self.positions.offset(node)

    def items(self, head: Node) -> Iterator[Node]:
        """The members of a list, as far as it is one."""
        for cell in self.cells(head):
            yield from self.graph.objects(cell, RDF.first)

    def cells(self, head: Node) -> Iterator[Node]:
        """The cells of a list, as far as it is one, each once, and its end."""
        seen: set[Node] = set()
        cell: Node | None = head
        while cell is not None and cell not in seen:
            seen.add(cell)
            yield cell
            cell = self.graph.value(cell, RDF.rest)

    def named_in_query(self, query: str) -> set[str]:
        """The IRIs that a query of a shape names, by its own prefixes, those of the file and those of `sh:declare`."""
        declared = {
            str(self.graph.value(one, SH.prefix)): str(self.graph.value(one, SH.namespace))
            for one in self.graph.objects(None, SH.declare)
        }
        own = declared_prefixes(query)
        known = {prefix: base for prefix, base, _ in self.positions.prefixes} | declared | own
        names = _NAME.findall(without(query, "#", '"', "'"))
        return {iri or f"{known.get(prefix, '')}{local}" for iri, prefix, local in names} - {*own.values()}

    def said(self, statement: tuple[Node, Node, Node]) -> str:
        """Predicate and object of a statement, the object only if it has a short form."""
        _, predicate, value = statement
        word = self.short(str(predicate))
        if isinstance(value, URIRef) and value != RDF.nil:
            return f"{word} {self.short(str(value))}"
        if isinstance(value, Literal) and isinstance(value.value, (bool, int, float, Decimal)):
            return f"{word} {value}"
        return f'{word} "{value}"' if isinstance(value, Literal) else word
