"""What was measured, as a page of Markdown and a plot."""

from __future__ import annotations

import math
import os
import platform
import statistics
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from benchmarks.search.engines import ENGINES, GENERAL
from benchmarks.search.families.wiring import Instance
from benchmarks.search.first import First
from benchmarks.search.measure import Measured
from selfconf.model.wording import listed

WORK = 0.01
"""Seconds; an instance on which the slower of ours and the best takes less is no work."""
GOAL = 1.5
TEN = 10.0
PLOTTED = ("navigation", "navigation, impossible", "fleet of 100", "chain", "3-SAT", "distinct, impossible")

TUNING = """\
Before it writes clauses, the search looks for a quick answer: depth first over the candidates, for at most
`CANDIDATE_STEPS` steps for each role that it has reached, or one for each `REDUCED_PER_STEP` candidates with ports of
their own, where `SKIPS_PER_STEP` candidates that play already are skipped for the price of one. If `PREFIX_REACH` times
the roles that it has reached are one in `PREFIX_SHARE` of all at most, they are tried by themselves. Then it goes depth
first over the reduced problem, for at most `REDUCED_PACE` steps for each option of the roles that it has reached. Then
comes the `SOLVER` of python-sat. Each was varied by itself, on seeds 7001 to 7003 and on sizes of the same families
that are not in the tables above (`python -m benchmarks.search.run --tuning`); solvers that cannot get cardinalities as
clauses. A time is a multiple of that with the value chosen, which is in bold; `worst` is the instance on which a value
does worst against that."""


@dataclass(frozen=True)
class Row:
    """An instance, what each engine did on it, and the answer on which those agree that have one.

    The answer to whether there is a configuration is a truth value; to which is the first, who plays in it.
    """

    instance: Instance
    found: Mapping[str, Measured]
    answer: First | None

    @property
    def others(self) -> dict[str, float]:
        """Seconds of the other engines that have an answer."""
        return {e: m.seconds for e, m in self.found.items() if e != "selfconf" and m.answer is not None}

    @property
    def ratio(self) -> float | None:
        """Our time over that of the best other engine."""
        return self.found["selfconf"].seconds / min(self.others.values()) if self.others else None

    @property
    def counts(self) -> bool:
        """Whether it is one of the instances that the goal speaks of."""
        return bool(self.others) and max(self.found["selfconf"].seconds, min(self.others.values())) > WORK


def table(rows: Sequence[Row]) -> str:
    """The times, an engine in each column."""
    engines = list(dict.fromkeys(engine for row in rows for engine in row.found))
    lines = [
        f"| family | instance | {' | '.join(engines)} | selfconf / best |",
        "|---|---|" + "---:|" * (len(engines) + 1),
    ]
    for row in rows:
        cells = " | ".join(_cell(row.found.get(engine)) for engine in engines)
        late = ">" if row.found["selfconf"].answer is None else ""
        ratio = "no other answers" if row.ratio is None else f"{late}{row.ratio:.2f}"
        missed = row.counts and (row.ratio or 0.0) > GOAL
        ratio = f"**{ratio}**" if missed else ratio
        lines.append(f"| {row.instance.family} | {row.instance.name} | {cells} | {ratio} |")
    return "\n".join(lines)


def _cell(found: Measured | None) -> str:
    if found is None:
        return ""
    return f"> {found.seconds:.3g} s" if found.answer is None else f"{found.seconds * 1000:.1f} ms"


def exponents(rows: Sequence[Row]) -> str:
    """How time grows with size: the slope in a log-log diagram, where three sizes take over a millisecond."""
    lines = ["| family | engine | time grows as size to the |", "|---|---|---:|"]
    for family in dict.fromkeys(row.instance.family for row in rows):
        for engine in ENGINES:
            points = [
                (math.log(row.instance.size), math.log(m.seconds))
                for row in rows
                if row.instance.family == family and (m := row.found.get(engine)) and m.answer is not None
                if m.seconds > 0.001
            ]
            if len({x for x, _ in points}) >= 3:
                slope = statistics.linear_regression([x for x, _ in points], [y for _, y in points]).slope
                lines.append(f"| {family} | {engine} | {slope:.1f} |")
    return "\n".join(lines)


