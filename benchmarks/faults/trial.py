"""One trial: a configurator runs, something happens to somebody at some moment, and every promise is looked at.

What happens is decided by its plan. `PROMISES` are what is looked at, each with the seconds it may take.
"""

from __future__ import annotations

import json
import os
import signal
import time
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial

from benchmarks.faults.ecology import PATIENCE, Ecology, Sign, lives_at_once
from benchmarks.faults.plan import KINDS, PHASES, Fault, Plan

GRACE = 1.0
LEASE = 1.0
SLACK = 0.7
"""Seconds that a busy machine may add."""
STEADY = 1.5
"""Seconds for which a task must run before it counts as running: what is wrong may not have been noticed before."""
HEALS = 25.0
"""Seconds after which a run must be running again: a site starts a component within 15."""
ASKED = 3
"""How often `status` is asked at most, where the task does not run on meanwhile."""
STATES = ("running", "lost", "waiting", "cut off", "connected")
"""The acts of which the last one says whether a task runs."""

PROMISES = {
    "a task comes to the phase of the fault": PATIENCE,
    "after the fault the task is running again": HEALS,
    "without its configurator nobody acts": LEASE + GRACE + SLACK,
    "no component acts in two processes at once": LEASE + GRACE + SLACK,
    "the drive does not act blind": LEASE + 2 * GRACE + SLACK,
    "status names the task that runs": 10.0,
    "once a run has ended nobody acts": SLACK,
    "Ctrl-C ends the run with exit code 0": 15.0,
    "no process is left when its site has ended": 5.0,
}
"""What is looked at, with the seconds that it may take."""


@dataclass(slots=True)
class Outcome:
    """What came of a trial: how long each promise took to be kept, and which were not kept."""

    trial: str
    fault: str
    took: dict[str, float] = field(default_factory=dict)
    broken: dict[str, str] = field(default_factory=dict)
    load: float = 0.0
    """The load of the machine at its end, averaged over a minute."""
    history: list[tuple[float, str]] = field(default_factory=list)
    """What happened: the faults, what the configurators said, who began and ceased to act; each with its time."""

    def judge(self, promise: str, seconds: float, detail: str = "") -> None:
        """Note how long a promise took."""
        self.took[promise] = max(seconds, self.took.get(promise, 0.0))
        if seconds > PROMISES[promise]:
            self.broken[promise] = f"{seconds:.2f} s {detail}".strip()


