"""The model's terms as rdflib's, and back: what pySHACL and owlrl work on. Loading rdflib takes some 40 ms.

rdflib makes a value of each literal as soon as there is one. What strangers write must not cost much thereby: markup
stays text here, as its value is a document that nothing compares. That a literal is none of its datatype is told by
selfconf where it matters, so rdflib does not log it.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable
from xml.parsers import expat

import rdflib

from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.turtle import Triple

_MARKUP = frozenset((rdflib.RDF.HTML, rdflib.RDF.XMLLiteral))


def _worth_logging(record: logging.LogRecord) -> bool:
    return not str(record.msg).startswith("Failed to convert Literal lexical form")


logging.getLogger("rdflib.term").addFilter(_worth_logging)


def to_rdflib(triples: Iterable[Triple]) -> rdflib.Graph:
    """The triples as an rdflib graph in memory, which is what pySHACL and owlrl are fastest on."""
    graph = rdflib.Graph()
    for subject, predicate, value in triples:
        graph.add((rdflib_term(subject), rdflib.URIRef(predicate), rdflib_term(value)))
    return graph


def rdflib_term(value: Term) -> rdflib.URIRef | rdflib.BNode | rdflib.Literal:
    """A value of the model as one of rdflib's terms."""
    if isinstance(value, IRI):
        return rdflib.URIRef(value)
    if isinstance(value, Literal):
        if value.language:
            return rdflib.Literal(value.lexical, lang=value.language, normalize=False)
        datatype = rdflib.URIRef(value.datatype)
        if datatype in _MARKUP:
            return _markup(value.lexical, datatype)
        return rdflib.Literal(value.lexical, datatype=datatype, normalize=False)
    return rdflib.BNode(value[2:])


def _markup(text: str, datatype: rdflib.URIRef) -> rdflib.Literal:
    """A literal of markup whose value is its text, and that is ill-typed where it is to be XML and is not."""
    literal = rdflib.Literal(text)
    literal._datatype, literal._value = datatype, text
    literal._ill_typed = datatype == rdflib.RDF.XMLLiteral and not _is_xml(text)
    return literal


def _is_xml(text: str) -> bool:
    try:
        expat.ParserCreate().Parse(f"<x>{text}</x>".encode(), True)
    except (expat.ExpatError, ValueError):
        return False
    return True


def from_rdflib(node: rdflib.term.Node) -> Term:
    """One of rdflib's terms as a value of the model."""
    if isinstance(node, rdflib.URIRef):
        return IRI(node)
    if isinstance(node, rdflib.Literal):
        datatype = IRI(node.datatype) if node.datatype else IRI("http://www.w3.org/2001/XMLSchema#string")
        if node.language:
            datatype = IRI("http://www.w3.org/1999/02/22-rdf-syntax-ns#langString")
        return Literal(str(node), datatype, node.language)
    return BlankNode(f"_:{node}")
