"""Side by side: the search, general solvers, SPARQL and the paper's algorithm, on families made from seeds.

    python -m benchmarks.search.run [--full | --smoke] [--limit SECONDS] [--only FAMILY] [--tuning] [--write]

Every engine runs in a process of its own, with a time limit; all must agree whether there is a configuration. Ours
answers with the first one, the others with any, which is the easier question; then those that can be are asked for
the first one as well. `--tuning` tries the thresholds of the
search on instances that are not reported (`tuning`). `--write` does both, and writes `docs/benchmarks/search.md` and
the plot beside it.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path

from benchmarks.search import first, tuning
from benchmarks.search.engines import SMALL, installed
from benchmarks.search.families import scaling as f
from benchmarks.search.families.wiring import Instance
from benchmarks.search.measure import Measured, made, measure
from benchmarks.search.report import Row, page, plot, table

SEED = 52_417
PAGE = Path(__file__).resolve().parents[2] / "docs" / "benchmarks" / "search.md"


def instances(full: bool) -> Iterator[Instance]:
    """The instances of a run, the short one or all of them."""
    seeds = range(SEED, SEED + (3 if full else 1))
    for k in (10, 100, 1_000, 10_000, 100_000):
        yield Instance("navigation", f"{k} per role", k, partial(f.navigation, k, SEED))
        yield Instance("navigation, impossible", f"{k} per role", k, partial(f.navigation, k, SEED, False))
    for kind in ("chain", "tree", "graph"):
        for roles in (5, 20, 50, 200) if full else (20, 50, 200):
            for seed in seeds:
                yield Instance(kind, f"{roles} roles, seed {seed}", roles, partial(f.graph, kind, roles, 10, 3, seed))
    for k in (12, 60, 120, *((240,) if full else ())):
        yield Instance("distinct", f"{k} roles, {k} components", k, partial(f.distinct, k, k))
        yield Instance("distinct, impossible", f"{k} roles, {k - 1} components", k, partial(f.distinct, k, k - 1))
    for k in (60, 120, 240):
        yield Instance("distinct, scarce", f"{k} roles, {k} components", k, partial(f.scarce, k, 0.1, SEED))
    for variables in (50, 100, 150):
        for seed in range(SEED, SEED + (5 if full else 2)):
            make = partial(f.satisfiability, variables, 4.26, seed)
            yield Instance("3-SAT", f"{variables} variables, seed {seed}", variables, make)
    for roles in (20, 50, 200):
        yield Instance("missing signal", f"{roles} roles", roles, partial(f.missing, roles, 20, SEED))
    for k in (100, 1_000, 10_000):
        yield Instance("fleet of 100", f"{k} per role", k, partial(f.fleet, 100, k, SEED))


def smoke() -> Iterator[Instance]:
    """The smallest of each family, to see that everything runs."""
    yield Instance("navigation", "4 per role", 4, partial(f.navigation, 4, SEED))
    yield Instance("navigation", "40 per role", 40, partial(f.navigation, 40, SEED))
    yield Instance("navigation, impossible", "4 per role", 4, partial(f.navigation, 4, SEED, False))
    yield Instance("graph", "5 roles", 5, partial(f.graph, "graph", 5, 4, 2, SEED))
    yield Instance("distinct, impossible", "4 roles, 3 components", 4, partial(f.distinct, 4, 3))
    yield Instance("3-SAT", "10 variables", 10, partial(f.satisfiability, 10, 4.26, SEED))
    yield Instance("fleet of 5", "8 per role", 8, partial(f.fleet, 5, 8, SEED))


def measured(instance: Instance, engines: Sequence[str], limit: float, times: int) -> Iterator[Row]:
    """Every engine that is not hopeless on an instance: asked for any configuration, and then for the first.

    The second row is only there if there is a configuration. Raises AssertionError if engines disagree.
    """
    problem = made(instance.make)
    hopeful = [e for e in engines if instance.size <= SMALL.get(e, instance.size) and not _hopeless(e, instance)]
    row = _row(instance, {engine: measure(engine, problem, limit, times) for engine in hopeful})
    yield row
    if not row.answer:
        return
    asked = [e for e in first.ENGINES if e.partition(",")[0] in engines and first.able(e, problem)]
    yield _row(instance, {engine: measure(engine, problem, limit, times, first.ENGINES) for engine in asked})


def _row(instance: Instance, found: dict[str, Measured]) -> Row:
    answers = {one.answer for one in found.values() if one.answer is not None}
    if len(answers) > 1:
        raise AssertionError(f"the engines disagree on {instance.family}, {instance.name}: {found}")
    return Row(instance, found, answers.pop() if answers else None)


def _hopeless(engine: str, instance: Instance) -> bool:
    if engine == "Oxigraph" and instance.family.startswith("distinct") and "scarce" not in instance.family:
        return False
    return engine in SMALL and not instance.family.startswith(("navigation", "fleet")) and instance.size > 5


def main() -> int:
    """Run, compare, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--full", action="store_true", help="all families at all sizes")
    parser.add_argument("--smoke", action="store_true", help="a few small instances, to see that everything runs")
    parser.add_argument("--limit", type=float, help="seconds for each answer (3; 20 with --full; 0.3 with --smoke)")
    parser.add_argument("--only", default="", help="families whose name contains this")
    parser.add_argument("--write", action="store_true", help="write the page and the plot")
    parser.add_argument("--tuning", action="store_true", help="only try the thresholds of the search")
    options = parser.parse_args()
    limit = options.limit or (20.0 if options.full else 0.3 if options.smoke else 3.0)
    rows: list[Row] = []
    engines = installed()
    if options.tuning:
        print(tuning.table(tuning.tried(limit)))
        return 0
    for instance in smoke() if options.smoke else instances(options.full):
        if options.only in instance.family:
            for row in measured(instance, engines, limit, 1 if options.smoke else 3):
                rows.append(row)
                print(table([row]).splitlines()[-1], flush=True)
    if not any("selfconf" in row.found for row in rows):
        print("nothing was measured", file=sys.stderr)
        return 1
    text = page(rows, limit, tuning.table(tuning.tried(limit)) if options.write else "")
    print(f"\n{text}")
    if options.write:
        PAGE.parent.mkdir(exist_ok=True)
        PAGE.write_text(text)
        plot([row for row in rows if not isinstance(row.answer, tuple)], limit, PAGE.with_suffix(".png"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