def memory(rows: Sequence[Row]) -> str:
    """The growth of memory where some engine needs over 20 MB."""
    engines = [engine for engine in ENGINES if any(engine in row.found for row in rows)]
    lines = [f"| family | instance | {' | '.join(engines)} |", "|---|---|" + "---:|" * len(engines)]
    for row in rows:
        if any(one.memory > 20 for one in row.found.values()):
            cells = [
                f"{row.found[e].memory:.0f} MB" if e in row.found and row.found[e].answer is not None else ""
                for e in engines
            ]
            lines.append(f"| {row.instance.family} | {row.instance.name} | {' | '.join(cells)} |")
    return "\n".join(lines)


def _beside_the_best(rows: Sequence[Row], question: str) -> Iterator[str]:
    counted = [row for row in rows if row.counts and row.ratio is not None]
    ratios = [row.ratio or 0.0 for row in counted]
    if not ratios:
        return
    missed = [row for row in counted if (row.ratio or 0.0) > GOAL]
    places = "; ".join(f"{r.instance.family}, {r.instance.name} ({r.ratio:.2f})" for r in missed)
    yield (
        f"* {question}: on the {len(ratios)} instances beyond {WORK * 1000:g} ms of work, selfconf takes"
        f" {statistics.median(ratios):.2f} times as long as the best other engine in the median, {max(ratios):.2f}"
        f" times at worst. The goal of at most {GOAL:g} times is"
        f" {f'missed on {len(missed)} of them: {places}' if missed else 'met on all of them'}."
    )


def verdict(everything: Sequence[Row]) -> Iterator[str]:
    """Whether the goals are met, and where not."""
    same = [row for row in everything if row.answer is not True]
    rows = [row for row in everything if not isinstance(row.answer, tuple)]
    yield from _beside_the_best(same, "All asked the same, for the first configuration or the proof that there is none")
    yield from _beside_the_best(rows, "The others asked for any configuration, the easier question")
    undecided = [row for row in rows if row.found["selfconf"].answer is None]
    if undecided:
        places = "; ".join(f"{r.instance.family}, {r.instance.name}" for r in undecided)
        yield f"* Without an answer within the limit: {places}."
    for engine in ENGINES:
        against = [
            (one.seconds / row.found["selfconf"].seconds, one.answer is None)
            for row in rows
            if engine != "selfconf" and (one := row.found.get(engine)) is not None
        ]
        if against:
            mean = statistics.geometric_mean(one for one, _ in against)
            late = sum(out for _, out in against)
            tail = f"; {late} time-out{'s count' if late > 1 else ' counts'} as the limit" if late else ""
            yield f"* {engine} takes {mean:.1f} times as long as selfconf (geometric mean of {len(against)}{tail})."
    large = [
        row for row in rows if row.instance.family.startswith(("navigation", "fleet")) and row.instance.size >= 1000
    ]
    least = {
        engine: min(
            (one.seconds / row.found["selfconf"].seconds for row in large if (one := row.found.get(engine))),
            default=0.0,
        )
        for engine in GENERAL
    }
    if large and any(least.values()):
        slow = [engine for engine, factor in least.items() if 0.0 < factor < TEN]
        yield (
            "* On the paper's template and the fleet from 1,000 candidates per role, the goal is 10 times quicker than"
            f" each general solver. At worst: {', '.join(f'{e} {x:.1f}' for e, x in least.items() if x)};"
            f" {'missed for ' + listed(slow) if slow else 'met'}."
        )
    ours = [row for row in rows if "Algorithm 1" in row.found and row.instance.size == 10]
    for row in ours:
        factor = row.found["Algorithm 1"].seconds / row.found["selfconf"].seconds
        at_least = "at least " if row.found["Algorithm 1"].answer is None else ""
        met = "met" if factor >= 1000 else "missed"
        yield (
            f"* {row.instance.family}, 10 per role: {at_least}{factor:.0f} times quicker than Algorithm 1; the goal of"
            f" 1,000 is {met}."
        )