class Trial:
    """A plan that is carried out in an ecology."""

    def __init__(self, ecology: Ecology, planned: Plan) -> None:
        self.ecology, self.plan = ecology, planned
        self.outcome = Outcome(planned.trial, str(planned))
        self.configurator = ecology.run()
        self._stopped: list[tuple[float, int]] = []
        """The processes that stand still, with the time at which they go on."""
        self._restart: list[tuple[float, str]] = []
        self._still: list[tuple[str, float, float]] = []
        """Who stood still, and from when to when: whoever did could not keep a promise."""
        self.began = time.monotonic()

    def carry_out(self) -> Outcome:
        """Wait for the phase, let the faults happen, and look at every promise."""
        self._await_phase()
        for fault in self.plan.faults:
            self._wait(fault.delay)
            self._do(fault)
        self._look_for_orphans()
        self._heal()
        self._judge_signs()
        self._judge_status()
        self._judge_end()
        return self.outcome

    def _remember(self, what: str, clock: float) -> None:
        """Add to what happened, at a time of the monotonic clock."""
        self.outcome.history.append((clock, what))

    def _forget_configurator(self) -> None:
        """Read a configurator that has ended, or is given up, no more."""
        self.ecology.forget(self.configurator)
        ahead = time.time() - time.monotonic()
        for event in self.configurator.events:
            self._remember(json.dumps(event), event["time"] - ahead)

    # What happens.

    def _await_phase(self) -> None:
        for act in PHASES[self.plan.phase]:
            began = time.monotonic()
            if act == "lost":
                self._make_fail()
            reached = self.ecology.until(partial(self._has_done, act), PATIENCE)
            took = time.monotonic() - began if reached else 99.0
            self.outcome.judge("a task comes to the phase of the fault", took, f"no {act!r}")

    def _has_done(self, act: str) -> bool:
        return not {act, "refused"}.isdisjoint(self.configurator.acts)

    def _make_fail(self) -> None:
        """Make the position sensor fail that acts; a component that begins to act says so within 20 ms."""
        acting: list[Sign] = []

        def found() -> bool:
            signs = self.ecology.witnesses.acting(self.began)
            acting[:] = [sign for sign in signs if sign.name in ("tracker", "odometry")]
            return bool(acting)

        if self.ecology.until(found, PATIENCE):
            with suppress(ProcessLookupError):
                os.kill(acting[-1].process, signal.SIGUSR1)

    def _process(self, fault: Fault) -> int | None:
        if fault.victim == "component":
            return self.ecology.witnesses.process_of(fault.name)
        program = self.configurator if fault.victim == "configurator" else self.ecology.sites[fault.name]
        return program.number if program.ended is None else None

    def _do(self, fault: Fault) -> None:
        process = self._process(fault)
        if process is None:
            return
        self._remember(str(fault), time.monotonic())
        seconds = KINDS[fault.kind]
        if seconds:
            os.kill(process, signal.SIGSTOP)
            now = time.monotonic()
            self._stopped.append((now + seconds, process))
            self._still.append((fault.victim, now, now + seconds))
            return
        os.kill(process, signal.SIGKILL if fault.kind == "kill" else signal.SIGTERM)
        if fault.victim in ("site", "router"):
            self._restart.append((time.monotonic() + 0.5, fault.name))

    def _wait(self, seconds: float) -> None:
        """Let time pass, in which stopped processes go on and sites come back."""
        until = time.monotonic() + seconds
        while True:
            now = time.monotonic()
            for moment, process in [one for one in self._stopped if one[0] <= now]:
                self._stopped.remove((moment, process))
                with suppress(ProcessLookupError):
                    os.kill(process, signal.SIGCONT)
            for moment, name in [one for one in self._restart if one[0] <= now]:
                self._restart.remove((moment, name))
                self.ecology.forget(self.ecology.sites[name])
                self.ecology.start_site(name)
            if now >= until:
                return
            self.ecology.let_pass(min(until - now, 0.02))

    def _settled(self) -> bool:
        return not self._stopped and not self._restart

    # What is looked at.

    def _look_for_orphans(self) -> None:
        """If the configurator is gone, or stands still, everybody must be off after a while."""
        hit = [fault for fault in self.plan.faults if fault.victim == "configurator"]
        promise = "without its configurator nobody acts"
        if not hit or any(KINDS[fault.kind] in (0.5, 2.0) for fault in hit):
            return  # it is back just when they would be off, or before
        fell = time.monotonic()
        bound = PROMISES[promise]
        self._wait(bound + 0.3)
        acting = self.ecology.witnesses.acting(fell)
        acting = [sign for sign in acting if not self._was_still(sign.time, "configurator")]
        last = max((sign.time for sign in acting), default=fell) - fell
        self.outcome.judge(promise, last, _names([sign for sign in acting if sign.time > fell + bound]))

    def _was_still(self, moment: float, but: str = "") -> bool:
        """Whether somebody stood still then, or shortly before, other than the one that is left out."""
        return any(begin <= moment <= end + LEASE + GRACE for who, begin, end in self._still if who != but)

    def _heal(self) -> None:
        """Wait until the task runs again; where its configurator is gone, another one is begun."""
        while not self._settled():
            self._wait(0.05)
        if self.configurator.ended is not None or self.plan.ends_the_configurator:
            self.ecology.until(lambda: self.configurator.ended is not None, 10.0)
            if self.configurator.ended is None:
                self.outcome.judge("Ctrl-C ends the run with exit code 0", 99.0, "it does not end")
            self._forget_configurator()
            self.configurator = self.ecology.run()
        self._await_running()

    def _await_running(self) -> None:
        """Wait until the task has run for a while, and judge how long that took."""
        began = steady = time.monotonic()
        while time.monotonic() < min(steady + STEADY, began + HEALS + STEADY):
            self._wait(0.05)
            if not self._runs():
                steady = time.monotonic()
        took = steady - began
        self.outcome.judge("after the fault the task is running again", took, f"acts: {self.configurator.acts[-6:]}")

    def _runs(self) -> bool:
        """Whether all five act, in the eyes of the witness, and the configurator says so."""
        self.configurator.read()
        states = [act for act in self.configurator.acts if act in STATES]
        if not states or states[-1] != "running":
            return False
        now = time.monotonic()
        acting = {sign.name for sign in self.ecology.witnesses.acting(now - 0.3)}
        return len(acting) == 5 and {"sonar", "encoder", "control", "drive"} < acting

    def _judge_signs(self) -> None:
        signs = self.ecology.witnesses.acting(self.began)
        doubles = lives_at_once(signs)
        longest = max(doubles.values(), default=0.0)
        self.outcome.judge("no component acts in two processes at once", longest, str(doubles))
        blind = max(self._blind(), default=0.0)
        self.outcome.judge("the drive does not act blind", blind)

    def _blind(self) -> Iterator[float]:
        """For how many seconds the drive acted, at each sign of it, without anybody who controls it."""
        controlled = 0.0
        for sign in self.ecology.witnesses.signs:
            if sign.time < self.began:
                continue
            if sign.name == "control" or (sign.name == "drive" and sign.what == "started"):
                controlled = sign.time
            elif sign.name == "drive" and sign.what == "acts" and not self._drive_was_still(sign.time):
                yield sign.time - (controlled or sign.time)

    def _drive_was_still(self, moment: float) -> bool:
        hit = any(fault.name == "drive" and KINDS[fault.kind] for fault in self.plan.faults)
        return hit and self._was_still(moment)

    def _judge_status(self) -> None:
        """Ask for the status, and anew where the configurator says that the task did not run on meanwhile."""
        promise = "status names the task that runs"
        for _ in range(ASKED):
            before = len(self.configurator.acts)
            seconds, said = self._status()
            self.configurator.read()
            named = '"running"' in said
            if named or seconds > PROMISES[promise] or set(STATES).isdisjoint(self.configurator.acts[before:]):
                break
            self._await_running()
        self.outcome.judge(promise, seconds if named else 99.0, said[:200])

    def _status(self) -> tuple[float, str]:
        """Return how many seconds `status` takes, and what it says; if it fails, with its exit code."""
        began = time.monotonic()
        asked = self.ecology.start("status", "--format", "json", "--ecology", self.ecology.name)
        self.ecology.until(lambda: asked.ended is not None, 20.0)
        seconds, code = time.monotonic() - began, asked.ended
        self.ecology.forget(asked)
        said = " ".join(line.strip() for line in asked.lines) if code == 0 else f"exit code {code}: {asked.lines[-1:]}"
        self._remember(f"status: {said}", began)
        return seconds, said

    def _judge_end(self) -> None:
        self.configurator.send(signal.SIGINT)
        began = time.monotonic()
        ended = self.ecology.until(lambda: self.configurator.ended is not None, 15.0)
        took = time.monotonic() - began
        good = ended and self.configurator.ended == 0
        promise = "Ctrl-C ends the run with exit code 0"
        self.outcome.judge(promise, took if good else 99.0, f"exit code {self.configurator.ended}")
        over = time.monotonic()
        self.ecology.let_pass(PROMISES["once a run has ended nobody acts"] + 0.2)
        late = self.ecology.witnesses.acting(over)
        last = max((sign.time for sign in late), default=over) - over
        self.outcome.judge("once a run has ended nobody acts", last, _names(late))
        self._forget_configurator()
        for sign in self.ecology.witnesses.signs:
            if sign.what != "acts":
                self._remember(f"{sign.name} {sign.process} {sign.what}", sign.time)
        self.ecology.witnesses.forget(time.monotonic())


def _names(signs: list[Sign]) -> str:
    return ", ".join(sorted({sign.name for sign in signs}))
