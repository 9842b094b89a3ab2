"""The benchmark of contention: its short run works, and its table says what contention costs beyond the own calls."""

from __future__ import annotations

import pytest

from benchmarks.contention import Round, needs, report
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough


@thorough
@pytest.mark.process
def test_the_short_run_runs() -> None:
    printed = short_run("benchmarks.contention")
    assert "| 2 | 1 |" in printed


def test_tasks_name_what_they_share_in_opposite_order() -> None:
    first, second = needs(0), needs(1)
    assert set(first) & set(second)
    assert first == sorted(first, reverse=True)
    assert second == sorted(second)


def test_the_table_says_what_is_beyond_the_own_calls() -> None:
    line = report([0.03, 0.04, 0.05], {2: [Round(0.06, 2, 0), Round(0.1, 1, 1), Round(0.08, 1, 1)]}).splitlines()[2]
    assert line == "| 2 | 3 | 40 | 80 | 40 | 60 | 1.3 | 0.7 |"
