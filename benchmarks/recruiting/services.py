"""Chains of services as in the contest WSC 2008, generated: the descriptions, and a check of what answers a request.

In the contest a service takes and gives instances of the concepts of a taxonomy (`services.xml`, `taxonomy.owl`), and a
request names what is given and what is wanted (`problem.wsdl`); what a service gives serves an input if its concept is
that of the input or lies below it. Only the concepts of the instances matter to that, so that they are the signal types
here. What is given is issued by one component without inputs; the request is the only role, a component whose inputs
are the wanted concepts.

There are three families:

* `contest`, as the sets of the contest are built: a few solutions, each a row of steps of which one needs all that the
  step before issues, each step offered by several services that ask for less or issue more; the other services take and
  give what is drawn at random, and can mostly not be fed.
* `decoys`: layers of services, each of which needs what the layer before issues, or something below that in the
  taxonomy; the other services resemble them, so that most can be fed, and many are detours.
* `markets`: few kinds of services, each offered by many with equal ports, that ask for what is general and issue what
  is specific, in a taxonomy that is much deeper; one kind follows from another in a long row, and most can be fed.
"""

from __future__ import annotations

import random
from dataclasses import dataclass

PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix : <urn:services:> .
"""
TASK = PREFIXES + (
    ":compose a sc:Template ; sc:roles ( :request ) .\n:request a sc:Role ; sh:class :Request ; sc:recruits true ."
)
CONCEPTS = {158: 1540, 558: 1565, 604: 3089, 1041: 3135, 1090: 3067, 2198: 12468, 4113: 3075, 8119: 12337}
"""For each of the eight sets of the contest, by its number of services, the number of concepts."""
STEPS = {158: 10, 558: 5, 604: 40, 1041: 10, 1090: 20, 2198: 35, 4113: 20, 8119: 30}
"""For each of the eight sets, about as many services as its best published solution has."""
SOLUTIONS = {604: 1, 1090: 1, 2198: 1}
"""How many solutions a set has; three if nothing is said."""
MOST_CONCEPTS = 20_000
"""How many concepts instances of other sizes have at most; else twice as many as services."""


@dataclass(frozen=True)
class Services:
    """An instance: services as their inputs and outputs, the taxonomy, and how many services the planted chain has."""

    parent: dict[int, int]
    """For each concept but the root the one right above it."""
    services: dict[str, tuple[list[int], list[int]]]
    wanted: list[int]
    planted: int

    def above(self, concept: int) -> list[int]:
        """A concept, and all above it."""
        found = [concept]
        while found[-1] in self.parent:
            found.append(self.parent[found[-1]])
        return found

    def ontology(self) -> str:
        """The taxonomy as Turtle."""
        return PREFIXES + "".join(f":C{low} rdfs:subClassOf :C{high} .\n" for low, high in self.parent.items())

    def advertisements(self) -> str:
        """The services and the request as Turtle."""
        everything = {**self.services, "request": (self.wanted, [])}
        return PREFIXES + "".join(_advertised(name, *ports) for name, ports in everything.items())

    def enough(self, chosen: list[str]) -> bool:
        """Whether services, taken in some order, can all be fed, and issue what is wanted."""
        known: set[int] = set()
        waiting = list(chosen)
        while ready := [name for name in waiting if known.issuperset(self.services[name][0])]:
            for name in ready:
                known.update(high for low in self.services[name][1] for high in self.above(low))
                waiting.remove(name)
        return not waiting and known.issuperset(self.wanted)


def _advertised(name: str, inputs: list[int], outputs: list[int]) -> str:
    kind = "Request" if name == "request" else "Service"
    ports = [f'sc:hasInput [ sc:name "i{k}" ; sc:signalType :C{concept} ]' for k, concept in enumerate(inputs)]
    ports += [f'sc:hasOutput [ sc:name "o{k}" ; sc:signalType :C{concept} ]' for k, concept in enumerate(outputs)]
    return " ;\n    ".join([f":{name} a sc:Component, :{kind}", *ports]) + " .\n"


@dataclass(frozen=True)
class Taxonomy:
    """A tree of concepts, of which 0 is the root."""

    rng: random.Random
    parent: dict[int, int]
    children: dict[int, list[int]]

    @classmethod
    def of(cls, number: int, rng: random.Random, deep: bool = False) -> Taxonomy:
        """A tree for a number of services; 6,000 concepts lie 15 deep in the mean, or 35 in a deep one."""
        concepts = CONCEPTS.get(number) or min(MOST_CONCEPTS, 2 * number)
        first = (2 * low // 3 if deep else max(0, low // 3 - 2) for low in range(1, concepts))
        parent = {low: rng.randrange(least, low) for low, least in enumerate(first, 1)}
        children: dict[int, list[int]] = {}
        for low, high in parent.items():
            children.setdefault(high, []).append(low)
        return cls(rng, parent, children)

    def __len__(self) -> int:
        return len(self.parent) + 1

    def any(self) -> int:
        """Some concept."""
        return self.rng.randrange(len(self))

    def below(self, concept: int) -> int:
        """The concept, or one below it."""
        while self.children.get(concept) and self.rng.random() < 0.5:
            concept = self.rng.choice(self.children[concept])
        return concept

    def above(self, concept: int) -> int:
        """The concept, or one a little above it, but not among the first, which nearly everything lies below."""
        while self.parent.get(concept, 0) > 3 and self.rng.random() < 0.3:
            concept = self.parent[concept]
        return concept


def decoys(number: int, seed: int) -> Services:
    """An instance of a number of services of which most can be fed."""
    rng = random.Random(f"{number}/{seed}")
    tree = Taxonomy.of(number, rng)
    depth, width = rng.randint(3, 23), rng.randint(1, 5)
    layer = [tree.any() for _ in range(rng.randint(2, 4))]
    services = {"given": (list[int](), [tree.below(concept) for concept in layer])}
    for place in range(depth):
        following: list[int] = []
        for k in range(width):
            issued = [tree.any() for _ in range(rng.randint(1, 3))]
            needed = rng.sample(layer, min(len(layer), rng.randint(1, 3)))
            services[f"planted{place}.{k}"] = needed, [tree.below(concept) for concept in issued]
            following += issued
        layer = following
    planted = len(services)
    names = list(services)
    while len(services) < number:
        inputs, outputs = services[rng.choice(names)]
        needed = [tree.below(concept) if rng.random() < 0.7 else tree.any() for concept in inputs or layer]
        issued = [concept if rng.random() < 0.3 else tree.any() for concept in outputs]
        services[f"service{len(services)}"] = needed, issued
        names.append(f"service{len(services) - 1}")
    return _shuffled(rng, tree, services, rng.sample(layer, min(len(layer), 4)), planted)


def contest(number: int, seed: int) -> Services:
    """An instance of a number of services that are built as those of the contest are."""
    rng = random.Random(f"contest/{number}/{seed}")
    tree = Taxonomy.of(number, rng)
    unused = rng.sample(range(len(tree) // 4, len(tree)), len(tree) - len(tree) // 4)
    layer, wanted = [unused.pop() for _ in range(rng.randint(2, 5))], [unused.pop() for _ in range(rng.randint(1, 3))]
    services = {"given": (list[int](), [tree.below(concept) for concept in layer])}
    steps = STEPS.get(number, min(20, 1 + number // 60))
    for solution in range(SOLUTIONS.get(number, 3)):
        # The first is the shortest that is planted.
        name = "planted" if not solution else f"other{solution}."
        length = steps if not solution else steps + rng.randint(1, steps)
        services |= _solution(tree, name, layer, wanted, length, unused)
    leaves = [concept for concept in range(len(tree)) if concept not in tree.children]
    while len(services) < number:
        issued = [tree.any() for _ in range(rng.randint(3, 9))]
        services[f"service{len(services)}"] = [rng.choice(leaves) for _ in range(rng.randint(2, 7))], issued
    return _shuffled(rng, tree, services, wanted, steps + 1)


def _solution(
    tree: Taxonomy, name: str, given: list[int], wanted: list[int], length: int, unused: list[int]
) -> dict[str, tuple[list[int], list[int]]]:
    """A row of steps, some of which stand beside each other; each is offered by one to nine services."""
    rng = tree.rng
    services: dict[str, tuple[list[int], list[int]]] = {}
    layer, place = given, 0
    while place < length:
        wide = min(length - place, rng.choice((1, 1, 1, 2, 2, 3, 4)))
        if place + wide == length and wide > len(wanted):
            wide = 1
        if place + wide == length:
            issued = [wanted[k::wide] for k in range(wide)]
        else:
            most = 9 if wide == 1 else 2
            issued = [[unused.pop() for _ in range(min(most, rng.choice((1, 2, 2, 3, 4))))] for _ in range(wide)]
        for outputs in issued:
            for k in range(rng.choice((1, 1, 1, 2, 2, 3, 3, 4, 5, 6, 9))):
                more = [tree.any() for _ in range(rng.randint(0, 4))]
                inputs = [tree.above(concept) for concept in layer]
                services[f"{name}{place}.{k}"] = inputs, [tree.below(concept) for concept in outputs] + more
            place += 1
        layer = [concept for outputs in issued for concept in outputs]
    return services


def markets(number: int, seed: int) -> Services:
    """An instance of a number of services, many of which are equal to others."""
    rng = random.Random(f"markets/{number}/{seed}")
    tree = Taxonomy.of(number, rng, deep=True)
    leaves = [concept for concept in range(len(tree)) if concept not in tree.children]

    def general(concept: int, most: int) -> int:
        for _ in range(rng.randint(0, most)):
            concept = tree.parent[concept] if tree.parent.get(concept, 0) > len(tree) // 50 else concept
        return concept

    layer = rng.sample(leaves, 4)
    services = {"given": (list[int](), layer)}
    steps = STEPS.get(number, 20)
    for place in range(steps):
        issued = rng.sample(leaves, rng.randint(1, 3))
        services[f"planted{place}"] = [general(rng.choice(layer), 2) for _ in range(rng.randint(1, 3))], issued
        layer = issued
    kinds = [*services.values()][1:]
    for _ in range(number // 10):
        inputs = [general(rng.choice(leaves), 6) for _ in range(rng.randint(1, 4))]
        kinds.append((inputs, rng.sample(leaves, rng.randint(1, 4))))
    while len(services) < number:
        # A few kinds are offered by very many, most by a few.
        services[f"service{len(services)}"] = kinds[int(len(kinds) * rng.random() ** 2)]
    return _shuffled(rng, tree, services, [general(concept, 1) for concept in layer], steps + 1)


def _shuffled(
    rng: random.Random,
    tree: Taxonomy,
    services: dict[str, tuple[list[int], list[int]]],
    wanted: list[int],
    planted: int,
) -> Services:
    order = list(services)
    rng.shuffle(order)
    return Services(tree.parent, {name: services[name] for name in order}, wanted, planted)


FAMILIES = {"contest": contest, "decoys": decoys, "markets": markets}
