"""The benchmark of real faults: its short run works, a seed decides its trials, and it sees what is broken."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.faults import __main__ as faults_program
from benchmarks.faults.__main__ import report
from benchmarks.faults.actor import ADVERTISEMENTS, OUTPUTS
from benchmarks.faults.ecology import HUB, Sign, lives_at_once
from benchmarks.faults.trial import KINDS, PHASES, PROMISES, ROUTED_VICTIMS, Outcome, Plan, plan
from tests.benchmark import short_run


@pytest.mark.process
def test_the_short_run_of_the_adoption_runs() -> None:
    printed = short_run("benchmarks.adoption")
    assert "1 trials; 0 components were stopped or started." in printed


@pytest.mark.process
def test_the_short_run_runs() -> None:
    printed = short_run("benchmarks.faults")
    assert "1 trials" in printed


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
    assert {path.stem for path in ADVERTISEMENTS.glob("*/*.ttl")} == set(OUTPUTS)


def test_trials_before_ctrl_c_count_and_the_ecology_is_ended(monkeypatch: pytest.MonkeyPatch) -> None:
    ended: list[bool] = []

    class Quiet:
        """An ecology in which nothing is left of what it has started."""

        def __init__(self, folder: Path, routed: bool) -> None:
            pass

        def close(self) -> list[str]:
            ended.append(True)
            return []

    class Third:
        """A trial, of which the third is interrupted."""

        def __init__(self, ecology: Quiet, planned: Plan) -> None:
            self.trial = planned.trial

        def carry_out(self) -> Outcome:
            if self.trial.endswith("/2"):
                raise KeyboardInterrupt
            return Outcome(self.trial, "running: kill drive")

    monkeypatch.setattr(faults_program, "Ecology", Quiet)
    monkeypatch.setattr(faults_program, "Trial", Third)
    outcomes = faults_program.measure(1, list(range(5)), 10.0, 1.0)
    assert [one.trial for one in outcomes] == ["1/0", "1/1"]
    assert ended == [True]
