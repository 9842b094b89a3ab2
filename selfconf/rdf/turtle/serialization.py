"""Triples as text, by Oxigraph: N-Triples for the wire, Turtle for people."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import overload

import pyoxigraph as ox

from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.turtle.document import Triple
from selfconf.rdf.vocabulary import PROV, ROB, SC, XSD

TURTLE_PREFIXES = {"sc": SC.base, "rob": ROB.base, "prov": PROV.base, "xsd": XSD.base}


@overload
def ox_term(value: IRI | BlankNode) -> ox.NamedNode | ox.BlankNode: ...
@overload
def ox_term(value: Term) -> ox.NamedNode | ox.BlankNode | ox.Literal: ...
def ox_term(value: Term) -> ox.NamedNode | ox.BlankNode | ox.Literal:
    """A value of the model as one of Oxigraph's terms."""
    if isinstance(value, IRI):
        return ox.NamedNode(value)
    if isinstance(value, Literal):
        if value.language:
            return ox.Literal(value.lexical, language=value.language)
        return ox.Literal(value.lexical, datatype=ox.NamedNode(value.datatype))
    return ox.BlankNode(value[2:])


def _ox_triples(triples: Iterable[Triple]) -> Iterator[ox.Triple]:
    for subject, predicate, value in triples:
        yield ox.Triple(ox_term(subject), ox.NamedNode(predicate), ox_term(value))


def ntriples(triples: Iterable[Triple]) -> bytes:
    """The triples as N-Triples, which is Turtle too."""
    return ox.serialize(_ox_triples(triples), format=ox.RdfFormat.N_TRIPLES) or b""


def to_turtle(triples: Iterable[Triple], prefixes: Mapping[str, str] | None = None) -> str:
    """The triples as Turtle for people."""
    prefixes = {**TURTLE_PREFIXES, **(prefixes or {})}
    return (ox.serialize(_ox_triples(triples), format=ox.RdfFormat.TURTLE, prefixes=prefixes) or b"").decode()
