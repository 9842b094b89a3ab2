"""A graph for pySHACL that takes up what a component says when something is asked about that component.

Most shapes look at one component after another, so what is said by those that are never looked at need not be parsed.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from typing import Any

import rdflib
from rdflib.plugins.stores.memory import Memory

from selfconf.model.term import IRI
from selfconf.rdf.rdflib_terms import rdflib_triple
from selfconf.rdf.turtle import Triple


class LazyStore(Memory):
    """rdflib's store in memory, to which the triples about a subject are added when it is first asked about."""

    def __init__(self) -> None:
        super().__init__()
        # A source may bring other blank nodes each time, so it is called once.
        self._waiting: dict[Any, Callable[[], Iterable[Triple]]] = {}
        self._graph = rdflib.Graph(store=self)

    def defer(self, subject: IRI, source: Callable[[], Iterable[Triple]]) -> None:
        """Add the triples of a source when they are needed, all about this subject or blank nodes of theirs."""
        self._waiting[rdflib.URIRef(subject)] = source

    @property
    def graph(self) -> rdflib.Graph:
        """What is in the store, as a graph."""
        return self._graph

    def triples(self, triple_pattern: Any, context: Any = None) -> Generator[Any, None, None]:
        """The triples that match a pattern; without a subject all that were deferred may."""
        subject = triple_pattern[0]
        if subject in self._waiting:
            self._take(subject)
        elif subject is None:
            self._take_all()
        return super().triples(triple_pattern, context)

    def __len__(self, context: Any = None) -> int:
        """At least how many triples there are: rdflib and pySHACL ask whether there are any."""
        return super().__len__(context) + len(self._waiting)

    def _take_all(self) -> None:
        for subject in list(self._waiting):
            self._take(subject)

    def _take(self, subject: Any) -> None:
        """Add what is said about a subject. An alarm may interrupt this: what is not all there is taken up again."""
        triples = tuple(self._waiting[subject]())
        self._waiting[subject] = lambda: triples
        for triple in triples:
            self._graph.add(rdflib_triple(triple))
        del self._waiting[subject]
