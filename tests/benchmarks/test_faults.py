"""The benchmark of real faults: its short run works, a seed decides its trials, and it sees what is broken."""

from __future__ import annotations

import json
import os
import signal
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar

import pytest

from benchmarks.faults import __main__ as faults_program
from benchmarks.faults.__main__ import Series, report
from benchmarks.faults.actor import ADVERTISEMENTS, OUTPUTS, RIVAL_OUTPUTS
from benchmarks.faults.ecology import HUB, Ecology, Halted, Sign, lives_at_once
from benchmarks.faults.plan import KINDS, LEADS, PHASES, ROUTED_VICTIMS, Plan, plan
from benchmarks.faults.trial import PROMISES, RIVALS, Outcome, Trial
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough


@thorough
@pytest.mark.process
def test_the_short_run_of_the_adoption_runs() -> None:
    printed = short_run("benchmarks.adoption")
    assert "1 trials; 0 components were stopped or started." in printed


@thorough
@pytest.mark.process
def test_the_short_run_runs() -> None:
    printed = short_run("benchmarks.faults")
    assert "2 trials at a load of" in printed


def test_a_trial_is_decided_by_its_seed_and_every_fault_comes_at_every_phase() -> None:
    plans = [plan(1, number, 10.0) for number in range(500)]
    assert plans == [plan(1, number, 10.0) for number in range(500)]
    seen = {(one.phase, one.faults[0].victim, one.faults[0].kind) for one in plans}
    assert len(seen) == len(PHASES) * 3 * len(KINDS)
    assert any(len(one.faults) == 2 for one in plans)
    assert not any("10 s" in str(plan(1, number, 0.5)) for number in range(100))


def test_where_all_go_through_a_router_it_is_hit_by_every_fault_too() -> None:
    plans = [plan(1, number, 10.0, ROUTED_VICTIMS) for number in range(200)]
    assert {one.faults[0].kind for one in plans if one.faults[0].victim == "router"} == set(KINDS)
    assert {fault.name for one in plans for fault in one.faults if fault.victim == "router"} == {HUB}


def test_a_rival_and_what_it_needs_have_every_fault_too() -> None:
    plans = [plan(1, number, 10.0, rival=True) for number in range(500)]
    assert {one.lead for one in plans} == set(LEADS)
    for victim in ("rival", *RIVAL_OUTPUTS):
        assert {one.faults[0].kind for one in plans if one.faults[0].name == victim} == set(KINDS)
    assert {plan(1, number, 10.0).lead for number in range(20)} == {None}


def test_a_drive_that_heeds_two_tasks_at_a_time_is_noticed() -> None:
    ecology = Watched()
    trial = Trial(ecology, Plan("1/0", "running", (), 0.0))  # type: ignore[arg-type]  # only its signs are looked at
    first = [Sign("drive", 1, "heeds the task", trial.began + moment / 10) for moment in range(1, 20)]
    then = [Sign("drive", 1, "heeds the rival", trial.began + moment / 10) for moment in range(20, 40)]
    ecology.witnesses.signs = [*first, *then]
    assert trial._heeds_both() <= 0.1
    both = [Sign("drive", 1, "heeds the rival", trial.began + moment / 10) for moment in range(10, 40)]
    ecology.witnesses.signs = [*first, *both]
    assert trial._heeds_both() == pytest.approx(1.0, abs=0.11)


class Watched:
    """An ecology of which only the signs are looked at."""

    def __init__(self) -> None:
        self.witnesses = self
        self.signs: list[Sign] = []

    def run(self) -> None:
        """Begin nothing."""


def test_two_processes_that_act_at_once_are_noticed_and_one_after_the_other_is_not() -> None:
    first = [Sign("drive", 1, "acts", moment / 10) for moment in range(10)]
    then = [Sign("drive", 2, "acts", moment / 10) for moment in range(10, 20)]
    assert lives_at_once([*first, *then]) == {}
    both = [Sign("drive", 2, "acts", moment / 10) for moment in range(5, 20)]
    assert lives_at_once([*first, *both])["drive"] == pytest.approx(0.5, abs=0.11)


def test_the_table_counts_what_was_broken() -> None:
    outcome = Outcome("1/0", "running: kill drive")
    outcome.judge("status names the task that runs", 0.3)
    outcome.judge("once a run has ended nobody acts", 5.0, "drive")
    assert outcome.broken == {"once a run has ended nobody acts": "5.00 s drive"}
    lines = {line.split(" | ")[0].strip("| "): line for line in report([outcome]).splitlines()}
    assert lines["once a run has ended nobody acts"].split(" | ")[2:4] == ["1", "1"]
    assert lines["status names the task that runs"].split(" | ")[2:4] == ["1", "0"]
    assert set(PROMISES) < set(lines)


def test_every_actor_has_an_advertisement() -> None:
    advertised = {path.stem for path in ADVERTISEMENTS.glob("*/*.ttl")}
    assert advertised - {"reflex"} == OUTPUTS.keys() | RIVAL_OUTPUTS.keys()  # a composite has no process
    assert advertised > RIVALS


class Quiet:
    """An ecology in which nothing is left of what it has started."""

    made: ClassVar[list[Quiet]] = []

    def __init__(self, folder: Path, routed: bool, halt: threading.Event, rival: bool) -> None:
        self.halt, self.closed = halt, False
        self.made.append(self)

    def close(self) -> list[str]:
        self.closed = True
        return []


@pytest.fixture
def quiet(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Quiet]]:
    monkeypatch.setattr(faults_program, "Ecology", Quiet)
    Quiet.made.clear()
    yield Quiet.made
    assert all(ecology.closed for ecology in Quiet.made)


