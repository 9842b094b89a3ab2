"""Side by side on families that the search was not tuned on at first, and on those that chose between its ideas.

    python -m benchmarks.search.further [--smoke] [--limit SECONDS] [--seeds N] [--only FAMILY] [--set SET] [--write]

Each engine runs in a process of its own, on the problems of `families/sets.py`, and is asked two questions: which
configuration is the first one, or that there is none, which is what selfconf answers; and, where there is one, for any
configuration, which is easier. An engine is stopped at the limit, or at `PATIENCE` times the best time so far where
that is sooner, since what is slower does not change how selfconf compares to the best.
`--write` writes `docs/benchmarks/further.md`.
"""

from __future__ import annotations

import argparse
import math
import os
import platform
import statistics
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from benchmarks.search import engines as anything
from benchmarks.search import first
from benchmarks.search.families.sets import SETS, SMALLEST
from benchmarks.search.families.wiring import Instance, instances
from benchmarks.search.measure import Measured, made, measure
from benchmarks.search.report import WORK, Row, table
from selfconf.search.problem import Problem

SEED = 94_211
SEEDS = 10
LIMIT = 60.0
PATIENCE = 3.0
"""An engine that has taken so many times as long as the best, and a second, is not waited for."""
MEDIAN, WORST, ANY = 0.7, 2.0, 2.0
"""The goals: the first configuration in so many times the best in the median and at worst; any one in the median."""
PAGE = Path(__file__).resolve().parents[2] / "docs" / "benchmarks" / "further.md"

SETTING = """\
One run on {machine}, {cores} cores, load {load:.1f} (above 1, other programs ran too), Python {python}; {seeds} seeds,
{limit:g} s for each answer. Every engine has a process of its own and starts from the same problem in its memory;
building a model is part of the time, importing a library is not. selfconf answers with the first configuration; where
MiniCard does not end at once, clasp works beside it in a thread, and later CaDiCaL in a process. Every other engine has
one thread. An engine that takes {patience:g} times as long as the best before it, and a second, is stopped, and its
time is written as `>`. Ratios are of those instances that take selfconf or the best other engine {work:g} ms at least.

The families `choosing` are those on which ideas and thresholds of the search were chosen; `reporting` were only
measured; `unseen` were made after the search was finished, and those called `later`, `last`, `newest`,
`installations`, `tasks`, `packings` and `rosters` once more each, to choose on and to measure. [The log of
experiments](../search-log.md) says why it lost, and what helped."""


class Asked(NamedTuple):
    """An instance, which set it is of, and how the engines did: asked for the first configuration, and for any."""

    set: str
    first: Row
    any: Row | None
    """None where there is no configuration, or none is known."""


def asked(set_: str, instance: Instance, installed: Sequence[str], limit: float, times: int = 3) -> Asked:
    """Ask all engines both questions about an instance; raises AssertionError if they disagree."""
    problem = made(instance.make)
    able = [e for e in first.ENGINES if e.partition(",")[0] in installed and e not in SLOW and first.able(e, problem)]
    found = _timed(problem, able, limit, times, first.ENGINES)
    least = Row(instance, found, _agreed(instance, found))
    if not least.answer:
        return Asked(set_, least, None)
    ours = Measured(found["selfconf"].seconds, found["selfconf"].answer and True)
    general = [engine for engine in anything.GENERAL if engine in installed]
    found = _timed(problem, general, limit, times, anything.ENGINES, {"selfconf": ours})
    return Asked(set_, least, Row(instance, found, _agreed(instance, found)))


SLOW = ("clingo, weights",)
"""Ways to ask an engine for the first configuration that are much slower than another way to ask it."""


def _timed(
    problem: Problem,
    engines: Sequence[str],
    limit: float,
    times: int,
    how: Mapping[str, Callable[[Problem], first.First]],
    known: Mapping[str, Measured] | None = None,
) -> dict[str, Measured]:
    found = dict(known or {})
    for engine in engines:
        best = min((one.seconds for one in found.values() if one.answer is not None), default=math.inf)
        # Ours is never stopped for being slow: how slow it is is what is asked.
        patience = limit if engine == "selfconf" else min(limit, 1.0 + PATIENCE * best)
        found[engine] = measure(engine, problem, patience, times, how, traced=False)
    return found


def _agreed(instance: Instance, found: Mapping[str, Measured]) -> first.First | None:
    answers = {one.answer for one in found.values() if one.answer is not None}
    if len(answers) > 1:
        raise AssertionError(f"the engines disagree on {instance.family}, {instance.name}: {found}")
    return answers.pop() if answers else None


def ratios(rows: Sequence[Row]) -> list[float]:
    """How many times as long as the best other engine selfconf takes, for each instance that is work.

    Where only selfconf has an answer, the others count as if they had it when they were stopped.
    """
    found = []
    for row in rows:
        ours = row.found["selfconf"]
        best = min(row.others.values(), default=min(one.seconds for e, one in row.found.items() if e != "selfconf"))
        if max(ours.seconds, best) > WORK and (ours.answer is not None or row.others):
            found.append(ours.seconds / best)
    return found


