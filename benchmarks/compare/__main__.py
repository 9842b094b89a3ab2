"""Measure the tree as it is beside the tree at a git revision, interleaved in one run.

    python -m benchmarks.compare REVISION [--smoke] [--only PART] [--write]

The revision is unpacked by `git archive` into a temporary folder. Both trees run the same commands over the same files,
one after the other and each as often as the other, with the same interpreter; the least of several runs counts. So the
ratios hold on a busy machine too, where the seconds do not. `--write` writes `docs/benchmarks/compare.md`.

Parts: start, search, scale, validate, failover. It takes some minutes.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
from pathlib import Path
from typing import Any

from benchmarks.compare.inputs import PROCESS, Measure, measures
from benchmarks.compare.report import MEDIAN, Row, page
from benchmarks.compare.trees import ROOT, Done, Tree, both
from benchmarks.failover import PAUSE

PAGE = ROOT / "docs" / "benchmarks" / "compare.md"
PARTS = ("start", "search", "scale", "validate", "failover")
IN_ALL = "FAIL to first message"
AFTER_REST = "import sys; from benchmarks import failover; failover.PAUSE = float(sys.argv.pop(1)); failover.main()"
"""The program `benchmarks.failover` of a tree, with so many seconds of rest before each trial as its first argument.

Trees differ in how long they rest, and after a longer rest all programs are slower: their memory is in no cache.
"""


def measured(measure: Measure, trees: tuple[Tree, Tree], folder: Path) -> list[Row]:
    """A row for each quantity: the least of several runs of either tree, of which the first is not counted."""
    seconds: dict[str, tuple[list[float], list[float]]] = {name: ([], []) for name in measure.quantities}
    answers: list[Any] = [None, None]
    for trial in range(measure.trials + 1):
        for which in (0, 1) if trial % 2 else (1, 0):  # neither is always the one that runs first
            done = trees[which].run("-m", "selfconf", *measure.arguments, cwd=folder)
            if done.code not in measure.codes:
                raise SystemExit(f"{trees[which].name}: selfconf {' '.join(measure.arguments)}: {done.err or done.out}")
            answer, inside = _taken_apart(done)
            answers[which] = (done.code, answer)
            for name in measure.quantities if trial else ():
                seconds[name][which].append(done.seconds if name == PROCESS else inside[name])
    alike = answers[0] == answers[1]
    return [
        Row(measure.part, measure.name, name, min(before), min(after), alike)
        for name, (before, after) in seconds.items()
    ]


def _taken_apart(done: Done) -> tuple[Any, dict[str, float]]:
    """The answer without its `seconds`, and the seconds."""
    try:
        answer = json.loads(done.out)
    except ValueError:
        return done.out, {}
    return answer, answer.pop("seconds", {})


def failover(trees: tuple[Tree, Tree], rounds: int, trials: int) -> list[Row]:
    """The failover of each tree, by turns and after as long a rest: of each part the least of the medians."""
    found: list[dict[str, list[float]]] = [{}, {}]
    for number in range(rounds):
        for which in (0, 1) if number % 2 else (1, 0):
            done = trees[which].run("-c", AFTER_REST, str(PAUSE), "--trials", str(trials))
            if done.code:
                raise SystemExit(f"{trees[which].name}: benchmarks.failover: {done.err or done.out}")
            for name, milliseconds in medians(done.out):
                found[which].setdefault(name, []).append(milliseconds / 1000)
    return [
        Row("failover", name, MEDIAN, min(found[0][name]), min(found[1][name])) for name in found[0] if name in found[1]
    ]


def medians(printed: str) -> list[tuple[str, float]]:
    """What the table of `benchmarks.failover` names in its first column, with the milliseconds in its second.

    Last comes the failover in all, which that table does not have.
    """
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in printed.splitlines() if line[:1] == "|"]
    medians = {row[0]: float(row[1]) for row in rows[2:]}
    # A tree that searches beforehand needs some of the rest for that, so that neither part can be compared by itself.
    return [*medians.items(), (IN_ALL, medians["decide"] + medians[f"{IN_ALL}, without the search"])]


def main(arguments: list[str] | None = None) -> int:
    """Measure, print, and write if asked."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("revision", metavar="REVISION", help="what to compare with: a commit, a tag, a branch")
    parser.add_argument("--smoke", action="store_true", help="small files, few runs, to see that it works")
    parser.add_argument("--only", choices=PARTS, action="append", help="this part alone; repeatable")
    parser.add_argument("--write", action="store_true", help="write the page into the documentation")
    given = parser.parse_args(arguments)
    parts = tuple(given.only or PARTS)
    rows: list[Row] = []
    with both(given.revision) as trees, tempfile.TemporaryDirectory(prefix="selfconf-compare-") as name:
        for measure in measures(Path(name), trees[0].path / "examples", given.smoke):
            if measure.part.startswith(parts):
                rows += measured(measure, trees, Path(name))
                print(rows[-1], file=sys.stderr)
        if "failover" in parts:
            rows += failover(trees, *((1, 2) if given.smoke else (4, 25)))
        text = page(rows, [tree.name for tree in trees])
    print(text)
    if given.write:
        PAGE.write_text(text)
    return 0 if all(row.alike for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
