"""How long `configure` takes over many advertisements, beside what else could read them, in the same run.

    python -m benchmarks.scale [--full] [--smoke]

An ecology of N generated components in one Turtle file, of 200 kinds, each with ports, a parameter, properties and a
preference; the paper's template of five roles asks for five of the kinds, on one robot. Each row:

    parse      bare iteration over Oxigraph's parser on the same bytes, nothing kept
    load       from the bytes to advertisements that can be partitioned, as `configure --ads` reads them
    partition  F1 ... F5
    search     the first configuration
    refusal    the same once the robot has lost its drives: the reasons, near misses, and a search in subclass mode
    rdflib     parsing into a graph, nothing else; beside it bulk load into an Oxigraph store in memory, which parses
               in several threads (left out above 100,000: it takes 10 kB an advertisement)

Times are seconds of processor time, the least of some trials; the two that are compared are measured in turns.
Memory is what the process grew by at its peak, for each advertisement: every size and engine has a process of its own.
A second table adds components that no role wants to a task, and shows what that does to the search.
"""

from __future__ import annotations

import argparse
import json
import random
import resource
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TypeVar

import pyoxigraph as ox
import rdflib

from benchmarks.machine import described, table
from selfconf import library
from selfconf.cli.inputs import parse_file, read_advertisements
from selfconf.configurator.compose import Composer
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import Reasoning
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.rdf import bindings, templates, turtle
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.closure import hierarchy
from selfconf.rdf.templates import TaskDocument
from selfconf.search import solve
from selfconf.search.problem import Problem

Result = TypeVar("Result")
PREFIXES = """@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix sh: <http://www.w3.org/ns/shacl#> .
@prefix xsd: <http://www.w3.org/2001/XMLSchema#> .
@prefix : <https://example.org/scale#> .
"""
ROLES = {
    "sonar": ((), ("RangeScan",)),
    "encoder": ((), ("Odometry2D",)),
    "position": ((), ("PlanarPose2D",)),
    "control": (("RangeScan", "Odometry2D", "PlanarPose2D"), ("Velocity2D",)),
    "drive": (("Velocity2D",), ()),
}
KINDS = 200
ROBOTS = 5
SIZES = (1_000, 10_000, 100_000)
FULL = 1_000_000
RDFLIB_MOST = 10_000


def ecology(size: int, seed: int = 0, wanted: bool = True) -> Iterator[str]:
    """The advertisements; without `wanted`, of kinds that no role asks for."""
    rng = random.Random(seed)
    names = list(ROLES)
    yield PREFIXES
    for number in range(size):
        kind = rng.randrange(KINDS) if wanted else rng.randrange(len(ROLES), KINDS)
        kind = number if wanted and number < len(ROLES) else kind
        inputs, outputs = ROLES[names[kind]] if kind < len(ROLES) else _ports(rng)
        said = [f":c{'' if wanted else 'x'}{number:07} a sc:Component, :Kind{kind}"]
        said += [f'sc:hasInput [ sc:name "in{k}" ; sc:signalType rob:{s} ]' for k, s in enumerate(inputs)]
        said += [f'sc:hasOutput [ sc:name "out{k}" ; sc:signalType rob:{s} ]' for k, s in enumerate(outputs)]
        said.append(f'sc:hasParameter [ sc:name "mode" ; sc:parameterType :Mode{kind % 7} ]')
        robot = 0 if number < len(ROLES) else rng.randrange(ROBOTS)
        said.append(f"rob:support :robot{robot} ; rob:place :room{rng.randrange(20)}")
        said.append(f":latency {rng.random():.3f} ; :accuracy {rng.random():.2f} ; sc:preference {rng.randrange(10)}")
        yield " ;\n    ".join(said) + " .\n"


def _ports(rng: random.Random) -> tuple[list[str], list[str]]:
    return [f"Signal{rng.randrange(50)}" for _ in range(2)], [f"Signal{rng.randrange(50)}" for _ in range(2)]


