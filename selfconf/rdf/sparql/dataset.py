"""The discovered ecology as an RDF dataset, one named graph per advertisement, for SPARQL.

The name of an advertisement's graph is the component's IRI; the default graph is the union of all. The union is in the
store as well: Oxigraph would find a triple as often as graphs have it, and the union has it once; that of graphs which
a query chooses is made for it. Queries run on Oxigraph. They read the dataset and nothing else: SERVICE is refused, and
FROM only chooses among the graphs there.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

import pyoxigraph as ox

from selfconf.errors import QueryError
from selfconf.model.term import IRI
from selfconf.rdf.sparql.dataset_clauses import chosen_graphs
from selfconf.rdf.sparql.mistakes import mistake
from selfconf.rdf.sparql.read_only import only_reads
from selfconf.rdf.turtle import Triple, ox_term
from selfconf.rdf.vocabulary import PROV, RDF, RDFS, ROB, SC, SH, XSD

if TYPE_CHECKING:
    from selfconf.rdf.advertisements import Advertisement

QUERY_PREFIXES = {
    "sc": SC.base,
    "rob": ROB.base,
    "home": "https://w3id.org/selfconf/peis-home#",
    "sh": SH.base,
    "rdf": RDF.base,
    "rdfs": RDFS.base,
    "xsd": XSD.base,
    "prov": PROV.base,
}
RENEWED = 10_000
"""How many triples are removed at least before the store is made anew; of a larger one, twice as many as it has."""
_UNION = ox.DefaultGraph()
QueryAnswer = ox.QuerySolutions | ox.QueryBoolean | ox.QueryTriples


class Dataset:
    """Named graphs, and questions to them."""

    def __init__(self) -> None:
        self._store = ox.Store()
        self._merged = True
        """Whether the default graph is the union of all others."""
        self._removed, self._most_removed = 0, RENEWED
        """How many triples were removed from the store, and after how many it is made anew."""

    def add_advertisements(self, found: Iterable[Advertisement]) -> None:
        """Add each advertisement as the graph that its component names."""
        for advertisement in found:
            self.add(advertisement.profile.component, advertisement.triples)

    def add(self, name: IRI, triples: Iterable[Triple]) -> None:
        """Add triples to a named graph."""
        graph = ox.NamedNode(name)
        self._store.extend(ox.Quad(ox_term(s), ox.NamedNode(p), ox_term(o), graph) for s, p, o in triples)
        self._merged = False

    def dump(self) -> bytes:
        """Everything in it, as N-Quads."""
        return self._store.dump(format=ox.RdfFormat.N_QUADS) or b""

    def load(self, quads: bytes) -> None:
        """Add what another dataset has dumped."""
        self._store.bulk_load(quads, format=ox.RdfFormat.N_QUADS)
        self._merged = False

    def replace(self, name: str, triples: bytes) -> None:
        """Let a named graph hold these N-Triples and nothing else; without any it is gone."""
        graph = ox.NamedNode(name)
        before = self._said_in(graph)
        for said in before if self._merged else ():
            stating = self._store.quads_for_pattern(said.subject, said.predicate, said.object, None)
            if all(quad.graph_name in (graph, _UNION) for quad in stating):
                self._store.remove(_in_union(said))
        self._store.remove_graph(graph)
        if triples:
            self._store.load(triples, format=ox.RdfFormat.N_TRIPLES, to_graph=graph)
        if self._merged:
            self._store.extend(map(_in_union, self._said_in(graph)))
        self._removed += len(before)
        if self._removed > self._most_removed:
            self._renew()

    def _renew(self) -> None:
        """Make the store anew: Oxigraph keeps in memory what was removed from a store, for as long as that is there."""
        store = ox.Store()
        store.bulk_extend(self._store)
        self._store, self._removed, self._most_removed = store, 0, max(RENEWED, 2 * len(store))

    def _said_in(self, graph: ox.NamedNode) -> list[ox.Quad]:
        return list(self._store.quads_for_pattern(None, None, None, graph))

    def _merge(self) -> None:
        if not self._merged:
            self._store.clear_graph(_UNION)
            self._store.update("INSERT { ?s ?p ?o } WHERE { GRAPH ?g { ?s ?p ?o } }")
            self._merged = True

    def _of_graphs(self, default: Iterable[str], named: Iterable[str]) -> ox.Store:
        """A store with the union of some graphs as its default graph, and with some named graphs."""
        store = ox.Store()
        for name in default:
            store.extend(map(_in_union, self._said_in(ox.NamedNode(name))))
        for name in named:
            store.extend(self._said_in(ox.NamedNode(name)))
        return store

    def query(
        self,
        text: str,
        prefixes: Mapping[str, str] | None = None,
        default_graphs: Sequence[str] = (),
        named_graphs: Sequence[str] = (),
        base: str | None = None,
    ) -> QueryAnswer:
        """The answer to a SPARQL 1.1 query. Raises QueryError, with what is wrong with it.

        The default graph is the union of all graphs, or what the query says by FROM; where graphs are given they are
        the dataset, whatever the query says (SPARQL 1.1 Protocol, section 2.1.4).
        """
        only_reads(text)
        lent = {**QUERY_PREFIXES, **(prefixes or {})}
        default, named = default_graphs, named_graphs
        if not (default or named):
            default, named = chosen_graphs(text, lent, base)
        try:
            if default or named:
                return self._of_graphs(default, named).query(
                    text,
                    base_iri=base,
                    prefixes=lent,
                    default_graph=_UNION,
                    named_graphs=[ox.NamedNode(name) for name in named],
                )
            self._merge()
            return self._store.query(text, base_iri=base, prefixes=lent)
        except (SyntaxError, ValueError, OSError) as error:
            raise QueryError(f"not a SPARQL query: {mistake(text, str(error), lent)}") from None
        except RuntimeError as error:  # it calls a function that is not there
            raise QueryError(f"this query cannot be answered: {error}") from None


def _in_union(said: ox.Quad) -> ox.Quad:
    """A triple of a graph, in the union of all."""
    return ox.Quad(said.subject, said.predicate, said.object, _UNION)
