"""What other files of a run say of the template and the components of a configuration, which is judged by them.

Of these files only such descriptions are read: the statements about a template or a component, and about whatever they
lead to. Nothing else that stands there can change what is found in the file of the configuration.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import lru_cache

from rdflib import RDFS, Graph, URIRef

from selfconf.model.term import IRI, Literal
from selfconf.rdf.rdflib_terms import merged, to_rdflib
from selfconf.rdf.turtle import Document, Node, Triple, parse
from selfconf.rdf.validation.term_index import TermIndex
from selfconf.rdf.vocabulary import SC, TYPE

_TYPES_OF_PORTS = tuple(URIRef(word) for word in (SC.signalType, SC.request, SC.response))


@lru_cache(maxsize=8)  # a folder of configurations mostly has its template and its advertisements in few files
def _document(octets: bytes, name: str, base: str) -> Document:
    return parse(octets, name, base)


def descriptions(files: Iterable[tuple[bytes, str, str, Iterable[str]]]) -> Graph:
    """What files say of some things: each file its octets, its name, its base and the IRIs of these things."""
    return to_rdflib(
        triple
        for octets, name, base, wanted in files
        for triple in _about(_document(octets, name, base), [IRI(one) for one in wanted])
    )


def _about(document: Document, wanted: list[IRI]) -> Iterator[Triple]:
    """The statements about templates and components, and about what they lead to, except other such things."""
    interactions: dict[Node, list[Node]] = {}  # nothing leads from a role to the interactions that begin with it
    for subject, statements in document.statements.items():
        for predicate, value in statements:
            if predicate == SC["from"] and not isinstance(value, Literal):
                interactions.setdefault(value, []).append(subject)
    apart = {
        thing for kind in (SC.Template, SC.Component, SC.Task, SC.Configuration) for thing in document.instances(kind)
    }
    waiting: list[Node] = list(wanted)
    seen: set[Node] = {*wanted, *apart}
    while waiting:
        subject = waiting.pop()
        yield from ((subject, predicate, value) for predicate, value in document.about(subject))
        led = [value for predicate, value in document.about(subject) if predicate != TYPE]
        following = [one for one in (*led, *interactions.get(subject, ())) if not isinstance(one, Literal)]
        waiting += [one for one in dict.fromkeys(following) if one not in seen]
        seen.update(following)


def with_hierarchy(graph: Graph, index: TermIndex) -> Graph:
    """A copy of a graph in which each type of its ports lies below all that the loaded ontologies put above it."""
    copy = merged(graph)
    for predicate in _TYPES_OF_PORTS:
        for kind in set(graph.objects(None, predicate)):
            for upper in index.at_or_above(str(kind)):
                copy.add((kind, RDFS.subClassOf, URIRef(upper)))
    return copy
