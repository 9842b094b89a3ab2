"""The benchmark of what keys cost: its short run works, and its table says ratios."""

from __future__ import annotations

import pytest

from benchmarks.access import KEYED, PLAIN, UNREAD, report
from tests.benchmarks.short_run import short_run
from tests.harness.effort import thorough


@thorough
@pytest.mark.process
def test_the_short_run_runs() -> None:
    printed = short_run("benchmarks.access")
    assert "| failover |" in printed
    assert "| signal of 300,000 bytes |" in printed
    assert "| 100 bytes at 10,000 a second: the hub's processor, for each |" in printed


def test_the_table_tells_ratios() -> None:
    times = {("x", PLAIN): [0.002] * 3, ("x", KEYED): [0.003] * 3, ("x", UNREAD): [0.0025] * 3}
    assert "| x | 2.000 | 3.000 | 2.500 | 1.50 | 1.20 |" in report(times)
