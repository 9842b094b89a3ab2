"""The values that a parameter which is left free may take: what an ecology states, and what the parameter permits."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from selfconf.model.template import Parameter
from selfconf.model.term import IRI, Term
from selfconf.rdf.tasks import shape_statements, suitable
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import RDFS, SC, SH, TYPE

KEPT = 64
"""Of how many sets of values it is remembered which of them suit a parameter."""
_STAYING = frozenset((SH.zeroOrMorePath, SH.zeroOrOnePath))
"""Paths that lead to where they begin."""
_QUERIES = frozenset((SH.sparql, SH.select, SH.ask))
_MEMBERSHIP = frozenset((SH.hasValue, SH["in"]))


def seen(document: Document, role: IRI, shown: Iterable[Triple]) -> set[Term]:
    """The terms in what a shape is shown that its paths could lead to, and so all that a parameter in it could be.

    Any other value makes no difference to the shape: it is one that no component has.
    """
    predicates, named = set[IRI](), set[Term]()
    for predicate, value in shape_statements(document, role):
        predicates.add(predicate)
        named.add(value)
    if SH["class"] in predicates:
        named.add(TYPE)
    everything = bool(predicates & _QUERIES)
    beginnings = everything or bool(predicates & _STAYING) or _about_themselves(document)
    found: set[Term] = set()
    for subject, predicate, value in shown:
        if everything or predicate in named:
            found.add(value)
            if SH.inversePath in predicates:
                found.add(subject)
        if beginnings:
            found.add(subject)
    return found


def looked_at(document: Document, role: IRI) -> frozenset[IRI] | None:
    """The predicates that the shape of a role can look at; None where it could be any."""
    said, named = set[IRI](), {TYPE, RDFS.subClassOf}
    for predicate, value in shape_statements(document, role):
        said.add(predicate)
        if isinstance(value, IRI):
            named.add(value)
    if said & _QUERIES or SH.closed in said or document.instances(SH.ConstraintComponent):
        return None
    return frozenset(named)


def enumerated(document: Document, parameter: IRI) -> set[Term]:
    """The values that a parameter lists (`sh:in`), so that it has no others; nothing if it lists none."""
    return {value for head in document.values(parameter, SH["in"]) for value in document.items(head)}


def _about_themselves(document: Document) -> bool:
    """Whether a shape asks which one its focus node is, not which values a path of it has."""
    for statements in document.statements.values():
        predicates = {predicate for predicate, _ in statements}
        if predicates & _MEMBERSHIP and SH.path not in predicates and (TYPE, SC.Parameter) not in statements:
            return True
    return False


class Suitable:
    """Which values conform to what parameters say of theirs, as a value that is bound has to.

    Answers are remembered, as an ecology that has changed states mostly what it stated before.
    """

    def __init__(self, parameters: Mapping[IRI, Parameter], document: Document) -> None:
        self._parameters, self._document = parameters, document
        self._known: dict[tuple[IRI, frozenset[Term]], frozenset[Term]] = {}

    def of(self, parameter: IRI, values: frozenset[Term]) -> frozenset[Term]:
        """Those of some values that a parameter may have."""
        known = self._known.get((parameter, values))
        if known is None:
            known = self._fitting(parameter, values)
            if len(self._known) == KEPT:
                self._known.clear()
            self._known[parameter, values] = known
        return known

    def _fitting(self, parameter: IRI, values: frozenset[Term]) -> frozenset[Term]:
        """Those of some values that conform to what a parameter says of its value."""
        return suitable(self._parameters[parameter], values, self._document)
