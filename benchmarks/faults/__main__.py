"""Real faults, by seed, and a table of promises, trials and violations.

    python -m benchmarks.faults [--trials 60] [--seed 1] [--minutes 10] [--workers 4] [--router] [--rival] [--smoke]
    python -m benchmarks.faults --only 1/17         one trial again
    python -m benchmarks.faults --keep FOLDER       what happened in each trial that broke a promise, as FOLDER/1-17.txt

Each trial: a configurator begins in an ecology of two sites whose components are started on demand; at a random moment
of discovery, reservation, activation, running or repair a component, a site or the configurator is killed, ended, or
stopped for half a second, two or ten; one in four has a second fault. Sites come back after half a second.

With `--router` each site is as on a host of its own, linked to nobody but a router that all go through; in two of seven
trials it is that which is killed, ended or stopped.

With `--rival` another run begins shortly before the fault, whose task goes before: it shares the sonar, takes the
drive, and has a composite for the control. It has faults as well, and is ended before the task has to run again.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import threading
import time
from collections.abc import Sequence
from concurrent.futures import FIRST_EXCEPTION, Future, ThreadPoolExecutor, wait
from pathlib import Path

from benchmarks.faults.ecology import Ecology, Halted
from benchmarks.faults.plan import ROUTED_VICTIMS, VICTIMS, Plan, plan
from benchmarks.faults.trial import PROMISES, Outcome, Trial
from benchmarks.machine import described, table

TOLD = 10
"""After how many trials it is told how many are done."""
LEFT = "no process is left when its site has ended"


class Series:
    """Trials that workers take one after the other, each worker in an ecology of its own.

    A worker goes on in its ecology, so that trials also begin with what others have left; only after a broken promise
    it makes another one. A worker is a thread: what a trial computes is computed by the processes that it looks at.
    """

    def __init__(self, plans: Sequence[Plan], minutes: float, routed: bool, keep: Path | None = None) -> None:
        self._plans, self._number, self._routed = iter(plans), len(plans), routed
        self._rival = any(planned.lead is not None for planned in plans)
        self._deadline, self._keep = time.monotonic() + 60 * minutes, keep
        self._turn = threading.Condition()
        self._at_work = 0
        self._halt = threading.Event()
        self.outcomes: list[Outcome] = []

    def play(self, workers: int) -> None:
        """Carry out as many trials as there is time for; Ctrl-C ends those under way, which do not count."""
        with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(workers) as pool:
            working: list[Future[None]] = []
            try:
                for _ in range(workers):
                    working.append(pool.submit(self._work, Path(folder)))
                wait(working, return_when=FIRST_EXCEPTION)
            except KeyboardInterrupt:
                print("interrupted; trials that were under way do not count", file=sys.stderr, flush=True)
            finally:
                self._halt.set()
                with self._turn:  # a pool that is interrupted as it starts a thread does not know it
                    self._turn.wait_for(lambda: not self._at_work)
        for one in working:
            one.result()

    def _work(self, folder: Path) -> None:
        ecology, last = None, None
        with self._turn:
            self._at_work += 1
        try:
            while (planned := self._next()) is not None:
                ecology = ecology or Ecology(folder, self._routed, self._halt, self._rival)
                last = Trial(ecology, planned).carry_out()
                self._note(last)
                if last.broken:
                    left, ecology = ecology, None
                    _leave(left, last)
        except Halted:
            pass
        finally:
            if ecology is not None:
                _leave(ecology, last)
            with self._turn:
                self._at_work -= 1
                self._turn.notify_all()

    def _next(self) -> Plan | None:
        with self._turn:
            ended = self._halt.is_set() or time.monotonic() > self._deadline
            return None if ended else next(self._plans, None)

    def _note(self, outcome: Outcome) -> None:
        with self._turn:
            outcome.load = os.getloadavg()[0]
            self.outcomes.append(outcome)
            if len(self.outcomes) % TOLD == 0:
                print(f"{len(self.outcomes)} of {self._number} trials", file=sys.stderr, flush=True)
            for promise in outcome.broken:
                _tell(outcome, promise)
            if outcome.broken and self._keep is not None:
                _keep(outcome, self._keep)
            outcome.history.clear()


def _tell(outcome: Outcome, promise: str) -> None:
    broken = f"{outcome.trial} {outcome.fault}, at a load of {outcome.load:.1f}: broken: {promise}"
    print(f"{broken}: {outcome.broken[promise]}", file=sys.stderr, flush=True)


def _keep(outcome: Outcome, folder: Path) -> None:
    """Write what happened in a trial, in order, each line with the seconds since the first."""
    folder.mkdir(parents=True, exist_ok=True)
    history = sorted(outcome.history)
    lines = [f"{clock - history[0][0]:8.3f} {what}\n" for clock, what in history]
    (folder / f"{outcome.trial.replace('/', '-')}.txt").write_text("".join((f"{outcome.fault}\n", *lines)))


def _leave(ecology: Ecology, outcome: Outcome | None) -> None:
    """End an ecology; whether a process is left counts for its last trial, if there is one."""
    left = ecology.close()
    if outcome is not None:
        outcome.judge(LEFT, 99.0 if left else 0.0, ", ".join(left))
        if left:
            _tell(outcome, LEFT)


def report(outcomes: list[Outcome]) -> str:
    """The table of promises."""
    rows = []
    for promise, bound in PROMISES.items():
        took = [outcome.took[promise] for outcome in outcomes if promise in outcome.took]
        kept = [seconds for seconds in took if seconds <= bound]
        worst = f"{max(kept):.2f}" if kept else ""
        rows.append([promise, f"{bound:g}", str(len(took)), str(len(took) - len(kept)), worst])
    head = ["promise", "within s", "trials", "violations", "worst that was kept, s"]
    loads = sorted(outcome.load for outcome in outcomes)
    load = f" at a load of {loads[0]:.1f} to {loads[-1]:.1f}" if loads else ""
    return f"{table(head, rows)}\n\n{len(outcomes)} trials{load}; {described('eclipse-zenoh')}"


def main() -> int:
    """Measure and print; the exit code is 1 if a promise was broken."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.faults", description="real faults, by seed")
    parser.add_argument("--trials", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=90.0, help="begin no trial after so many minutes")
    parser.add_argument("--workers", type=int, default=1, metavar="N", help="trials at once, at most two for each core")
    parser.add_argument("--only", metavar="SEED/NUMBER", help="one trial")
    parser.add_argument("--keep", metavar="FOLDER", type=Path, help="write what happened where a promise was broken")
    parser.add_argument("--router", action="store_true", help="have all go through one router, and hit that as well")
    parser.add_argument("--rival", action="store_true", help="have a task of higher priority come and go")
    parser.add_argument("--smoke", action="store_true", help="two short trials at once, to see that it works")
    given = parser.parse_args()
    seed, numbers, longest, workers = given.seed, list(range(given.trials)), 10.0, given.workers
    if given.smoke:
        numbers, longest, workers = [0, 1], 0.5, 2
    if given.only:
        seed, number = map(int, given.only.split("/"))
        numbers = [number]
    victims = ROUTED_VICTIMS if given.router else VICTIMS
    plans = [plan(seed, number, longest, victims, given.rival) for number in numbers]
    series = Series(plans, given.minutes, given.router, given.keep)
    series.play(min(workers, len(numbers)))
    print(report(series.outcomes))
    return 1 if any(outcome.broken for outcome in series.outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
