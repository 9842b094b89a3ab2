"""Chains of services as in the contest WSC 2008, generated: the descriptions, and a check of what answers a request.

In the contest a service takes and gives instances of the concepts of a taxonomy (`services.xml`, `taxonomy.owl`), and a
request names what is given and what is wanted (`problem.wsdl`); what a service gives serves an input if its concept is
that of the input or lies below it. Only the concepts of the instances matter to that, so that they are the signal types
here. What is given is issued by one component without inputs; the request is the only role, a component whose inputs
are the wanted concepts.

Services are made around a solution: layers of services, each of which needs what the layer before issues, or something
below that in the taxonomy. Beside them stand decoys: services with concepts that are alike, of which some lead nowhere
and others are detours.
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


def made(number: int, seed: int) -> Services:
    """An instance of a number of services."""
    rng = random.Random(f"{number}/{seed}")
    concepts = CONCEPTS.get(number) or min(MOST_CONCEPTS, 2 * number)
    parent = {low: rng.randrange(max(0, low // 3 - 2), low) for low in range(1, concepts)}
    children: dict[int, list[int]] = {}
    for low, high in parent.items():
        children.setdefault(high, []).append(low)

    def below(concept: int) -> int:
        while children.get(concept) and rng.random() < 0.5:
            concept = rng.choice(children[concept])
        return concept

    depth, width = rng.randint(3, 23), rng.randint(1, 5)
    layer = [rng.randrange(concepts) for _ in range(rng.randint(2, 4))]
    services = {"given": (list[int](), [below(concept) for concept in layer])}
    for place in range(depth):
        following: list[int] = []
        for k in range(width):
            issued = [rng.randrange(concepts) for _ in range(rng.randint(1, 3))]
            needed = rng.sample(layer, min(len(layer), rng.randint(1, 3)))
            services[f"planted{place}.{k}"] = needed, [below(concept) for concept in issued]
            following += issued
        layer = following
    planted = len(services)
    names = list(services)
    while len(services) < number:
        inputs, outputs = services[rng.choice(names)]
        needed = [below(concept) if rng.random() < 0.7 else rng.randrange(concepts) for concept in inputs or layer]
        issued = [concept if rng.random() < 0.3 else rng.randrange(concepts) for concept in outputs]
        services[f"service{len(services)}"] = needed, issued
        names.append(f"service{len(services) - 1}")
    order = list(services)
    rng.shuffle(order)
    return Services(parent, {name: services[name] for name in order}, rng.sample(layer, min(len(layer), 4)), planted)