def test_workers_play_each_trial_once_beside_each_other_in_ecologies_of_their_own(
    monkeypatch: pytest.MonkeyPatch, quiet: list[Quiet]
) -> None:
    together = threading.Barrier(3)

    class Met:
        """A trial that ends when two others are under way."""

        def __init__(self, ecology: Quiet, planned: Plan) -> None:
            self.trial = planned.trial

        def carry_out(self) -> Outcome:
            together.wait(30)
            return Outcome(self.trial, "running: kill drive")

    monkeypatch.setattr(faults_program, "Trial", Met)
    series = Series([plan(1, number, 10.0) for number in range(6)], 1.0, False)
    series.play(3)
    assert sorted(one.trial for one in series.outcomes) == [f"1/{number}" for number in range(6)]
    assert len(quiet) == 3


def test_after_a_broken_promise_an_ecology_is_made_anew_and_what_happened_is_kept(
    monkeypatch: pytest.MonkeyPatch, quiet: list[Quiet], tmp_path: Path
) -> None:
    class Second:
        """A trial, of which the second breaks a promise."""

        def __init__(self, ecology: Quiet, planned: Plan) -> None:
            self.trial = planned.trial

        def carry_out(self) -> Outcome:
            outcome = Outcome(self.trial, "running: kill drive", history=[(7.5, "lost"), (7.0, "kill drive")])
            outcome.judge("once a run has ended nobody acts", 5.0 if self.trial == "1/1" else 0.0)
            return outcome

    monkeypatch.setattr(faults_program, "Trial", Second)
    series = Series([plan(1, number, 10.0) for number in range(4)], 1.0, False, tmp_path / "kept")
    series.play(1)
    assert len(series.outcomes) == 4
    assert len(quiet) == 2
    (kept,) = (tmp_path / "kept").iterdir()
    assert kept.name == "1-1.txt"
    assert kept.read_text().splitlines() == ["running: kill drive", "   0.000 kill drive", "   0.500 lost"]


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Ctrl-C as a terminal has it: what a shell starts in the background ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("interruptible")
def test_trials_before_ctrl_c_count_and_the_ecologies_are_ended(
    monkeypatch: pytest.MonkeyPatch, quiet: list[Quiet]
) -> None:
    class Third:
        """A trial, of which the third is interrupted, and the fourth, if it is under way, is halted."""

        def __init__(self, ecology: Quiet, planned: Plan) -> None:
            self.trial, self.halt = planned.trial, ecology.halt

        def carry_out(self) -> Outcome:
            if self.trial in ("1/2", "1/3"):
                if self.trial == "1/2":
                    os.kill(os.getpid(), signal.SIGINT)
                assert self.halt.wait(30)
                raise Halted
            return Outcome(self.trial, "running: kill drive")

    monkeypatch.setattr(faults_program, "Trial", Third)
    series = Series([plan(1, number, 10.0) for number in range(50)], 1.0, False)
    series.play(2)
    assert {"1/0", "1/1"} <= {one.trial for one in series.outcomes}
    assert not {"1/2", "1/3"} & {one.trial for one in series.outcomes}
    assert quiet  # and the fixture sees that each has been closed


@pytest.mark.process
def test_an_ecology_that_is_halted_waits_for_nothing_and_can_be_closed(tmp_path: Path) -> None:
    halt = threading.Event()
    ecology = Ecology(tmp_path, halt=halt)
    halt.set()
    with pytest.raises(Halted):
        ecology.let_pass(60.0)
    sites = list(ecology.programs)
    assert ecology.close() == []
    assert [site.ended for site in sites] == [0, 0]


@thorough
@pytest.mark.process
def test_a_fault_of_a_reservation_comes_though_all_components_live_already(tmp_path: Path) -> None:
    ecology = Ecology(tmp_path)
    seen = []
    try:
        for number in range(2):
            outcome = Trial(ecology, Plan(f"1/{number}", "reservation", ())).carry_out()
            assert not outcome.broken
            seen.append(json.dumps([what for _, what in sorted(outcome.history)]))
    finally:
        ecology.close()
    assert '"waking' in seen[0].replace("\\", "")
    assert "waking" not in seen[1]
    assert outcome.took["a task comes to the phase of the fault"] < 25.0


class Said:
    """A configurator, which says more each time that it is read."""

    def __init__(self, *more: tuple[str, ...]) -> None:
        self.acts: list[str] = ["running"]
        self._more = list(more)

    def read(self) -> None:
        self.acts += self._more.pop(0)


class Asked(Trial):
    """A trial in which `status` says one thing after the other."""

    def __init__(self, said: Said, *answers: str) -> None:
        self.configurator, self.outcome = said, Outcome("1/0", "running: kill drive")  # type: ignore[assignment]  # only `acts` and `read` are used
        self.answers = list(answers)
        self.waited = 0

    def _status(self) -> tuple[float, str]:
        return 0.5, self.answers.pop(0)

    def _await_running(self) -> None:
        self.waited += 1


STATUS = "status names the task that runs"


def test_status_is_asked_anew_only_where_the_task_did_not_run_on_meanwhile() -> None:
    disturbed = Asked(Said(("lost", "composed"), ()), 'phase "reserving"', 'phase "running"')
    disturbed._judge_status()
    assert (disturbed.waited, disturbed.outcome.took) == (1, {STATUS: 0.5})
    wrong = Asked(Said(()), 'phase "reserving"', 'phase "running"')
    wrong._judge_status()
    assert wrong.outcome.broken == {STATUS: '99.00 s phase "reserving"'}


def test_status_that_never_names_the_task_breaks_the_promise() -> None:
    never = Asked(Said(("lost",), ("connected",), ("cut off",)), "", "", "")
    never._judge_status()
    assert STATUS in never.outcome.broken
    assert never.answers == []
