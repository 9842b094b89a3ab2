"""What a thousand strangers cost an honest task: ten kinds of advertisements that were written to hold others up.

    python -m benchmarks.strangers [--rounds 5] [--smoke]

The strangers are those of `tests/hostile_words.py`: each is of a class that a role asks for, is preferred to all that
is honest, and is not eligible. Every question is asked without them and with them in turns, and the answers have to be
equal but for the strangers themselves.

    files     `configure` and `partition` of a folder, as programs, from start to end
    living    `discover`, `configure` and `partition` of an ecology: the honest components are a process, the strangers
              are advertised by a second site
    run       a task in that ecology: from the beginning to `running`, and from the end of the
              process of a component to `running`
"""

from __future__ import annotations

import argparse
import os
import secrets
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from statistics import median
from typing import NamedTuple

import selfconf as sc
from benchmarks.live.__main__ import act_until_stdin_ends, line, program, until
from benchmarks.machine import described, table
from benchmarks.validate import run
from selfconf import rendezvous, this_machine
from selfconf.sdk import Component, open_host
from tests.hostile_words import HONEST, KINDS, TEMPLATE, stranger

NUMBER = 1_000
PATIENCE = 60.0
FIRST = "cam-1"
"""Who plays first, and is killed."""
OTHERS = ("cam-2", "ear-1", "ear-2", "arm-1", "arm-2", "screen")
COMMANDS = ("configure", "partition", "discover")


class Timed(NamedTuple):
    """What was asked, and how many seconds the answers took without strangers and with them."""

    question: str
    alone: list[float]
    beside: list[float]

    def row(self) -> list[str]:
        """A row of the table, in seconds; medians."""
        alone, beside = median(self.alone), median(self.beside)
        return [self.question, f"{alone:.2f}", f"{beside:.2f}", f"{beside - alone:.2f}"]


class Actor(Component):
    """An honest component, which does nothing by itself."""


def act(path: Path, names: Sequence[str]) -> None:
    """Be some of the components of a file, in one process that ends with its stdin."""
    host = open_host()
    for component in sc.read(path).components:
        if component.short in names:
            host.add(type("One", (Actor,), {"advertisement": str(path), "component": component})())
    act_until_stdin_ends(host)


def strangers(number: int) -> list[str]:
    """The advertisements of so many strangers, of each kind alike."""
    kinds = list(KINDS)
    return [stranger(kinds[place % len(kinds)], place) for place in range(number)]


@contextmanager
def actors(path: Path, *names: str) -> Iterator[subprocess.Popen[str]]:
    """A process with some components that are alive."""
    with program("benchmarks.strangers", "--act", str(path), *names) as process:
        assert line(process) == "ready"
        yield process


@contextmanager
def ecology(folder: Path, crowd: Path | None) -> Iterator[str]:
    """An ecology, by name: a site with the honest ones, all but the first alive, and perhaps one with strangers."""
    name = f"strangers-{secrets.token_hex(3)}"
    os.environ[rendezvous.ECOLOGY_VARIABLE] = name
    with ExitStack() as stack:
        served = [folder / "honest.ttl", *([] if crowd is None else [crowd])]
        for number, path in enumerate(served):
            stack.enter_context(program("selfconf", "site", str(path), "--name", f"site{number}"))
        until(PATIENCE, lambda: len(this_machine.local_sites(name)) == len(served))
        stack.enter_context(actors(folder / "honest.ttl", *OTHERS))
        yield name


def ran(name: str, folder: Path) -> tuple[float, float]:
    """Seconds until a task runs, and until it runs again after the process of a component was killed."""
    moments = list[float]()
    with actors(folder / "honest.ttl", FIRST) as first:
        began = time.monotonic()
        with sc.join(name) as living, living.run(sc.template(folder / "task.ttl")) as running:
            for event in running.events():
                if event.act != "running":
                    continue
                moments.append(time.monotonic() - began)
                if len(moments) == 2:
                    running.stop()
                else:
                    began = time.monotonic()
                    first.kill()
    return moments[0], moments[1]


def _of_the_honest(command: str, output: str) -> Iterator[str]:
    """What is said of components that are no strangers; not why some are kept out, of which some are shown alone."""
    for each in output.splitlines():
        if command == "discover":
            yield from (word for word in each.split()[:1] if word in (f":{name}" for name in (FIRST, *OTHERS)))
        elif "stranger-" not in each and not each.startswith("    "):
            yield each


def answered(command: str, folder: Path, *given: str) -> tuple[float, str]:
    """The seconds that a command takes, and what it says of those that are no strangers."""
    task = [] if command == "discover" else [str(folder / "task.ttl")]
    done = run(["selfconf", command, *task, *given], folder)
    if done.code:
        raise SystemExit(f"`{command}` has failed:\n{done.output}")
    return done.seconds, "\n".join(_of_the_honest(command, done.output))


def measure(number: int, rounds: int) -> list[Timed]:
    """Each question, asked without and with so many strangers in turns. SystemExit where an answer is another."""
    questions = [*(f"files, {each}" for each in COMMANDS[:2]), *(f"living, {each}" for each in COMMANDS)]
    questions += ["run, to running", "run, after a failure"]
    found = {question: Timed(question, [], []) for question in questions}
    with tempfile.TemporaryDirectory() as path:
        folder = Path(path)
        os.environ["SELFCONF_RUNTIME_DIR"] = f"{path}/runtime"
        written(folder, number)
        for _ in range(rounds):
            said = dict[str, str]()
            for crowded in (False, True):
                times = {question: timed.beside if crowded else timed.alone for question, timed in found.items()}
                ads = [str(folder / "honest.ttl"), *([str(folder / "crowd")] if crowded else [])]
                for question, seconds, words in asked(folder, ads, folder / "crowd" if crowded else None):
                    times[question].append(seconds)
                    if said.setdefault(question, words) != words:
                        raise SystemExit(f"with strangers the answer is another:\n{said[question]}\n{words}")
    return list(found.values())


def asked(folder: Path, ads: Sequence[str], crowd: Path | None) -> Iterator[tuple[str, float, str]]:
    """Each question with the seconds that its answer takes, and what is said of those that are no strangers."""
    options = [word for path in ads for word in ("--ads", path)]
    for command in COMMANDS[:2]:
        yield f"files, {command}", *answered(command, folder, *options)
    with ecology(folder, crowd) as name:
        with actors(folder / "honest.ttl", FIRST):
            for command in COMMANDS:
                yield f"living, {command}", *answered(command, folder, "--ecology", name)
        first, again = ran(name, folder)
    yield "run, to running", first, ""
    yield "run, after a failure", again, ""


def written(folder: Path, number: int) -> None:
    """The task, the honest components, and each stranger in a file of its own."""
    (folder / "task.ttl").write_text(TEMPLATE)
    (folder / "honest.ttl").write_text(HONEST)
    (folder / "crowd").mkdir()
    for place, text in enumerate(strangers(number)):
        (folder / "crowd" / f"{place}.ttl").write_text(text)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="what strangers cost an honest task")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--smoke", action="store_true", help="a stranger of each kind once, to see that it works")
    parser.add_argument("--act", nargs="+", help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.act:
        act(Path(given.act[0]), given.act[1:])
        return
    number, rounds = (len(KINDS), 1) if given.smoke else (NUMBER, given.rounds)
    head = ["seconds", "without", f"beside {number:,} strangers", "more"]
    print(f"{table(head, [timed.row() for timed in measure(number, rounds)])}\n\n{described('eclipse-zenoh')}")


if __name__ == "__main__":
    main()
