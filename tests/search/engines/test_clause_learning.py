"""Clause learning finds the least solution, and is a guest in the process that takes no signal of others."""

from __future__ import annotations

import importlib.util
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import given

from benchmarks.search.families import scaling
from selfconf.search.budget import Budget
from selfconf.search.engines import clause_learning, solver_available
from selfconf.search.engines.formula import Counted
from selfconf.search.engines.least_solution import least_by_clauses
from selfconf.search.engines.ordered_decisions import OrderedDecisions
from selfconf.search.problem import Problem
from selfconf.search.reduction.constraints import pruned
from selfconf.search.reduction.dominance import reduced
from tests.search.comparison import least_numbers, numbers
from tests.search.without_solvers import without_solvers
from tests.search.worlds import agreement, problems

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture
def interruptible() -> Iterator[None]:
    """Handle SIGINT as Python does at a terminal: a shell starts what runs in the background with SIGINT ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_the_decision_for_python_sat_names_what_imports_it_and_how_long_a_call_is() -> None:
    page = " ".join((ROOT / "docs" / "decisions" / "0004-python-sat.md").read_text().split())
    sources = sorted((ROOT / "selfconf").rglob("*.py"))
    importing = [path for path in sources if re.search(r"^ *(from|import) pysat\b", path.read_text(), re.MULTILINE)]
    assert {path.parent for path in importing} == {Path(clause_learning.__file__).parent}
    assert sorted({path.name for path in importing}) == sorted(set(re.findall(r"`(\w+\.py)`", page)))
    for conflicts in (clause_learning.CONFLICTS_PER_CALL, clause_learning.LONGEST_CALL):
        assert f"{conflicts:,}" in page


def test_whether_the_solver_is_there_is_looked_up_once() -> None:
    there = importlib.util.find_spec("pysat") is not None
    assert solver_available() == there
    with without_solvers():
        assert not solver_available()
        assert not solver_available()
        assert solver_available.cache_info().misses == 1
    assert solver_available() == there


INTERRUPTING = "import os, signal, sys; sys.stdin.read(1); os.kill(os.getppid(), signal.SIGINT)"


@given(problems())
@agreement(0.6)
def test_clause_learning_finds_the_least_solution(problem: Problem) -> None:
    pytest.importorskip("pysat")
    expected = least_numbers(problem)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(OrderedDecisions, "available", staticmethod(lambda _: False))
        assert numbers(least_by_clauses(pruned(reduced(problem)), Budget())) == expected
        assert numbers(least_by_clauses(reduced(problem), Budget(10_000))) == expected


def test_propagation_alone_refutes_what_is_refuted_without_a_search() -> None:
    pytest.importorskip("pysat")
    with clause_learning.ClauseSolver(pruned(reduced(scaling.distinct(3, 3)))) as solver:
        first, second = solver.literal(), solver.literal()
        assert not solver.refutes(first)
        solver.add([-first, second])
        solver.add([-first, -second])
        assert solver.refutes(first)
        assert not solver.refutes(second)
        assert solver.conflicts == 0


def test_what_is_settled_refutes_what_cannot_be_beside_it() -> None:
    pytest.importorskip("pysat")
    given_ = pruned(reduced(scaling.distinct(3, 3)))
    with clause_learning.ClauseSolver(given_) as solver:
        (first, second, third), (of_second, *others), _ = solver.plays
        assert {-second, -third, -of_second} <= (solver.implied([first]) or set())
        assert solver.implied([first, of_second]) is None
        assert not solver.refutes(of_second)
        solver.settle([first])
        assert solver.refutes(second)
        assert solver.refutes(of_second)
        assert not any(map(solver.refutes, others))
        # What holds by now follows from nothing, and not from what is asked about.
        assert -of_second not in (solver.implied(others[:1]) or set())
        assert solver.ask((), Budget())
        assert solver.holds(first)
        every = [literal for literals in solver.plays for literal in literals]
        assert solver.holding(every) == [literal for literal in every if solver.holds(literal)]


def test_another_thread_ends_a_call_and_the_next_one_goes_on(monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pysat")
    monkeypatch.setattr(clause_learning, "CONFLICTS_PER_CALL", 10**9)
    with clause_learning.ClauseSolver(reduced(scaling.satisfiability(400, 4.26, 1))) as clauses:
        timer = threading.Timer(0.2, clauses.interrupt)
        timer.start()
        assert clauses.ask((), Budget()) is None
        timer.join()
        before = clauses.conflicts
        assert clauses.ask((), Budget(), 100) is None
        assert clauses.conflicts - before >= 100


@pytest.mark.parametrize(
    ("counted", "which"),
    [(Counted.NONE, []), (Counted.MANY, [5]), (Counted.ALL, [2, 4, 5, 6])],
    ids=lambda one: str(one),
)
def test_numbers_are_counted_by_clauses_or_by_the_solver(counted: Counted, which: list[int]) -> None:
    pytest.importorskip("pysat")
    with clause_learning.ClauseSolver(reduced(scaling.satisfiability(10, 2.0, 1)), counted=counted) as clauses:
        literals = [clauses.literal() for _ in range(10)]
        grown = []
        for most in (2, 4, 5, 6, 10, 1):
            before = clauses.literal()
            clauses.at_most(literals, most)
            grown += [most] if clauses.literal() > before + 1 else []
        assert grown == which
        before = clauses.literal()
        clauses.at_most(literals, 1, exactly=True)
        assert (clauses.literal() > before + 1) == (counted is Counted.ALL)
        for literal in literals[:2]:
            assert clauses.ask((literal,), Budget())
        assert not clauses.ask(literals[:2], Budget())


@pytest.mark.usefixtures("interruptible")
def test_an_interrupt_in_the_middle_of_a_call_reaches_the_program(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(clause_learning, "CONFLICTS_PER_CALL", 20_000)  # conflicts: calls of about a tenth of a second
    command = [sys.executable, "-c", INTERRUPTING]
    with (
        clause_learning.ClauseSolver(reduced(scaling.satisfiability(400, 4.26, seed=1))) as clauses,
        subprocess.Popen(command, stdin=subprocess.PIPE) as other,
    ):
        solve_limited = clauses._solver.solve_limited

        def solving(**options: object) -> object:
            if other.stdin is not None and not other.stdin.closed:
                other.stdin.close()
            return solve_limited(**options)

        monkeypatch.setattr(clauses._solver, "solve_limited", solving)
        with pytest.raises(KeyboardInterrupt):
            clauses.solve((), Budget())
