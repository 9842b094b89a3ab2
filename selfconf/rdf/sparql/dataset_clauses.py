"""The dataset clauses of a SPARQL query (SPARQL 1.1, 13.2): which graphs it chooses by FROM and FROM NAMED."""

from __future__ import annotations

import re
from collections.abc import Mapping

import pyoxigraph as ox

from selfconf.rdf.sparql.prologue import PROLOGUE
from selfconf.rdf.sparql.read_only import without

_CLAUSE = re.compile(r"(?<![\w?$:@.-])FROM(\s+NAMED\b)?(\s*<[^<>\s]*>|\s+[^\s<{]+)", re.IGNORECASE)


def chosen_graphs(text: str, prefixes: Mapping[str, str], base: str | None) -> tuple[list[str], list[str]]:
    """The graphs that a query chooses for its default graph, and as named graphs; none of what is no query."""
    bare = without(text, "#", '"', "'")
    clauses = _CLAUSE.findall(bare)
    prologue = PROLOGUE.match(bare)
    if not clauses or prologue is None:
        return [], []
    names = " ".join(name for _, name in clauses)
    try:  # the engine itself knows best what a name with a prefix, or a relative IRI, is
        listed = f"{prologue[0]} SELECT ?g {{ VALUES ?g {{ {names} }} }}"
        rows = ox.Store().query(listed, base_iri=base, prefixes=dict(prefixes))
    except (SyntaxError, ValueError):  # which the query itself will meet, and tell of
        return [], []
    assert isinstance(rows, ox.QuerySolutions)
    chosen: tuple[list[str], list[str]] = ([], [])
    for (named, _), (graph,) in zip(clauses, rows, strict=True):
        if not isinstance(graph, ox.NamedNode):
            return [], []
        chosen[bool(named)].append(graph.value)
    return chosen
