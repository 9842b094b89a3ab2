"""Real faults, by seed, and a table of promises, trials and violations.

    python -m benchmarks.faults [--trials 60] [--seed 1] [--minutes 10] [--router] [--smoke]
    python -m benchmarks.faults --only 1/17         one trial again

Each trial: a configurator begins in an ecology of two sites whose components are started on demand; at a random moment
of discovery, reservation, activation, running or repair a component, a site or the configurator is killed, ended, or
stopped for half a second, two or ten; one in four has a second fault. Sites come back after half a second.

With `--router` each site is as on a host of its own, linked to nobody but a router that all go through; in two of seven
trials it is that which is killed, ended or stopped.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.faults.ecology import Ecology
from benchmarks.faults.trial import PROMISES, ROUTED_VICTIMS, VICTIMS, Outcome, Trial, plan
from benchmarks.machine import described, table

TOLD = 10
"""After how many trials it is told how many are done."""
LEFT = "no process is left when its site has ended"


def measure(seed: int, numbers: list[int], longest: float, minutes: float, routed: bool = False) -> list[Outcome]:
    """The outcomes of the trials, as many as there is time for; the ecology is made anew after a broken promise.

    Ctrl-C ends the trial that is under way, which does not count; those before it do.
    """
    outcomes: list[Outcome] = []
    deadline = time.monotonic() + 60 * minutes
    ecology: Ecology | None = None
    with tempfile.TemporaryDirectory() as folder:
        try:
            for number in numbers:
                if time.monotonic() > deadline:
                    break
                ecology = ecology or Ecology(Path(folder), routed)
                victims = ROUTED_VICTIMS if routed else VICTIMS
                outcome = Trial(ecology, plan(seed, number, longest, victims)).carry_out()
                outcomes.append(outcome)
                _tell(outcome, len(outcomes), len(numbers))
                if outcome.broken or number == numbers[-1]:
                    _leave(ecology, outcome)
                    ecology = None
        except KeyboardInterrupt:
            print("interrupted; the trial that was under way does not count", file=sys.stderr, flush=True)
        if ecology is not None:
            _leave(ecology, outcomes[-1] if outcomes else None)
    return outcomes


def _tell(outcome: Outcome, done: int, of: int) -> None:
    if done % TOLD == 0:
        print(f"{done} of {of} trials", file=sys.stderr, flush=True)
    for promise, detail in outcome.broken.items():
        print(f"{outcome.trial} {outcome.fault}: broken: {promise}: {detail}", file=sys.stderr, flush=True)


def _leave(ecology: Ecology, outcome: Outcome | None) -> None:
    """End an ecology; whether a process is left counts for its last trial, if there is one."""
    left = ecology.close()
    if outcome is not None:
        outcome.judge(LEFT, 99.0 if left else 0.0, ", ".join(left))


def report(outcomes: list[Outcome]) -> str:
    """The table of promises."""
    rows = []
    for promise, bound in PROMISES.items():
        took = [outcome.took[promise] for outcome in outcomes if promise in outcome.took]
        kept = [seconds for seconds in took if seconds <= bound]
        worst = f"{max(kept):.2f}" if kept else ""
        rows.append([promise, f"{bound:g}", str(len(took)), str(len(took) - len(kept)), worst])
    head = ["promise", "within s", "trials", "violations", "worst that was kept, s"]
    return f"{table(head, rows)}\n\n{len(outcomes)} trials; {described('eclipse-zenoh')}"


def main() -> int:
    """Measure and print; the exit code is 1 if a promise was broken."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.faults", description="real faults, by seed")
    parser.add_argument("--trials", type=int, default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--minutes", type=float, default=90.0, help="begin no trial after so many minutes")
    parser.add_argument("--only", metavar="SEED/NUMBER", help="one trial")
    parser.add_argument("--router", action="store_true", help="have all go through one router, and hit that as well")
    parser.add_argument("--smoke", action="store_true", help="one short trial, to see that it works")
    given = parser.parse_args()
    seed, numbers, longest = given.seed, list(range(given.trials)), 10.0
    if given.smoke:
        numbers, longest = [0], 0.5
    if given.only:
        seed, number = map(int, given.only.split("/"))
        numbers = [number]
    outcomes = measure(seed, numbers, longest, given.minutes, given.router)
    print(report(outcomes))
    return 1 if any(outcome.broken for outcome in outcomes) else 0


if __name__ == "__main__":
    sys.exit(main())