def task(robot: str) -> TaskDocument:
    """The paper's template over the generated kinds, on a robot."""
    edges = {"sonar": "control", "encoder": "control", "position": "control", "control": "drive"}
    roles = [
        f":{name} a sc:Role ; sh:class :Kind{kind} ; sh:property [ sh:path rob:support ; sh:in ( :robot ) ]"
        + (f" ; sc:feeds :{edges[name]} ." if name in edges else " .")
        for kind, name in enumerate(ROLES)
    ]
    text = f"{PREFIXES}:t a sc:Template ; sc:parameter :robot ; sc:roles ( {' '.join(f':{r}' for r in ROLES)} ) .\n"
    text += ':robot a sc:Parameter ; sc:name "robot" ; sh:nodeKind sh:IRI .\n' + "\n".join(roles)
    given = templates.read(turtle.parse(text, "scale.ttl"))
    return bindings.complete(bindings.bind(given, [("robot", f":{robot}")]))


def timed(work: Callable[..., Result], *arguments: object) -> tuple[float, Result]:
    """Seconds of processor time, and what came of it."""
    began = time.process_time()
    result = work(*arguments)
    return time.process_time() - began, result


def bare(text: bytes) -> None:
    """Every triple of the parser, and nothing done with it."""
    for _ in ox.parse(text, format=ox.RdfFormat.TURTLE, base_iri="file:///ads.ttl"):
        pass


def keep(found: dict[str, float], part: str, seconds: float) -> None:
    """Remember the least time of a part."""
    found[part] = min(seconds, found.get(part, seconds))


