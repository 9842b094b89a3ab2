"""The whole template as one SPARQL query, over the partition as triples.

A variable for each role ranges over its candidates; nobody plays two of them; no input of whoever plays has a signal
that nobody feeding that role issues; and a free parameter has a value that nobody who is constrained forbids.
"""

from __future__ import annotations

from collections.abc import Iterator

import pyoxigraph as ox
import rdflib

from selfconf.search.problem import Problem

Triple = tuple[str, str, str]
BASE = "urn:bench:"


def oxigraph(problem: Problem) -> bool:
    """Oxigraph in memory."""
    store = ox.Store()
    store.bulk_extend(ox.Quad(*map(ox.NamedNode, triple)) for triple in triples(problem))
    return bool(store.query(query(problem)))


def rdflib_graph(problem: Problem) -> bool:
    """rdflib in memory."""
    graph = rdflib.Graph()
    for triple in triples(problem):
        graph.add((rdflib.URIRef(triple[0]), rdflib.URIRef(triple[1]), rdflib.URIRef(triple[2])))
    return bool(graph.query(query(problem)).askAnswer)


def triples(problem: Problem) -> Iterator[Triple]:
    """Who could play what, with ports, and what each allows a parameter to be in a role."""
    for role, candidates in enumerate(problem.candidates):
        for candidate in candidates:
            name = str(candidate.profile.component)
            yield name, f"{BASE}plays{role}", f"{BASE}yes"
            for wanted in candidate.profile.inputs:
                yield name, f"{BASE}input", str(wanted.signal)
            for output in candidate.profile.outputs:
                yield name, f"{BASE}output", str(output.signal)
            for variable, mask in enumerate(candidate.admits):
                if mask >= 0:
                    yield name, f"{BASE}constrained{role}", f"{BASE}variable{variable}"
                    for number in range(mask.bit_length()):
                        if mask >> number & 1:
                            yield name, f"{BASE}allows{role}.{variable}", f"{BASE}value{number}"
    for variable, one in enumerate(problem.variables):
        for number in range(len(one.domain)):
            yield f"{BASE}variable{variable}", f"{BASE}domain", f"{BASE}value{number}"


def query(problem: Problem) -> str:
    """Whether there is a configuration."""
    names = [{c.profile.component for c in candidates} for candidates in problem.candidates]
    lines = ["ASK {"]
    for variable in range(len(problem.variables)):
        lines.append(f"  <{BASE}variable{variable}> <{BASE}domain> ?v{variable} .")
    for role in range(len(problem.roles)):
        lines.append(f"  ?r{role} <{BASE}plays{role}> <{BASE}yes> .")
        lines += [f"  FILTER ( ?r{role} != ?r{other} )" for other in range(role) if names[role] & names[other]]
        for variable in range(len(problem.variables)):
            lines.append(
                f"  FILTER NOT EXISTS {{ ?r{role} <{BASE}constrained{role}> <{BASE}variable{variable}> ."
                f" FILTER NOT EXISTS {{ ?r{role} <{BASE}allows{role}.{variable}> ?v{variable} }} }}"
            )
        if any(candidate.profile.inputs for candidate in problem.candidates[role]):
            fed = " ".join(
                f"FILTER NOT EXISTS {{ ?r{source} <{BASE}output> ?s{role} }}" for source in problem.sources[role]
            )
            lines.append(f"  FILTER NOT EXISTS {{ ?r{role} <{BASE}input> ?s{role} . {fed} }}")
    return "\n".join((*lines, "}"))
