"""Hierarchies that match more than was meant, or nothing: circles, classes in the place of properties, and no lists.

A circle of classes, each below the next, makes them one class wherever the hierarchy is followed: what offers one
serves where any other is wanted. RDFS allows it; where that is meant, an equivalence says so.
"""

from __future__ import annotations

from collections.abc import Iterator

from rdflib import OWL, RDF, RDFS, URIRef
from rdflib.term import Node

from selfconf.model.diagnostic import Diagnostic
from selfconf.model.wording import listed
from selfconf.rdf.validation.lints.linted_file import LintedFile
from selfconf.rdf.validation.term_index import TermIndex

_CLASSES, _PROPERTIES = "classes", "properties"
_BETWEEN: dict[Node, tuple[str, URIRef]] = {
    RDFS.subClassOf: (_CLASSES, RDFS.subPropertyOf),
    OWL.equivalentClass: (_CLASSES, OWL.equivalentProperty),
    RDFS.subPropertyOf: (_PROPERTIES, RDFS.subClassOf),
    OWL.equivalentProperty: (_PROPERTIES, OWL.equivalentClass),
}
"""Between what each word of a hierarchy stands, and the word that stands between the others."""
_LISTING = frozenset(
    (
        *(OWL.unionOf, OWL.intersectionOf, OWL.disjointUnionOf, OWL.oneOf),
        *(OWL.propertyChainAxiom, OWL.hasKey, OWL.members, OWL.distinctMembers),
    )
)
"""What has a list for its value in every ontology (OWL 2, mapping to RDF graphs, section 2)."""


def circular_hierarchies(file: LintedFile) -> Iterator[Diagnostic]:
    """Classes, or properties, each of which lies below the next, and the last below the first: once for each circle."""
    last: dict[str, tuple[int, bool]] = {}
    for (lower, predicate, upper), offsets in file.positions.triples.items():
        if lower == upper or (predicate != RDFS.subClassOf and predicate != RDFS.subPropertyOf):
            continue
        circle = file.index.circle(str(lower), str(upper))
        if circle is not None:
            found = offsets.object, predicate == RDFS.subClassOf
            last[circle] = max(last.get(circle, found), found)
    for circle, (offset, classes) in last.items():
        names = listed(sorted(file.short(one) for one in file.index.in_circle(circle) if not one.startswith("_:")))
        kind, word = (_CLASSES, "owl:equivalentClass") if classes else (_PROPERTIES, "owl:equivalentProperty")
        message = f"The {kind} {names} lie below each other, so that each matches where another is wanted."
        yield file.at(offset, "SC-L29", message, hint=f"If that is meant, say so by {word}.")


def mixed_hierarchies(file: LintedFile) -> Iterator[Diagnostic]:
    """Properties in a hierarchy of classes, and classes in one of properties: nothing is matched along them."""
    for (lower, predicate, upper), offsets in file.positions.triples.items():
        if predicate not in _BETWEEN:
            continue
        wanted, other_word = _BETWEEN[predicate]
        kinds = [_kind(file.index, str(one)) for one in (lower, upper)]
        stray = next((one for one, kind in zip((lower, upper), kinds, strict=True) if kind not in (None, wanted)), None)
        if stray is not None:
            offset = offsets.predicate if stray == lower else offsets.object
            what = "a property" if wanted == _CLASSES else "a class"
            message = f"{file.short(str(predicate))} stands between {wanted}, and {file.short(str(stray))} is {what}."
            hint = None if wanted in kinds else f"Did you mean {file.short(str(other_word))}?"
            yield file.at(offset, "SC-L30", message, hint=hint)


def unlisted_members(file: LintedFile) -> Iterator[Diagnostic]:
    """Where OWL wants a list and there is none: once for each subject and property."""
    told: set[tuple[Node, Node]] = set()
    for (subject, predicate, value), offsets in file.positions.triples.items():
        listed_well = value == RDF.nil or (value, RDF.first, None) in file.graph
        if predicate in _LISTING and not listed_well and (subject, predicate) not in told:
            told.add((subject, predicate))
            word = file.short(str(predicate))
            message = f"The value of {word} has to be a list, so nothing is inferred from this."
            yield file.at(offsets.object, "SC-L32", message, hint=f"Write {word} ( ... ), without commas.")


def _kind(index: TermIndex, term: str) -> str | None:
    """What a term is declared as, if it is one of the two alone."""
    kinds = [kind for kind, known in ((_CLASSES, index.classes), (_PROPERTIES, index.properties)) if term in known]
    return kinds[0] if len(kinds) == 1 else None
