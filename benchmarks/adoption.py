"""How long a task is without a configurator when the site that keeps it is killed, and whether anybody notices.

    python -m benchmarks.adoption [--trials 20] [--smoke]

All processes are real: two sites that start six components, and three sites that only keep tasks. A task is handed to
the sites; the one that runs it is ended by kill -9, if it is one of the three, and is started again after the trial.

    adopted   kill -9 to the life of the next configurator, which watches FAIL from its beginning
    pause     the longest time between two signs of a component that acts, from a second before the kill until the site
              that was started again runs the task; a component gives a sign every 20 ms
    changed   how many components were stopped or started meanwhile

After the last trial a component is made to fail, and another must take its part: the last successor does watch. Then
all five sites are killed at once and started again, and the task must come back by itself.
"""

from __future__ import annotations

import argparse
import os
import queue
import secrets
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import selfconf as sc
from benchmarks.faults.ecology import PATIENCE, SITES, TASK, Ecology, Sign
from benchmarks.machine import described, quantile, table
from selfconf import rendezvous
from selfconf.bus.zenoh import client
from selfconf.protocol.keys import Keys

KEEPERS = ("keeper-1", "keeper-2", "keeper-3")
AFTERWARDS = 4.0
"""Seconds for which a trial goes on: a component that missed its supervisor would be off after two."""
HURRY = 10
"""How often a task is handed over anew at most, until one of the keepers runs it."""


class Adoption(NamedTuple):
    """What came of a trial."""

    adopted: float
    pause: float
    changed: int


class KeptTask:
    """A task that the sites of an ecology keep, and a view of who runs it."""

    def __init__(self, ecology: Ecology, folder: Path) -> None:
        os.environ.update({name: ecology.environment[name] for name in ("SELFCONF_RUNTIME_DIR",)})
        self.ecology, self._folder = ecology, folder
        for name in KEEPERS:
            self.start_keeper(name)
        self.living = sc.join(ecology.name)
        self._began: queue.SimpleQueue[float] = queue.SimpleQueue()
        self._bus = client(rendezvous.find(ecology.name, [])[1])
        self._bus.run_aside()
        lives = Keys(ecology.name).any_configurator_life()
        self._bus.watch(lives, lambda key, alive: self._began.put(time.monotonic()) if alive else None)
        self.name = ""

    def close(self) -> None:
        """End the view; the ecology goes on."""
        self._bus.close()
        self.living.close()

    def start_keeper(self, name: str) -> None:
        """Start a site that advertises nothing, and keeps tasks."""
        (self._folder / name).mkdir(exist_ok=True)
        where = ("site", str(self._folder / name), "--state", str(self._folder / f"{name}-state"))
        site = self.ecology.start(*where, "--ecology", self.ecology.name, "--name", name)
        self.ecology.sites[name] = site
        _need(self.ecology.until(lambda: any(" on tcp/" in line for line in site.lines), PATIENCE), "a site begins")

    def keeper(self) -> str:
        """The site that runs the task, which is handed over until it is one of the keepers."""
        for _ in range(HURRY):
            for name in KEEPERS:
                if self._runs_at(name):
                    return name
            if any(status.phase == "running" for status in self.living.tasks):
                self.living.stop()
            self.name = self.living.detach(sc.template(TASK), name=f"navigate-{secrets.token_hex(2)}")
            self.until_it_runs()
        raise SystemExit("the benchmark stalled: no keeper runs the task")

    def _runs_at(self, site: str) -> bool:
        """Whether a site runs the task, and it is deployed."""
        number = self.ecology.sites[site].number
        return any(status.process == number and status.phase == "running" for status in self.living.tasks)

    def until_it_runs(self) -> None:
        """Wait until five components act, and their configurator says so."""

        def runs() -> bool:
            since = time.monotonic() - 0.3
            return len({sign.name for sign in self.ecology.witnesses.acting(since)}) == 5

        def says_so() -> bool:
            return any(status.phase == "running" for status in self.living.tasks)

        _need(self.ecology.until(runs, PATIENCE) and self.ecology.until(says_so, PATIENCE), "the task runs")

    def kill_keeper(self) -> Adoption:
        """End the site that runs the task, and look at what becomes of it."""
        name = self.keeper()
        self.ecology.let_pass(1.0)
        while not self._began.empty():
            self._began.get()
        killed = time.monotonic()
        os.kill(self.ecology.sites[name].number, signal.SIGKILL)
        _need(self.ecology.until(lambda: not self._began.empty(), PATIENCE), "the task is adopted")
        adopted = self._began.get() - killed
        self.ecology.let_pass(max(0.0, killed + AFTERWARDS - time.monotonic()))
        self.ecology.forget(self.ecology.sites[name])
        self.start_keeper(name)
        _need(self.ecology.until(lambda: self._runs_at(name), PATIENCE), "the task goes back to the site")
        self.ecology.let_pass(1.0)
        signs = [one for one in self.ecology.witnesses.signs if killed - 1.0 < one.time]
        self.ecology.witnesses.forget(time.monotonic() - 1.0)
        return Adoption(adopted, _longest_pause(signs), sum(sign.what in ("started", "stopped") for sign in signs))

    def replaces(self) -> bool:
        """Whether a component that fails is replaced."""
        tracks, follows = self._acts("tracker"), self._acts("odometry")
        _need(self.ecology.until(lambda: tracks() or follows(), PATIENCE), "one of the two acts")
        failing = "tracker" if tracks() else "odometry"
        other = {"tracker": "odometry", "odometry": "tracker"}[failing]
        process = self.ecology.witnesses.process_of(failing)
        assert process is not None
        os.kill(process, signal.SIGUSR1)
        return self.ecology.until(self._acts(other), PATIENCE)

    def comes_back(self) -> float:
        """Seconds from the moment when all sites are killed until the task runs again, by itself."""
        for name in (*SITES, *KEEPERS):
            os.kill(self.ecology.sites[name].number, signal.SIGKILL)
        killed = time.monotonic()
        for name in (*SITES, *KEEPERS):
            self.ecology.forget(self.ecology.sites[name])
        for name in KEEPERS:
            self.start_keeper(name)
        for name in SITES:
            self.ecology.start_site(name)
        self.ecology.let_pass(0.5)
        self.until_it_runs()
        return time.monotonic() - killed

    def _acts(self, name: str) -> Callable[[], bool]:
        return lambda: any(sign.name == name for sign in self.ecology.witnesses.acting(time.monotonic() - 0.1))


