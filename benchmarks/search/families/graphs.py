"""Families after problems on graphs: colourings, tours and trees."""

from __future__ import annotations

import math
import random
from functools import partial
from itertools import combinations, product
from operator import ne

from benchmarks.search.families.wiring import Goes, counted, heard_by_name, hearing, in_pairs, iri, made, profile
from selfconf.model.partition import ANY_VALUE, Candidate, Variable
from selfconf.search.problem import Problem


def colouring(nodes: int, colours: int, degree: float, seed: int) -> Problem:
    """A random graph to be coloured."""
    rng = random.Random(seed)
    every = list(combinations(range(nodes), 2))
    pairs = sorted(rng.sample(every, min(len(every), round(nodes * degree / 2))))
    return in_pairs([list(range(colours))] * nodes, dict.fromkeys(pairs, ne))


def tour(places: int, degree: float, seed: int) -> Problem:
    """A walk through all places: a role for each stop, each place hands over to its neighbours, none twice."""
    rng = random.Random(seed)
    near: dict[int, set[int]] = {k: set() for k in range(places)}
    for a, b in rng.sample(list(combinations(range(places), 2)), round(places * degree / 2)):
        near[a].add(b)
        near[b].add(a)
    start = Candidate(profile("start", (), [f"to{k}" for k in sorted(near[0])]))
    others = [
        Candidate(profile(f"place{k:03}", [f"to{k}"], [f"to{n}" for n in sorted(near[k])])) for k in range(1, places)
    ]
    return made([[start], *([others] * (places - 1))], [(k - 1, k) for k in range(1, places)])


def frequencies(radios: int, channels: int, reach: float, seed: int) -> Problem:
    """Radios on a square: two near each other use channels apart, and further apart the nearer they are."""
    rng = random.Random(seed)
    places = [(rng.random(), rng.random()) for _ in range(radios)]
    pairs: dict[tuple[int, int], Goes] = {}
    for a, b in combinations(range(radios), 2):
        distance = math.dist(places[a], places[b])
        if distance < reach:
            pairs[a, b] = partial(_apart, 1 + (distance < 0.7 * reach) + (distance < 0.4 * reach))
    return in_pairs([rng.sample(range(channels), channels - 2) for _ in range(radios)], pairs)


def _apart(least: int, one: int, other: int) -> bool:
    return abs(one - other) >= least


def coloured_parameters(nodes: int, colours: int, degree: float, seed: int) -> Problem:
    """A random graph to be coloured: a free parameter for each node, a role for each edge that names two colours."""
    rng = random.Random(seed)
    edges = rng.sample(list(combinations(range(nodes), 2)), round(nodes * degree / 2))
    variables = tuple(
        Variable(iri(f"node{n:03}"), tuple(iri(f"colour{n:03}.{c}") for c in range(colours))) for n in range(nodes)
    )
    pairs = [(a, b) for a, b in product(range(colours), repeat=2) if a != b]
    parts = []
    for number, (one, other) in enumerate(edges):
        some = []
        for k, (a, b) in enumerate(rng.sample(pairs, len(pairs))):
            admits = [ANY_VALUE] * nodes
            admits[one], admits[other] = 1 << a, 1 << b
            some.append(Candidate(profile(f"edge{number:03}.{k:02}"), tuple(admits)))
        parts.append(some)
    return counted(parts, [1] * len(parts), (), variables)


def tree(nodes: int, sockets: int, more: int, depth: int, seed: int) -> Problem:
    """A tree that spans a random graph: each node but the first hangs at a socket of a neighbour, a level below it."""
    rng = random.Random(seed)
    near: list[set[int]] = [set() for _ in range(nodes)]
    links = [(rng.randrange(max(0, node - 6), node), node) for node in range(1, nodes)]
    for a, b in [*links, *rng.sample(list(combinations(range(nodes), 2)), more)]:
        near[a].add(b)
        near[b].add(a)
    parts = [[hearing("first", {}, ["level0"])]]
    for node in range(1, nodes):
        places = [
            (other, socket, level)
            for other in sorted(near[node])
            for socket in range(sockets)
            for level in ((1,) if other == 0 else range(2, depth + 1))
        ]
        parts.append(
            [
                hearing(f"socket{other:03}.{socket}.{level:02}", {other: f"level{level - 1}"}, [f"level{level}"])
                for other, socket, level in rng.sample(places, len(places))
            ]
        )
    return heard_by_name(parts, [(other, node) for node in range(1, nodes) for other in sorted(near[node])])


def cycles(nodes: int, more: int, seed: int) -> Problem:
    """Cycles of three nodes or more through all of a random graph, which has some.

    A role says who follows a node, and one whom it follows.
    """
    rng = random.Random(seed)
    order = rng.sample(range(nodes), nodes)
    links = [*zip(order, order[1:] + order[:1], strict=True), *rng.sample(list(combinations(range(nodes), 2)), more)]
    near: list[set[int]] = [set() for _ in range(nodes)]
    for a, b in links:
        near[a].add(b)
        near[b].add(a)

    def both(one: int, other: int) -> Goes:
        return lambda after, before: (after == other) == (before == one)

    def not_both(one: int, other: int) -> Goes:
        return lambda a, b: a != other or b != one

    domains = [rng.sample(sorted(some), len(some)) for some in near] * 2
    pairs = {(one, nodes + other): both(one, other) for one in range(nodes) for other in sorted(near[one])}
    pairs |= {(one, other): not_both(one, other) for one in range(nodes) for other in sorted(near[one]) if one < other}
    return in_pairs(domains, pairs)
