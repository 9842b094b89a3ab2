"""What reads advertisements, each measured in a process of its own: seconds of processor time, octets at the peak."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from decimal import Decimal
from pathlib import Path
from typing import TypeVar

import pyoxigraph as ox
import rdflib

from benchmarks.scale.worlds import ROLES, task
from selfconf import files
from selfconf.api.ontologies import hierarchy_of
from selfconf.api.reading import read
from selfconf.composition import TimeLimit, explained
from selfconf.composition.composer import Composer
from selfconf.model.configuration import Configuration
from selfconf.model.hierarchy import Reasoning
from selfconf.model.profile import Input, OperationalParameter, Output, Ports, Profile
from selfconf.model.refusal import Refusal
from selfconf.model.term import IRI
from selfconf.rdf.advertisements import Advertisement
from selfconf.rdf.advertisements.advertisement import property_order
from selfconf.rdf.eligibility.advertisement_index import AdvertisementIndex
from selfconf.rdf.permitted_fields import STRUCTURE
from selfconf.rdf.rdflib_terms import from_rdflib
from selfconf.rdf.vocabulary import SC
from selfconf.search.problem import Problem
from selfconf.search.strategies import first as solve

Result = TypeVar("Result")
Found = dict[str, float]


def timed(work: Callable[..., Result], *arguments: object) -> tuple[float, Result]:
    """Seconds of processor time, and what came of it."""
    began = time.process_time()
    result = work(*arguments)
    return time.process_time() - began, result


def keep(found: Found, part: str, seconds: float) -> None:
    """Remember the least time of a part."""
    found[part] = min(seconds, found.get(part, seconds))


def peak() -> float:
    """The most memory that this process had so far, in octets; `ru_maxrss` would begin with that of its parent."""
    (line,) = (line for line in Path("/proc/self/status").read_text().splitlines() if line.startswith("VmHWM"))
    return float(line.split()[1]) * 1024


def bare(path: Path) -> None:
    """Every triple of the parser, and nothing done with it."""
    for file in files.listed_files([path]):
        for _ in ox.parse(file.read_bytes(), format=ox.RdfFormat.TURTLE, base_iri="file:///ads.ttl"):
            pass


def loading(path: Path, trials: int) -> Found:
    """From the files to advertisements, with the time of bare parsing beside it; the two in turns."""
    before = peak()
    number = len(read(path))
    found = {"bytes": (peak() - before) / number}
    for _ in range(trials):
        keep(found, "parse", timed(bare, path)[0])
        keep(found, "load", timed(read, path)[0])
    return found


def configure(path: Path, trials: int) -> Found:
    """The parts of `configure`; each trial reads the advertisements anew, so that nobody has looked at them yet."""
    found, before = Found(), peak()
    given = task("robot0")
    for trial in range(trials):
        ads: Mapping[IRI, Advertisement] = AdvertisementIndex(
            {}
        )  # the last trial's are given back before the next are read
        seconds, ecology = timed(read, path)
        ads = ecology.advertisements()
        keep(found, "load", seconds)
        if trial == 0:
            found["bytes"] = (peak() - before) / len(ads)
        keep(found, "parse", timed(bare, path)[0])
        composer = Composer(given)
        seconds, partition = timed(composer.partition, ads)
        keep(found, "partition", seconds)
        seconds, outcome = timed(composer.compose, ads, frozenset(), None)
        assert isinstance(outcome, Configuration), outcome
        keep(found, "search", seconds)
        drives = {candidate.profile.component for candidate in partition.candidates[-1]}
        alive = AdvertisementIndex({component: one for component, one in ads.items() if component not in drives})
        composer.partition(alive)  # this is not timed again
        keep(found, "refusal", timed(refuse, composer, alive)[0])
        found["candidates"] = sum(map(len, partition.candidates)) / len(ROLES)
    return found


def refuse(composer: Composer, ads: Mapping[IRI, Advertisement]) -> None:
    """All that a refusal costs `configure`: reasons, near misses, repairs, and whether subclass mode knows better."""
    refusal = composer.compose(ads, frozenset(), None)
    assert isinstance(refusal, Refusal)
    wider = hierarchy_of(Reasoning.SUBCLASS)
    assert explained(composer, ads, refusal, wider, TimeLimit(None)).repairs


def crowd(path: Path, trials: int) -> Found:
    """The search alone, in an ecology and in the same ecology among components that no role wants."""
    given, found = task("robot0"), Found()
    few = read(path).advertisements()
    many = AdvertisementIndex({**few, **read(path.with_name("unwanted.ttl")).advertisements()})
    problems = {
        name: Problem(given.task, Composer(given).partition(ads))
        for name, ads in {"alone": few, "in the crowd": many}.items()
    }
    for _ in range(200 * trials):
        for name, problem in problems.items():
            keep(found, name, timed(solve.search, problem)[0])
    found["unwanted"] = len(many) - len(few)
    return found


def rdflib_graph(path: Path, trials: int) -> Found:
    """Parsing into a graph of rdflib, and reading the profiles from that."""
    before = peak()
    seconds, graph = timed(lambda: rdflib.Graph().parse(path, format="turtle"))
    reading, found = timed(profiles, graph)
    return {"load": seconds, "read": reading, "bytes": (peak() - before) / len(found)}


def profiles(graph: rdflib.Graph) -> list[Profile]:
    """The profiles of all components in a graph, with no checks at all."""
    sc = rdflib.Namespace(SC.base)

    def ports(component: rdflib.term.Node, link: str, kind: str) -> Sequence[tuple[str, IRI]]:
        nodes = graph.objects(component, sc[link])
        return sorted((str(graph.value(node, sc.name)), IRI(str(graph.value(node, sc[kind])))) for node in nodes)

    found = []
    for component in graph.subjects(rdflib.RDF.type, sc.Component):
        said = [(IRI(str(p)), from_rdflib(o)) for p, o in graph.predicate_objects(component)]
        found.append(
            Profile(
                component=IRI(str(component)),
                types=frozenset(IRI(str(kind)) for kind in graph.objects(component, rdflib.RDF.type)),
                properties=tuple(sorted((pair for pair in said if pair[0] not in STRUCTURE), key=property_order)),
                ports=Ports(
                    tuple(Input(name, (signal,)) for name, signal in ports(component, "hasInput", "signalType")),
                    tuple(Output(name, (signal,)) for name, signal in ports(component, "hasOutput", "signalType")),
                ),
                parameters=tuple(
                    OperationalParameter(*one) for one in ports(component, "hasParameter", "parameterType")
                ),
                preference=Decimal(str(graph.value(component, sc.preference) or 0)),
            )
        )
    return found


def oxigraph_store(path: Path, trials: int) -> Found:
    """Bulk load into an Oxigraph store in memory; it parses in several threads."""
    before, store = peak(), ox.Store()
    seconds, _ = timed(lambda: store.bulk_load(path=str(path), format=ox.RdfFormat.TURTLE))
    return {"load": seconds, "bytes": peak() - before}


ENGINES: dict[str, Callable[[Path, int], Found]] = {
    "configure": configure,
    "loading": loading,
    "rdflib": rdflib_graph,
    "store": oxigraph_store,
    "crowd": crowd,
}
