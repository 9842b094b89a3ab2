"""`selfconf validate` beside the pyshacl command line, over the same advertisements in one run.

`python -m benchmarks.validate` writes a table in Markdown: 1,000 advertisements, one in ten of which breaks a shape;
`--full` adds 10,000, `--smoke` does it with 10. pyshacl has every shape of selfconf in one file and is run once for
each of ten files, which is extrapolated to all of them, and once over one file with everything. Times are of processes,
start included: the fastest of several for selfconf, one run for pyshacl, which takes minutes. Both must find the same
files wrong, in the very runs that are timed. Memory is that of the largest process. A second table has odd files.
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
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

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


class Finished(NamedTuple):
    """A program that has ended: exit code, output, seconds from start to end, octets at the peak."""

    code: int
    output: str
    seconds: float
    memory: int


def run(arguments: Sequence[str], cache: Path) -> Finished:
    """Run a Python program to its end."""
    environment = {**os.environ, "SELFCONF_CACHE_DIR": str(cache)}
    with tempfile.TemporaryFile() as output:
        began = time.perf_counter()
        process = subprocess.Popen(
            [sys.executable, "-m", *arguments], stdout=output, stderr=subprocess.DEVNULL, env=environment
        )
        _, status, usage = os.wait4(process.pid, 0)
        seconds = time.perf_counter() - began
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        return Finished(process.returncode, output.read().decode(), seconds, usage.ru_maxrss << 10)


def fastest(arguments: Sequence[str], cache: Path, times: int) -> Finished:
    """The fastest of several runs."""
    return min((run(arguments, cache) for _ in range(times)), key=lambda done: done.seconds)


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
    listed = sorted(files.iterdir())[-min(SAMPLE, number // 5) :]

    cold = fastest(validate, folder, times)
    verdicts = json.loads(cold.output)["diagnostics"]
    ours = {Path(found["file"]).name for found in verdicts if found["severity"] == "error"}
    run([*validate, "--cache"], folder)
    warm = fastest([*validate, "--cache"], folder, times)

    single = [run([*pyshacl, str(path)], folder) for path in listed]
    theirs = {path.name for path, done in zip(listed, single, strict=True) if done.code}
    assert theirs == {path.name for path in listed} & ours, (theirs, ours)
    batch = run([*pyshacl, str(whole)], folder)
    blamed = set(re.findall(r"Focus Node: \S*?c(\d+)\b", batch.output))
    assert {f"{int(each):05}.ttl" for each in blamed} == ours, (len(blamed), len(ours))
    seconds = sum(done.seconds for done in single) / len(single) * number
    rows = [
        ("selfconf validate", cold.seconds, cold.memory),
        ("selfconf validate --cache, nothing changed", warm.seconds, warm.memory),
        ("pyshacl, all in one file", batch.seconds, batch.memory),
        (f"pyshacl, file by file, from {len(listed)} of them", seconds, max(done.memory for done in single)),
    ]
    return [
        [f"{number:,}", name, f"{taken:.2f}", f"{taken / cold.seconds:.1f}", f"{memory >> 20:,}"]
        for name, taken, memory in rows
    ]


def odd(number: int, folder: Path) -> list[list[str]]:
    """The rows for files that are odd: what they cost besides a good file of the same size."""
    wrong = "".join(f":c{each} a sc:Component, rob:Tuneer . " for each in range(number))
    foreign = "".join(
        f":c{each} a sc:Component, :Kind ; sc:hasOutput [ sc:name 'x' ; sc:signalType <urn:my#S> ] .\n"
        for each in range(10 * number)
    )
    texts = {
        f"{number:,} warnings on one line": wrong,
        f"{10 * number:,} components of a foreign signal type": foreign,
        "a literal of 17 MiB": f':c a sc:Component, :Kind ; :p "{"x" * (17 << 20)}" .',
        f"a list of {number:,} members": f":c a sc:Component, :Kind ; :p ( {'1 ' * number}) .",
    }
    rows = []
    for name, text in texts.items():
        path = folder / "odd.ttl"
        path.write_text(HEAD + text)
        done = run(["selfconf", "validate", str(path), "--format", "json"], folder)
        found = json.loads(done.output)["diagnostics"]
        said = ", ".join(f"{count:,} {code}" for code, count in sorted(Counter(one["code"] for one in found).items()))
        rows.append([name, said or "nothing", str(done.code), f"{done.seconds:.2f}", f"{done.memory >> 20:,}"])
    return rows


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description="selfconf validate beside the pyshacl command line")
    parser.add_argument("--full", action="store_true", help="10,000 advertisements as well; minutes")
    parser.add_argument("--smoke", action="store_true", help="10 advertisements, once, to see that it runs")
    given = parser.parse_args(arguments)
    sizes = [10] if given.smoke else [1_000, 10_000] if given.full else [1_000]
    with tempfile.TemporaryDirectory() as folder:
        rows = [row for size in sizes for row in measure(size, 1 if given.smoke else 3, Path(folder))]
        strange = odd(20 if given.smoke else 8_000, Path(folder))
    print(described("selfconf", "pyshacl", "rdflib", "pyoxigraph"))
    print()
    print(table(["advertisements", "program", "seconds", "to selfconf validate", "MiB at the peak"], rows))
    print()
    print(table(["odd file", "what is found", "exit code", "seconds", "MiB at the peak"], strange))
    return 0


if __name__ == "__main__":
    sys.exit(main())
