"""The values that a parameter which is left free may take: what an ecology states, and what the parameter permits."""

from __future__ import annotations

from collections.abc import Iterable

from selfconf.model.template import Parameter
from selfconf.model.term import IRI, Term
from selfconf.rdf.bindings import misfits
from selfconf.rdf.templates import shape_statements
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import SC, SH, TYPE

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


def _about_themselves(document: Document) -> bool:
    """Whether a shape asks which one its focus node is, not which values a path of it has."""
    for statements in document.statements.values():
        predicates = {predicate for predicate, _ in statements}
        if predicates & _MEMBERSHIP and SH.path not in predicates and (TYPE, SC.Parameter) not in statements:
            return True
    return False


def suitable(parameter: Parameter, values: Iterable[Term], document: Document) -> frozenset[Term]:
    """Those of some values that conform to what a parameter says of its value, as a value that is bound has to."""
    wanted = frozenset(values)
    return wanted - misfits(parameter, wanted, document).keys()