def page(everything: Sequence[Row], limit: float, tuned: str = "") -> str:
    """The page; `tuned` is the table of the thresholds that were tried, if they were."""
    rows = [row for row in everything if not isinstance(row.answer, tuple)]
    setting = (
        f"One run on {platform.machine()}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f},"
        f" Python {platform.python_version()}. Every engine in a process of its own, {limit:g} s for each answer, the"
        " shortest of three where it takes less than 0.3 s; all start from the same problem in their own memory, after"
        " a few small ones so that nobody pays for what a process does for the first time: building a model is part of"
        " the time, importing a library is not. selfconf answers with the lexicographically first configuration. The"
        " others may answer with any, which is the easier question; in a table of their own those that can be are asked"
        " for the first too, and name the same components. python-sat is Glucose 4 with cardinalities as clauses, the"
        " usual way; MiniCard is the solver of the same library that counts by itself, which selfconf uses in the end"
        " too. Every engine has one thread. SPARQL asks one query for the whole template, on small sizes."
    )
    parts = [
        "# The search beside general solvers",
        "<!-- Made by `python -m benchmarks.search.run --write`. -->",
        setting,
        "![Time by size](search.png)",
        "\n".join(verdict(everything)),
    ]
    titles = {
        "Time to any configuration": [row for row in rows if row.answer],
        "Time to the first configuration": [row for row in everything if isinstance(row.answer, tuple)],
        "Time to the proof that there is none": [row for row in rows if row.answer is False],
        "Decided by nobody": [row for row in rows if row.answer is None],
    }
    for title, some in titles.items():
        if some:
            parts += [f"## {title}", table(some)]
    note = (
        "How far the peak of resident memory rises above that of the problem itself, where some engine needs over"
        " 20 MB. What fits into memory that making the problem has left free does not show there; for selfconf it is at"
        " least what Python allocates, counted in a run of its own."
    )
    if tuned:
        parts += ["## How the thresholds were chosen", TUNING, tuned]
    parts += ["## Growth", exponents(rows), "## Memory", note, memory(rows)]
    return "\n\n".join(parts) + "\n"


def plot(rows: Sequence[Row], limit: float, path: Path) -> None:
    """Time by size, a panel for each family."""
    import matplotlib

    matplotlib.use("agg")
    from matplotlib import pyplot

    families = [family for family in PLOTTED if any(row.instance.family == family for row in rows)]
    figure, axes = pyplot.subplots(2, 3, figsize=(12, 7), sharey=True, layout="constrained")
    for number, family in enumerate(families):
        panel = axes.flat[number]
        for color, engine in enumerate(ENGINES):
            times: dict[int, list[float]] = {}
            for row in rows:
                if row.instance.family == family and engine in row.found:
                    times.setdefault(row.instance.size, []).append(row.found[engine].seconds)
            middle = [statistics.median(some) for some in times.values()]
            width = 2.8 if engine == "selfconf" else 1.2
            if times:
                panel.plot(list(times), middle, f"C{color}o-", ms=4, label=engine, linewidth=width)
        panel.axhline(limit, color="grey", linestyle=":", linewidth=1)
        wide = family.startswith(("navigation", "fleet"))
        unit = "candidates per role" if wide else "variables" if family == "3-SAT" else "roles"
        panel.set(xscale="log" if wide else "linear", yscale="log", title=family, xlabel=unit)
        panel.grid(visible=True, which="major", alpha=0.3)
        if number % 3 == 0:
            panel.set_ylabel("seconds")
    handles = {label: h for panel in axes.flat for h, label in zip(*panel.get_legend_handles_labels(), strict=True)}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=len(handles), frameon=False)
    figure.savefig(path, dpi=100)
    pyplot.close(figure)
