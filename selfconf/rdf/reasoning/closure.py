"""From ontologies to the hierarchy that a reasoning mode lets a role's shape see.

`subclass` reads `rdfs:subClassOf`, `rdfs:subPropertyOf`, `owl:equivalentClass` and `owl:equivalentProperty`, and of an
`owl:intersectionOf` the members that have names, and closes them itself. `owl-rl` first lets owlrl infer what it can
from the ontology alone: it never sees a property value of a component, because owlrl gives values that it takes for
equal to subjects that never had them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import chain
from types import ModuleType, SimpleNamespace

from selfconf.model.hierarchy import NOTHING_ABOVE, Hierarchy, Reasoning
from selfconf.model.term import IRI, BlankNode, Literal, Term
from selfconf.rdf.turtle import Document, Node, Triple
from selfconf.rdf.vocabulary import FIRST, OWL, RDFS, REST

HIERARCHY = (RDFS.subClassOf, OWL.equivalentClass, RDFS.subPropertyOf, OWL.equivalentProperty)
READ = (*HIERARCHY, OWL.intersectionOf, FIRST, REST)
"""The predicates that the mode `subclass` reads."""
_BELOW = (RDFS.subClassOf, OWL.equivalentClass)
_ABOVE_ALL = (OWL.Thing, RDFS.Resource)
"""What the rules of OWL put above every class that is declared; it counts where an ontology states it."""
_INTERSECTION, _EQUIVALENT = OWL.intersectionOf, OWL.equivalentClass  # a taxonomy asks for them 100,000 times
Entailment = Callable[[Iterable[Triple]], Iterable[Triple]]


def owlrl_owl_rl(triples: Iterable[Triple]) -> Iterator[Triple]:
    """The hierarchy in the OWL 2 RL closure of an ontology by owlrl, without the literal subjects that it emits."""
    # Loaded here, as the other modes need neither.
    import rdflib
    from owlrl import OWLRL, DeductiveClosure, OWLRL_Semantics

    from selfconf.rdf.rdflib_terms import to_rdflib

    _keep_terms(OWLRL)
    graph = to_rdflib(triples, "SimpleMemory")
    DeductiveClosure(OWLRL_Semantics).expand(graph)
    for predicate in HIERARCHY:
        for subject, value in graph.subject_objects(rdflib.URIRef(predicate)):
            if isinstance(subject, rdflib.URIRef) and isinstance(value, rdflib.URIRef):
                yield IRI.unchecked(subject), predicate, IRI.unchecked(value)


def _keep_terms(rules: ModuleType) -> None:
    """Let the rules of owlrl mention terms that are kept: for rdflib to look each up takes as long as all else."""
    for name in ("OWL", "RDF", "RDFS"):
        terms = getattr(rules, name)
        if not isinstance(terms, SimpleNamespace):  # else they are kept already
            kept = {term: terms[term] for term in terms.__annotations__ if not term.startswith("_")}
            setattr(rules, name, SimpleNamespace(**kept))


def hierarchy(ontologies: Sequence[Document], reasoning: Reasoning, entail: Entailment = owlrl_owl_rl) -> Hierarchy:
    """The hierarchy that the ontologies state (`subclass`) or entail (`owl-rl`); empty for `syntactic`."""
    if reasoning is Reasoning.SYNTACTIC:
        return NOTHING_ABOVE
    triples: Iterable[Triple] = [triple for document in ontologies for triple in document.triples()]
    if reasoning is Reasoning.OWL_RL:
        stated = (triple for triple in triples if triple[2] in _ABOVE_ALL)
        triples = [*(triple for triple in entail(triples) if triple[2] not in _ABOVE_ALL), *stated]
    return Hierarchy(
        chain(edges(triples, RDFS.subClassOf, OWL.equivalentClass), *map(intersections, ontologies)),
        edges(triples, RDFS.subPropertyOf, OWL.equivalentProperty),
    )


def edges(triples: Iterable[Triple], below: IRI, same: IRI) -> Iterator[tuple[IRI, IRI]]:
    """The pairs (lower, higher) between named terms, also where blank nodes lie between the two.

    An equivalence is a pair in each direction.
    """
    above_blank: dict[Node, list[Node]] = {}
    below_blank: list[tuple[IRI, BlankNode]] = []
    for subject, predicate, value in triples:
        if predicate not in (below, same) or isinstance(value, Literal):
            continue
        for lower, higher in ((subject, value), (value, subject))[: 1 + (predicate == same)]:
            if isinstance(lower, BlankNode):
                above_blank.setdefault(lower, []).append(higher)
            elif isinstance(higher, BlankNode):
                below_blank.append((lower, higher))
            else:
                yield lower, higher
    for named, blank in below_blank:
        seen: set[Node] = {named, blank}
        waiting: list[Node] = [blank]
        while waiting:
            for higher in above_blank.get(waiting.pop(), ()):
                if higher in seen:
                    continue
                seen.add(higher)
                if isinstance(higher, IRI):
                    yield named, higher
                else:
                    waiting.append(higher)


def intersections(document: Document) -> Iterator[tuple[IRI, IRI]]:
    """The pairs (lower, higher) of a class and each named class that it is, or lies below, an intersection of."""
    named: dict[Term, list[IRI]] = {}
    for subject, predicate, value in document.triples():
        if isinstance(subject, IRI) and predicate in _BELOW:
            named.setdefault(value, []).append(subject)
        elif isinstance(value, IRI) and predicate == _EQUIVALENT:
            named.setdefault(subject, []).append(value)
    for subject, predicate, value in document.triples():
        if predicate == _INTERSECTION:
            for lower in [subject] if isinstance(subject, IRI) else named.get(subject, ()):
                yield from ((lower, one) for one in document.items(value) if isinstance(one, IRI))
