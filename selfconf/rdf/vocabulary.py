"""The terms of selfconf's ontology and of the vocabularies it stands on, as IRIs.

The ontology's word is the code's word; a test compares this module with `ontology/selfconf.ttl`, both ways.
"""

from __future__ import annotations

from selfconf.model.term import IRI


class Namespace:
    """The start of a family of IRIs: attribute access and indexing give a member."""

    __slots__ = ("__dict__", "base")

    def __init__(self, base: str) -> None:
        self.base = base

    def __getattr__(self, name: str) -> IRI:
        member = self.__dict__[name] = IRI.unchecked(self.base + name)  # found at once from then on
        return member

    def __getitem__(self, name: str) -> IRI:
        return IRI.unchecked(self.base + name)

    def __contains__(self, iri: object) -> bool:
        return isinstance(iri, str) and iri.startswith(self.base)


SC = Namespace("https://w3id.org/selfconf#")
ROB = Namespace("https://w3id.org/selfconf/robotics#")
SHAPES = Namespace("https://w3id.org/selfconf/shapes#")
RDF = Namespace("http://www.w3.org/1999/02/22-rdf-syntax-ns#")
RDFS = Namespace("http://www.w3.org/2000/01/rdf-schema#")
OWL = Namespace("http://www.w3.org/2002/07/owl#")
SH = Namespace("http://www.w3.org/ns/shacl#")
XSD = Namespace("http://www.w3.org/2001/XMLSchema#")
PROV = Namespace("http://www.w3.org/ns/prov#")
UNIT = Namespace("http://qudt.org/vocab/unit/")

TYPE = RDF.type
LABEL = RDFS.label
FIRST, REST, NIL = RDF.first, RDF.rest, RDF.nil
