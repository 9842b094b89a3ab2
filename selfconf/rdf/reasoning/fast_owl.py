"""OWL 2 RL by `reasonable`, a reasoner in Rust, for the ontologies of which it infers the hierarchy that owlrl infers.

It implements most of the rules of OWL 2 RL (OWL 2 Profiles, section 4.3). Of those that a hierarchy may come from,
version 0.4 lacks *scm-int* and *scm-uni* (a class lies below what it is an intersection of, and above what it is a
union of), which are applied here beforehand, since they need nothing but the lists. It also lacks those that compare
restrictions (*scm-svf*, *scm-avf*, *scm-hv*), and does not count a term among the terms that are the same as a class or
property (*eq-rep* together with *scm-cls*, *scm-op*, *scm-dp*), nor every class below `owl:Thing` (*scm-cls*). So an
ontology that uses other words of OWL, RDFS and RDF than those below, by which both reasoners infer the same hierarchy,
is left to owlrl: restrictions, `owl:sameAs` and what may entail it, and statements about the words of OWL themselves.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from importlib.util import find_spec

from selfconf.model.term import IRI, Literal
from selfconf.rdf.turtle import Document, Triple
from selfconf.rdf.vocabulary import OWL, RDF, RDFS, TYPE

OWL_AXIOMS = frozenset(
    (
        TYPE, RDF.first, RDF.rest, RDFS.subClassOf, RDFS.subPropertyOf, RDFS.domain, RDFS.range, OWL.equivalentClass,
        OWL.equivalentProperty, OWL.unionOf, OWL.intersectionOf, OWL.complementOf, OWL.disjointWith, OWL.oneOf,
        OWL.inverseOf, OWL.propertyChainAxiom,
    )
)  # fmt: skip
OWL_ANNOTATIONS = frozenset(
    (
        RDFS.label, RDFS.comment, RDFS.seeAlso, RDFS.isDefinedBy, OWL.imports, OWL.versionIRI, OWL.versionInfo,
        OWL.deprecated,
    )
)  # fmt: skip
OWL_KINDS = frozenset(
    (
        OWL.Class, OWL.Ontology, OWL.ObjectProperty, OWL.DatatypeProperty, OWL.AnnotationProperty,
        OWL.TransitiveProperty, OWL.SymmetricProperty, OWL.NamedIndividual, RDFS.Class, RDF.Property, RDF.nil,
        OWL.Thing, RDF.List, RDFS.Literal, RDFS.Resource,
    )
)  # fmt: skip

_OF_THINGS = frozenset((TYPE, RDFS.subClassOf, RDFS.domain, RDFS.range))
"""What may lead to owl:Thing; as equal to a class, or as a part of one, it would lie below it, with all classes."""


def suits(triples: Sequence[Triple]) -> bool:
    """Whether `reasonable` is installed and certain to find what owlrl finds."""
    cells = [(subject, predicate) for subject, predicate, _ in triples if predicate in (RDF.first, RDF.rest)]
    return (
        find_spec("reasonable") is not None
        and len(cells) == len(set(cells))
        and not any(
            _of_owl(subject)
            or (_of_owl(predicate) and predicate not in OWL_AXIOMS | OWL_ANNOTATIONS)
            or (_of_owl(value) and value not in OWL_KINDS)
            or (value == OWL.Thing and predicate not in _OF_THINGS)
            for subject, predicate, value in triples
        )
    )


def _of_owl(term: object) -> bool:
    return term in OWL or term in RDFS or term in RDF


def reasonable_owl_rl(triples: Sequence[Triple]) -> Iterator[Triple]:
    """The OWL 2 RL closure of an ontology that suits."""
    from reasonable import PyReasoner  # an extra

    from selfconf.rdf.rdflib_terms import from_rdflib, to_rdflib

    reasoner = PyReasoner()
    reasoner.from_graph(to_rdflib([*triples, *_of_lists(triples)]))
    for subject, predicate, value in reasoner.reason():
        terms = from_rdflib(subject), from_rdflib(predicate), from_rdflib(value)
        if isinstance(terms[1], IRI) and not isinstance(terms[0], Literal):
            yield terms[0], terms[1], terms[2]


def _of_lists(triples: Sequence[Triple]) -> Iterator[Triple]:
    """Rules scm-int and scm-uni."""
    document = Document("", {}, {})
    for subject, predicate, value in triples:
        document.statements.setdefault(subject, []).append((predicate, value))
    for subject, predicate, value in triples:
        if predicate == OWL.intersectionOf:
            yield from ((subject, RDFS.subClassOf, member) for member in document.items(value))
        elif predicate == OWL.unionOf:
            members = document.items(value)
            yield from ((member, RDFS.subClassOf, subject) for member in members if not isinstance(member, Literal))
