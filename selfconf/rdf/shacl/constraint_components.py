"""Constraint components that a document brings along (SHACL, section 6): predicates of its own that constrain."""

from __future__ import annotations

from selfconf.model.term import IRI
from selfconf.rdf.turtle import Document
from selfconf.rdf.vocabulary import SH


def component_parameters(document: Document) -> frozenset[IRI]:
    """Return the predicates by which a shape of the document uses one of its own SPARQL-based constraint components.

    Only pySHACL can judge what they say.
    """
    return frozenset(
        path
        for component in document.instances(SH.ConstraintComponent)
        for parameter in document.values(component, SH.parameter)
        for path in document.values(parameter, SH.path)
        if isinstance(path, IRI)
    )
