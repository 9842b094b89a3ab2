"""Side by side: the search, three general solvers and the paper's algorithm, on families made from seeds.

    python -m benchmarks.search.run [--full] [--limit SECONDS] [--only FAMILY]

Every engine runs in a process of its own, with a time limit; all must agree whether there is a configuration. The
table is Markdown. Thresholds of the search were chosen on other seeds than the ones here.
"""

from __future__ import annotations

import argparse
import gc
import importlib
import multiprocessing
import os
import platform
import resource
import statistics
import sys
import time
from collections.abc import Iterator
from functools import partial
from multiprocessing.connection import Connection

from benchmarks.search import families as f
from benchmarks.search.engines import ENGINES, LIBRARIES
from benchmarks.search.families import Instance

SEED = 7001


def instances(full: bool) -> Iterator[Instance]:
    """The instances of a run, the short one or all of them."""
    seeds = range(SEED, SEED + (3 if full else 1))
    for k in (10, 100, 1_000, 10_000, *((100_000,) if full else ())):
        yield Instance("navigation", f"{k} per role", partial(f.navigation, k, SEED))
        yield Instance("navigation, impossible", f"{k} per role", partial(f.navigation, k, SEED, False))
    for kind in ("chain", "tree", "graph"):
        for roles in (5, 20, 50, 200) if full else (20, 50):
            for seed in seeds:
                yield Instance(kind, f"{roles} roles, seed {seed}", partial(f.graph, kind, roles, 10, 3, seed))
    for k in (10, 100, *((300,) if full else ())):
        yield Instance("distinct", f"{k} roles, {k} components", partial(f.distinct, k, k))
        yield Instance("distinct", f"{k} roles, {k - 1} components", partial(f.distinct, k, k - 1))
    for variables in (50, 100, 150) if full else (50, 100):
        for seed in range(SEED, SEED + (5 if full else 2)):
            make = partial(f.satisfiability, variables, 4.26, seed)
            yield Instance("3-SAT", f"{variables} variables, seed {seed}", make)
    for roles in (20, 200) if full else (50,):
        yield Instance("missing signal", f"{roles} roles", partial(f.missing, roles, 20, SEED))
    for k in (100, 1_000, 10_000):
        yield Instance("fleet of 100", f"{k} per role", partial(f.fleet, 100, k, SEED))


def measure(engine: str, instance: Instance, limit: float) -> tuple[float, bool | None, float]:
    """Seconds, the answer (None: none within the limit) and the growth of memory in megabytes."""
    context = multiprocessing.get_context("fork")
    receiving, sending = context.Pipe(duplex=False)
    process = context.Process(target=_child, args=(engine, instance, sending))
    process.start()
    sending.close()
    answer: tuple[float, bool | None, float] = limit, None, 0.0
    if _ready(receiving) and receiving.poll(limit):
        try:
            answer = receiving.recv()
        except EOFError:
            answer = limit, None, 0.0
    process.kill()
    process.join()
    return answer


def _ready(receiving: Connection) -> bool:
    """Wait until the instance is made; that is not part of the time."""
    try:
        return receiving.poll(120) and bool(receiving.recv())
    except EOFError:
        return False


def _child(engine: str, instance: Instance, sending: Connection) -> None:
    if engine in LIBRARIES:
        importlib.import_module(LIBRARIES[engine])
    if engine == "selfconf":
        importlib.import_module("pysat.solvers")
    problem = instance.make()
    gc.collect()
    sending.send(True)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    start = time.perf_counter()
    answer = ENGINES[engine](problem)
    seconds = time.perf_counter() - start
    sending.send((seconds, answer, (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024))
    sending.close()


def main() -> int:
    """Run, compare, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--full", action="store_true", help="all families at all sizes")
    parser.add_argument("--limit", type=float, help="seconds for each engine and instance (3, or 20 with --full)")
    parser.add_argument("--only", default="", help="families whose name contains this")
    options = parser.parse_args()
    limit = options.limit or (20.0 if options.full else 3.0)
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}, limit {limit:g} s\n")
    print("| family | instance | answer | " + " | ".join(ENGINES) + " | selfconf / best |")
    print("|---|---|---|" + "---:|" * (len(ENGINES) + 1))
    ratios: list[float] = []
    against: dict[str, list[float]] = {engine: [] for engine in ENGINES}
    for instance in instances(options.full):
        if options.only not in instance.family:
            continue
        found: dict[str, tuple[float, bool | None, float]] = {}
        for engine in ENGINES:
            hopeless = engine == "Algorithm 1" and instance.family not in ("navigation", "navigation, impossible")
            if not hopeless and not (engine == "Algorithm 1" and not instance.name.startswith("10 ")):
                found[engine] = measure(engine, instance, limit)
        answers = {answer for _, answer, _ in found.values() if answer is not None}
        if len(answers) > 1:
            print(f"the engines disagree on {instance.family}, {instance.name}: {found}", file=sys.stderr)
            return 1
        mine, answer, _ = found["selfconf"]
        others = [s for e, (s, a, _) in found.items() if e != "selfconf" and a is not None]
        ratio = mine / min(others) if others else 0.0
        if answer is not None and others and max(mine, min(others)) > 0.01:
            ratios.append(ratio)
        for engine, (seconds, _, _) in found.items():
            against[engine].append(seconds / mine)
        cells = [_cell(found.get(engine)) for engine in ENGINES]
        word = "undecided" if not answers else "yes" if answers.pop() else "no"
        last = f"{ratio:.2f}" if others else "no other answers"
        print(f"| {instance.family} | {instance.name} | {word} | {' | '.join(cells)} | {last} |", flush=True)
    if ratios:
        worst = max(ratios)
        print(f"\nBeyond 10 ms of work: {statistics.median(ratios):.2f} times the best other engine in the median,")
        print(f"{worst:.2f} times at worst, over {len(ratios)} instances. Geometric mean of others against selfconf:")
        for engine, some in against.items():
            if engine != "selfconf" and some:
                print(f"{engine} {statistics.geometric_mean(some):.1f} times (time-outs count as the limit).")
    return 0


def _cell(found: tuple[float, bool | None, float] | None) -> str:
    if found is None:
        return ""
    seconds, answer, memory = found
    if answer is None:
        return f"> {seconds:g} s"
    return f"{seconds * 1000:.1f} ms" + (f", {memory:.0f} MB" if memory >= 10 else "")


if __name__ == "__main__":
    sys.exit(main())