def _longest_pause(signs: list[Sign]) -> float:
    """The longest time between two signs of one process that acts."""
    moments: dict[int, list[float]] = {}
    for sign in signs:
        if sign.what == "acts":
            moments.setdefault(sign.process, []).append(sign.time)
    pauses = (later - sooner for times in moments.values() for sooner, later in pairwise(times))
    return max(pauses, default=0.0)


def _need(reached: bool, what: str) -> None:
    if not reached:
        raise SystemExit(f"the benchmark stalled: {what} did not come about")


def report(found: list[Adoption], replaces: bool, back: float | None) -> str:
    """The table."""
    rows = [
        [
            name,
            f"{1000 * quantile(values, 0.5):.0f}",
            f"{1000 * quantile(values, 0.95):.0f}",
            f"{1000 * max(values):.0f}",
        ]
        for name, values in (("adopted", [one.adopted for one in found]), ("pause", [one.pause for one in found]))
    ]
    said = [
        f"{len(found)} trials; {sum(one.changed for one in found)} components were stopped or started.",
        f"Afterwards a component that failed was {'' if replaces else 'NOT '}replaced.",
    ]
    if back is not None:
        said.append(f"All sites killed and started again: the task ran again after {back:.1f} s.")
    return "\n\n".join([table(["ms", "median", "95 %", "worst"], rows), *said, described("eclipse-zenoh")])


def main() -> int:
    """Measure and print; the exit code is 1 if anybody was stopped or started, or a failure was not seen."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.adoption", description="a task's keeper is killed")
    parser.add_argument("--trials", type=int, default=20)
    parser.add_argument("--smoke", action="store_true", help="one trial, to see that it works")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as name:
        ecology = Ecology(Path(name))
        kept = KeptTask(ecology, Path(name))
        try:
            found = []
            for _ in range(1 if given.smoke else given.trials):
                found.append(kept.kill_keeper())
                print(found[-1], file=sys.stderr, flush=True)
            replaces = kept.replaces()
            back = None if given.smoke else kept.comes_back()
        finally:
            kept.close()
            ecology.close()
    print(report(found, replaces, back))
    return 0 if replaces and not any(one.changed for one in found) else 1


if __name__ == "__main__":
    sys.exit(main())
