"""The whole template as one SPARQL query, over the partition as triples.

A variable for each slot ranges over the candidates of its role; nobody fills two of them; no input of whoever plays
goes without an output that feeds it; and a free parameter has a value that nobody who is constrained forbids. What a
template does not use costs nothing: ports are told apart by name only where an interaction names one, and outputs are
said to serve other signals only where the hierarchy has some.
"""

from __future__ import annotations

from collections.abc import Iterator

import pyoxigraph as ox
import rdflib
import rdflib.plugins.sparql  # here, as each process that is forked off would have to read its grammar

from selfconf.model.partition import ANY_VALUE
from selfconf.model.profile import Input, Output, Profile
from selfconf.search.problem import Link, Problem

Triple = tuple[str, str, str]
BASE = "urn:bench:"


def oxigraph(problem: Problem) -> bool:
    """Oxigraph in memory."""
    return bool(_store(problem).query(query(problem)))


def _store(problem: Problem) -> ox.Store:
    store = ox.Store()
    store.bulk_extend(ox.Quad(*map(ox.NamedNode, triple)) for triple in triples(problem))
    return store


def rdflib_graph(problem: Problem) -> bool:
    """rdflib in memory."""
    graph = rdflib.Graph()
    for triple in triples(problem):
        graph.add((rdflib.URIRef(triple[0]), rdflib.URIRef(triple[1]), rdflib.URIRef(triple[2])))
    return bool(graph.query(query(problem)).askAnswer)


def first(problem: Problem) -> list[tuple[int, int]] | None:
    """The least solution as pairs of a role and the number of a candidate, slot by slot, from Oxigraph; None if none.

    The answers are put in order by the numbers of the candidates, which are rows of the query.
    """
    slots = _slots(problem)
    ranks = [
        f"VALUES ( ?r{place} ?n{place} ) {{ "
        + " ".join(f"( <{c.profile.component}> {number} )" for number, c in enumerate(problem.candidates[role]))
        + " }"
        for place, role in enumerate(slots)
    ]
    names = " ".join(f"?n{place}" for place in range(len(slots)))
    select = f"SELECT {names or '*'} {{ {' '.join(ranks)} {_pattern(problem)} }}"
    order = f" ORDER BY {names} LIMIT 1" if slots else " LIMIT 1"
    found = _store(problem).query(select + order)
    assert isinstance(found, ox.QuerySolutions)
    answer = next(iter(found), None)
    if answer is None:
        return None
    return [(role, int(str(answer[f"n{place}"].value))) for place, role in enumerate(slots)]


def triples(problem: Problem) -> Iterator[Triple]:
    """Who could play what, with ports, and what each allows a parameter to be in a role."""
    tell = _named(problem)
    for role, candidates in enumerate(problem.candidates):
        for candidate in candidates:
            name = str(candidate.profile.component)
            yield name, f"{BASE}plays{role}", f"{BASE}yes"
            yield from _ports(problem, candidate.profile, tell)
            for variable, mask in enumerate(candidate.admits):
                if mask != ANY_VALUE:
                    yield name, f"{BASE}constrained{role}", f"{BASE}variable{variable}"
                    for number in _values(problem, variable):
                        if mask >> number & 1:
                            yield name, f"{BASE}allows{role}.{variable}", f"{BASE}value{number}"
    for variable in range(len(problem.variables)):
        for number in _values(problem, variable):
            yield f"{BASE}variable{variable}", f"{BASE}domain", f"{BASE}value{number}"


def _values(problem: Problem, variable: int) -> range:
    """The numbers of the values of a variable, the last of them, unless it is set, a value that nobody names."""
    return range(len(problem.variables[variable].domain) + (problem.open_values[variable] == ANY_VALUE))


def _ports(problem: Problem, profile: Profile, tell: bool) -> Iterator[Triple]:
    name = str(profile.component)
    for wanted in profile.inputs:
        yield name, f"{BASE}input", _port(wanted, tell)
        if tell:
            yield _port(wanted, tell), f"{BASE}signal", str(wanted.signals[0])
            yield _port(wanted, tell), f"{BASE}name", f"{BASE}name:{wanted.name}"
    for output in profile.outputs:
        for signal in problem.hierarchy.superclasses(output.signals[0]):
            yield name, f"{BASE}output", str(signal)
            if tell:
                yield name, f"{BASE}output:{output.name}", str(signal)


def _port(wanted: Input | Output, tell: bool) -> str:
    return f"{wanted.signals[0]}:{wanted.name}" if tell else str(wanted.signals[0])


def _named(problem: Problem) -> bool:
    return any(link.output or link.input for links in problem.links for link in links)


def _slots(problem: Problem) -> list[int]:
    return [role for role, asked in enumerate(problem.roles) for _ in range(asked.minimum)]


def query(problem: Problem) -> str:
    """Whether there is a configuration."""
    return f"ASK {{\n{_pattern(problem)}\n}}"


def _pattern(problem: Problem) -> str:
    slots, tell = _slots(problem), _named(problem)
    names = [{c.profile.component for c in candidates} for candidates in problem.candidates]
    lines = [
        f"  <{BASE}variable{variable}> <{BASE}domain> ?v{variable} ." for variable in range(len(problem.variables))
    ]
    for place, role in enumerate(slots):
        lines.append(f"  ?r{place} <{BASE}plays{role}> <{BASE}yes> .")
        lines += [f"  FILTER ( ?r{place} != ?r{other} )" for other in range(place) if names[role] & names[slots[other]]]
        for variable in range(len(problem.variables)):
            lines.append(
                f"  FILTER NOT EXISTS {{ ?r{place} <{BASE}constrained{role}> <{BASE}variable{variable}> ."
                f" FILTER NOT EXISTS {{ ?r{place} <{BASE}allows{role}.{variable}> ?v{variable} }} }}"
            )
        if any(candidate.profile.inputs for candidate in problem.candidates[role]):
            links = dict.fromkeys((Link(s) for s in problem.sources[role]) if not tell else problem.links[role])
            fed = " ".join(
                f"FILTER NOT EXISTS {{ {_feeds(place, source, link, tell)} }}"
                for link in links
                for source, feeding in enumerate(slots)
                if feeding == link.source
            )
            port = (
                f"?r{place} <{BASE}input> ?p{place} . ?p{place} <{BASE}signal> ?s{place}"
                if tell
                else f"?r{place} <{BASE}input> ?s{place}"
            )
            lines.append(f"  FILTER NOT EXISTS {{ {port} . {fed} }}")
    return "\n".join(lines)


def _feeds(place: int, source: int, link: Link, tell: bool) -> str:
    """That the slot `source` issues the signal of the input in question along a link."""
    output = f"{BASE}output:{link.output}" if link.output else f"{BASE}output"
    named = f" ?p{place} <{BASE}name> <{BASE}name:{link.input}> ." if tell and link.input else ""
    return f"?r{source} <{output}> ?s{place} .{named}"
