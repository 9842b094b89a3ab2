"""The engines that take turns, or work beside each other, find the least solution, whichever of them settles what."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from benchmarks.search.families.coverage import cover
from benchmarks.search.families.puzzles import queens
from benchmarks.search.families.random_relations import ring
from selfconf.search.budget import Budget
from selfconf.search.engines import clause_learning, least_solution, rival
from selfconf.search.engines.formula import Counted
from selfconf.search.engines.least_solution import any_by_clauses, least_by_clauses
from selfconf.search.engines.ordered_decisions import OrderedDecisions
from selfconf.search.engines.rival import Rival
from selfconf.search.problem import Problem
from selfconf.search.reduction import pruned, reduced
from tests.harness.effort import examples, thorough
from tests.search.comparison import least_numbers, numbers
from tests.search.worlds import agreement, problems, rivalries

pytest.importorskip("pysat")


@given(st.one_of(problems(), rivalries()))
@agreement()
def test_solvers_that_take_turns_find_the_least_solution(problem: Problem) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(least_solution, "BRIEF", 0)
        patch.setattr(least_solution, "ALONE", 1)
        assert numbers(least_by_clauses(reduced(problem), Budget(100_000))) == least_numbers(problem)


@thorough
@pytest.mark.process
@given(st.one_of(problems(), rivalries()))
@settings(agreement(0.1), max_examples=examples(30), suppress_health_check=list(HealthCheck))
def test_a_rival_that_does_all_the_work_finds_the_least_solution(problem: Problem) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(OrderedDecisions, "available", staticmethod(lambda _: False))
        patch.setattr(least_solution, "ALONE", 0)
        patch.setattr(Rival, "available", staticmethod(lambda: True))
        patch.setattr(least_solution._Descent, "_ask", lambda *_: time.sleep(0) or 1)
        assert numbers(least_by_clauses(reduced(problem), Budget())) == least_numbers(problem)


def test_an_engine_that_cannot_join_in_is_done_without(monkeypatch: pytest.MonkeyPatch) -> None:
    for moment in ("UNSUPPORTED", "BRIEF", "PREPARED", "ALONE", "ALONE_OF_TWO"):
        monkeypatch.setattr(least_solution, moment, 10**9 if moment == "PREPARED" else 0)
    monkeypatch.setattr(Rival, "available", staticmethod(lambda: True))
    given_ = pruned(reduced(queens(6, 1, 3)))
    expected = numbers(least_by_clauses(given_, Budget()))

    def full(*_: object, **__: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(tempfile, "NamedTemporaryFile", full)
    monkeypatch.setattr(rival.sys, "executable", "/removed/since/python")
    assert numbers(least_by_clauses(given_, Budget())) == expected


def test_the_first_solver_begins_anew_with_clauses_that_count_only_where_a_role_asks_for_several(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for moment in ("UNSUPPORTED", "BRIEF_COUNTING", "BRIEF_COUNTED", "BRIEF"):
        monkeypatch.setattr(least_solution, moment, 0)
    counted: list[Counted] = []

    class Noted(clause_learning.ClauseSolver):
        def __init__(self, *arguments: Any, **options: Any) -> None:
            super().__init__(*arguments, **options)
            counted.append(self.counted)

    monkeypatch.setattr(least_solution, "ClauseSolver", Noted)
    for problem, expected in (
        (queens(6, 1, 3), [Counted.NONE]),
        (ring(6, 3, 8, 6, 1), [Counted.NONE, Counted.ALL]),
        (cover(30, 24, 6, 0.25, 1), [Counted.NONE, Counted.MANY]),
    ):
        counted.clear()
        found = least_by_clauses(pruned(reduced(problem)), Budget())
        assert counted == expected
        assert found is None or isinstance(found, list)


def test_company_waits_for_as_long_as_it_takes_to_prepare(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = pruned(reduced(queens(14, 1, 3)))
    together: list[int] = []
    search_together = least_solution._Descent._search_together

    def noted(*arguments: Any) -> None:
        together.append(least_solution.PREPARED)
        search_together(*arguments)

    monkeypatch.setattr(least_solution._Descent, "_search_together", noted)
    for moment in ("UNSUPPORTED", "BRIEF"):
        monkeypatch.setattr(least_solution, moment, 0)
    for prepared in (1_000_000, 1):
        monkeypatch.setattr(least_solution, "PREPARED", prepared)
        assert least_by_clauses(problem, Budget())
    assert together == [1_000_000]


def test_one_that_decides_in_order_and_never_ends_stops_nobody(monkeypatch: pytest.MonkeyPatch) -> None:
    problem = pruned(reduced(queens(14, 1, 3)))
    alone = numbers(least_by_clauses(problem, Budget()))
    monkeypatch.setattr(least_solution, "BRIEF", 0)
    monkeypatch.setattr(OrderedDecisions, "search", lambda *_: None)
    monkeypatch.setattr(OrderedDecisions, "begin", lambda *_: None)
    assert numbers(least_by_clauses(problem, Budget())) == alone


@pytest.mark.process
@pytest.mark.parametrize("number", [1, 2, 3], ids=["turns", "two at a time", "all three"])
def test_what_several_settle_is_the_same_as_alone(number: int, monkeypatch: pytest.MonkeyPatch) -> None:
    for problem in (queens(14, 1, 3), cover(30, 24, 6, 0.25, 1)):
        alone = numbers(least_by_clauses(pruned(reduced(problem)), Budget()))
        with monkeypatch.context() as patch:
            patch.setattr(rival, "processors", lambda: number)
            patch.setattr(least_solution, "processors", lambda: number)
            for moment in ("ALONE", "ALONE_OF_TWO", "FIRST_TURN"):
                patch.setattr(least_solution, moment, 1)
            patch.setattr(least_solution, "BRIEF", 0)
            patch.setattr(clause_learning, "CONFLICTS_PER_CALL", 20)
            assert numbers(least_by_clauses(pruned(reduced(problem)), Budget())) == alone
            assert any_by_clauses(pruned(reduced(problem)), Budget()) is not None


def test_a_budget_of_steps_starts_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(least_solution, "ALONE", 1)
    monkeypatch.setattr(subprocess, "Popen", None)
    assert least_by_clauses(pruned(reduced(queens(10, 1, 2))), Budget(100_000))


SEARCHING = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # what a shell starts in the background ignores it
from benchmarks.search.families.scaling import satisfiability
from selfconf.search.budget import Budget
from selfconf.search.engines import clause_learning, least_solution, rival
from selfconf.search.reduction import reduced
least_solution.ALONE = least_solution.ALONE_OF_TWO = 1
popen = rival.subprocess.Popen
def started(*arguments, **options):
    process = popen(*arguments, **options)
    print(process.pid, flush=True)
    return process
rival.subprocess.Popen = started
least_solution.least_by_clauses(reduced(satisfiability(400, 4.26, 1)), Budget())
"""


@pytest.mark.process
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGKILL], ids=lambda number: number.name)
def test_the_rival_ends_with_the_search(number: signal.Signals) -> None:
    root = Path(__file__).resolve().parents[3]
    command = [
        sys.executable,
        "-c",
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)" + SEARCHING,
    ]
    with subprocess.Popen(command, cwd=root, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as search:
        assert search.stdout is not None
        other = int(search.stdout.readline())
        search.send_signal(number)
        search.wait(30)
        deadline = time.monotonic() + 60
        while _lives(other):
            assert time.monotonic() < deadline
            os.sched_yield()


def _lives(process: int) -> bool:
    try:
        return "Z" not in Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except FileNotFoundError:
        return False
    except ProcessLookupError:
        return False


def test_without_a_processor_to_spare_there_is_no_rival(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sched_getaffinity", lambda _: {0})
    assert not Rival.available()