def undecided(rows: Sequence[Row]) -> int:
    """On how many instances selfconf has no answer that another engine has."""
    return sum(row.found["selfconf"].answer is None and bool(row.others) for row in rows)


def summary(everything: Sequence[Asked]) -> str:
    """A line for each family, and one for each set."""
    lines = [
        "| set | family | instances | first: median | worst | undecided | any: median | worst |",
        "|---|---|---:|---:|---:|---:|---:|---:|",
    ]
    for set_ in dict.fromkeys(one.set for one in everything):
        of_set = [one for one in everything if one.set == set_]
        for family in [*dict.fromkeys(one.first.instance.family for one in of_set), None]:
            some = [one for one in of_set if family in (None, one.first.instance.family)]
            least = [one.first for one in some]
            cells = [set_, family or "**all**", str(len(some)), *_middle(least), str(undecided(least))]
            lines.append(f"| {' | '.join([*cells, *_middle([one.any for one in some if one.any is not None])])} |")
    return "\n".join(lines)


def _middle(rows: Sequence[Row]) -> tuple[str, str]:
    some = ratios(rows)
    return (f"{statistics.median(some):.2f}", f"{max(some):.2f}") if some else ("", "")


def verdict(everything: Sequence[Asked]) -> Iterator[str]:
    """Whether the goals are met, set by set."""
    for set_ in dict.fromkeys(one.set for one in everything):
        least = [one.first for one in everything if one.set == set_]
        some = ratios(least)
        if some:
            met = statistics.median(some) <= MEDIAN and max(some) <= WORST and not undecided(least)
            yield (
                f"* {set_}, the first configuration or the proof that there is none: {statistics.median(some):.2f}"
                f" times the best other engine in the median, {max(some):.2f} at worst, {undecided(least)} undecided"
                f" that another engine decides ({len(some)} instances). The goal of {MEDIAN:g}, {WORST:g} and none is"
                f" {'met' if met else 'missed'}; {sum(one > WORST for one in some)} instances take more than"
                f" {WORST:g} times the best."
            )
        some = ratios([one.any for one in everything if one.set == set_ and one.any is not None])
        if some:
            yield (
                f"* {set_}, the others asked for any configuration: {statistics.median(some):.2f} times in the median,"
                f" {max(some):.2f} at worst ({len(some)} instances). The goal of {ANY:g} in the median is"
                f" {'met' if statistics.median(some) <= ANY else 'missed'}."
            )


def page(everything: Sequence[Asked], seeds: int, limit: float) -> str:
    """The page."""
    setting = SETTING.format(
        machine=platform.machine(),
        cores=os.cpu_count(),
        load=os.getloadavg()[0],
        python=platform.python_version(),
        seeds=seeds,
        limit=limit,
        patience=PATIENCE,
        work=1000 * WORK,
    )
    parts = [
        "# The search on further families",
        "<!-- Made by `python -m benchmarks.search.further --write`. -->",
        setting,
        "\n".join(verdict(everything)),
        summary(everything),
        "## The first configuration, or the proof that there is none",
        table([one.first for one in everything]),
        "## Any configuration",
        table([one.any for one in everything if one.any is not None]),
    ]
    return "\n\n".join(parts) + "\n"


def main() -> int:
    """Run, compare, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--smoke", action="store_true", help="one small instance of each family, for 0.3 s")
    parser.add_argument("--limit", type=float, help=f"seconds for each answer ({LIMIT:g}; 0.3 with --smoke)")
    parser.add_argument("--seeds", type=int, default=SEEDS, help=f"instances of each size ({SEEDS})")
    parser.add_argument("--only", default="", help="families whose name contains this")
    parser.add_argument("--set", choices=SETS, help="only the families of this set")
    parser.add_argument("--write", action="store_true", help="write the page")
    options = parser.parse_args()
    limit = options.limit or (0.3 if options.smoke else LIMIT)
    seeds = 1 if options.smoke else options.seeds
    engines = anything.installed()
    everything: list[Asked] = []
    for set_, families in {"smoke": SMALLEST}.items() if options.smoke else SETS.items():
        chosen = {name: sizes for name, sizes in families.items() if options.only in name}
        if options.set not in (None, set_):
            continue
        for instance in instances(chosen, range(SEED, SEED + seeds)):
            everything.append(asked(set_, instance, engines, limit, 1 if options.smoke else 3))
            for row in everything[-1][1:]:
                if row is not None:
                    print(table([row]).splitlines()[-1], flush=True)
    if not everything:
        print("nothing was measured", file=sys.stderr)
        return 1
    text = page(everything, seeds, limit)
    print(f"\n{text}")
    if options.write:
        PAGE.write_text(text)
    return 0


if __name__ == "__main__":
    sys.exit(main())
