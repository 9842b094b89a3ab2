"""How many components are recruited, and how long that takes: chains of services as in the contest WSC 2008.

    python -m benchmarks.recruiting [--seed 1] [--services 158 558 ...] [--smoke] [--write]

A service is a component whose inputs and outputs are concepts of a taxonomy; what is given is issued by one component;
the request is the only role, a component whose inputs are the wanted concepts. Services are made around a solution:
layers of services, each of which needs what the layer before issues, or something below that in the taxonomy. Beside
them stand decoys: services with the same concepts, of which some lead nowhere and others are detours.

Each answer is checked by forward chaining in this file, which shares no code with the search. `planted` is the number
of services of the solution that was built in; fewer may be enough.
"""

from __future__ import annotations

import argparse
import random
import sys
import tempfile
import time
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import selfconf as sc
from benchmarks.machine import described, table
from selfconf.model.configuration import Configuration

PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix rdfs: <http://www.w3.org/2000/01/rdf-schema#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix : <urn:services:> .
"""
TASK = PREFIXES + (
    ":compose a sc:Template ; sc:roles ( :request ) .\n:request a sc:Role ; sh:class :Request ; sc:recruits true ."
)
SIZES = (158, 558, 604, 1041, 1090, 2198, 4113, 8119)
"""The numbers of services of the eight sets of the contest."""
PAGE = Path(__file__).parents[1] / "docs" / "benchmarks" / "recruiting.md"
INTRODUCTION = """# Recruits

Made by `python -m benchmarks.recruiting --write`; what is measured is told at the head of that file.

"""


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
    concepts = 3 * number
    parent = {low: rng.randrange(max(0, low // 3 - 2), low) for low in range(1, concepts)}
    children: dict[int, list[int]] = {}
    for low, high in parent.items():
        children.setdefault(high, []).append(low)

    def below(concept: int) -> int:
        while children.get(concept) and rng.random() < 0.5:
            concept = rng.choice(children[concept])
        return concept

    depth, width = rng.randint(3, 8), rng.randint(1, 5)
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


def measured(number: int, seed: int, folder: Path) -> list[str]:
    """A row of the table. Raises AssertionError where the answer is none."""
    given, ontology = made(number, seed), folder / "taxonomy.ttl"
    ontology.write_text(given.ontology(), "utf-8")
    began = time.perf_counter()
    home = sc.read(given.advertisements())
    task = sc.template(TASK)
    loaded = time.perf_counter()
    answer = sc.configure(task, home, reasoning="subclass", ontologies=ontology)
    ended = time.perf_counter()
    assert isinstance(answer, Configuration), answer
    chosen = [component.short for component in answer.recruits]
    assert given.enough(chosen), chosen
    counts = map(str, (number, seed, given.planted, len(chosen)))
    return [*counts, f"{loaded - began:.2f}", f"{ended - loaded:.2f}"]


def main() -> int:
    """Measure and print, or write the page; the exit code is 0, for a wrong answer raises."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.recruiting", description="chains of services")
    parser.add_argument("--seed", type=int, action="append", help="may be repeated; 1, 2 and 3 if it is not said")
    parser.add_argument("--services", type=int, nargs="+", default=SIZES)
    parser.add_argument("--smoke", action="store_true", help="two small instances, to see that it works")
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name} among the docs")
    given = parser.parse_args()
    sizes, seeds = ((40, 80), (1,)) if given.smoke else (given.services, given.seed or (1, 2, 3))
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        for number, seed in product(sizes, seeds):
            rows.append(measured(number, seed, Path(folder)))
            print(*rows[-1], file=sys.stderr, flush=True)
    head = ["services", "seed", "planted", "recruits", "load (s)", "partition and search (s)"]
    text = f"{table(head, rows)}\n\n{described()}"
    print(text)
    if given.write:
        PAGE.write_text(f"{INTRODUCTION}{text}\n", "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