def peak() -> float:
    """The most memory that this process had so far, in bytes."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024.0


def configure(path: Path, trials: int) -> dict[str, float]:
    """The parts of `configure`, with the time of bare parsing beside them."""
    found: dict[str, float] = {}
    text = path.read_bytes()
    before = peak()
    ads = read_advertisements([path])
    found["bytes"] = (peak() - before) / len(ads)
    for _ in range(trials):
        keep(found, "parse", timed(bare, text)[0])
        ads.clear()
        seconds, ads = timed(read_advertisements, [path])
        keep(found, "load", seconds)
    given = task("robot0")
    for _ in range(trials):
        composer = Composer(given)
        seconds, partition = timed(composer.partition, ads)
        keep(found, "partition", seconds)
        seconds, outcome = timed(composer.compose, ads, frozenset(), None)
        assert isinstance(outcome, Configuration), outcome
        keep(found, "search", seconds)
        lost = frozenset(candidate.profile.component for candidate in partition.candidates[-1])
        keep(found, "refusal", timed(refuse, composer, ads, lost)[0])
    found["candidates"] = sum(map(len, partition.candidates)) / len(ROLES)
    return found


def refuse(composer: Composer, ads: Mapping[IRI, Advertisement], lost: frozenset[IRI]) -> None:
    """All that a refusal costs: the reasons, the near misses, and whether subclass mode knows better."""
    assert isinstance(composer.compose(ads, lost, None), Refusal)
    above = hierarchy([parse_file(path) for path in library.ontologies()], Reasoning.SUBCLASS)
    assert isinstance(Composer(composer.task, above).compose(ads, lost, None), Refusal)


def crowd(path: Path, trials: int) -> dict[str, float]:
    """The search alone, in an ecology and in the same ecology among components that no role wants."""
    given, found = task("robot0"), dict[str, float]()
    few = read_advertisements([path])
    many = few | read_advertisements([path.with_name("unwanted.ttl")])
    problems = {
        name: Problem(given.task, Composer(given).partition(ads))
        for name, ads in {"alone": few, "in the crowd": many}.items()
    }
    for _ in range(200 * trials):
        for name, problem in problems.items():
            keep(found, name, timed(solve.search, problem)[0])
    found["unwanted"] = len(many) - len(few)
    return found


def rdflib_graph(path: Path, trials: int) -> dict[str, float]:
    """Parsing into a graph of rdflib."""
    before = peak()
    seconds, graph = timed(lambda: rdflib.Graph().parse(path, format="turtle"))
    assert len(graph)
    return {"load": seconds, "bytes": peak() - before}


def oxigraph_store(path: Path, trials: int) -> dict[str, float]:
    """Bulk load into an Oxigraph store in memory; it parses in several threads."""
    before, store = peak(), ox.Store()
    seconds, _ = timed(lambda: store.bulk_load(path=str(path), format=ox.RdfFormat.TURTLE))
    return {"load": seconds, "bytes": peak() - before}


ENGINES: dict[str, Callable[[Path, int], dict[str, float]]] = {
    "configure": configure,
    "rdflib": rdflib_graph,
    "store": oxigraph_store,
    "crowd": crowd,
}


def measured(engine: str, path: Path, trials: int) -> dict[str, float]:
    """What an engine measures in a process of its own."""
    command = [sys.executable, "-m", "benchmarks.scale", "--engine", engine, "--trials", str(trials), str(path)]
    done = subprocess.run(command, check=True, capture_output=True, text=True)
    found: dict[str, float] = json.loads(done.stdout)
    return found


def row(size: int, folder: Path, with_rdflib: bool) -> list[str]:
    """One size, measured by every engine."""
    path = folder / f"{size}.ttl"
    with path.open("w") as file:
        file.writelines(ecology(size))
    trials = 1 if size > SIZES[-1] else 3 if size == SIZES[-1] else 5
    own = measured("configure", path, trials)
    store = measured("store", path, 1) if size < FULL else None
    graph = measured("rdflib", path, 1) if with_rdflib else None
    after = own["partition"] + own["search"] + own["refusal"]
    path.unlink()
    return [
        f"{size:,}",
        f"{own['parse']:.3f}",
        f"{own['load']:.3f}",
        f"{own['load'] / own['parse']:.2f}",
        f"{own['candidates']:.0f}",
        *(f"{1000 * own[part]:.1f}" for part in ("partition", "search", "refusal")),
        f"{100 * after / own['load']:.1f} %",
        f"{own['bytes']:.0f}",
        f"{store['load']:.2f} ({store['bytes'] / size:.0f})" if store else "",
        f"{graph['load']:.1f} ({graph['bytes'] / size:.0f}), {graph['load'] / own['load']:.0f} times" if graph else "",
    ]


HEAD = (
    "components", "parse s", "load s", "load / parse", "candidates per role", "partition ms", "search ms",
    "refusal ms", "those three / load", "bytes per advertisement", "Oxigraph store s (bytes)", "rdflib s (bytes)",
)  # fmt: skip


def main() -> int:
    """Print the tables."""
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--full", action="store_true", help="a million components too, and rdflib on 100,000")
    options.add_argument("--smoke", action="store_true", help="200 components, to see that it runs")
    options.add_argument("--engine", choices=ENGINES, help=argparse.SUPPRESS)
    options.add_argument("--trials", type=int, default=1, help=argparse.SUPPRESS)
    options.add_argument("path", nargs="?", type=Path, help=argparse.SUPPRESS)
    given = options.parse_args()
    if given.engine:
        print(json.dumps(ENGINES[given.engine](given.path, given.trials)))
        return 0
    sizes = (200,) if given.smoke else (*SIZES, FULL) if given.full else SIZES
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        most = SIZES[-1] if given.full else RDFLIB_MOST
        print(table(HEAD, [row(size, folder, size <= most) for size in sizes]))
        few, unwanted = (200, 1_000) if given.smoke else (10_000, 100_000)
        (folder / "wanted.ttl").write_text("".join(ecology(few)))
        (folder / "unwanted.ttl").write_text("".join(ecology(unwanted, wanted=False)))
        crowded = measured("crowd", folder / "wanted.ttl", 1)
    print(
        f"\nSearch among {few:,} components: {1e6 * crowded['alone']:.0f} us; with {crowded['unwanted']:,.0f} more "
        f"that no role wants: {1e6 * crowded['in the crowd']:.0f} us.\n\n{described('pyoxigraph', 'rdflib')}"
    )
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
