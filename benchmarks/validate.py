"""`selfconf validate` beside the pyshacl command line, over the same advertisements in one run.

`python -m benchmarks.validate` writes a table in Markdown: 1,000 advertisements, one in ten of which breaks a shape;
`--full` adds 10,000, `--smoke` does it with 20. pyshacl has every shape of selfconf in one file and is run once for
each of ten files, which is extrapolated to all of them, and once over one file with everything. Times are of processes,
start included: the fastest of several for selfconf, one run for pyshacl, which takes minutes. Both must find the same
files wrong, in the very runs that are timed.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from benchmarks.machine import described, table
from selfconf import library

HEAD = """\
@prefix sc: <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix : <https://example.org/home#> .
"""
SAMPLE = 10
"""Files for which pyshacl is run one by one."""


def advertisement(number: int) -> str:
    """One advertisement; every tenth has a preference that is no number."""
    preference = '"high"' if number % 10 == 9 else number % 7
    return f""":c{number} a sc:Component, rob:NavigationControl ;
    sc:hasInput [ sc:name "position" ; sc:signalType rob:PlanarPose2D ] ,
                [ sc:name "scan" ; sc:signalType rob:RangeScan ] ;
    sc:hasOutput [ sc:name "velocity" ; sc:signalType rob:Velocity2D ] ;
    sc:hasParameter [ sc:name "goal" ; sc:parameterType rob:BehaviouralGoal ] ;
    rob:place :room{number % 5} ; sc:preference {preference} .
"""


def fastest(action: Callable[[], object], times: int) -> float:
    """Seconds of the fastest of several runs."""
    seconds = []
    for _ in range(times):
        began = time.perf_counter()
        action()
        seconds.append(time.perf_counter() - began)
    return min(seconds)


def run(arguments: Sequence[str], cache: Path) -> tuple[int, str]:
    """Exit code and output of a Python program."""
    environment = {**os.environ, "SELFCONF_CACHE_DIR": str(cache)}
    done = subprocess.run(
        [sys.executable, "-m", *arguments], capture_output=True, text=True, env=environment, check=False
    )
    return done.returncode, done.stdout


def measure(number: int, times: int, folder: Path) -> list[list[str]]:
    """The rows for so many advertisements. AssertionError if the verdicts differ."""
    files = folder / f"{number}"
    files.mkdir()
    for each in range(number):
        (files / f"{each:05}.ttl").write_text(HEAD + advertisement(each))
    whole, shapes = folder / f"{number}.ttl", folder / "shapes.ttl"
    whole.write_text(HEAD + "".join(map(advertisement, range(number))))
    shapes.write_text("\n".join(path.read_text() for path in library.shapes()))
    validate = ["selfconf", "validate", str(files), "--format", "json"]
    pyshacl = ["pyshacl", "-s", str(shapes), "-f", "human"]
    listed = sorted(files.iterdir())[-SAMPLE:]

    verdicts = json.loads(run(validate, folder)[1])["diagnostics"]
    ours = {Path(found["file"]).name for found in verdicts if found["severity"] == "error"}
    cold = fastest(lambda: run(validate, folder), times)
    run([*validate, "--cache"], folder)
    warm = fastest(lambda: run([*validate, "--cache"], folder), times)

    began = time.perf_counter()
    theirs = {path.name for path in listed if run([*pyshacl, str(path)], folder)[0]}
    single = (time.perf_counter() - began) / len(listed) * number
    assert theirs == {path.name for path in listed} & ours, (theirs, ours)
    began = time.perf_counter()
    report = run([*pyshacl, str(whole)], folder)[1]
    batch = time.perf_counter() - began
    blamed = set(re.findall(r"Focus Node: \S*?c(\d+)\b", report))
    assert {f"{int(each):05}.ttl" for each in blamed} == ours, (len(blamed), len(ours))
    rows = [
        ("selfconf validate", cold),
        ("selfconf validate --cache, nothing changed", warm),
        ("pyshacl, all in one file", batch),
        (f"pyshacl, file by file, from {len(listed)} of them", single),
    ]
    return [[f"{number:,}", name, f"{seconds:.2f}", f"{seconds / cold:.1f}"] for name, seconds in rows]


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description="selfconf validate beside the pyshacl command line")
    parser.add_argument("--full", action="store_true", help="10,000 advertisements as well; minutes")
    parser.add_argument("--smoke", action="store_true", help="20 advertisements, once, to see that it runs")
    given = parser.parse_args(arguments)
    sizes = [20] if given.smoke else [1_000, 10_000] if given.full else [1_000]
    with tempfile.TemporaryDirectory() as folder:
        rows = [row for size in sizes for row in measure(size, 1 if given.smoke else 3, Path(folder))]
    print(described("selfconf", "pyshacl", "rdflib", "pyoxigraph"))
    print()
    print(table(["advertisements", "program", "seconds", "to selfconf validate"], rows))
    return 0


if __name__ == "__main__":
    sys.exit(main())
