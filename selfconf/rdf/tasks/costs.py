"""The cost of a template (`sc:cost`): levels of terms, each a property whose values count."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from selfconf.model.cost import CostLevel, CostTerm
from selfconf.model.number import fraction
from selfconf.model.term import IRI, Term
from selfconf.rdf.tasks.mistakes import DocumentReader, worded
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import SC


def cost_of(document: Document, template: IRI, roles: frozenset[IRI]) -> tuple[CostLevel, ...]:
    """The levels of the cost of a template with some roles. Raises TemplateError."""
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
