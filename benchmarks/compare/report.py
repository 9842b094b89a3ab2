"""The page on which two trees are compared."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from benchmarks.failover import PAUSE
from benchmarks.machine import described, table

MEDIAN = "median"
"""The quantity of what varies from trial to trial, so that a mean of ratios says nothing."""
NOISE = 0.05
"""Ratios within so much of 1 say nothing."""


@dataclass(frozen=True)
class Row:
    """What one quantity of one command takes before and after, in seconds."""

    part: str
    name: str
    quantity: str
    before: float
    after: float
    alike: bool = True
    """Whether both trees have given one answer."""

    @property
    def ratio(self) -> float:
        """After to before: less than 1 is quicker."""
        return self.after / self.before if self.before else math.inf

    def __str__(self) -> str:
        return f"{self.part}: {self.name}: {self.quantity} {self.ratio:.2f}"


def page(rows: Sequence[Row], names: Sequence[str]) -> str:
    """The page in Markdown."""
    before, after = names
    lines = [
        "# Before and after",
        "",
        "`python -m benchmarks.compare REVISION --write` makes this page: two trees run the same commands over the",
        "same files, interleaved in one run, with one interpreter. A number is the least of several runs. `process` is",
        "the processor time of the whole process and its children; `load`, `partition` and `search` are what",
        f"`configure` tells in `seconds`; failover is the median of trials, each after {PAUSE:g} s of rest in either",
        "tree, the least of several rounds, its last row all of it with the search. Trust the ratios,",
        f"not the digits: less than 1 is quicker, and those within {NOISE:.0%} of 1 are noise. So are ratios of less",
        "than a millisecond.",
        "",
        f"* before: {before}",
        f"* after: {after}",
        "",
    ]
    for part, group in groupby(rows, key=lambda row: row.part):
        lines += [f"## {part[0].upper()}{part[1:]}", "", *_table(list(group)), ""]
    lines += [*_unlike(rows), described("selfconf", "pyshacl", "rdflib", "pyoxigraph", "eclipse-zenoh")]
    return "\n".join(lines) + "\n"


def _table(rows: Sequence[Row]) -> list[str]:
    cells = [
        [row.name, row.quantity, f"{row.before * 1000:.2f}", f"{row.after * 1000:.2f}", _ratio(row.ratio)]
        for row in rows
    ]
    lines = [table(["what", "quantity", "before, ms", "after, ms", "after / before"], cells)]
    for quantity in dict.fromkeys(row.quantity for row in rows if row.quantity != MEDIAN):
        ratios = [row.ratio for row in rows if row.quantity == quantity]
        lines += ["", f"Geometric mean of the ratios of `{quantity}`: {_mean(ratios):.2f}"]
    return lines


def _ratio(ratio: float) -> str:
    return f"{ratio:.2f}" if abs(ratio - 1) <= NOISE else f"**{ratio:.2f}**"


def _mean(ratios: Sequence[float]) -> float:
    return math.exp(sum(map(math.log, ratios)) / len(ratios))


def _unlike(rows: Sequence[Row]) -> list[str]:
    names = list(dict.fromkeys(f"{row.part}: {row.name}" for row in rows if not row.alike))
    if not names:
        return ["Both trees gave the same answer to every command.", ""]
    return ["**The trees gave different answers to:**", "", *(f"* {name}" for name in names), ""]
