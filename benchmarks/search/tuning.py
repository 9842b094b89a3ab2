"""How the thresholds of the search were chosen: each varied by itself, on instances that are not reported.

The seeds and the sizes are other ones than those of the run. A setting is judged by its time on each instance as a
multiple of the time with what is chosen: the geometric mean over all instances, and the worst.
"""

from __future__ import annotations

import statistics
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial
from types import ModuleType

from benchmarks.search.families import scaling as f
from benchmarks.search.families.wiring import Instance
from benchmarks.search.measure import made, measure
from selfconf.search.engines import candidate_search
from selfconf.search.engines import clause_learning as sat
from selfconf.search.strategies import first as solve

SEEDS = range(7_001, 7_004)


@dataclass(frozen=True)
class Threshold:
    """A constant of the search, where it lies, and the values to be tried."""

    module: ModuleType
    name: str
    values: tuple[object, ...]

    @property
    def chosen(self) -> object:
        """What the search uses."""
        return getattr(self.module, self.name)


THRESHOLDS = (
    Threshold(solve, "CANDIDATE_STEPS", (0, 1, 2, 4, 8, 16)),
    Threshold(candidate_search, "SKIPS_PER_STEP", (1, 8, 32, 128)),
    Threshold(solve, "PREFIX_REACH", (0, 1, 2, 3, 4, 6)),
    Threshold(solve, "PREFIX_SHARE", (1, 2, 3, 4, 6)),
    Threshold(solve, "REDUCED_PACE", (0.0, 0.15, 0.3, 0.6, 1.2, 2.4, 4.8)),
    Threshold(sat, "SOLVER", ("Minicard", "Minisat22", "MinisatGH", "Glucose4", "MapleCM", "Cadical153", "Cadical195")),
)


@dataclass(frozen=True)
class Tried:
    """A value of a threshold, and how the times with it compare to those with the value chosen."""

    threshold: Threshold
    value: object
    mean: float
    worst: float


def instances() -> Iterator[Instance]:
    """The instances for tuning."""
    for seed in SEEDS:
        for k in (30, 300, 3_000):
            yield Instance("navigation", f"{k}, {seed}", k, partial(f.navigation, k, seed))
            yield Instance("navigation, impossible", f"{k}, {seed}", k, partial(f.navigation, k, seed, False))
            yield Instance("fleet", f"{k}, {seed}", k, partial(f.fleet, 50, k, seed))
        for kind in ("chain", "tree", "graph"):
            for roles in (30, 100, 300):
                yield Instance(kind, f"{roles}, {seed}", roles, partial(f.graph, kind, roles, 10, 3, seed))
        for variables in (40, 80, 120):
            yield Instance("3-SAT", f"{variables}, {seed}", variables, partial(f.satisfiability, variables, 4.26, seed))
        yield Instance("missing signal", f"100, {seed}", 100, partial(f.missing, 100, 20, seed))
    for roles in (30, 80):
        yield Instance("distinct", f"{roles}", roles, partial(f.distinct, roles, roles))
        yield Instance("distinct, impossible", f"{roles}", roles, partial(f.distinct, roles, roles - 1))


def tried(limit: float, times: int = 3) -> list[Tried]:
    """Every value of every threshold on every instance, the other thresholds being as they are."""
    seconds: dict[tuple[str, object], list[float]] = {}
    for instance in instances():
        problem = made(instance.make)
        for threshold in THRESHOLDS:
            chosen = threshold.chosen
            for value in threshold.values:
                setattr(threshold.module, threshold.name, value)
                taken = measure("selfconf", problem, limit, times).seconds
                seconds.setdefault((threshold.name, value), []).append(taken)
            setattr(threshold.module, threshold.name, chosen)
    found = []
    for threshold in THRESHOLDS:
        base = seconds[threshold.name, threshold.chosen]
        for value in threshold.values:
            ratios = [one / other for one, other in zip(seconds[threshold.name, value], base, strict=True)]
            found.append(Tried(threshold, value, statistics.geometric_mean(ratios), max(ratios)))
    return found


def table(found: list[Tried]) -> str:
    """The values that were tried, the chosen ones in bold."""
    lines = ["| threshold | value | time, geometric mean | worst |", "|---|---|---:|---:|"]
    for one in found:
        value = f"**{one.value}**" if one.value == one.threshold.chosen else str(one.value)
        lines.append(f"| {one.threshold.name} | {value} | {one.mean:.2f} | {one.worst:.2f} |")
    return "\n".join(lines)
