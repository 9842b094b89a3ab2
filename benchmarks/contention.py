"""How soon tasks are settled that begin at once and want components that they share, in opposite order of their needs.

    python -m benchmarks.contention [--rounds 20] [--smoke]

All processes are real: a site, and a process with four sensors and three drives, of which no two tasks can share one.
Two to eight tasks that wait begin at the same moment, each in a process of its own; half of them name what they need
in the opposite order, and reserving goes by the order of the IRIs. A round is over when no task has begun to run for
`QUIET` seconds.

    alone      from the beginning of one task to `running`, when it is the only one: what its own calls take
    settled    from the beginning of all tasks to the last `running`
    beyond     the difference of the two: what the contention costs
    run, wait  how many tasks run and wait then
"""

from __future__ import annotations

import argparse
import itertools
import os
import queue
import secrets
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import median
from typing import NamedTuple

import selfconf as sc
from benchmarks.live.__main__ import act_until_stdin_ends, line, program, until
from benchmarks.machine import described, quantile, table
from selfconf import rendezvous, this_machine
from selfconf.sdk import Component, Signal, open_host

SENSORS, DRIVES = 4, 3
TASKS = (2, 3, 4, 6, 8)
QUIET = 1.0
PATIENCE = 60.0
FOLDER_VARIABLE = "CONTENTION_BENCHMARK_FOLDER"
HEAD = """@prefix sc:  <https://w3id.org/selfconf#> .
@prefix rob: <https://w3id.org/selfconf/robotics#> .
@prefix sh:  <http://www.w3.org/ns/shacl#> .
@prefix :    <https://example.org/contention#> .
"""


class Actor(Component):
    """A sensor that emits once when it is started, or a drive."""

    output = ""

    def started(self) -> None:
        """Emit, if it is a sensor."""
        if self.output:
            self.emit(self.output, {"x": 1.0, "y": 2.0, "theta": 0.5, "frame": "home"})

    def received(self, port: str, signal: Signal) -> None:
        """Pass over what is heard."""


class Round(NamedTuple):
    """What came of some tasks that have begun at once; times in seconds."""

    settled: float
    running: int
    waiting: int


def written(folder: Path) -> list[Path]:
    """The advertisements, a file each."""
    paths = []
    for number in range(SENSORS):
        text = (
            f":sensor{number} a sc:Component, :Sensor{number} ; sc:shareable false ;\n"
            '    sc:hasOutput [ sc:name "pose" ; sc:signalType rob:PlanarPose2D ] .\n'
        )
        paths.append(folder / f"sensor{number}.ttl")
        paths[-1].write_text(HEAD + text)
    for number in range(DRIVES):
        text = (
            f':drive{number} a sc:Component, :Drive ; sc:hasInput [ sc:name "in" ; sc:signalType rob:PlanarPose2D ] .\n'
        )
        paths.append(folder / f"drive{number}.ttl")
        paths[-1].write_text(HEAD + text)
    return paths


def task(number: int, sensors: Sequence[int]) -> str:
    """A task that needs some sensors and a drive, in the order given."""
    roles = " ".join([*(f":role{one}" for one in sensors), ":drive-role"])
    lines = [f":task{number} a sc:Template ; sc:roles ( {roles} ) ."]
    lines += [f":role{one} a sc:Role ; sh:class :Sensor{one} ; sc:feeds :drive-role ." for one in sensors]
    return HEAD + "\n".join([*lines, ":drive-role a sc:Role ; sh:class :Drive .\n"])


def needs(number: int) -> list[int]:
    """The sensors of a task: two that its neighbours want as well, every other time in the opposite order."""
    wanted = [number % SENSORS, (number + 1) % SENSORS]
    return wanted if number % 2 else wanted[::-1]


def some_tasks(size: int, first: int) -> list[int]:
    """So many of the eight tasks, neighbours from one on, no task twice."""
    return [(first + one) % max(TASKS) for one in range(size)]


def act(folder: Path) -> None:
    """Be all sensors and drives, in one process that ends with its stdin."""
    host = open_host()
    for path in sorted(folder.glob("*.ttl")):
        output = "pose" if path.stem.startswith("sensor") else ""
        host.add(type("One", (Actor,), {"advertisement": str(path), "output": output})())
    act_until_stdin_ends(host)


@contextmanager
def ecology() -> Iterator[None]:
    """A site and the actors, as processes, in an ecology that the environment names."""
    name = f"contention-{secrets.token_hex(3)}"
    with tempfile.TemporaryDirectory() as path, ExitStack() as stack:
        folder = Path(path) / "ads"
        folder.mkdir()
        written(folder)
        os.environ |= {
            "SELFCONF_RUNTIME_DIR": f"{path}/runtime",
            rendezvous.ECOLOGY_VARIABLE: name,
            FOLDER_VARIABLE: str(folder),
        }
        stack.enter_context(program("selfconf", "site", str(folder), "--name", "one"))
        until(PATIENCE, lambda: bool(this_machine.local_sites(name)))
        assert line(stack.enter_context(program("benchmarks.contention", "--act"))) == "ready"
        yield


