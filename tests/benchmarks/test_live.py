"""The benchmark of living ecologies: its short run works, and its page tells how the times grow."""

from __future__ import annotations

import pytest

from benchmarks.live.__main__ import Measured, report
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough


@thorough
@pytest.mark.process
def test_the_short_run_runs() -> None:
    printed = short_run("benchmarks.live")
    assert "| 20 | 2 |" in printed


@thorough
@pytest.mark.process
@pytest.mark.parametrize("keys", ["no", "yes"])
def test_sites_and_their_tasks_are_back_after_a_short_stall(keys: str) -> None:
    printed = short_run("benchmarks.live.stall", *(["--keys"] if keys == "yes" else []))
    assert f"| 3 | 6 | {keys} |" in printed


def test_the_page_tells_how_the_times_grow() -> None:
    small = Measured(100, 1, 1.0, 0.01, 0.01, 0.01, 0.1, 0.005, 50.0, 0.001)
    large = Measured(10_000, 1, 1.0, 1.0, 0.1, 0.1, 1.0, 0.005, 100.0, 0.001)
    page = report([small, large])
    assert "from 100 to 10,000 components: discover 1.00, again 0.50, bare 0.50, running 0.50, failover 0.00" in page
