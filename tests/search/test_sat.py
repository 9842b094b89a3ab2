"""The clause-learning engine as a guest in the process: it takes no signal that is not its own."""

from __future__ import annotations

import subprocess
import sys

import pytest

from benchmarks.search import families
from selfconf.search.budget import Budget
from selfconf.search.engines import clause_learning as sat
from selfconf.search.reduction.dominance import reduced

INTERRUPTING = "import os, signal, sys; sys.stdin.read(1); os.kill(os.getppid(), signal.SIGINT)"


def test_an_interrupt_in_the_middle_of_a_call_is_one_for_the_program(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sat, "SLICE", 20_000)  # conflicts: calls of about a tenth of a second
    command = [sys.executable, "-c", INTERRUPTING]
    with (
        sat.ClauseSolver(reduced(families.satisfiability(400, 4.26, seed=1))) as clauses,
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
