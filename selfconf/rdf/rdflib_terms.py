"""The model's terms as rdflib's, and back: what pySHACL and owlrl work on. Loading rdflib takes some 40 ms."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import chain

import rdflib

from selfconf.model.term import IRI, STRING, BlankNode, Literal, Term
from selfconf.rdf.rdflib_literals import literal
from selfconf.rdf.turtle import Document, Node, Triple


def to_rdflib(triples: Iterable[Triple], store: str = "default") -> rdflib.Graph:
    """The triples as an rdflib graph in memory, which is what pySHACL and owlrl are fastest on.

    The store `SimpleMemory`, of a graph that is no part of a dataset, takes a fifth less time.
    """
    graph = rdflib.Graph(store)
    for triple in triples:
        graph.add(rdflib_triple(triple))
    return graph


def rdflib_triple(triple: Triple) -> tuple[rdflib.URIRef | rdflib.BNode, rdflib.URIRef, rdflib.term.Identifier]:
    """One of the model's triples as rdflib's."""
    subject, predicate, value = triple
    about = rdflib.URIRef(subject) if isinstance(subject, IRI) else rdflib.BNode(subject[2:])
    return about, rdflib.URIRef(predicate), rdflib_term(value)


def rdflib_term(value: Term) -> rdflib.URIRef | rdflib.BNode | rdflib.Literal:
    """A value of the model as one of rdflib's terms."""
    if isinstance(value, IRI):
        return rdflib.URIRef(value)
    if isinstance(value, Literal):
        # A string has no datatype to rdflib, whose queries would not find "x" where it had one.
        plain = value.language or value.datatype == STRING
        return literal(value.lexical, None if plain else rdflib.URIRef(value.datatype), value.language)
    return rdflib.BNode(value[2:])


def from_rdflib(node: rdflib.term.Node) -> Term:
    """One of rdflib's terms as a value of the model."""
    if isinstance(node, rdflib.URIRef):
        return IRI.unchecked(node)
    if isinstance(node, rdflib.Literal):
        datatype = IRI.unchecked(node.datatype) if node.datatype else STRING
        if node.language:
            datatype = IRI("http://www.w3.org/1999/02/22-rdf-syntax-ns#langString")
        return Literal(str(node), datatype, node.language)
    return BlankNode(f"_:{node}")


def merged(*graphs: rdflib.Graph) -> rdflib.Graph:
    """The statements of some graphs in one, where a string is equal to the same one with the datatype xsd:string."""
    whole = rdflib.Graph()
    for subject, predicate, value in chain.from_iterable(graphs):
        same = isinstance(value, rdflib.Literal) and value.datatype == rdflib.XSD.string
        whole.add((subject, predicate, rdflib.Literal(str(value)) if same else value))
    return whole


def to_document(triples: Iterable[tuple[rdflib.term.Node, ...]], source: str) -> Document:
    """The statements of an rdflib graph, in a given order, as the readers of Turtle take them."""
    statements: dict[Node, list[tuple[IRI, Term]]] = {}
    for subject, predicate, value in triples:
        about = from_rdflib(subject)
        assert not isinstance(about, Literal)
        statements.setdefault(about, []).append((IRI.unchecked(str(predicate)), from_rdflib(value)))
    return Document(source, statements, {})