def take_part() -> None:
    """Run a task for each number that is read from stdin, from `go` on until `stop`; print each act with its moment."""
    name = os.environ[rendezvous.ECOLOGY_VARIABLE]
    for said in sys.stdin:
        number = int(said)
        with sc.join(name) as living, ExitStack() as stack:
            wanted = sc.template(task(number, needs(number)))
            print("ready", flush=True)
            sys.stdin.readline()
            run = stack.enter_context(living.run(wanted, wait=True, name=f"task{number}"))
            threading.Thread(target=_stop_when_told, args=(run,), daemon=True).start()
            for event in run.events():
                print(event.act, time.monotonic(), flush=True)
        print("over", flush=True)


def _stop_when_told(run: sc.Run) -> None:
    sys.stdin.readline()
    run.stop()


class Runner:
    """A process that runs tasks, one after another, and what it has told of the one that runs."""

    def __init__(self, process: subprocess.Popen[str], heard: queue.SimpleQueue[tuple[str, float]]) -> None:
        self._process, self._heard = process, heard
        self._told = threading.Semaphore(0)
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        assert self._process.stdout is not None
        for said in self._process.stdout:
            act, _, moment = said.strip().partition(" ")
            if moment:
                self._heard.put((act, float(moment)))
            else:
                self._told.release()

    def tell(self, word: str) -> None:
        """Tell the process what to do next."""
        assert self._process.stdin is not None
        print(word, file=self._process.stdin, flush=True)

    def wait(self) -> None:
        """Wait until it is ready, or until its task is over."""
        if not self._told.acquire(timeout=PATIENCE):
            raise SystemExit("the benchmark stalled")


def contend(runners: Sequence[Runner], heard: queue.SimpleQueue[tuple[str, float]], numbers: Sequence[int]) -> Round:
    """Let tasks begin at once, wait until they are settled, and take them down."""
    taking_part = list(zip(runners, numbers, strict=False))
    for runner, number in taking_part:
        runner.tell(str(number))
    for runner, _ in taking_part:
        runner.wait()
    began = last = time.monotonic()
    for runner, _ in taking_part:
        runner.tell("go")
    running = 0
    while True:
        try:
            said, moment = heard.get(timeout=QUIET)
        except queue.Empty:
            break
        if said == "running":
            running, last = running + 1, moment
        if moment > last + QUIET and running:
            break
    for runner, _ in taking_part:
        runner.tell("stop")
    for runner, _ in taking_part:
        runner.wait()
    while not heard.empty():
        heard.get()
    return Round(last - began, running, len(numbers) - running)


def measure(sizes: Sequence[int], rounds: int) -> tuple[list[float], dict[int, list[Round]]]:
    """What a task takes alone, and the rounds of each number of tasks."""
    heard: queue.SimpleQueue[tuple[str, float]] = queue.SimpleQueue()
    with ecology(), ExitStack() as stack:
        every = [stack.enter_context(program("benchmarks.contention", "--take-part")) for _ in range(max(sizes))]
        runners = [Runner(process, heard) for process in every]
        for number, runner in enumerate(runners):
            contend([runner], heard, [number])  # modules are loaded, and the site is known
        alone = [contend(runners, heard, [number % 8]).settled for number in range(rounds)]
        shifts = itertools.count()
        found = {
            size: [contend(runners, heard, some_tasks(size, next(shifts))) for _ in range(rounds)] for size in sizes
        }
    return alone, found


def report(alone: list[float], found: dict[int, list[Round]]) -> str:
    """The table; times in milliseconds."""
    own = median(alone)
    rows = [
        [
            str(size),
            str(len(rounds)),
            f"{1000 * own:.0f}",
            f"{1000 * median(one.settled for one in rounds):.0f}",
            f"{1000 * (median(one.settled for one in rounds) - own):.0f}",
            f"{1000 * (quantile([one.settled for one in rounds], 0.95) - own):.0f}",
            f"{sum(one.running for one in rounds) / len(rounds):.1f}",
            f"{sum(one.waiting for one in rounds) / len(rounds):.1f}",
        ]
        for size, rounds in found.items()
    ]
    head = ["tasks", "rounds", "alone ms", "settled ms", "beyond ms", "beyond, 95 %", "run", "wait"]
    return f"{table(head, rows)}\n\nMedians; {described('eclipse-zenoh')}"


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="tasks that begin at once and want the same components")
    parser.add_argument("--rounds", type=int, default=20)
    parser.add_argument("--smoke", action="store_true", help="two tasks once, to see that it works")
    parser.add_argument("--act", action="store_true", help=argparse.SUPPRESS)
    parser.add_argument("--take-part", action="store_true", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.take_part:
        take_part()
        return
    if given.act:
        act(Path(os.environ[FOLDER_VARIABLE]))
        return
    sizes, rounds = ((2,), 1) if given.smoke else (TASKS, given.rounds)
    print(report(*measure(sizes, rounds)))


if __name__ == "__main__":
    main()
