"""How many components are recruited and how long that takes, beside clingo and CP-SAT, on chains of services.

    python -m benchmarks.recruiting [--seed 1] [--services 158 558 ...] [--smoke] [--write]

The sizes are those of the contest WSC 2008, then 10,000 and 100,000 services, in three families (`services.py`).
selfconf gets advertisements in Turtle and reports the time to load them apart from the time for partition and search;
the general solvers (`engines.py`) get numbers, and report the time for model and search, up to a limit. Each engine has
a process of its own, one after another. All are asked for the fewest services; each answer is checked by forward
chaining (`Services.enough`), which shares no code with any of them. `planted` is the number of services of the solution
that was built in; fewer may be enough.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import tempfile
import time
from collections.abc import Callable
from itertools import product
from multiprocessing.connection import Connection
from pathlib import Path

import selfconf as sc
from benchmarks.machine import described, table
from benchmarks.recruiting.engines import ENGINES, LIMIT, PACKAGES, Engine
from benchmarks.recruiting.services import CONCEPTS, FAMILIES, TASK, Services, decoys
from selfconf.model.configuration import Configuration

GROWTH = (10_000, 100_000)
"""The sizes beyond those of the contest."""
SMALL = decoys(40, 0)
"""What each engine solves before its time begins."""
PAGE = Path(__file__).parents[2] / "docs" / "benchmarks" / "recruiting.md"
INTRODUCTION = f"""# Recruits

Made by `python -m benchmarks.recruiting --write`; what is measured is told at the head of its `__main__.py`. Times are
in seconds; `-` is no answer within {LIMIT:.0f} s, and a number in brackets that of the services where that is another.

"""


def configured(given: Services) -> tuple[list[str], float, float]:
    """The services that selfconf recruits, and the seconds to load, and to partition and search."""
    with tempfile.TemporaryDirectory() as folder:
        ontology = Path(folder) / "taxonomy.ttl"
        ontology.write_text(given.ontology(), "utf-8")
        text = given.advertisements()
        began = time.perf_counter()
        home = sc.read(text)
        task = sc.template(TASK)
        loaded = time.perf_counter()
        answer = sc.configure(task, home, reasoning="subclass", ontologies=ontology)
        ended = time.perf_counter()
    assert isinstance(answer, Configuration), answer
    return [component.short for component in answer.recruits], loaded - began, ended - loaded


def alone(run: Callable[[Services], object], given: Services, limit: float) -> object:
    """What a function returns in a process of its own, or None after a limit in seconds."""
    receiving, sending = multiprocessing.Pipe(duplex=False)
    process = multiprocessing.Process(target=_sent, args=(run, given, sending))
    process.start()
    sending.close()
    # The process has its small instance to solve before, and may end without an answer, for want of memory say.
    found: object = None
    try:
        found = receiving.recv() if receiving.poll(limit) else None
    except EOFError:
        found = None
    process.kill()
    process.join()
    return found


def _sent(run: Callable[[Services], object], given: Services, sending: Connection) -> None:
    run(SMALL)
    sending.send(run(given))


def timed(engine: Engine, given: Services) -> tuple[list[str] | None, float]:
    """The services that a general solver finds, and the seconds that it takes."""
    began = time.perf_counter()
    found = engine(given)
    return found, time.perf_counter() - began


class Timed:
    """A general solver with its time, by name, so that another process can be told to run it."""

    def __init__(self, name: str) -> None:
        self.name = name

    def __call__(self, given: Services) -> tuple[list[str] | None, float]:
        return timed(ENGINES[self.name], given)


def measured(family: str, number: int, seed: int) -> list[str]:
    """A row of the table. Raises AssertionError where an answer is none."""
    given = FAMILIES[family](number, seed)
    ours = alone(configured, given, 600)
    assert isinstance(ours, tuple), "selfconf has no answer"
    chosen, load, search = ours
    assert given.enough(chosen), chosen
    row = [*map(str, (family, number, seed, given.planted, len(chosen))), f"{load:.2f}", f"{search:.2f}"]
    for name in ENGINES:
        found = alone(Timed(name), given, LIMIT)
        services, seconds = found if isinstance(found, tuple) else (None, LIMIT)
        if services is not None:
            assert given.enough(services), (name, services)
        other = "" if services is None or len(services) == len(chosen) else f" ({len(services)})"
        row.append("-" if services is None else f"{seconds:.2f}{other}")
    return row


def main() -> int:
    """Measure and print, or write the page; the exit code is 0, for a wrong answer raises."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.recruiting", description="chains of services")
    parser.add_argument("--seed", type=int, action="append", help="may be repeated; 1 and 2 if it is not said")
    parser.add_argument("--services", type=int, nargs="+", default=(*CONCEPTS, *GROWTH))
    parser.add_argument("--smoke", action="store_true", help="small instances, to see that it works")
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.name} among the docs")
    given = parser.parse_args()
    sizes, seeds = ((40,), (1,)) if given.smoke else (given.services, given.seed or (1, 2))
    rows = []
    for family, number, seed in product(FAMILIES, sizes, seeds):
        rows.append(measured(family, number, seed))
        print(*rows[-1], file=sys.stderr, flush=True)
    head = ["family", "services", "seed", "planted", "recruits", "load", "partition and search", *ENGINES]
    text = f"{table(head, rows)}\n\n{described(*PACKAGES)}"
    print(text)
    if given.write:
        PAGE.write_text(f"{INTRODUCTION}{text}\n", "utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
