"""One trial: a configurator runs, something happens to somebody at some moment, and every promise is looked at.

What happens is decided by its plan. `PROMISES` are what is looked at, each with the seconds it may take.
"""

from __future__ import annotations

import json
import os
import signal
import time
from collections import defaultdict
from collections.abc import Callable, Container, Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from functools import partial

from benchmarks.faults.actor import OUTPUTS, RIVAL_OUTPUTS
from benchmarks.faults.ecology import HUB, PATIENCE, RIVAL, Ecology, Program, Sign, lives_at_once
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
    "a rival of higher priority runs": HEALS,
    "the drive heeds one task at a time": SLACK,
    "status names the task that runs": 10.0,
    "once a run has ended nobody acts": SLACK,
    "Ctrl-C ends the run with exit code 0": 15.0,
    "no process is left when its site has ended": 5.0,
}
"""What is looked at, with the seconds that it may take."""
RIVALS = frozenset({"sonar", "veer", "drive"})
"""Who acts for the rival: it shares the sonar with the task."""


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
        self.rival: Program | None = None
        self._stopped: list[tuple[float, int]] = []
        """The processes that stand still, with the time at which they go on."""
        self._restart: list[tuple[float, str]] = []
        self._still: list[tuple[str, float, float]] = []
        """Who stood still, and from when to when: whoever did could not keep a promise."""
        self.began = time.monotonic()

    def carry_out(self) -> Outcome:
        """Wait for the phase, let the faults happen, and look at every promise."""
        self._await_phase()
        if self.plan.lead is not None:
            self.rival = self.ecology.run(RIVAL)
            self._wait(self.plan.lead)
        for fault in self.plan.faults:
            self._wait(fault.delay)
            self._do(fault)
        self._look_for_orphans()
        self._settle()
        if self.rival is not None:
            self._judge_rival(self.rival)
        self._heal()
        self._judge_signs()
        self._judge_status()
        self._judge_end()
        return self.outcome

    def _remember(self, what: str, clock: float) -> None:
        """Add to what happened, at a time of the monotonic clock."""
        self.outcome.history.append((clock, what))

    def _forget(self, configurator: Program, who: str = "") -> None:
        """Read a configurator that has ended, or is given up, no more."""
        self.ecology.forget(configurator)
        ahead = time.time() - time.monotonic()
        for event in configurator.events:
            self._remember(who + json.dumps(event), event["time"] - ahead)

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
        configurators = {"configurator": self.configurator, "rival": self.rival}
        program = configurators[fault.victim] if fault.victim in configurators else self.ecology.sites[fault.name]
        return program.number if program is not None and program.ended is None else None

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
        others = RIVALS if self.rival is not None else frozenset()
        acting = [s for s in acting if s.name not in others and not self._was_still(s.time, "configurator")]
        last = max((sign.time for sign in acting), default=fell) - fell
        self.outcome.judge(promise, last, _names([sign for sign in acting if sign.time > fell + bound]))

    def _was_hit(self, name: str) -> bool:
        """Whether a fault of the plan names somebody."""
        return any(fault.name == name for fault in self.plan.faults)

    def _was_still(self, moment: float, but: str = "") -> bool:
        """Whether somebody stood still then, or shortly before, other than the one that is left out."""
        return any(begin <= moment <= end + LEASE + GRACE for who, begin, end in self._still if who != but)

    def _settle(self) -> None:
        """Wait until all that stood still goes on, and what was to come back is back."""
        while self._stopped or self._restart:
            self._wait(0.05)

    def _heal(self) -> None:
        """Wait until the task runs again; where its configurator is gone, another one is begun."""
        if self.configurator.ended is not None or self.plan.ends("configurator"):
            self._await_end(self.configurator)
            self._forget(self.configurator)
            self.configurator = self.ecology.run()
        self._await_running()

    def _await_end(self, configurator: Program) -> None:
        """Wait for a configurator that was killed, or told to end."""
        self.ecology.until(lambda: configurator.ended is not None, 10.0)
        if configurator.ended is None:
            self.outcome.judge("Ctrl-C ends the run with exit code 0", 99.0, "it does not end")

    def _await_running(self) -> None:
        """Wait until the task has run for a while, and judge how long that took."""
        took = self._until_steady(self._runs)
        self.outcome.judge("after the fault the task is running again", took, f"acts: {self.configurator.acts[-6:]}")

    def _until_steady(self, runs: Callable[[], bool]) -> float:
        """Wait until a task has run for a while; return after how many seconds it began to."""
        began = steady = time.monotonic()
        while time.monotonic() < min(steady + STEADY, began + HEALS + STEADY):
            self._wait(0.05)
            if not runs():
                steady = time.monotonic()
        return steady - began

    def _runs(self) -> bool:
        """Whether all five act, in the eyes of the witness, and the configurator says so."""
        acting = self._acting_for(self.configurator)
        return len(acting) == 5 and {"sonar", "encoder", "control", "drive"} < acting

    def _acting_for(self, configurator: Program) -> set[str]:
        """Who acts, in the eyes of the witness, if a configurator says that its task runs; else nobody."""
        configurator.read()
        states = [act for act in configurator.acts if act in STATES]
        if not states or states[-1] != "running":
            return set()
        return {sign.name for sign in self.ecology.witnesses.acting(time.monotonic() - 0.3)}

    def _judge_rival(self, rival: Program) -> None:
        """Look whether the rival of the task has run, and end it; nobody acts for it then."""
        is_ended = self.plan.ends("rival")
        if self._was_hit(HUB) and self.ecology.until(lambda: rival.ended == 2 and not rival.acts, STEADY):
            self._forget(rival, "rival: ")  # a run that begins while nobody can be reached ends, and says so
            rival, is_ended = self.ecology.run(RIVAL), False
        if is_ended:
            self._await_end(rival)
        else:
            took = self._until_steady(lambda: self._acting_for(rival) == RIVALS)
            self.outcome.judge("a rival of higher priority runs", took, f"acts: {rival.acts[-6:]}")
            self._end(rival)
        over = time.monotonic() + (LEASE + GRACE if is_ended else 0.0)
        self._wait(over - time.monotonic() + PROMISES["once a run has ended nobody acts"] + 0.2)
        self._judge_late(over, RIVAL_OUTPUTS)
        self._forget(rival, "rival: ")

    def _judge_signs(self) -> None:
        signs = self.ecology.witnesses.acting(self.began)
        doubles = lives_at_once(signs)
        longest = max(doubles.values(), default=0.0)
        self.outcome.judge("no component acts in two processes at once", longest, str(doubles))
        blind = max(self._blind(), default=0.0)
        self.outcome.judge("the drive does not act blind", blind)
        if self.plan.lead is not None:
            self.outcome.judge("the drive heeds one task at a time", self._heeds_both())

    def _heeds_both(self) -> float:
        """For how many seconds at a time the drive heeded both tasks, one tenth after the other."""
        tenths: defaultdict[int, set[str]] = defaultdict(set)
        for sign in self.ecology.witnesses.signs:
            if sign.what.startswith("heeds") and sign.time >= self.began:
                tenths[int(sign.time * 10)].add(sign.what)
        longest = now = 0
        for tenth in range(min(tenths, default=0), max(tenths, default=0) + 1):
            now = now + 1 if len(tenths.get(tenth, ())) > 1 else 0
            longest = max(longest, now)
        return longest / 10

    def _blind(self) -> Iterator[float]:
        """For how many seconds the drive acted, at each sign of it, without anybody who controls it."""
        controlled = 0.0
        for sign in self.ecology.witnesses.signs:
            if sign.time < self.began:
                continue
            if sign.name in ("control", *RIVAL_OUTPUTS) or (sign.name == "drive" and sign.what == "started"):
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
        self._end(self.configurator)
        over = time.monotonic()
        self.ecology.let_pass(PROMISES["once a run has ended nobody acts"] + 0.2)
        self._judge_late(over, OUTPUTS | RIVAL_OUTPUTS)
        self._forget(self.configurator)
        for sign in self.ecology.witnesses.signs:
            if sign.what in ("born", "started", "stopped"):
                self._remember(f"{sign.name} {sign.process} {sign.what}", sign.time)
        self.ecology.witnesses.forget(time.monotonic())

    def _end(self, configurator: Program) -> None:
        """End a run by Ctrl-C."""
        configurator.send(signal.SIGINT)
        began = time.monotonic()
        ended = self.ecology.until(lambda: configurator.ended is not None, 15.0)
        took = time.monotonic() - began
        good = ended and configurator.ended == 0
        promise = "Ctrl-C ends the run with exit code 0"
        self.outcome.judge(promise, took if good else 99.0, f"exit code {configurator.ended}")

    def _judge_late(self, over: float, names: Container[str]) -> None:
        """Look whether one of some components has acted after the run was over."""
        late = [sign for sign in self.ecology.witnesses.acting(over) if sign.name in names]
        last = max((sign.time for sign in late), default=over) - over
        self.outcome.judge("once a run has ended nobody acts", last, _names(late))


def _names(signs: list[Sign]) -> str:
    return ", ".join(sorted({sign.name for sign in signs}))
